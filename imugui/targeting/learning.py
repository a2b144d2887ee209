"""Learning over blocks: the power law of practice, and from which block on people stay as they are."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

IMPROVEMENT = 0.05
"""A block that is faster than the one before by more than this share is still learning."""


@dataclass(frozen=True)
class LearningCurve:
    """T_b = T_1 b^-r over blocks b = 1, 2, ...; NaN where there are fewer than two."""

    first: float = math.nan  # T_1 of the fit, in the unit of the values
    exponent: float = math.nan  # r; above 0 it gets faster
    rate: float = math.nan  # 2^-r: what is left of the time when the blocks double
    plateau: int = 0  # place of the first block after the last improvement, counted from 0
    settled: bool = False  # a block followed that did not improve


def learning_curve(times: ArrayLike) -> LearningCurve:
    """Fit the values (n,) > 0 of blocks in their order, by least squares on the logarithms."""
    values = np.asarray(times, float)
    n = len(values)
    if n < 2 or not (np.isfinite(values) & (values > 0.0)).all():
        return LearningCurve()
    x, y = np.log(np.arange(1.0, n + 1.0)), np.log(values)
    slope = float(((x - x.mean()) * (y - y.mean())).sum() / ((x - x.mean()) ** 2).sum())
    start = plateau(values)
    return LearningCurve(math.exp(float(y.mean()) - slope * float(x.mean())), -slope, 2.0**slope, start, start < n - 1)


def plateau(times: ArrayLike) -> int:
    """The place of the block (n,) that made the last improvement of more than 5 %; 0 when none did."""
    values = np.asarray(times, float)
    better = np.flatnonzero(values[1:] < (1.0 - IMPROVEMENT) * values[:-1])
    return int(better[-1]) + 1 if len(better) else 0
