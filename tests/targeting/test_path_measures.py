"""Path measures on paths whose answers can be counted by eye, and under a sensor's jitter."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from imugui.targeting.path_measures import (
    PathMeasures,
    crossings,
    entries,
    path_measures,
    resample,
    spectral_arc_length,
    task_axes,
    turns,
)

START, GOAL, WIDTH = (0.0, 0.0), (100.0, 0.0), 20.0


def measured(points: list[tuple[float, float]], band: float = 1.0, turn: float = 0.0) -> PathMeasures:
    """Straight lines through these points, 1 s each; the whole turned by ``turn`` rad."""
    way = np.array([[math.cos(turn), math.sin(turn)], [-math.sin(turn), math.cos(turn)]])
    goal = np.array(GOAL) @ way
    return path_measures(np.arange(len(points)), np.array(points) @ way, START, goal, WIDTH, band)


@pytest.mark.parametrize("turn", [0.0, 1.0, -2.5])
def test_a_straight_path_has_nothing_to_count(turn: float) -> None:
    found = measured([START, GOAL], turn=turn)
    counts = (found.reentries, found.axis_crossings, found.direction_changes, found.orthogonal_changes)
    assert (*counts, found.overshoots) == (0, 0, 0, 0, 0)
    assert found.length == pytest.approx(100.0)
    assert found.efficiency == pytest.approx(1.0)
    assert (found.variability, found.error, found.offset) == pytest.approx((0.0, 0.0, 0.0), abs=1e-9)


def test_an_overshoot_with_return_is_one_reentry_and_one_turn() -> None:
    found = measured([START, (130.0, 0.0), GOAL])
    assert (found.overshoots, found.reentries, found.orthogonal_changes) == (1, 1, 1)
    assert found.efficiency == pytest.approx(100.0 / 160.0)


def test_leaving_the_target_sideways_is_a_reentry_but_no_overshoot() -> None:
    found = measured([START, GOAL, (100.0, 30.0), GOAL])
    assert (found.reentries, found.overshoots) == (1, 0)


def test_a_zigzag_crosses_and_turns() -> None:
    found = measured([START, (20.0, 10.0), (40.0, -10.0), (60.0, 10.0), (80.0, -10.0), GOAL])
    assert found.axis_crossings == 3
    assert found.direction_changes == 4
    assert found.orthogonal_changes == 0


def test_a_path_beside_the_axis_has_offset_but_no_variability() -> None:
    found = measured([(0.0, 7.0), (100.0, 7.0)])
    assert (found.offset, found.error, found.variability) == pytest.approx((7.0, 7.0, 0.0), abs=1e-9)
    below = measured([(0.0, -7.0), (100.0, -7.0)])
    assert (below.offset, below.error) == pytest.approx((-7.0, 7.0))


def test_variability_is_the_standard_deviation_across() -> None:
    t = np.arange(101) / 100.0
    v = 5.0 * np.sin(20.0 * t)
    found = path_measures(t, np.column_stack((100.0 * t, v)), START, GOAL, WIDTH)
    assert found.variability == pytest.approx(v.std(ddof=1), rel=1e-9)
    assert found.error == pytest.approx(np.abs(v).mean(), rel=1e-9)


@given(st.integers(0, 2**32 - 1))
def test_jitter_inside_the_band_counts_nothing(seed: int) -> None:
    t = np.arange(300) / 100.0
    jitter = np.random.default_rng(seed).uniform(-0.45, 0.45, (300, 2))
    found = path_measures(t, np.column_stack((t / 2.99 * 100.0, 0.0 * t)) + jitter, START, GOAL, WIDTH, band=1.0)
    assert (found.axis_crossings, found.direction_changes, found.orthogonal_changes, found.reentries) == (0, 0, 0, 0)


def test_the_counts_do_not_depend_on_the_rate_of_the_samples() -> None:
    points = [START, (40.0, 15.0), (130.0, -15.0), (90.0, 15.0), GOAL]
    t = np.arange(len(points), dtype=float)
    fine = np.linspace(0.0, 4.0, 3999)
    dense = np.column_stack([np.interp(fine, t, np.array(points)[:, k]) for k in (0, 1)])
    coarse, many = (path_measures(*path, START, GOAL, WIDTH) for path in ((t, points), (fine, dense)))
    assert (coarse.axis_crossings, coarse.direction_changes, coarse.orthogonal_changes, coarse.reentries) == (
        many.axis_crossings, many.direction_changes, many.orthogonal_changes, many.reentries
    )  # fmt: skip
    assert coarse.length == pytest.approx(many.length, rel=1e-3)


def test_rows_that_are_no_numbers_or_go_back_are_left_out() -> None:
    t = [0.0, 0.5, math.nan, 0.4, 0.5, 1.0]
    xy = [(0.0, 0.0), (50.0, 0.0), (9.0, 9.0), (-99.0, 9.0), (77.0, 7.0), (100.0, 0.0)]
    assert path_measures(t, xy, START, GOAL, WIDTH).efficiency == pytest.approx(1.0)
    xy[1] = (math.nan, 0.0)
    assert path_measures(t, xy, START, GOAL, WIDTH).length > 0.0


@pytest.mark.parametrize("t", [[], [0.0], [1.0, 1.0], [math.nan, 1.0]])
def test_a_path_of_less_than_two_places_has_no_measures(t: list[float]) -> None:
    found = path_measures(t, [START] * len(t), START, GOAL, WIDTH)
    assert math.isnan(found.length)
    assert math.isnan(found.efficiency)


def test_standing_still_has_no_efficiency_and_a_target_at_the_start_no_axis() -> None:
    still = path_measures([0.0, 1.0], [START, START], START, GOAL, WIDTH)
    assert still.length == 0.0
    assert math.isnan(still.efficiency)
    assert math.isnan(still.smoothness)
    here = path_measures([0.0, 1.0], [START, (3.0, 4.0)], START, START, WIDTH)
    assert here.length == pytest.approx(5.0)
    assert math.isnan(here.variability)


def test_resampling_keeps_both_ends_and_says_its_rate() -> None:
    path, rate_hz = resample([0.0, 0.013, 0.3337], [(0.0, 1.0), (1.0, 1.0), (5.0, 2.0)])
    assert path[0].tolist() == [0.0, 1.0]
    assert path[-1].tolist() == [5.0, 2.0]
    assert rate_hz == pytest.approx((len(path) - 1) / 0.3337)
    assert rate_hz == pytest.approx(100.0, rel=0.02)


def test_the_axes_point_along_and_to_the_left() -> None:
    u, v = task_axes(np.array([(0.0, 10.0), (-3.0, 0.0)]), (0.0, 0.0), (0.0, 50.0))
    assert u.tolist() == pytest.approx([10.0, 0.0])
    assert v.tolist() == pytest.approx([0.0, 3.0])


def test_the_hysteresis_of_each_count() -> None:
    assert entries(np.array([5.0, 0.9, 1.5, 0.9, 2.1, 0.5]), 1.0, 1.0) == 2
    assert crossings(np.array([2.0, 0.5, -0.5, 2.0, -1.5, 0.5, 1.5]), 1.0) == 2
    assert turns(np.array([0.0, 5.0, 4.5, 9.0, 3.0, 3.5, 2.0, 6.0]), 1.0) == 2
    assert turns(np.zeros(5), 1.0) == 0


def minimum_jerk(rate_hz: float, length_s: float) -> np.ndarray:
    s = np.linspace(0.0, 1.0, round(length_s * rate_hz) + 1)
    return 30.0 * s**2 * (1.0 - s) ** 2


def test_smoothness_is_that_of_the_shape_alone() -> None:
    reach = spectral_arc_length(minimum_jerk(100.0, 1.0), 100.0)
    assert spectral_arc_length(7.0 * minimum_jerk(100.0, 1.0), 100.0) == pytest.approx(reach, rel=1e-9)
    assert spectral_arc_length(minimum_jerk(100.0, 2.0), 100.0) == pytest.approx(reach, abs=0.02)


def test_smoothness_of_the_published_example() -> None:
    """The figure that the authors' own tool documents for a Gaussian speed profile."""
    t = np.arange(-1.0, 1.0, 0.01)
    assert spectral_arc_length(np.exp(-5.0 * t**2), 100.0) == pytest.approx(-1.41403, abs=5e-6)


def test_a_movement_in_two_parts_is_less_smooth() -> None:
    one = minimum_jerk(100.0, 1.0)
    two = np.concatenate((one, np.zeros(30), one))
    assert spectral_arc_length(two, 100.0) < spectral_arc_length(one, 100.0) - 0.3
