"""Whether a row is fit to steer with, by its own numbers and by the time since the row before."""

from __future__ import annotations

from collections import deque
from math import inf, isfinite, nan, radians, sqrt

from imugui.fusion.scalar import Quat, Vector
from imugui.targeting.settings import Control

PERIODS = 5.0
"""So many periods without a sample are no jitter any more (E.2, T2)."""

REMEMBERED = 9
"""The period is the median of so many intervals: one gap, or a few, do not change it."""

LENGTH_ERROR = 0.01
"""A quaternion whose length is further from 1 is no rotation."""

RANGE_END = 0.99
"""From this part of its range on a gyroscope is saturated."""


class Validity:
    """Measures dt and looks for what makes a row useless."""

    def __init__(self, control: Control) -> None:
        self._stale_s = control.stale_s
        self._fastest = RANGE_END * radians(control.gyro_range_dps)  # rad/s
        self._intervals: deque[float] = deque(maxlen=REMEMBERED)
        self.t = nan  # s, of the last row that had a time
        self.dt = 0.0  # s, between the last two rows; 0 when that is not known
        self.limit_s = self._stale_s

    @property
    def stale_words(self) -> str:
        """The cause to log when no row came for ``limit_s``."""
        return f"no sample for {1000.0 * self.limit_s:.0f} ms"

    def look(self, t: float, quat: Quat, gyr: Vector) -> str:
        """Why the row at t (s) is useless, in words; empty for a good one.

        ``gyr`` in rad/s may be NaN: some boards have no gyroscope.
        """
        last, limit, gap = self.t, self.limit_s, self.stale_words
        self.dt = 0.0
        if not isfinite(t):
            return "a time that is not a number"
        self.t = t
        if t < last:
            return "time went back"
        if t > last:  # never for the first row
            self.dt = t - last
            self._learn(self.dt)
            if self.dt > limit:
                return gap
        return self._wrong(quat, gyr)

    def _learn(self, dt: float) -> None:
        self._intervals.append(dt)
        period = sorted(self._intervals)[len(self._intervals) // 2]
        self.limit_s = max(self._stale_s, PERIODS * period)

    def _wrong(self, quat: Quat, gyr: Vector) -> str:
        w, x, y, z = quat
        length = sqrt(w * w + x * x + y * y + z * z)
        if not length < inf:
            return "an attitude that is not a number"
        if abs(length - 1.0) > LENGTH_ERROR:
            return "a quaternion that is not of unit length"
        fastest = self._fastest
        if abs(gyr[0]) >= fastest or abs(gyr[1]) >= fastest or abs(gyr[2]) >= fastest:
            return "the gyroscope is saturated"
        return ""
