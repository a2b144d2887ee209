"""Cursors: two places in time, snapped to samples, with what lies between them."""

from __future__ import annotations

import math
from dataclasses import dataclass

from imugui.signals.history import History

NAMES = ("A", "B")
FIRST_PLACES = (0.3, 0.7)  # share of the window


@dataclass(frozen=True)
class Reading:
    """Values at both cursors, their difference and the slope a second; of angles with whole turns counted on."""

    a: float
    b: float
    delta: float
    slope: float


class Cursors:
    """``times`` of both, s, NaN while there are none; ``active`` is the one that keys and clicks move."""

    def __init__(self) -> None:
        self.clear()

    def clear(self) -> None:
        """Take both away."""
        self.times = [math.nan, math.nan]
        self.active = 0

    @property
    def shown(self) -> bool:
        return not math.isnan(self.times[0])

    @property
    def delta_s(self) -> float:
        """Time from A to B, s."""
        return self.times[1] - self.times[0]

    def put(self, history: History, start: float, end: float) -> None:
        """Set both into the window from start to end (s)."""
        self.times = [history.nearest_t(start + share * (end - start)) for share in FIRST_PLACES]

    def take(self, number: int) -> None:
        """Make cursor 0 (A) or 1 (B) the active one."""
        self.active = number

    def move_to(self, history: History, t: float) -> None:
        """Set the active one to the sample nearest to t (s)."""
        self.times[self.active] = history.nearest_t(t)

    def step(self, history: History, samples: int) -> None:
        """Move the active one by samples."""
        self.times[self.active] = history.stepped_t(self.times[self.active], samples)

    def read(self, history: History, key: str) -> Reading:
        """What a channel says at the cursors, SI."""
        a, b = (history.at(key, t) for t in self.times)
        return Reading(a, b, b - a, (b - a) / self.delta_s if self.delta_s else math.nan)
