"""Statistics: numpy's numbers, NaN left out, angles by the way they went."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as some

from imugui.signals.history import History
from imugui.signals.statistics import mean_rate, summary

TURN = 2.0 * math.pi


@given(some.arrays(np.float64, st.integers(2, 200), elements=st.floats(-1e3, 1e3)))
def test_summary_is_numpys(values: np.ndarray) -> None:
    found = summary(values)
    assert found.n == len(values)
    assert found.mean == pytest.approx(values.mean(), abs=1e-9)
    assert found.sd == pytest.approx(values.std(ddof=1), abs=1e-9)
    assert found.peak_to_peak == np.ptp(values)
    assert found.rms == pytest.approx(math.sqrt((values**2).mean()), abs=1e-9)


def test_nan_does_not_count() -> None:
    found = summary(np.array([math.nan, 1.0, math.nan, 3.0]))
    assert (found.n, found.mean, found.peak_to_peak) == (2, 2.0, 2.0)
    assert found.rms == pytest.approx(math.sqrt(5.0))


@pytest.mark.parametrize("values", [[], [math.nan, math.nan]])
def test_nothing_has_no_numbers(values: list[float]) -> None:
    found = summary(np.array(values))
    assert found.n == 0
    assert all(math.isnan(one) for one in (found.mean, found.sd, found.peak_to_peak, found.rms))


def test_one_value_has_no_deviation() -> None:
    found = summary(np.array([4.0]))
    assert (found.mean, found.peak_to_peak, found.rms) == (4.0, 0.0, 4.0)
    assert math.isnan(found.sd)


def test_an_angle_that_swings_about_the_fold_is_not_zero_on_average() -> None:
    found = summary(math.pi + 0.1 * np.sin(np.linspace(0.0, TURN, 1001)), TURN)
    assert abs(found.mean) == pytest.approx(math.pi, abs=1e-3)
    assert found.sd == pytest.approx(0.1 / math.sqrt(2.0), rel=1e-2)
    assert found.peak_to_peak == pytest.approx(0.2, rel=1e-3)
    assert found.rms == pytest.approx(math.pi, abs=0.1)


def test_three_turns_are_three_turns_from_peak_to_peak() -> None:
    assert summary(np.linspace(0.0, 3 * TURN, 100), TURN).peak_to_peak == pytest.approx(3 * TURN)


def test_the_rate_leaves_gaps_out() -> None:
    history = History(("a",), 1000)
    t = np.concatenate((np.arange(101) * 0.01, 4.0 + np.arange(101) * 0.01))
    history.push(t, t[None])
    gaps = history.gaps(0.0, 9.0)
    assert len(gaps) == 1
    assert mean_rate(history.t, gaps) == pytest.approx(100.0)


@pytest.mark.parametrize("t", [[], [1.0], [2.0, 2.0]])
def test_there_is_no_rate_without_time(t: list[float]) -> None:
    assert math.isnan(mean_rate(np.array(t), np.empty((0, 2))))
