"""What a number of people can show at all: to be read before a study, not after it."""

from __future__ import annotations

import math

from imugui.targeting.distributions import bisect, noncentral_t, t_quantile

ALPHA, POWER = 0.05, 0.80
LARGEST_DZ = 1000.0


def smallest_p(n: int) -> float:
    """The least two-sided p that sign flips of n differences can give: 2 / 2^n."""
    return min(1.0, 2.0 / 2.0**n)


def power(n: int, dz: float, alpha: float = ALPHA) -> float:
    """The chance that a two-sided paired t test of n people finds an effect of ``dz`` standard deviations."""
    if n < 2:
        return 0.0
    shift, limit = dz * math.sqrt(n), t_quantile(n - 1, 1.0 - 0.5 * alpha)
    # the far tail is lost in rounding (NaN) where it is too small to matter
    far = noncentral_t(n - 1, shift, -limit)
    return 1.0 - noncentral_t(n - 1, shift, limit) + (0.0 if math.isnan(far) else far)


def dz_needed(n: int, wanted: float = POWER, alpha: float = ALPHA) -> float:
    """The effect size dz that n people find with this power; NaN for fewer than two."""
    if n < 2:
        return math.nan
    high = 1.0
    while power(n, high, alpha) < wanted and high < LARGEST_DZ:
        high *= 2.0
    return bisect(lambda dz: power(n, dz, alpha) - wanted, 0.0, high)


def people_needed(dz: float, wanted: float = POWER, alpha: float = ALPHA, most: int = 1000) -> int:
    """The least number of people that finds ``dz`` with this power; 0 when ``most`` are not enough."""
    return next((n for n in range(2, most + 1) if power(n, dz, alpha) >= wanted), 0)
