"""Hold: a reading may be taken only when the tool was inside the tolerance and steady for a while."""

from __future__ import annotations

import math

HOLD_S = 0.5
STEADY = math.radians(2.0)
"""rad/s; the tool's axis may move slower than this."""
GAP_S = 0.1
"""A longer step between two samples is a break: nobody knows what the tool did meanwhile."""


class Hold:
    """Arms after HOLD_S without a break. Told of every sample, in order, by the samples' own time."""

    def __init__(self) -> None:
        self.armed = False
        self.progress = 0.0  # 0 to 1
        self._since = math.nan  # s, when the present unbroken hold began
        self._last = math.nan

    def step(self, t: float, inside: bool, rate: float, trusted: bool) -> bool:
        """Take one sample at ``t`` s: inside the tolerance, moving at ``rate`` rad/s, trusted; True when armed.

        A rate that is not known (NaN) counts as moving.
        """
        broken = not 0.0 <= t - self._last <= GAP_S
        self._last = t
        if not (inside and trusted and rate < STEADY):
            self._since = math.nan
        elif broken or math.isnan(self._since):
            self._since = t
        held = t - self._since
        # sums of rounded times: 1 microsecond short of the time is the time
        self.armed = held >= HOLD_S - 1e-6
        self.progress = 0.0 if math.isnan(held) else min(1.0, held / HOLD_S)
        return self.armed

    def reset(self) -> None:
        """Begin again: trust was lost, the plan was changed, or a reading was taken."""
        self.armed, self.progress, self._since = False, 0.0, math.nan
