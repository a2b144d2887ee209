"""What the simulated user knows of the machine: where the view will be, and what the hand must do to have it there.

One axis of one activation. ``asked`` is what the hand asks the machine for: a place (px) with the position mapping, a
speed (px/s) with the speed mapping. The plan is the same for every machine: to be at the target a horizon from now.
Against a slow one that means to ask for more, and to take it back later.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections import deque
from math import exp, tanh, tau

from imugui.targeting.person import Person
from imugui.targeting.settings import POSITION, SPEED, Control

STILL = 50.0
"""px/s: a view that moves faster than this says little about what the hand asked for."""
HAND_SPEED = 50.0
"""deg/s, of a usual movement: it decides how much a 1-euro filter lags."""
SOFT_DEG = 0.5
"""A hand does not switch across a dead zone, it goes over it within about so much."""


class Axis(ABC):
    """``gain`` is what the person believes of the machine, px or px/s per deg; ``place`` where the view engages."""

    def __init__(self, person: Person, control: Control, gain: float, place: float, dt: float) -> None:
        self.angle = 0.0  # deg, where the hand is wanted
        self._limited = False
        self._gain, self._dead_deg, self._offset = gain, control.dead_zone_deg, 0.0
        cutoff_hz = control.min_cutoff_hz + HAND_SPEED * control.beta
        self._lag_s = control.lag_s + (1.0 / (tau * cutoff_hz) if control.smoothing else 0.0)
        self._dt, self._horizon_s, self._row_left = dt, person.horizon_s, self._left(dt)
        self._learned = dt / person.correct_s
        self._interval, self._rows_left = max(1, round(person.interval_s / dt)), 0
        late = max(1, round(person.late_s / dt))
        self._asked = deque([0.0] * late, maxlen=late)  # since what is seen now
        self._arm = range(round(2.0 / person.arm / dt))  # rows by which the arm lags
        self._start(place)

    def follow(self, place: float, speed: float, goal: float, felt: float) -> None:
        """Choose the angle for a view seen at ``place`` (px) with ``speed`` (px/s) and a hand that feels at (deg).

        A choice stands until the next one: people correct a few times a second, not all the time (R. C. Miall et
        al., J. Motor Behav. 25 (1993) 53).
        """
        self._offset += self._learned / (1.0 + (speed / STILL) ** 2) * self._surprise(place, speed, self._asked[0])
        self._asked.append(self._of(felt))
        self._rows_left -= 1
        if self._rows_left > 0:
            return
        self._rows_left = self._interval
        for asked in self._asked:
            place, speed = self._row(place, speed, asked)
        asked = self._of(self.angle)
        for _ in self._arm:
            place, speed = self._row(place, speed, asked)
        self.angle = self._angle(self._ask(place, speed, goal))
        self._limited = False

    def limit(self, part: float) -> None:
        """The hand reaches only so far: take this part of the angle."""
        if part < 1.0:
            self.angle, self._limited = part * self.angle, True

    def stuck(self, goal: float, place: float, tolerance: float) -> bool:
        """Whether the view has come as far as this activation brings it, and that is not the goal."""
        asked = self._of(self.angle)
        return self._limited and self.ends and abs(goal - asked) > tolerance and abs(place - asked) < tolerance

    ends = False
    """Whether an angle leads to a place, and no further."""

    @abstractmethod
    def _start(self, place: float) -> None: ...

    @abstractmethod
    def _of(self, angle: float) -> float:
        """What an angle of the hand (deg) asks for, as the person believes."""

    @abstractmethod
    def _angle(self, asked: float) -> float:
        """The angle (deg) that asks for this."""

    @abstractmethod
    def _row(self, place: float, speed: float, asked: float) -> tuple[float, float]:
        """Place and speed a row later, when the hand asks for this."""

    @abstractmethod
    def _ask(self, place: float, speed: float, goal: float) -> float:
        """What to ask for from now on, to be at the goal after the horizon."""

    @abstractmethod
    def _surprise(self, place: float, speed: float, asked: float) -> float:
        """By how much more seems to have been asked for than the person believes."""

    def _left(self, seconds: float) -> float:
        """What the machine leaves of a difference after so long."""
        return exp(-seconds / self._lag_s) if self._lag_s > 0.0 else 0.0


class PositionAxis(Axis):
    """lag place' = asked - place."""

    ends = True

    def _start(self, place: float) -> None:
        self._offset = place
        self._asked.extend([place] * len(self._asked))

    def _of(self, angle: float) -> float:
        return self._offset + self._gain * angle

    def _angle(self, asked: float) -> float:
        return (asked - self._offset) / self._gain

    def _row(self, place: float, speed: float, asked: float) -> tuple[float, float]:
        return asked + self._row_left * (place - asked), self._row_left * speed

    def _ask(self, place: float, speed: float, goal: float) -> float:
        return place + (goal - place) / (1.0 - self._left(self._horizon_s))

    def _surprise(self, place: float, speed: float, asked: float) -> float:
        return place + self._lag_s * speed - asked


class SpeedAxis(Axis):
    """place' = speed, lag speed' = asked - speed. A hand does not feel its neutral attitude: a creep has to be seen."""

    def _start(self, place: float) -> None:
        self._expected = 0.0  # px/s

    def _of(self, angle: float) -> float:
        over = angle - self._dead_deg * tanh(angle / (SOFT_DEG + self._dead_deg))
        return self._gain * over + self._offset

    def _angle(self, asked: float) -> float:
        angle = (asked - self._offset) / self._gain
        return angle + self._dead_deg * tanh(angle / SOFT_DEG)

    def _row(self, place: float, speed: float, asked: float) -> tuple[float, float]:
        speed = asked + self._row_left * (speed - asked)
        return place + self._dt * speed, speed

    def _ask(self, place: float, speed: float, goal: float) -> float:
        rolled = self._lag_s * (1.0 - self._left(self._horizon_s))
        return (goal - place - speed * rolled) / (self._horizon_s - rolled)

    def _surprise(self, place: float, speed: float, asked: float) -> float:
        self._expected = asked + self._row_left * (self._expected - asked)
        return speed - self._expected


AXES: dict[str, type[Axis]] = {POSITION: PositionAxis, SPEED: SpeedAxis}
