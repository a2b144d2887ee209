"""Comparisons within people against the published vector, brute force and closed forms."""

from __future__ import annotations

import itertools
import math
import subprocess
import sys

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from imugui.targeting.distributions import f_above, noncentral_t, noncentrality, t_quantile, t_two_sided
from imugui.targeting.statistics import (
    EXACT_UP_TO,
    anova,
    differences,
    exponential,
    holm,
    paired,
    ratio,
    sign_flips,
    welch,
    wilcoxon,
)

# TV-A2 of guidance-teleop.md A.6
A = (36.0, 41.0, 33.0, 45.0, 38.0, 40.0)
B = (52.0, 60.0, 41.0, 58.0, 57.0, 49.0)
few = st.lists(st.floats(-100.0, 100.0).map(lambda value: round(value, 1)), min_size=1, max_size=7)


def test_the_published_vector() -> None:
    found = paired(A, B)
    assert (found.n, found.df, found.word) == (6, 5, "")
    assert found.mean == pytest.approx(14.0, rel=1e-12)
    assert found.sd == pytest.approx(4.816638, abs=5e-7)
    assert found.t == pytest.approx(7.119667, abs=5e-7)
    assert found.p == pytest.approx(0.000847866, abs=5e-10)
    assert (found.low, found.high) == pytest.approx((8.945249, 19.054751), abs=5e-7)
    assert found.dz == pytest.approx(2.906592, abs=5e-7)
    assert found.gz == pytest.approx(2.447656, abs=5e-7)
    assert (found.dz_low, found.dz_high) == pytest.approx((0.9773, 4.8094), abs=5e-5)


def test_the_published_vector_exactly() -> None:
    """The same figures from their formulas, where there are closed ones, to 1e-9."""
    d = [b - a for a, b in zip(A, B, strict=True)]
    sd = math.sqrt(sum((one - 14.0) ** 2 for one in d) / 5)
    found = paired(A, B)
    assert found.sd == pytest.approx(sd, rel=1e-9)
    assert found.t == pytest.approx(14.0 / (sd / math.sqrt(6)), rel=1e-9)
    assert found.dz == pytest.approx(14.0 / sd, rel=1e-9)
    assert found.gz == pytest.approx(14.0 / sd * (1 - 3 / 19), rel=1e-9)
    for limit, p in ((found.dz_low, 0.975), (found.dz_high, 0.025)):
        assert noncentral_t(5, limit * math.sqrt(6), found.t) == pytest.approx(p, rel=1e-9)


def test_the_published_tests_and_ratio() -> None:
    d = differences(A, B)
    assert sign_flips(d).p == wilcoxon(d).p == 0.03125
    assert wilcoxon(d).statistic == 0.0
    assert sign_flips(d).word == "exact, all 64 sign flips"
    found = ratio(A, B)
    assert found.ratio == pytest.approx(1.356116, abs=5e-7)
    assert (found.low, found.high) == pytest.approx((1.233836, 1.490514), abs=5e-7)
    assert found.ratio == pytest.approx((math.prod(B) / math.prod(A)) ** (1 / 6), rel=1e-9)


@given(few)
def test_sign_flips_count_what_brute_force_counts(d: list[float]) -> None:
    seen = abs(sum(d))
    flips = itertools.product((1, -1), repeat=len(d))
    sums = [abs(sum(sign * one for sign, one in zip(signs, d, strict=True))) for signs in flips]
    assert sign_flips(d).p == sum(one >= seen - 1e-9 for one in sums) / 2 ** len(d)


@given(few)
def test_wilcoxon_counts_what_brute_force_counts(d: list[float]) -> None:
    values = [one for one in d if one != 0.0]
    sizes = sorted(abs(one) for one in values)
    ranks = [sum(k + 1 for k, size in enumerate(sizes) if size == abs(one)) / sizes.count(abs(one)) for one in values]
    positive = sum(rank for rank, one in zip(ranks, values, strict=True) if one > 0.0)
    least = min(positive, sum(ranks) - positive)
    sums = [sum(itertools.compress(ranks, chosen)) for chosen in itertools.product((0, 1), repeat=len(ranks))]
    found = wilcoxon(d)
    if values:
        assert found.statistic == least
        assert found.p == min(1.0, 2 * sum(one <= least for one in sums) / len(sums))
    else:
        assert math.isnan(found.p)


@given(few)
def test_both_tests_do_not_care_which_condition_comes_first(d: list[float]) -> None:
    turned = [-one for one in d]
    assert sign_flips(d).p == sign_flips(turned).p
    assert wilcoxon(d).p == wilcoxon(turned).p or math.isnan(wilcoxon(d).p)


def test_many_people_are_drawn_by_a_seed_and_said_to_be() -> None:
    d = np.random.default_rng(4).normal(0.5, 1.0, EXACT_UP_TO + 1)
    found = sign_flips(d, seed=7)
    assert found == sign_flips(d, seed=7)
    assert "Monte Carlo" in found.word
    assert "seed 7" in found.word
    assert "exact" in sign_flips(d[:EXACT_UP_TO]).word
    bits = 1 - 2 * ((np.arange(2**17)[:, None] >> np.arange(17)) & 1)
    exact = float((np.abs(bits @ d) >= abs(d.sum()) - 1e-9).mean())
    assert found.p == pytest.approx(exact, abs=5.0 * math.sqrt(exact / 99_999))


def test_a_drawn_p_is_never_zero() -> None:
    assert sign_flips(np.ones(40)).p == pytest.approx(1e-5)


def test_equal_differences_have_no_spread_to_test_by() -> None:
    found = paired((1.0, 2.0, 3.0), (1.1, 2.1, 3.1))
    assert found.mean == pytest.approx(0.1)
    assert math.isnan(found.t)
    assert math.isnan(found.dz)
    assert found.word == "n/a: all differences are the same"


@pytest.mark.parametrize("n", [0, 1])
def test_too_few_pairs_say_so(n: int) -> None:
    for found in (paired(A[:n], B[:n]), ratio(A[:n], B[:n])):
        assert found.word == "n/a: fewer than 2 pairs"
        assert math.isnan(found.p)
    assert math.isnan(sign_flips([]).p)


def test_pairs_with_a_missing_value_are_left_out() -> None:
    a, b = (*A, math.nan, 3.0), (*B, 5.0, math.inf)
    assert paired(a, b) == paired(A, B)
    assert ratio(a, b) == ratio(A, B)


def test_a_ratio_needs_values_above_zero() -> None:
    assert ratio((0.0, 1.0), (1.0, 2.0)).word == "n/a: a ratio needs values above 0"
    assert exponential(5000.0) == math.inf
    assert math.isnan(exponential(math.nan))


def test_the_ratio_turns_round_with_the_conditions() -> None:
    forth, back = ratio(A, B), ratio(B, A)
    assert (back.ratio, back.low, back.high) == pytest.approx((1 / forth.ratio, 1 / forth.high, 1 / forth.low))


@pytest.mark.parametrize(
    ("df", "t"), [(5, 7.12), (5, 0.0), (5, -2.0), (1, 0.3), (1, 200.0), (23, 3.0), (40, 25.0), (199, 12.0)]
)
def test_the_noncentrality_is_where_the_probability_is(df: int, t: float) -> None:
    for p in (0.025, 0.975):
        assert noncentral_t(df, noncentrality(df, t, p), t) == pytest.approx(p, rel=1e-7)
    assert noncentrality(df, t, 0.025) == pytest.approx(-noncentrality(df, -t, 0.975), rel=1e-6)


def test_the_distributions_where_they_have_closed_forms() -> None:
    # one degree of freedom is Cauchy's distribution; F with (1, df) is t squared
    assert t_quantile(1, 0.975) == pytest.approx(math.tan(math.pi * 0.475), rel=1e-12)
    assert t_two_sided(1, 1.0) == pytest.approx(0.5, rel=1e-12)
    assert f_above(1, 7, 2.5**2) == pytest.approx(t_two_sided(7, 2.5), rel=1e-12)
    assert noncentral_t(9, 0.0, 1.7) == pytest.approx(1.0 - t_two_sided(9, 1.7) / 2, rel=1e-12)


def test_scipy_is_loaded_only_when_it_is_used() -> None:
    modules = "statistics, results_report, thesis_tables, design, crossover"
    code = f"import sys; from imugui.targeting import {modules}; print('scipy' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=True)
    assert done.stdout.strip() == "False"


def test_holm_multiplies_from_the_smallest_up() -> None:
    assert holm([0.01, 0.04, 0.03]) == pytest.approx((0.03, 0.06, 0.06))
    assert holm([0.5]) == (0.5,)
    assert holm([0.6, 0.7]) == (1.0, 1.0)
    found = holm([math.nan, 0.01])
    assert math.isnan(found[0])
    assert found[1] == 0.01
    assert holm([]) == ()


def test_two_groups_by_welch_and_by_variance_agree_when_alike() -> None:
    a, b = np.array(A), np.array(A) + 5.0
    by_t, by_f = welch(a, b), anova([a, b])
    assert by_t.df == pytest.approx(10.0)
    assert by_t.statistic**2 == pytest.approx(by_f.statistic, rel=1e-12)
    assert by_t.p == pytest.approx(by_f.p, rel=1e-9)
    assert by_t.difference == pytest.approx(5.0)
    assert by_t.low < 5.0 < by_t.high


def test_groups_without_spread_or_members_have_no_p() -> None:
    assert math.isnan(welch([1.0], [2.0, 3.0]).p)
    assert math.isnan(welch([1.0, 1.0], [2.0, 2.0]).p)
    assert welch([1.0, 1.0], [2.0, 2.0]).difference == 1.0
    assert math.isnan(anova([[1.0, 1.0], [2.0, 2.0]]).p)
    assert math.isnan(anova([[1.0, 2.0]]).p)
    assert math.isnan(anova([[1.0], [2.0]]).p)


@pytest.mark.parametrize("df", [1, 5, 20])
def test_a_huge_t_has_its_noncentrality_at_once(df: int) -> None:
    """People who all differ by the very same: scipy's sum took minutes for it, and was wrong."""
    for p in (0.025, 0.975):
        share = noncentrality(df, 900.0, p) / 900.0
        for t in (1e3, 1e4, 1e12, 1e300):
            assert noncentrality(df, t, p) / t == pytest.approx(share, rel=1e-5)
        assert noncentrality(df, -1e9, 1.0 - p) == pytest.approx(-noncentrality(df, 1e9, p), rel=1e-6)
