"""Angles that start again after half a turn: drawn where they are, never as a line across the plot.

A history counts whole turns on (history.py), so that a curve has no jumps; here the turns are taken off again.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


def fold_bars(bars: Floats, period: float) -> Floats:
    """Bars (n, 3) of x, low, high with low and high folded to plus or minus half a period, shape (m, 3).

    A bar across the fold becomes two, one at either edge; one of a whole period or more fills everything.
    """
    half = 0.5 * period
    x, low, high = bars.T
    whole = high - low >= period
    turns = period * np.floor((low + half) / period)
    low = np.where(whole, -half, low - turns)
    high = np.where(whole, half, high - turns)
    across = high > half
    lower = np.column_stack((x, low, np.minimum(high, half)))
    upper = np.column_stack((x, np.full_like(x, -half), high - period))[across]
    return np.concatenate((lower, upper))


def fold_segments(lines: Floats, period: float) -> Floats:
    """Lines (n, 4) of x, y, x, y with y folded to plus or minus half a period, shape (m, 4).

    A line across the fold becomes two that end and begin at the edges. No line is longer than half a period.
    """
    half = 0.5 * period
    x0, y0, x1, y1 = lines.T
    turns = period * np.floor((y0 + half) / period)
    y0, y1 = y0 - turns, y1 - turns
    edge = np.where(y1 > half, half, -half)
    across = (y1 > half) | (y1 < -half)
    middle = x1.copy()
    middle[across] = (x0 + (x1 - x0) * (edge - y0) / np.where(across, y1 - y0, 1.0))[across]
    first = np.column_stack((x0, y0, middle, np.where(across, edge, y1)))
    second = np.column_stack((middle, -edge, x1, y1 - 2.0 * edge))[across]
    return np.concatenate((first, second))
