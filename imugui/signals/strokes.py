"""Strokes: what is drawn of a channel within a window, ready for the painter."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from imugui.signals.columns import Columns, Grid, segments
from imugui.signals.folding import fold_bars, fold_segments
from imugui.signals.history import History

Floats = NDArray[np.float64]

DENSE = 1.5  # rows a column above which extents are drawn, below it lines from row to row


@dataclass(frozen=True)
class Strokes:
    """Bars (m, 3) of column, low, high, or lines (m, 4) of x, y, x, y; x in columns from the left, y as given."""

    marks: Floats

    @property
    def dense(self) -> bool:
        """True for bars."""
        return bool(self.marks.shape[1] == 3)

    def extremes(self) -> tuple[float, float]:
        """Least and greatest value drawn; NaN when nothing is."""
        if len(self.marks) == 0:
            return math.nan, math.nan
        ends = self.marks[:, 1:3] if self.dense else self.marks[:, 1::2]
        return float(ends.min()), float(ends.max())

    def scaled(self, factor: float) -> Strokes:
        """The same with values multiplied by a factor."""
        return Strokes(self.marks * ((1.0, factor, factor) if self.dense else (1.0, factor, 1.0, factor)))


def make_strokes(history: History, grid: Grid, channels: Iterable[tuple[str, float]]) -> dict[str, Strokes]:
    """The strokes of channels (key, period in SI or 0) within a grid of seconds; values in SI, angles folded."""
    inside = history.span(grid.start, grid.end)
    rows = slice(max(inside.start - 1, 0), inside.stop + 1)  # lines come from beyond the edges
    x = history.t[rows]
    if inside.stop - inside.start > DENSE * grid.count:
        columns = Columns(grid, x, history.gaps(grid.start, grid.end))
        return {key: _bars(columns, history.values(key)[rows], period) for key, period in channels}
    x = (x - grid.start) / grid.step
    return {key: _lines(x, history.values(key)[rows], period) for key, period in channels}


def bars_of(columns: Columns, values: Floats) -> Floats:
    """Bars (m, 3) of column, low, high of values (n,) on their columns."""
    low, high = columns.extent(values)
    drawn = np.flatnonzero(np.isfinite(low))
    return np.column_stack((drawn, low[drawn], high[drawn]))


def _bars(columns: Columns, values: Floats, period: float) -> Strokes:
    bars = bars_of(columns, values)
    return Strokes(fold_bars(bars, period) if period else bars)


def _lines(x: Floats, values: Floats, period: float) -> Strokes:
    lines = segments(x, values)
    return Strokes(fold_segments(lines, period) if period else lines)
