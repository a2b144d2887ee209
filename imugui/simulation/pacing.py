"""Pacing: how many samples of a steady board are due at a host time."""

from __future__ import annotations

import math

CATCH_UP_S = 0.5
"""After a stall at most this much is made up for; the rest is given up, or one stall would breed the next."""


class Pacer:
    """Counts samples against a clock that it is told; never drifts, since every answer counts from the start."""

    def __init__(self, rate_hz: float, start_t: float, catch_up_s: float = CATCH_UP_S) -> None:
        if not rate_hz > 0.0:
            raise ValueError(f"a rate is above 0 Hz, not {rate_hz}")
        self.rate_hz, self.start_t = rate_hz, start_t
        self.skipped = 0  # samples given up after stalls
        self._most = max(1, math.floor(catch_up_s * rate_hz))
        self._given = 0

    def due(self, t: float) -> int:
        """How many samples to send at host time t in s, given what was sent before; the first is due at the start."""
        passed = math.floor((t - self.start_t) * self.rate_hz + 1e-6) + 1
        late = passed - self._given - self.skipped
        if late <= 0:
            return 0
        n = min(late, self._most)
        self.skipped += late - n
        self._given += n
        return n

    def wait_s(self, t: float) -> float:
        """Time from host time t until the next sample is due, s; 0 when one is due."""
        return max(0.0, self.start_t + (self._given + self.skipped) / self.rate_hz - t)
