"""A person in figures: what the simulated user of the game is like. None of them depends on the mapping or the lag."""

from __future__ import annotations

import dataclasses
import math
import random
from dataclasses import dataclass

SPREAD = 0.12
"""Standard deviation between people of the logarithm of their figures."""
PERSONAL = ("reaction_s", "think_s", "press_s", "check_s", "sight_s", "horizon_s", "reach_deg", "misjudge", "motor")
SLOW = ("reaction_s", "think_s", "press_s", "check_s", "horizon_s", "interval_s")
"""What practice makes shorter."""


@dataclass(frozen=True)
class Person:
    """One person; the defaults are one in the middle."""

    reaction_s: float = 0.25  # from a change on the screen to the first movement
    think_s: float = 0.5  # to decide what is next, before pressing
    press_s: float = 0.2  # a short press
    long_press_s: float = 0.7
    check_s: float = 0.15  # a match has to last so long to be believed
    sight_s: float = 0.12  # the eye is so much behind while following
    glance_s: float = 0.10  # over which a speed is seen
    see_px: float = 1.0  # rms error of a place as it is seen
    see_share: float = 0.20  # the same of a speed, as a part of it
    horizon_s: float = 0.6  # how far ahead the person plans: the view is to be at the target by then
    interval_s: float = 0.25  # between two corrections
    correct_s: float = 0.25  # time constant of learning from where the view really went
    misjudge: float = 0.05  # rms error of what an angle does, as a part of it, anew at each activation
    arm: float = 15.0  # rad/s, natural frequency of the arm, critically damped
    reach_deg: float = 35.0  # the hand is not turned further from its neutral attitude
    neutral_deg: float = 2.0  # nearer than this the hand is back
    motor: float = 0.03  # noise of the moving hand: deg per deg/s and root of s
    wander_deg: float = 0.15  # rms of the hand that holds still
    jolt_deg: float = 0.3  # rms of what a press does to the hand
    margin: float = 0.6  # part of the tolerance that the person allows
    form: float = 0.12  # standard deviation of the logarithm of all times from run to run
    uneven: float = 0.25  # the same of each single wait and press
    slip: float = 0.03  # chance that a press is too long or too short
    learning: float = 0.1  # r of T_b = T_1 b^-r, the power law of practice

    @property
    def late_s(self) -> float:
        """How old what the person sees is: place and speed are those in the middle of the glance."""
        return self.sight_s + 0.5 * self.glance_s


def one_of_many(seed: int) -> Person:
    """A person drawn from the seed: figures vary between people."""
    draw = random.Random(f"person {seed}")  # noqa: S311 - a simulation
    figures = {name: getattr(Person(), name) * math.exp(draw.gauss(0.0, SPREAD)) for name in PERSONAL}
    return dataclasses.replace(Person(), **figures)


def of_the_day(person: Person, draw: random.Random) -> Person:
    """The person in one run: sometimes quicker, sometimes slower."""
    scale = math.exp(draw.gauss(0.0, person.form))
    return dataclasses.replace(person, **{name: scale * getattr(person, name) for name in SLOW})


def practised(person: Person, block: int) -> Person:
    """The person in a block (1 is the first): what takes time takes b^-r of the first."""
    scale = max(block, 1) ** -person.learning
    return dataclasses.replace(person, **{name: scale * getattr(person, name) for name in SLOW})
