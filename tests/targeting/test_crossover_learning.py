"""Orders AB and BA, and learning over blocks: what was put in comes out."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from imugui.targeting.crossover import crossover
from imugui.targeting.distributions import t_quantile, t_two_sided
from imugui.targeting.learning import learning_curve, plateau

small = st.floats(-10.0, 10.0)


def groups(effect: float, period: float, carry: float, noise: float = 0.0, n: int = 4) -> tuple[np.ndarray, np.ndarray]:
    """Values by person and period; condition A adds ``effect``, the first period ``period``, group AB ``carry``."""
    random = np.random.default_rng(2)
    people = random.normal(0.0, 5.0, (2, n, 1)) + noise * random.normal(0.0, 1.0, (2, n, 2))
    people -= people.mean(axis=1, keepdims=True)
    ab = people[0] + [effect + period, 0.0] + 0.5 * carry
    ba = people[1] + [period, effect]
    return ab, ba


@given(small, small, small)
def test_effect_period_and_carry_over_are_told_apart(effect: float, period: float, carry: float) -> None:
    found = crossover(*groups(effect, period, carry))
    values = (found.effect.value, found.period.value, found.carry_over.value)
    assert values == pytest.approx((effect, period, carry), abs=1e-9)


def test_the_effect_is_the_formula_of_the_reference() -> None:
    ab, ba = groups(3.0, 1.0, 0.0, noise=2.0)
    found = crossover(ab, ba[:3])
    a_minus_b, b_minus_a = ab[:, 0] - ab[:, 1], ba[:3, 0] - ba[:3, 1]
    assert found.effect.value == pytest.approx((a_minus_b.mean() - b_minus_a.mean()) / 2)
    assert found.period.value == pytest.approx((a_minus_b.mean() + b_minus_a.mean()) / 2)
    pooled = (a_minus_b.var(ddof=1) * 3 + b_minus_a.var(ddof=1) * 2) / 5
    error = 0.5 * math.sqrt(pooled * (1 / 4 + 1 / 3))
    assert found.effect.p == pytest.approx(t_two_sided(5, found.effect.value / error))
    assert found.effect.high - found.effect.value == pytest.approx(t_quantile(5, 0.975) * error)


def test_a_strong_carry_over_is_told() -> None:
    assert crossover(*groups(3.0, 1.0, 60.0)).carry_over_seen
    assert not crossover(*groups(3.0, 1.0, 0.0)).carry_over_seen


@pytest.mark.parametrize(("n_ab", "n_ba"), [(0, 0), (3, 0), (0, 3), (1, 1)])
def test_one_order_alone_shows_nothing(n_ab: int, n_ba: int) -> None:
    found = crossover(np.ones((n_ab, 2)), np.ones((n_ba, 2)))
    assert (found.n_ab, found.n_ba) == (n_ab, n_ba)
    assert "both orders" in found.word
    assert math.isnan(found.effect.value)
    assert not found.carry_over_seen


def test_no_spread_gives_a_value_without_limits() -> None:
    found = crossover([(2.0, 1.0)] * 2, [(1.0, 2.0)] * 2)
    assert found.effect.value == 1.0
    assert math.isnan(found.effect.p)


@given(st.floats(0.5, 100.0), st.floats(-0.5, 0.9), st.integers(2, 8))
def test_a_power_law_is_found_again(first: float, exponent: float, n: int) -> None:
    found = learning_curve([first * b**-exponent for b in range(1, n + 1)])
    assert found.first == pytest.approx(first, rel=1e-9)
    assert found.exponent == pytest.approx(exponent, abs=1e-9)
    assert found.rate == pytest.approx(2.0**-exponent, rel=1e-9)


@pytest.mark.parametrize(
    ("times", "start", "settled"),
    [
        ([10.0, 10.0, 10.0], 0, True),
        ([10.0, 8.0, 7.9, 7.8], 1, True),
        ([10.0, 9.6, 9.0, 8.9], 2, True),
        ([10.0, 9.0, 8.0], 2, False),
        ([10.0, 9.501], 0, True),
        ([10.0, 9.49], 1, False),
        ([8.0, 10.0, 9.0, 8.9], 2, True),
    ],
)
def test_the_plateau_begins_with_the_last_improvement(times: list[float], start: int, settled: bool) -> None:
    found = learning_curve(times)
    assert (plateau(times), found.plateau, found.settled) == (start, start, settled)


@pytest.mark.parametrize("times", [[], [3.0], [3.0, 0.0], [3.0, math.nan], [3.0, -1.0]])
def test_no_curve_through_too_little(times: list[float]) -> None:
    found = learning_curve(times)
    assert math.isnan(found.first)
    assert not found.settled
