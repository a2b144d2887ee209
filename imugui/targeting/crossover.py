"""Two conditions in two orders (AB and BA): the effect freed from the period, the period's own, and carry-over.

S. Senn, Cross-over Trials in Clinical Research, 2nd ed. 2002, chapter 3; effect sizes: L. Madeyski, B. Kitchenham,
Empir. Softw. Eng. 23 (2018) 1982. Values of times are given as logarithms.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from imugui.fusion.quaternion import Floats
from imugui.targeting.distributions import t_quantile, t_two_sided
from imugui.targeting.statistics import LEVEL, SAME

CARRY_OVER_P = 0.10
"""A carry-over below this is told: the test is weak, so it is read generously."""


@dataclass(frozen=True)
class Estimate:
    """A value with its 95 % limits and two-sided p; NaN where there is none."""

    value: float = math.nan
    low: float = math.nan
    high: float = math.nan
    p: float = math.nan


@dataclass(frozen=True)
class Crossover:
    """What two groups show that met A and B in the two orders."""

    n_ab: int
    n_ba: int
    effect: Estimate = Estimate()  # A - B, whatever the period does
    period: Estimate = Estimate()  # first - second period, whatever the condition
    carry_over: Estimate = Estimate()  # sum of both periods, AB - BA
    word: str = ""

    @property
    def carry_over_seen(self) -> bool:
        """The two groups' sums differ more than chance likes."""
        return self.carry_over.p < CARRY_OVER_P


def crossover(ab: ArrayLike, ba: ArrayLike) -> Crossover:
    """Compare groups (n, 2), columns first and second period: ``ab`` met A first, ``ba`` met B first.

    effect = (mean_AB(A-B) - mean_BA(B-A)) / 2, which is half the difference of the groups' (period 1 - period 2);
    the period effect is half their sum. Limits and p from the pooled t with n - 2 degrees of freedom.
    """
    first, second = (np.asarray(group, float).reshape(-1, 2) for group in (ab, ba))
    n_ab, n_ba = len(first), len(second)
    if min(n_ab, n_ba) < 1 or n_ab + n_ba < 3:
        return Crossover(n_ab, n_ba, word="n/a: it needs people in both orders, 3 or more")
    falls = [group[:, 0] - group[:, 1] for group in (first, second)]
    sums = [group[:, 0] + group[:, 1] for group in (first, second)]
    return Crossover(
        n_ab,
        n_ba,
        _estimate(0.5 * falls[0], 0.5 * falls[1], -1.0),
        _estimate(0.5 * falls[0], 0.5 * falls[1], 1.0),
        _estimate(sums[0], sums[1], -1.0),
    )


def _estimate(a: Floats, b: Floats, sign: float) -> Estimate:
    """mean(a) + sign * mean(b) with the pooled variance of two independent groups."""
    df = len(a) + len(b) - 2
    value = float(a.mean() + sign * b.mean())
    squares = float(((a - a.mean()) ** 2).sum() + ((b - b.mean()) ** 2).sum())
    error = math.sqrt(squares / df * (1.0 / len(a) + 1.0 / len(b)))
    if error <= SAME * float(np.abs(np.concatenate((a, b))).max()):
        return Estimate(value)
    half = t_quantile(df, 0.5 + 0.5 * LEVEL) * error
    return Estimate(value, value - half, value + half, t_two_sided(df, value / error))
