"""From engaging to letting go: the chain that turns attitudes into places of the view."""

from __future__ import annotations

from typing import NamedTuple

from imugui.fusion.scalar import NOTHING, Quat, Vector
from imugui.targeting.lag import DeadTime
from imugui.targeting.mappings import MAPPINGS
from imugui.targeting.one_euro import OneEuro
from imugui.targeting.settings import Control
from imugui.targeting.turning import Steering, turn_deg
from imugui.targeting.view_pose import ZERO, Pair


class Stages(NamedTuple):
    """What the newest row became on its way, deg: in view axes, smoothed, delayed."""

    steer: Pair
    smooth: Pair
    delayed: Pair


NO_STAGES = Stages(ZERO, ZERO, ZERO)


class Engagement:
    """Everything that remembers anything about the hand. It is made anew at each engaging, at rest and at zero:

    no old attitude can be left in a filter, so the first row moves the view by exactly 0 px (E.2, T3).
    """

    def __init__(self, control: Control, mode: str, t: float, origin: Quat, place: Pair) -> None:
        self.turn: Vector = NOTHING
        """The rotation vector since engaging, (3,) deg, in the axes the board had then."""
        self.stages = NO_STAGES
        self._ramp_s = control.gain_ramp_s
        self._ramp_t = t + control.dead_time_s  # when the first movement gets through
        self._origin = origin
        self._steering = Steering(control, mode, origin)
        self._smooth = OneEuro(control.min_cutoff_hz, control.beta, control.derivative_cutoff_hz)
        self._smooth.reset(ZERO)
        self._smoothing = control.smoothing
        self._dead_time = DeadTime(control.dead_time_s)
        self._dead_time.reset(t)
        self._mapping = MAPPINGS[control.mapping](control, mode, place)

    def look(self, quat: Quat) -> Vector:
        """The turn since engaging for this attitude, deg."""
        self.turn = turn_deg(self._origin, quat)
        return self.turn

    def step(self, t: float, dt: float) -> Pair:
        """The place, px, that the turn looked at last leads to; t in s, ``dt`` > 0 in s since the row before."""
        steer = self._steering.pair(self.turn)
        smooth = self._smooth.update(steer, dt) if self._smoothing else steer
        delayed = self._dead_time.update(t, smooth)
        self.stages = Stages(steer, smooth, delayed)
        return self._mapping.step(delayed, self._ramp(t), dt)

    def _ramp(self, t: float) -> float:
        """The part of the gain that counts at t in s."""
        after, whole = t - self._ramp_t, self._ramp_s
        return max(after, 0.0) / whole if after < whole and whole > 0.0 else 1.0
