"""The seeds' own methods, as they are in their sources."""

from __future__ import annotations

import numpy as np
import pytest

from imugui.calibration import seeds
from imugui.fusion.pipeline import Pipeline
from imugui.simulation.board import VirtualBoard
from imugui.simulation.errors import Errors


def test_min_max_scales_each_axis_to_one() -> None:
    points = np.array([[10.0, 0.0, 0.0], [30.0, 2.0, 8.0], [20.0, 1.0, 4.0]])
    fit = seeds.min_max_scaled(points)
    np.testing.assert_allclose(fit.apply(points) / fit.radius, [[-1, -1, -1], [1, 1, 1], [0, 0, 0]], atol=1e-12)
    assert "001" in fit.method


def test_the_offset_alone_leaves_the_shape() -> None:
    points = np.array([[10.0, 0.0, 0.0], [30.0, 2.0, 8.0], [20.0, 1.0, 4.0]])
    fit = seeds.min_max_offset(points)
    np.testing.assert_allclose(fit.bias, (20.0, 1.0, 4.0))
    np.testing.assert_allclose(fit.matrix, np.eye(3))
    assert "002" in fit.method


def test_half_a_turn_gives_the_two_offsets_across_its_axis() -> None:
    offset = seeds.half_turn_offset((15.0, -3.0, 40.0), (5.0, 9.0, 40.0), 2)
    np.testing.assert_allclose(offset[:2], (10.0, 3.0))
    assert np.isnan(offset[2])


def test_half_turns_are_found_in_a_free_motion() -> None:
    board = VirtualBoard("free", 50.0, Errors(mag_hard_ut=30.0), seed=2)
    rows = board.rows(3000)
    attitude = Pipeline(use_mag=False).step(rows)
    fit = seeds.half_turns(rows["mag"], attitude["quat"])
    assert fit is not None
    assert "000" in fit.method
    np.testing.assert_allclose(fit.bias, board.perfect_correction()["mag_bias"], atol=6.0)


def test_without_half_turns_there_is_no_offset() -> None:
    rows = VirtualBoard("rest", 50.0).rows(100)
    assert seeds.half_turns(rows["mag"], np.tile([1.0, 0, 0, 0], (100, 1))) is None


@pytest.mark.parametrize(("norm", "value"), [(1.0, 100), (0.931, 93), (1.0691, 93), (0.0, 0), (2.5, 0), (np.nan, 0)])
def test_the_bar_measures_one_length(norm: float, value: int) -> None:
    assert seeds.bar_value(norm) == value


def test_the_bar_fills_within_fifty_ticks_while_nothing_is_known() -> None:
    bar = seeds.ProgressBar()
    assert bar.push(1.0) == 2
    for _ in range(48):
        bar.push(1.0)
    assert bar.push(1.0) == 100


def test_the_bar_rounds_up() -> None:
    bar = seeds.ProgressBar()
    assert bar.push(0.5) == 1


def test_heading_spread_is_zero_for_a_perfect_field() -> None:
    board = VirtualBoard("free", 50.0)
    rows = board.rows(500)
    fit = seeds.min_max_offset(np.concatenate((rows["mag"], -rows["mag"])))
    assert seeds.level_heading_spread_deg(fit, rows["mag"], board.truth) == pytest.approx(0.0, abs=1e-6)


def test_every_method_names_its_seed() -> None:
    assert all("seed 00" in method.title for method in seeds.SEED_METHODS.values())
