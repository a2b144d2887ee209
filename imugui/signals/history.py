"""History: the last minutes of many channels, as plain rows with the gaps between them.

A window of 120 s at 1 kHz is reduced to screen columns anew for each picture: ``numpy.fmin.reduceat`` takes 0.03 ms
for 131,072 numbers, so that levels of coarser minima and maxima would save nothing that can be noticed.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

LONGEST_WINDOW_S = 120.0
BACK_S = 0.1  # a smaller step back in time is jitter of a clock: time stands still
GAP_INTERVALS = 3.5  # as in fusion/timing.py: fewer missing samples are not called a gap
GAP_MIN_S = 0.005
REMEMBERED = 64  # newest intervals, whose median is the usual one


class History:
    """At least the last ``capacity`` rows of the channels ``keys``; a row of NaN stands in each gap.

    ``periods`` names the channels that start again after a period: their whole turns are counted, so that a curve
    goes on where the angle jumps; ``channels.fold`` takes the turns off.
    Time going back by more than BACK_S, or on by more than the longest window, starts the history anew.
    """

    def __init__(self, keys: Sequence[str], capacity: int, periods: Mapping[str, float] | None = None) -> None:
        self.capacity = capacity
        self.restarts = 0  # times that the history began anew
        self._row = {key: row for row, key in enumerate(keys)}
        self._periods = {self._row[key]: period for key, period in (periods or {}).items()}
        room = capacity + capacity // 4 + 1
        # filled, so that the system gives the memory now and not while the history grows
        self._t = np.full(room, np.nan)
        self._values = np.full((len(keys), room), np.nan)
        self.clear()

    def clear(self) -> None:
        """Forget every row."""
        self._end = 0
        self._steps: Floats = np.empty(0)
        self._gaps: list[tuple[float, float]] = []
        self._turned = dict.fromkeys(self._periods, math.nan)

    def __len__(self) -> int:
        return self._end

    @property
    def nbytes(self) -> int:
        """Memory of all arrays, bytes."""
        return self._t.nbytes + self._values.nbytes + self._steps.nbytes + 16 * len(self._gaps)

    @property
    def first_t(self) -> float:
        """Time of the oldest row, s; NaN when empty."""
        return float(self._t[0]) if self._end else math.nan

    @property
    def last_t(self) -> float:
        """Time of the newest row, s; NaN when empty."""
        return float(self._t[self._end - 1]) if self._end else math.nan

    @property
    def t(self) -> Floats:
        """Times of all rows, s, never falling; a view."""
        return self._t[: self._end]

    def values(self, key: str) -> Floats:
        """All values of a channel, SI, in the order of ``t``; a view."""
        return self._values[self._row[key], : self._end]

    def push(self, t: Floats, values: Floats) -> None:
        """Append rows: times (n,) in s and values (channels, n) in SI; rows without a time are left out."""
        known = np.isfinite(t)
        if not known.all():
            t, values = t[known], values[:, known]
        t, values = self._newest_stretch(t, values)
        if len(t) == 0:
            return
        steps = np.diff(t, prepend=self.last_t)
        t = np.maximum.accumulate(np.maximum(t, self.last_t) if self._end else t)
        values = self._unwrapped(values)
        start = 0
        for stop in (*np.flatnonzero(self._is_gap(steps)).tolist(), len(t)):
            self._append(t[start:stop], values[:, start:stop])
            if stop < len(t):
                self._break(float(t[stop]))
            start = stop

    def span(self, start: float, end: float) -> slice:
        """Which rows lie in start <= t <= end, s."""
        first, last = np.searchsorted(self.t, start, "left"), np.searchsorted(self.t, end, "right")
        return slice(int(first), int(last))

    def gaps(self, start: float, end: float) -> Floats:
        """(last time before, first time after) of each gap that touches start to end, s, shape (m, 2)."""
        touching = [gap for gap in self._gaps if gap[1] > start and gap[0] < end]
        return np.array(touching, float).reshape(-1, 2)

    def nearest_t(self, t: float) -> float:
        """Time of the row nearest to t, s; NaN when empty."""
        if not self._end:
            return math.nan
        after = min(int(np.searchsorted(self.t, t)), self._end - 1)
        before = max(after - 1, 0)
        return float(min(self._t[before], self._t[after], key=lambda one: abs(one - t)))

    def stepped_t(self, t: float, n: int) -> float:
        """Time of the row n later (earlier when negative) than the one at t, s; within the history."""
        t = self.nearest_t(t)
        for _ in range(abs(n)):  # a time may stand for several rows
            place = np.searchsorted(self.t, t, "right") if n > 0 else np.searchsorted(self.t, t, "left") - 1
            if not 0 <= place < self._end:
                break
            t = float(self._t[place])
        return t

    def at(self, key: str, t: float) -> float:
        """The value of the row nearest to t; NaN in a gap's place or when empty."""
        if not self._end:
            return math.nan
        return float(self.values(key)[np.searchsorted(self.t, self.nearest_t(t))])

    def newest(self, key: str) -> float:
        """The newest value; NaN when empty."""
        return float(self.values(key)[-1]) if self._end else math.nan

    def _newest_stretch(self, t: Floats, values: Floats) -> tuple[Floats, Floats]:
        """What follows the last jump in time, at the most ``capacity`` rows; the past is forgotten where it must be."""
        steps = np.diff(t, prepend=self.last_t)
        jumps = np.flatnonzero((steps < -BACK_S) | (steps > LONGEST_WINDOW_S))
        first = 0
        if len(jumps):
            first = int(jumps[-1])
            self.restarts += 1
            self.clear()
        if len(t) - first > self.capacity:
            first = len(t) - self.capacity
            self.clear()
        return t[first:], values[:, first:]

    def _is_gap(self, steps: Floats) -> NDArray[np.bool_]:
        usual = np.concatenate((self._steps, steps[np.isfinite(steps)]))
        self._steps = usual[-REMEMBERED:].copy()
        if len(usual) == 0:
            return np.zeros(len(steps), bool)
        return np.asarray(steps > max(GAP_INTERVALS * float(np.median(usual)), GAP_MIN_S))

    def _unwrapped(self, values: Floats) -> Floats:
        """The values, those with a period as whole turns counted on from the newest known one."""
        if not self._periods:
            return values
        values = values.copy()
        for row, period in self._periods.items():
            known = np.isfinite(values[row])
            if known.any():
                start = [] if math.isnan(self._turned[row]) else [self._turned[row]]
                turned = np.unwrap(np.concatenate((start, values[row, known])), period=period)[len(start) :]
                values[row, known] = turned
                self._turned[row] = float(turned[-1])
        return values

    def _break(self, t: float) -> None:
        """Mark the gap between the newest row and one at t by a row of NaN."""
        self._gaps.append((self.last_t, t))
        self._append(np.array([self.last_t]), np.full((len(self._values), 1), np.nan))

    def _append(self, t: Floats, values: Floats) -> None:
        n = len(t)
        if self._end + n > len(self._t):
            self._move(max(0, self.capacity - n))
        self._t[self._end : self._end + n] = t
        self._values[:, self._end : self._end + n] = values
        self._end += n

    def _move(self, kept: int) -> None:
        """Make room: the newest rows go to the front."""
        start = self._end - kept
        self._t[:kept] = self._t[start : self._end]
        for row in self._values:
            row[:kept] = row[start : self._end]
        self._end = kept
        self._gaps = [gap for gap in self._gaps if kept and gap[1] > self._t[0]]
