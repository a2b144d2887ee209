"""Student's t, noncentral t and F, from scipy; imported when used, because it takes longer to load than numpy.

Probabilities are shares of 1. Degrees of freedom need not be whole numbers.
"""

from __future__ import annotations

import math
from collections.abc import Callable

ROUNDS = 200
LARGE = 1000.0
"""of a t: people who all differ by the same to three digits."""


def t_quantile(df: float, p: float) -> float:
    """The value that a t with ``df`` degrees of freedom stays below with probability p."""
    from scipy.special import stdtrit

    return float(stdtrit(df, p))


def t_two_sided(df: float, t: float) -> float:
    """Probability of a t at least this far from 0."""
    from scipy.special import stdtr

    return float(2.0 * stdtr(df, -abs(t)))


def noncentral_t(df: float, shift: float, t: float) -> float:
    """Probability that a noncentral t with noncentrality ``shift`` stays below t."""
    from scipy.special import nctdtr

    return float(nctdtr(df, shift, t))


def f_above(df1: float, df2: float, f: float) -> float:
    """Probability of an F above f."""
    from scipy.special import fdtrc

    return float(fdtrc(df1, df2, f))


def noncentrality(df: float, t: float, p: float) -> float:
    """The noncentrality at which a noncentral t stays below ``t`` with probability p; NaN when it is not found.

    By bisection: scipy's own inverse is right to 1e-6 only. Beyond LARGE the noncentrality grows as t itself does, to
    1e-6, and scipy's sum would take minutes and be wrong.
    """
    if abs(t) > LARGE:
        return noncentrality(df, math.copysign(LARGE, t), p) * (abs(t) / LARGE)
    step = math.sqrt(1.0 + t * t / (2.0 * df))

    def excess(shift: float) -> float:
        return noncentral_t(df, shift, t) - p

    low = next((t - k * step for k in range(ROUNDS) if excess(t - k * step) >= 0.0), math.nan)
    high = next((t + k * step for k in range(ROUNDS) if excess(t + k * step) <= 0.0), math.nan)
    return bisect(lambda shift: -excess(shift), low, high)


def bisect(rising: Callable[[float], float], low: float, high: float) -> float:
    """Where a rising function passes 0 between low and high, to the last digit; NaN when an end is NaN."""
    if math.isnan(low) or math.isnan(high):
        return math.nan
    for _ in range(ROUNDS):
        middle = 0.5 * (low + high)
        if not low < middle < high:
            break
        if rising(middle) < 0.0:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)
