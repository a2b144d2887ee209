"""From rows to what a screen can show: the extent of a curve in each column of pixels, or its segments.

No extreme is ever lost: the extent of a column is the least and the greatest value of all its rows.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Extent = tuple[Floats, Floats]
"""Least and greatest value of each column, shape (columns,); NaN where nothing is drawn."""


@dataclass(frozen=True)
class Grid:
    """``count`` columns, each ``step`` seconds (or hertz) wide, from ``start``."""

    start: float
    step: float
    count: int

    @property
    def end(self) -> float:
        return self.start + self.count * self.step

    @cached_property
    def edges(self) -> Floats:
        """Where the columns begin and the last one ends, shape (count + 1,)."""
        return np.asarray(self.start + self.step * np.arange(self.count + 1, dtype=float))


class Columns:
    """Which rows fall into which column; shared by all channels with the same times.

    ``x`` (n,) never falls; ``gaps`` (m, 2) are stretches of x in which nothing is drawn.
    """

    def __init__(self, grid: Grid, x: Floats, gaps: Sequence[Sequence[float]] | Floats = ()) -> None:
        self.grid = grid
        bounds = np.searchsorted(x, grid.edges)
        self._first, self._last = int(bounds[0]), int(bounds[-1])
        self.filled = np.flatnonzero(bounds[1:] > bounds[:-1])
        self._starts = bounds[self.filled] - self._first
        self._bridges(np.asarray(gaps, float).reshape(-1, 2))

    @property
    def rows(self) -> int:
        """Rows inside the grid."""
        return self._last - self._first

    def extent(self, values: Floats) -> Extent:
        """The extents of a channel's values, shape (n,); rows of NaN are passed over.

        A column without rows between two that have some is bridged unless it lies in a gap.
        """
        low, high = np.full((2, self.grid.count), np.nan)
        if self.rows == 0:
            return low, high
        inside = values[self._first : self._last]
        low[self.filled] = np.fmin.reduceat(inside, self._starts)
        high[self.filled] = np.fmax.reduceat(inside, self._starts)
        if len(self._empty):
            middle = 0.5 * (low + high)
            bridge = middle[self._before] + self._share * (middle[self._after] - middle[self._before])
            low[self._empty] = high[self._empty] = bridge
        return joined(low, high)

    def _bridges(self, gaps: Floats) -> None:
        """The columns to bridge, the columns they hang between, and how far along they are."""
        places = np.arange(self.grid.count)
        full = np.zeros(self.grid.count, bool)
        full[self.filled] = True
        before = np.maximum.accumulate(np.where(full, places, -1))
        after = np.minimum.accumulate(np.where(full, places, self.grid.count)[::-1])[::-1]
        wanted = ~full & (before >= 0) & (after < self.grid.count)
        edges = np.searchsorted(self.grid.edges, gaps, "right") - 1
        for start, end in edges.tolist():
            wanted[max(start + 1, 0) : max(end, 0)] = False
        self._empty = np.flatnonzero(wanted)
        self._before, self._after = before[wanted], after[wanted]
        self._share = (self._empty - self._before) / np.maximum(self._after - self._before, 1)


def joined(low: Floats, high: Floats) -> Extent:
    """Extents stretched so that neighbours touch, half-way between them; nothing goes beyond the extremes."""
    low, high = low.copy(), high.copy()
    up, down = low[1:] > high[:-1], high[1:] < low[:-1]  # NaN is neither
    rising, falling = 0.5 * (low[1:] + high[:-1])[up], 0.5 * (high[1:] + low[:-1])[down]
    low[1:][up], high[:-1][up] = rising, rising
    high[1:][down] = np.maximum(high[1:][down], falling)
    low[:-1][down] = np.minimum(low[:-1][down], falling)
    return low, high


def segments(x: Floats, values: Floats) -> Floats:
    """Lines between neighbouring rows, shape (m, 4) of x, value, x, value; none to or from NaN.

    A row that stands alone gives a line of no length.
    """
    known = np.isfinite(values)
    pairs = known[1:] & known[:-1]
    lines = np.column_stack((x[:-1], values[:-1], x[1:], values[1:]))[pairs]
    alone = known.copy()
    alone[1:] &= ~pairs
    alone[:-1] &= ~pairs
    return np.concatenate((lines, np.column_stack((x, values, x, values))[alone]))
