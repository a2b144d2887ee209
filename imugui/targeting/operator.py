"""The simulated user: looks at the game, thinks, turns the board and presses its button; seeded.

It sees what a screen shows, late and not exactly: where view and target are, what is steered, what matches. It knows
the mapping, its gain and its lag, as somebody does who has practised. What it does: pan until the place matches, stop,
zoom until the size does, and begin again when one of them is lost.
"""

from __future__ import annotations

import random
from collections import deque
from collections.abc import Iterator
from math import exp, hypot, sqrt

from imugui.fusion.scalar import NOTHING, Quat
from imugui.targeting.activation import Input
from imugui.targeting.game import SELECT, Game
from imugui.targeting.operator_hand import Card, Hand
from imugui.targeting.operator_plan import AXES, Axis
from imugui.targeting.person import Person, of_the_day
from imugui.targeting.play_again import Row
from imugui.targeting.settings import Control
from imugui.targeting.tasks import BUTTON
from imugui.targeting.trials import Trial
from imugui.targeting.turning import LETTERS
from imugui.targeting.view_pose import PAN, ZOOM, Pair, View

LEVEL: Quat = (1.0, 0.0, 0.0, 0.0)
SEEN_S = 0.2
"""Correlation time of the error of the eye."""
LONGEST_S = 600.0
"""A run that takes longer is given up."""


class Eye:
    """What the person sees of the view: late, and with an error that changes slowly."""

    def __init__(self, person: Person, dt: float, draw: random.Random) -> None:
        self._person, self._gauss = person, draw.gauss
        late, glance = round(person.sight_s / dt), max(1, round(person.glance_s / dt))
        self._glance, self._glance_s = glance, glance * dt
        self._views: deque[View] = deque(maxlen=late + glance + 1)
        self._slow = exp(-dt / SEEN_S)
        self._errors = [0.0, 0.0, 0.0]  # of the place (2), of the speed as a part of it

    def see(self, view: View) -> None:
        """The view as it is now, to be noticed later."""
        self._views.append(view)
        kick = sqrt(1.0 - self._slow**2)
        self._errors = [self._slow * error + self._gauss(0.0, kick) for error in self._errors]

    def look(self, mode: str) -> tuple[Pair, Pair]:
        """Place (px) and speed (px/s) of what ``mode`` steers."""
        views, person = self._views, self._person
        before, now = views[0].part(mode), views[min(self._glance, len(views) - 1)].part(mode)
        a, b, c = self._errors
        share = (1.0 + person.see_share * c) / self._glance_s
        place = 0.5 * (now[0] + before[0]) + person.see_px * a, 0.5 * (now[1] + before[1]) + person.see_px * b
        return place, (share * (now[0] - before[0]), share * (now[1] - before[1]))


class Operator:
    """One person who plays one run, one row at a time; ``inputs`` belong to the row that ``act`` gave last."""

    def __init__(self, game: Game, person: Person, seed: int, rate_hz: float = 100.0) -> None:
        draw = random.Random(f"operator {seed}")  # noqa: S311 - a simulation
        self.inputs: tuple[Input, ...] = ()
        person = of_the_day(person, draw)
        self._game, self._person, self._dt = game, person, 1.0 / rate_hz
        self._count = 0
        self._hand, self._card = Hand(person, self._dt, LEVEL, draw), Card()
        self._eye, self._draw = Eye(person, self._dt, draw), draw
        self._stuck = False
        self._axes: list[Axis] = []
        self._life = self._live()

    def act(self) -> Row:
        """Look at the game as it stands, and make the next row."""
        self._count += 1
        self._eye.see(self._game.controller.view)
        self.inputs = (Input("confirm"),) if self._count == 1 else ()
        next(self._life, None)
        self._hand.step()
        return self._count * self._dt, self._hand.quat, self._hand.gyr, self._card.status

    @property
    def _control(self) -> Control:
        return self._game.controller.control

    @property
    def _mode(self) -> str:
        return self._game.controller.mode

    def _live(self) -> Iterator[None]:
        """What the person does, row by row."""
        yield from self._wait(self._person.reaction_s)
        while not self._game.done:
            need = self._need()
            if self._mode == need:
                yield from self._steer(need)
            elif self._mode:
                yield from self._press(self._person.press_s)
            else:
                yield from self._begin(need)

    def _need(self) -> str:
        """What the person wants to steer next."""
        place_ok, _ = self._game.matched
        return PAN if not place_ok or not self._game.task.sized else ZOOM

    def _wait(self, seconds: float) -> Iterator[None]:
        for _ in range(self._rows(seconds)):
            yield

    def _rows(self, seconds: float) -> int:
        """So many rows: the time, more or less."""
        return max(1, round(seconds * exp(self._draw.gauss(0.0, self._person.uneven)) / self._dt))

    def _begin(self, mode: str) -> Iterator[None]:
        """Take the hand back, and press the button as long as the mode needs it."""
        self._hand.wanted = NOTHING
        yield from self._wait(self._person.think_s)
        while not self._hand.back:
            yield
        control, person = self._control, self._person
        slip = self._draw.random() < person.slip
        yield from self._press(person.long_press_s if (mode == ZOOM) != slip else person.press_s)
        gain = (control.zoom_gain if mode == ZOOM else control.gain) * exp(self._draw.gauss(0.0, person.misjudge))
        kind, places = AXES[control.mapping], self._game.controller.view.part(mode)
        self._axes = [kind(person, control, gain, place, self._dt) for place in places]

    def _press(self, seconds: float) -> Iterator[None]:
        """Hold the button for so long; then it takes a moment to see what came of it."""
        self._hand.jolt()
        for _ in range(self._rows(seconds)):
            self._card.hold(self._dt)
            yield
        self._card.release()
        yield from self._wait(self._person.sight_s)

    def _steer(self, mode: str) -> Iterator[None]:
        """Follow the target until it changes, or until something else has to be done first."""
        game, person = self._game, self._person
        target, quiet, stuck = game.target, 0.0, 0.0
        while game.target is target and self._mode == mode:
            settled = self._follow(mode)
            quiet, stuck = (quiet + self._dt if settled else 0.0), (stuck + self._dt if self._stuck else 0.0)
            if quiet >= person.check_s and self._selects():
                yield from self._click(mode)
                quiet = 0.0
            elif stuck >= person.check_s or (quiet >= person.check_s and self._finished(mode)):
                yield from self._press(person.press_s)
                return
            yield
        yield from self._wait(person.reaction_s)

    def _selects(self) -> bool:
        return self._game.task.selection == BUTTON and all(self._game.matched)

    def _click(self, mode: str) -> Iterator[None]:
        """Select, while the hand still follows."""
        for _ in range(self._rows(self._person.press_s)):
            self._follow(mode)
            yield
        self.inputs = (Input(SELECT),)
        yield

    def _finished(self, mode: str) -> bool:
        """What is steered matches, and the other does not."""
        place_ok, size_ok = self._game.matched
        return (place_ok and not size_ok) if mode == PAN else (size_ok and not place_ok)

    def _follow(self, mode: str) -> bool:
        """Turn the hand by what is seen; whether the view is about to stay within the margin."""
        person, task = self._person, self._game.task
        goal, (place, speed) = View(*self._game.target[:3]).part(mode), self._eye.look(mode)
        tolerance = 0.5 * task.width(self._game.target) if mode == PAN else task.tolerance_px
        axes, felt = self._axes[: len(self._names(mode))], self._felt(mode)
        for n, axis in enumerate(axes):
            axis.follow(place[n], speed[n], goal[n], felt[n])
        self._turn(mode)
        self._stuck = any(axis.stuck(goal[n], place[n], tolerance) for n, axis in enumerate(axes))
        after = person.press_s + person.late_s
        return max(abs(goal[n] - place[n] - after * speed[n]) for n in range(len(axes))) < person.margin * tolerance

    def _names(self, mode: str) -> tuple[str, ...]:
        """The axes of the board that steer."""
        control = self._control
        return (control.zoom_axis,) if mode == ZOOM else (control.x_axis, control.y_axis)

    def _felt(self, mode: str) -> list[float]:
        """How far the hand is turned about them, deg, as it feels."""
        angles = self._hand.angles
        return [(-1.0 if name[0] == "-" else 1.0) * angles[LETTERS.index(name[1])] for name in self._names(mode)]

    def _turn(self, mode: str) -> None:
        """Want the hand turned as the axes ask for, as far as it reaches."""
        names = self._names(mode)
        length = hypot(*(axis.angle for axis in self._axes[: len(names)]))
        part = min(1.0, self._person.reach_deg / length) if length > 0.0 else 1.0
        wanted = [0.0, 0.0, 0.0]
        for name, axis in zip(names, self._axes, strict=False):
            axis.limit(part)
            wanted[LETTERS.index(name[1])] += -axis.angle if name[0] == "-" else axis.angle
        self._hand.wanted = wanted[0], wanted[1], wanted[2]


def played(game: Game, person: Person, seed: int, rate_hz: float = 100.0) -> Iterator[tuple[Row, tuple[Input, ...]]]:
    """Let a simulated user play a run: each row with the inputs that came with it, after the game has taken them.

    A run that never ends is cut off.
    """
    operator = Operator(game, person, seed, rate_hz)
    for _ in range(round(LONGEST_S * rate_hz)):
        row = operator.act()
        game.step(*row, operator.inputs)
        yield row, operator.inputs
        if game.done:
            return


def play_run(game: Game, person: Person, seed: int, rate_hz: float = 100.0) -> list[Trial]:
    """Let a simulated user play a run; its trials."""
    deque(played(game, person, seed, rate_hz), maxlen=0)
    return game.trials
