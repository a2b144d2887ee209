"""Throughput: the published vectors, the degenerate sequences, the outlier rule, and nominal difficulties."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from imugui.targeting.throughput import (
    axis_errors,
    chord,
    index_of_difficulty,
    outliers,
    pan_difficulty,
    ring,
    throughput,
    width_from_errors,
    zoom_difficulty,
    zoom_difficulty_linear,
)

Floats = NDArray[np.float64]
# TV-A1 of guidance-teleop.md A.6
ERRORS = (1.0, -2.0, 0.5, 3.0, -1.5, 0.0, 2.5, -3.0, 1.5, -0.5, 2.0)
TIMES = np.array((900, 950, 870, 1010, 990, 930, 880, 1020, 940, 910, 960)) / 1000.0
WIDTH = 20.0


def sequence(errors: tuple[float, ...] = ERRORS) -> tuple[Floats, Floats, Floats]:
    """A ring of 11 on a circle of 200, selected with these errors along the way."""
    centres = ring(11, 200.0)
    start, goal = centres[:-1], centres[1:]
    way = goal - start
    return start, goal, goal + way / np.hypot(*way.T)[:, None] * np.array(errors)[:, None]


def test_the_published_vector() -> None:
    found = throughput(*sequence(), TIMES, WIDTH)
    assert found.n == 11
    assert found.sd == pytest.approx(1.927079750, rel=1e-9)
    assert found.width == pytest.approx(7.964102906, rel=1e-9)
    assert found.amplitude == pytest.approx(198.418833831, rel=1e-9)
    assert found.difficulty == pytest.approx(4.695668024, rel=1e-9)
    assert found.movement_time_s == pytest.approx(0.941818182, rel=1e-9)
    assert found.bits_per_s == pytest.approx(4.985747902, rel=1e-9)
    assert (found.error_percent, found.rejected, found.word) == (0.0, 0, "")


def test_the_overshoot_of_the_trial_before_makes_the_way_longer_in_serial_tasks_only() -> None:
    serial, discrete = (throughput(*sequence(), TIMES, WIDTH, serial=one) for one in (True, False))
    a = chord(11, 200.0)
    assert discrete.amplitude == pytest.approx(a + np.mean(ERRORS), rel=1e-12)
    assert serial.amplitude == pytest.approx(a + np.mean(ERRORS) + sum(ERRORS[:-1]) / 11, rel=1e-12)


@given(st.lists(st.tuples(*[st.floats(-300.0, 300.0)] * 6), min_size=1, max_size=8))
def test_the_error_along_the_axis_is_that_of_the_three_distances(rows: list[tuple[float, ...]]) -> None:
    start, goal, end = np.hsplit(np.array(rows), 3)
    goal = goal + np.where(np.hypot(*(goal - start).T)[:, None] < 1.0, 5.0, 0.0)
    a, b, c = (np.hypot(*way.T) for way in (goal - start, end - goal, end - start))
    amplitude, error = axis_errors(start, goal, end)
    assert amplitude == pytest.approx(a)
    assert error == pytest.approx((c**2 - b**2 - a**2) / (2 * a), abs=1e-6)


def test_endpoints_without_spread_have_no_throughput() -> None:
    for errors in ((0.0,) * 11, (0.1,) * 11):
        found = throughput(*sequence(errors), TIMES, WIDTH)
        assert math.isnan(found.bits_per_s)
        assert math.isnan(found.difficulty)
        assert found.word == "n/a: the endpoints do not spread"
        assert found.movement_time_s == pytest.approx(TIMES.mean())


@pytest.mark.parametrize("n", [0, 1, 2])
def test_fewer_than_three_trials_have_no_throughput(n: int) -> None:
    found = throughput(*(part[:n] for part in sequence()), TIMES[:n], WIDTH)
    assert math.isnan(found.bits_per_s)
    assert found.word == "n/a: fewer than 3 trials"
    assert not math.isnan(throughput(*(part[:3] for part in sequence()), TIMES[:3], WIDTH).bits_per_s)


@pytest.mark.parametrize("bad", [0.0, -0.5, math.nan, math.inf])
def test_a_trial_without_a_time_is_rejected_and_counted(bad: float) -> None:
    times = TIMES.copy()
    times[4] = bad
    found = throughput(*sequence(), times, WIDTH)
    assert (found.n, found.rejected) == (10, 1)
    assert found.movement_time_s == pytest.approx(np.delete(TIMES, 4).mean())
    assert found.sd == pytest.approx(np.delete(np.array(ERRORS), 4).std(ddof=1))
    assert throughput(*sequence(), np.full(11, bad), WIDTH).word == "n/a: fewer than 3 trials"


def test_a_target_where_the_last_one_was_is_rejected() -> None:
    start, goal, end = sequence()
    start[3] = goal[3]
    found = throughput(start, goal, end, TIMES, WIDTH)
    assert (found.n, found.rejected) == (10, 1)
    assert math.isfinite(found.bits_per_s)


def test_movements_away_from_the_targets_have_no_throughput() -> None:
    errors = tuple(-400.0 - 10.0 * k for k in range(11))
    found = throughput(*sequence(errors), TIMES, WIDTH)
    assert math.isnan(found.bits_per_s)
    assert "did not go" in found.word


def test_errors_are_selections_beyond_the_radius() -> None:
    found = throughput(*sequence(), TIMES, 2.0 * 2.25)
    # 3.0, 2.5, -3.0 are farther than 2.25
    assert found.error_percent == pytest.approx(100.0 * 3 / 11)


def test_outliers_moved_too_little_or_ended_far_away() -> None:
    start, goal = np.zeros((5, 2)), np.tile((100.0, 0.0), (5, 1))
    end = np.array([(100.0, 0.0), (49.0, 0.0), (51.0, 0.0), (100.0, 81.0), (100.0, 79.0)])
    assert outliers(start, goal, end, 40.0).tolist() == [False, True, False, True, False]
    assert outliers(start, goal, end, 60.0).tolist() == [False, True, False, False, False]
    assert outliers(start, goal, end, 20.0).tolist() == [False, True, True, True, True]


def test_one_lost_trial_ruins_the_sequence_and_is_left_out_by_the_rule() -> None:
    errors = (*ERRORS[:5], -198.0, *ERRORS[6:])
    start, goal, end = sequence(errors)
    flags = outliers(start, goal, end, WIDTH)
    assert np.flatnonzero(flags).tolist() == [5]
    every, without = (throughput(start, goal, end, TIMES, WIDTH, keep=keep) for keep in (True, ~flags))
    assert every.bits_per_s < 0.4 * without.bits_per_s
    assert (without.n, without.rejected) == (10, 0)
    # the trial after it still began where it ended
    a, kept = chord(11, 200.0), np.delete(np.array(errors), 5)
    before = np.delete(np.array((0.0, *errors[:-1])), 5)
    assert without.amplitude == pytest.approx(a + kept.mean() + before.mean())


@pytest.mark.parametrize("n", [3, 5, 11, 15, 25])
def test_all_ways_of_a_ring_are_the_same_chord_and_every_target_is_met(n: int) -> None:
    centres = ring(n, 300.0)
    assert np.hypot(*np.diff(centres, axis=0).T) == pytest.approx(chord(n, 300.0), rel=1e-12)
    assert chord(n, 300.0) == pytest.approx(300.0 * math.cos(math.pi / (2 * n)))
    assert np.hypot(*centres.T) == pytest.approx(150.0)
    assert len({tuple(row) for row in np.round(centres[1:], 6).tolist()}) == n
    assert centres[-1] == pytest.approx(centres[0])


def test_the_chord_of_the_vector() -> None:
    assert chord(11, 200.0) == pytest.approx(197.964288376, rel=1e-9)


@pytest.mark.parametrize("n", [0, 1, 2, 4, 14])
def test_an_even_ring_is_refused(n: int) -> None:
    with pytest.raises(ValueError, match="odd"):
        ring(n, 200.0)


def test_nominal_difficulties_of_the_game() -> None:
    assert pan_difficulty(300.0, 9.0) == pytest.approx(4.143, abs=5e-4)
    assert zoom_difficulty_linear(100.0, 200.0, 9.0) == pytest.approx(2.713, abs=5e-4)
    expected = math.log2(math.log(2.0) / math.log(209.0 / 191.0) + 1.0)
    assert zoom_difficulty(100.0, 200.0, 9.0) == pytest.approx(expected, rel=1e-12)
    assert index_of_difficulty(70.0, 10.0) == 3.0
    assert pan_difficulty(0.0, 9.0) == zoom_difficulty(80.0, 80.0, 9.0) == 0.0


@given(st.floats(20.0, 300.0), st.floats(20.0, 300.0), st.floats(0.5, 3.0))
def test_a_zoom_is_as_hard_at_any_magnification(size: float, goal: float, factor: float) -> None:
    bits = zoom_difficulty(size, goal, 9.0)
    assert zoom_difficulty(size * factor, goal * factor, 9.0 * factor) == pytest.approx(bits, abs=1e-9)


@pytest.mark.parametrize(("size", "goal", "tolerance"), [(0.0, 50.0, 9.0), (50.0, 9.0, 9.0), (50.0, 60.0, 0.0)])
def test_difficulties_that_do_not_exist_are_nan(size: float, goal: float, tolerance: float) -> None:
    assert math.isnan(zoom_difficulty(size, goal, tolerance))
    assert math.isnan(index_of_difficulty(100.0, 0.0))
    assert math.isnan(index_of_difficulty(math.nan, 10.0))


@pytest.mark.parametrize(("percent", "factor"), [(1.0, 0.8021), (4.0, 1.0060), (20.0, 1.6121)])
def test_effective_width_from_an_error_rate(percent: float, factor: float) -> None:
    assert width_from_errors(30.0, percent) == pytest.approx(30.0 * factor, abs=30.0 * 5e-5)


@pytest.mark.parametrize(
    ("percent", "z", "factor"), [(3.88, 2.06630, 1.000), (10.0, 1.644854, 1.2561), (0.0, 4.060354, 0.5089)]
)
def test_effective_width_where_the_reference_rounds_otherwise(percent: float, z: float, factor: float) -> None:
    # z from tables of the normal distribution; the last digit of the reference's own figure is one off
    assert width_from_errors(1.0, percent) == pytest.approx(2.066 / z, abs=2e-6)
    assert width_from_errors(1.0, percent) == pytest.approx(factor, abs=1.5e-4)


def test_no_width_from_an_impossible_error_rate() -> None:
    assert math.isnan(width_from_errors(30.0, 100.0))
