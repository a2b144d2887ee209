"""The two mappings that are compared: an angle means a place, or an angle means a speed.

Each gets the smoothed, delayed turn since engaging, in view axes, and returns the place of the view.
No limit winds up: whatever was not executed is forgotten, so a hand that turns back acts at once.
"""

from __future__ import annotations

from typing import Protocol

from imugui.targeting.curve import Curve
from imugui.targeting.lag import FirstOrderLag
from imugui.targeting.limits import Box, RateLimit, box_around, stopped
from imugui.targeting.settings import POSITION, SPEED, Control
from imugui.targeting.view_pose import ZERO, ZOOM, Pair


class Mapping(Protocol):
    """One activation: turns in, places out."""

    def __init__(self, control: Control, mode: str, place: Pair) -> None: ...

    def step(self, turn: Pair, ramp: float, dt: float) -> Pair:
        """The new place in px; ``turn`` in deg since engaging, ``ramp`` 0 to 1 of the gain, ``dt`` > 0 in s."""


class PositionMapping:
    """place = lag(base + gain * curve(turn - reference)), from the place at engaging.

    Whatever a limit cuts off is taken from base or reference: the reference slides (E.2, T6). The ramp slides it
    too, by the part of each movement that does not count yet, so that a hand at rest never moves the view.
    """

    def __init__(self, control: Control, mode: str, place: Pair) -> None:
        self._gain = control.zoom_gain if mode == ZOOM else control.gain
        self._curve = Curve(control)
        self._box: Box = box_around(control, mode, place)
        self._rate = RateLimit(control.v_max, control.a_max)
        self._lag = FirstOrderLag(control.lag_s)
        self._lag.reset(place)
        self._base = self._command = place
        self._reference = self._turn = ZERO

    def step(self, turn: Pair, ramp: float, dt: float) -> Pair:
        """The new place in px; ``turn`` in deg since engaging, ``ramp`` 0 to 1 of the gain, ``dt`` > 0 in s."""
        a, b = self._pull(turn, ramp)
        wanted = self._base[0] + a, self._base[1] + b
        place = self._within(wanted, dt)
        if place != wanted:
            self._base = place[0] - a, place[1] - b
        self._command = place
        return self._lag.update(place, dt)

    def _pull(self, turn: Pair, ramp: float) -> Pair:
        """How far the hand asks for, px from the base; the reference slides with ramp and saturation."""
        late = 1.0 - ramp
        ra, rb = self._reference
        ra, rb = ra + late * (turn[0] - self._turn[0]), rb + late * (turn[1] - self._turn[1])
        self._turn = turn
        ea, eb = self._curve.excess((turn[0] - ra, turn[1] - rb))
        self._reference = ra, rb = ra + ea, rb + eb
        a, b = self._curve.shape((turn[0] - ra, turn[1] - rb))
        return self._gain * a, self._gain * b

    def _within(self, wanted: Pair, dt: float) -> Pair:
        """The place nearest to ``wanted`` that the limits allow ``dt`` s after the last command."""
        a, b = self._command
        asked = (wanted[0] - a) / dt, (wanted[1] - b) / dt
        velocity = self._rate.limit(asked, dt)
        place = wanted if velocity == asked else (a + velocity[0] * dt, b + velocity[1] * dt)
        allowed = self._box.clamp(place)
        self._rate.value = stopped(velocity, place, allowed)
        return allowed


class SpeedMapping:
    """velocity = lag(ramp * gain * curve(turn)), integrated from the place at engaging; a wall stops the integrator.

    The lag and the velocity limit forget their speed into a wall too: else they would push on after the hand
    has turned back.
    """

    def __init__(self, control: Control, mode: str, place: Pair) -> None:
        self._gain = control.zoom_gain if mode == ZOOM else control.gain
        self._curve = Curve(control)
        self._box: Box = box_around(control, mode, place)
        self._rate = RateLimit(control.v_max, control.a_max)
        self._lag = FirstOrderLag(control.lag_s)
        self._place = place

    def step(self, turn: Pair, ramp: float, dt: float) -> Pair:
        """The new place in px; ``turn`` in deg since engaging, ``ramp`` 0 to 1 of the gain, ``dt`` > 0 in s."""
        gain = ramp * self._gain
        a, b = self._curve.shape(turn)
        velocity = self._lag.update(self._rate.limit((gain * a, gain * b), dt), dt)
        place = self._place[0] + velocity[0] * dt, self._place[1] + velocity[1] * dt
        self._place = self._box.clamp(place)
        if self._place != place:
            self._lag.reset(stopped(velocity, place, self._place))
            self._rate.value = stopped(self._rate.value, place, self._place)
        return self._place


MAPPINGS: dict[str, type[Mapping]] = {POSITION: PositionMapping, SPEED: SpeedMapping}
