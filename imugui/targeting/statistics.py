"""Comparisons of two conditions within the same people: effect first, with its uncertainty, then exact tests.

Differences are b - a and ratios b / a: with times, above 0 or 1 means that b is slower. Effect sizes: D. Lakens,
Front. Psychol. 4 (2013) 863, equations 7 (dz) and, for the small sample factor, 4.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from imugui.fusion.quaternion import Floats
from imugui.targeting.distributions import f_above, noncentrality, t_quantile, t_two_sided

LEVEL = 0.95
EXACT_UP_TO = 16
"""People up to whom all 2^n sign flips are counted; above, this many are drawn."""
DRAWS = 99_999
CHUNK = 11_111  # a ninth of the draws
SAME = 1e-12
LARGEST_LOG = 700.0


@dataclass(frozen=True)
class Paired:
    """Differences of n pairs; NaN where there is none, and ``word`` says why. Limits hold 95 %."""

    n: int = 0
    mean: float = math.nan
    low: float = math.nan
    high: float = math.nan
    sd: float = math.nan
    t: float = math.nan
    df: int = 0
    p: float = math.nan
    dz: float = math.nan
    gz: float = math.nan
    dz_low: float = math.nan
    dz_high: float = math.nan
    word: str = ""


@dataclass(frozen=True)
class Ratio:
    """Ratio of geometric means b / a of n pairs with its 95 % limits; NaN where there is none."""

    n: int = 0
    ratio: float = math.nan
    low: float = math.nan
    high: float = math.nan
    p: float = math.nan  # t test on the logarithms
    word: str = ""


@dataclass(frozen=True)
class ExactTest:
    """A two-sided p and how it was counted."""

    p: float = math.nan
    statistic: float = math.nan
    word: str = ""


@dataclass(frozen=True)
class GroupTest:
    """A test between groups of independent values."""

    statistic: float = math.nan
    df: float = math.nan
    p: float = math.nan
    difference: float = math.nan  # of the second mean to the first
    low: float = math.nan
    high: float = math.nan


def paired(a: ArrayLike, b: ArrayLike) -> Paired:
    """Mean difference b - a of pairs (n,) with t test, 95 % limits and effect size; NaN pairs are left out."""
    d = differences(a, b)
    n = len(d)
    if n < 2:
        return Paired(n, float(d[0]) if n else math.nan, word="n/a: fewer than 2 pairs")
    mean, sd, df = float(d.mean()), float(d.std(ddof=1)), n - 1
    if sd <= SAME * float(np.abs(d).max()):
        return Paired(n, mean, mean, mean, sd, df=df, word="n/a: all differences are the same")
    error = sd / math.sqrt(n)
    half, t, dz = t_quantile(df, 0.5 + 0.5 * LEVEL) * error, mean / error, mean / sd
    low, high = (noncentrality(df, t, 0.5 + side * LEVEL) / math.sqrt(n) for side in (0.5, -0.5))
    gz = dz * (1.0 - 3.0 / (4.0 * df - 1.0))
    return Paired(n, mean, mean - half, mean + half, sd, t, df, t_two_sided(df, t), dz, gz, low, high)


def ratio(a: ArrayLike, b: ArrayLike) -> Ratio:
    """Ratio of the geometric means of pairs (n,), all above 0; NaN pairs are left out."""
    first, second = _pairs(a, b)
    if not ((first > 0.0) & (second > 0.0)).all():
        return Ratio(len(first), word="n/a: a ratio needs values above 0")
    logs = paired(np.log(first), np.log(second))
    value, low, high = (exponential(one) for one in (logs.mean, logs.low, logs.high))
    return Ratio(logs.n, value, low, high, logs.p, logs.word)


def exponential(value: float) -> float:
    """exp of a logarithm's limit, however wide; NaN stays."""
    return math.exp(value) if not value > LARGEST_LOG else math.inf


def differences(a: ArrayLike, b: ArrayLike) -> Floats:
    """b - a of the pairs (n,) in which both are numbers."""
    first, second = _pairs(a, b)
    return second - first


def sign_flips(d: ArrayLike, seed: int = 0) -> ExactTest:
    """Two-sided permutation test that differences (n,) are as often negative as positive, by |sum|.

    All 2^n flips up to 16 differences; above, random flips from ``seed`` with the seen one counted in.
    """
    values = np.asarray(d, float)
    n, seen = len(values), abs(float(values.sum()))
    if n == 0:
        return ExactTest(word="n/a: no pairs")
    least = seen - SAME * float(np.abs(values).sum())
    if n <= EXACT_UP_TO:
        bits = (np.arange(2**n)[:, None] >> np.arange(n)) & 1
        count = int((np.abs((1 - 2 * bits) @ values) >= least).sum())
        return ExactTest(count / 2**n, seen, f"exact, all {2**n} sign flips")
    random = np.random.default_rng(seed)
    blocks = (1 - 2 * random.integers(0, 2, (CHUNK, n)) for _ in range(0, DRAWS, CHUNK))
    drawn = sum(int((np.abs(block @ values) >= least).sum()) for block in blocks)
    return ExactTest((drawn + 1) / (DRAWS + 1), seen, f"Monte Carlo, {DRAWS} random sign flips, seed {seed}")


def wilcoxon(d: ArrayLike) -> ExactTest:
    """Exact signed-rank test of differences (n,): zeros are dropped, equal sizes share their mean rank."""
    values = np.asarray(d, float)
    values = values[values != 0.0]
    n = len(values)
    if n == 0:
        return ExactTest(word="n/a: no differences")
    doubled = [int(rank) for rank in doubled_ranks(np.abs(values))]
    positive = sum(rank for rank, value in zip(doubled, values, strict=True) if value > 0.0)
    least = min(positive, sum(doubled) - positive)
    ways = [1] + [0] * sum(doubled)
    for rank in doubled:
        ways = [ways[k] + (ways[k - rank] if k >= rank else 0) for k in range(len(ways))]
    return ExactTest(min(1.0, 2 * sum(ways[: least + 1]) / 2**n), 0.5 * least, "exact, mean ranks for ties")


def doubled_ranks(values: Floats) -> Floats:
    """Twice the ranks (n,) of values, so that the mean ranks of equal values are whole numbers."""
    below = (values[None, :] < values[:, None]).sum(axis=1)
    same = (values[None, :] == values[:, None]).sum(axis=1)
    return np.asarray(2.0 * below + same + 1.0)


def holm(ps: Sequence[float]) -> tuple[float, ...]:
    """The p values of several tests of one study, adjusted after S. Holm, Scand. J. Stat. 6 (1979) 65; NaN stay."""
    known = sorted((p, k) for k, p in enumerate(ps) if not math.isnan(p))
    adjusted, worst = list(ps), 0.0
    for rank, (p, k) in enumerate(known):
        worst = max(worst, min(1.0, (len(known) - rank) * p))
        adjusted[k] = worst
    return tuple(adjusted)


def welch(a: ArrayLike, b: ArrayLike) -> GroupTest:
    """Difference of the means of two independent groups (n,), (m,) of unequal spread, with 95 % limits.

    B. L. Welch, Biometrika 34 (1947) 28. NaN with fewer than two values in a group or no spread.
    """
    first, second = np.asarray(a, float), np.asarray(b, float)
    if min(len(first), len(second)) < 2:
        return GroupTest()
    squares = [float(group.var(ddof=1)) / len(group) for group in (first, second)]
    total, difference = sum(squares), float(second.mean() - first.mean())
    if total == 0.0:
        return GroupTest(difference=difference)
    df = total**2 / (squares[0] ** 2 / (len(first) - 1) + squares[1] ** 2 / (len(second) - 1))
    t, half = difference / math.sqrt(total), t_quantile(df, 0.5 + 0.5 * LEVEL) * math.sqrt(total)
    return GroupTest(t, df, t_two_sided(df, t), difference, difference - half, difference + half)


def anova(groups: Sequence[ArrayLike]) -> GroupTest:
    """One-way analysis of variance of independent groups: F, its second degrees of freedom, p."""
    arrays = [np.asarray(group, float) for group in groups]
    n, k = sum(map(len, arrays)), len(arrays)
    if k < 2 or n <= k or min(map(len, arrays)) < 1:
        return GroupTest()
    mean = float(np.concatenate(arrays).mean())
    between = sum(len(group) * (float(group.mean()) - mean) ** 2 for group in arrays) / (k - 1)
    within = sum(float(((group - group.mean()) ** 2).sum()) for group in arrays) / (n - k)
    if within == 0.0:
        return GroupTest(df=n - k)
    return GroupTest(between / within, n - k, f_above(k - 1, n - k, between / within))


def _pairs(a: ArrayLike, b: ArrayLike) -> tuple[Floats, Floats]:
    first, second = np.asarray(a, float), np.asarray(b, float)
    good = np.isfinite(first) & np.isfinite(second)
    return first[good], second[good]
