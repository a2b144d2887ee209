"""What a calibration page shows of a flow, free of Qt: the picture, the plot, the figures and the verdict."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from imugui.samples import Rows

Floats = NDArray[np.float64]


def _nothing() -> Floats:
    return np.empty(0)


def _no_points() -> Floats:
    return np.empty((0, 3))


@dataclass(frozen=True)
class Figure:
    """One number of a result: a label, the value with its unit in words, and what it means."""

    label: str
    value: str
    tip: str = ""
    tone: str = "neutral"


@dataclass(frozen=True, eq=False)
class Plot:
    """Lengths before and after in ``unit``, and the length that would be right."""

    before: Floats = field(default_factory=_nothing)
    after: Floats = field(default_factory=_nothing)
    wanted: float = float("nan")


@dataclass(frozen=True, eq=False)
class Look:
    """A picture of a flow. Directions and points are in the sensor frame; ``goal`` is what to turn to next.

    A sphere has ``levels`` (cells,) from 0 to 1, a ``cloud`` (n, 3) and ``outliers`` (k, 3) in radii about
    ``centre`` (3,) in the sensor's unit. A cube has ``directions`` (n, 3) and which of them were ``reached`` (n,).
    """

    levels: Floats = field(default_factory=_nothing)
    cloud: Floats = field(default_factory=_no_points)
    outliers: Floats = field(default_factory=_no_points)
    centre: Floats | None = None
    directions: Floats = field(default_factory=_no_points)
    reached: Floats = field(default_factory=_nothing)
    goal: Floats | None = None
    plot: Plot = field(default_factory=Plot)
    figures: tuple[Figure, ...] = ()
    level_turn: bool = False  # the board is to be turned about the vertical now
    can_finish: bool = False  # enough for the next stage, if the user does not want to go on
    comparison: tuple[tuple[str, ...], ...] = ()
    """Rows of a table whose first row is its head: the seeds' own ways on the same data."""


@dataclass(frozen=True)
class Verdict:
    """A result for people: ``word`` with its ``tone``, the reason, figures; ``can_apply`` only above the bar."""

    tone: str
    word: str
    reason: str
    figures: tuple[Figure, ...] = ()
    can_apply: bool = False
    keep: str = ""  # why the old calibration should rather be kept, in words


@dataclass(frozen=True)
class Guide:
    """One guided flow as the page offers it. ``picture`` is "board", "sphere" or "cube"."""

    key: str
    part: str  # key of PARTS: what of the board it calibrates
    title: str
    words: str  # what to do, and how long it takes
    accuracy: str  # what to expect, in numbers
    picture: str
    unit: str  # of the plot; "" for none
    start: Callable[[Any], Any]  # profile in use or None -> a flow
    look: Callable[[Any, Rows], Look]  # the flow and the newest rows it got
    judge: Callable[[Any, Any], Verdict]  # result, profile in use or None
    apply: Callable[[Any, Any, Look], Any]  # profile, result, the last look -> profile with it
    first: tuple[str, ...] = ()  # parts that had better be calibrated before
    finish: str = ""  # the flow's method for "that is enough"
    ends: bool = False  # once done, what comes after adds nothing
    pace_s: float = 0.4  # least time between two verdicts
