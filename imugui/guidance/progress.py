"""Progress: how a person came to the plan, one for each trajectory."""

from __future__ import annotations

import math
from dataclasses import dataclass

LEAVE = 1.25
"""Green is left, for counting overshoots, at this many tolerances: a tremor on the edge is no overshoot."""
LONGEST_STEP_S = 0.1
"""Time between two samples that counts; what lies in a longer step nobody saw."""


@dataclass
class Progress:
    """Times in s of the samples' own clock, counted from the first trusted one; NaN: not yet."""

    began: float = math.nan
    first_green: float = math.nan
    in_green: float = 0.0
    overshoots: int = 0  # times the error left green again
    _entered: bool = False
    _last: float = math.nan

    def step(self, t: float, error: float, tolerance: float) -> None:
        """Take one trusted sample: at ``t`` s the tool was ``error`` rad off, of which ``tolerance`` rad is green."""
        if math.isnan(self.began):
            self.began = t
        green = error <= tolerance
        if green and math.isnan(self.first_green):
            self.first_green = t
        passed = t - self._last
        if green and 0.0 <= passed <= LONGEST_STEP_S:
            self.in_green += passed
        if self._entered and error > LEAVE * tolerance:
            self.overshoots += 1
            self._entered = False
        self._entered = self._entered or green
        self._last = t

    @property
    def time_to_green(self) -> float:
        """Seconds from the first trusted sample to the first green one; NaN when there was none."""
        return self.first_green - self.began

    @property
    def duration(self) -> float:
        """Seconds from the first trusted sample to the last."""
        return self._last - self.began
