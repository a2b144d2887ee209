"""One picture of the Signals page: everything the painter needs to know, in columns and units shown."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from imugui.signals.scale import Range
from imugui.signals.strokes import Strokes


@dataclass(frozen=True)
class Curve:
    """``tone`` is an axis 0 to 2, or PLAIN; strokes are in columns and the unit shown."""

    label: str
    tone: int
    strokes: Strokes


@dataclass(frozen=True)
class Ticks:
    """Where lines of the grid are, and their words."""

    values: NDArray[np.float64]
    words: tuple[str, ...]


NO_TICKS = Ticks(np.empty(0), ())


@dataclass(frozen=True)
class Plot:
    """One plot of the stack. ``note`` says why there is nothing to see."""

    key: str
    title: str
    unit: str
    range: Range
    ticks: Ticks
    curves: tuple[Curve, ...]
    note: str = ""


@dataclass(frozen=True)
class Mark:
    """Where a cursor meets a curve: the plot's number, column, value."""

    plot: int
    column: float
    value: float
    tone: int


@dataclass(frozen=True)
class CursorLine:
    """A cursor: its letter, its column, and whether keys move it."""

    name: str
    column: float
    active: bool


@dataclass(frozen=True)
class Frame:
    """The whole stack over ``count`` columns."""

    count: int
    plots: tuple[Plot, ...] = ()
    ticks: Ticks = NO_TICKS  # along x, in columns
    cursors: tuple[CursorLine, ...] = ()
    marks: tuple[Mark, ...] = ()
    note: str = ""  # why there is no plot at all
    bands: tuple[tuple[float, float], ...] = ()  # from column to column, where the accelerometer was masked
