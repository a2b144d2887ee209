"""The gyroscope's scale and cross-axis terms from turns, real and virtual."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from imugui.calibration.accelerometer import many
from imugui.calibration.gyroscope import gyroscope_matrix, scale_from_whole_turns, whole_turns
from imugui.calibration.positions import positions_of, stops_of
from imugui.calibration.turns import Turn, turned_angles, turns_of
from imugui.fusion.correction import Correction
from imugui.samples import GRAVITY, Rows
from imugui.simulation.board import VirtualBoard

DEGREE = np.pi / 180
Real = Callable[[str], Rows]


def turns_and_acc(rows: Rows) -> tuple[list[Turn], Correction]:
    stops = stops_of(rows)
    found = many(positions_of(stops))
    return turns_of(rows, stops), Correction(acc_bias=found.bias, acc_matrix=found.matrix)


def test_xsens(load_real: Real) -> None:
    turns, acc = turns_and_acc(load_real("xsens"))
    assert len(turns) == 37
    result = gyroscope_matrix(turns, acc)
    assert result.accepted, result.reason
    assert result.nominal_deg == pytest.approx(3.9, abs=0.1)
    assert result.error_deg <= 0.38
    assert result.loo_deg <= 0.44


def test_nine_turns_are_too_few(load_real: Real) -> None:
    turns, acc = turns_and_acc(load_real("mpu6050"))
    assert len(turns) == 9
    result = gyroscope_matrix(turns, acc)
    assert not result.accepted
    assert "15 are needed" in result.reason
    assert result.matrix == ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


def test_nilspod_whole_turns(load_real: Real) -> None:
    turns, _ = turns_and_acc(load_real("nilspod"))
    result = scale_from_whole_turns(whole_turns(turns))
    assert result.accepted, result.reason
    assert result.turns == 3
    assert np.round(result.angles_deg) == pytest.approx([370, 354, 359])
    assert 1 / np.diag(result.matrix) == pytest.approx([1.028, 0.982, 0.998], abs=5e-4)
    assert result.angles_deg[0] == pytest.approx(370, abs=0.5)


@pytest.mark.parametrize("seed", [1, 2])
def test_the_virtual_boards_matrix_is_found(seed: int, held: Callable[..., tuple[VirtualBoard, Rows]]) -> None:
    board, once = held(12, seed)
    rows = np.concatenate((once, board.rows(len(once))))
    turns, acc = turns_and_acc(rows)
    assert len(turns) >= 15
    result = gyroscope_matrix(turns, acc)
    assert result.accepted, result.reason
    assert result.loo_deg < 0.5 * result.nominal_deg
    # true up to the small rotation between the accelerometer's own axes and the board's
    angles = turned_angles(turns, np.array(result.matrix))
    true = turned_angles(turns, np.linalg.inv(board.sensors.gyr.matrix))
    assert np.abs(angles - true).max() < 0.5 * DEGREE


def test_a_matrix_without_gain_is_not_used() -> None:
    """Turns whose gyroscope was perfect and whose accelerometer was not: nothing to gain."""
    rng = np.random.default_rng(0)
    turns = []
    for _ in range(16):
        before, after = rng.normal(size=(2, 3))
        turns.append(Turn(rng.normal(size=(50, 3)) * 0.02, before * GRAVITY, after * GRAVITY, 0.5))
    result = gyroscope_matrix(turns, Correction())
    assert not result.accepted
    assert result.turns == 16


@pytest.mark.parametrize(("read", "word"), [({}, "No whole turn"), ({0: [3.0]}, "too far off")])
def test_what_is_no_whole_turn_gives_no_scale(read: dict[int, list[float]], word: str) -> None:
    result = scale_from_whole_turns(read)
    assert not result.accepted
    assert word in result.reason


def test_an_axis_without_a_turn_keeps_its_scale() -> None:
    result = scale_from_whole_turns({2: [365 * DEGREE]})
    assert np.diag(result.matrix) == pytest.approx([1.0, 1.0, 360 / 365])


def test_turns_across_a_gap_are_left_out(held: Callable[..., tuple[VirtualBoard, Rows]]) -> None:
    _, rows = held(6, 1)
    whole = turns_of(rows, stops_of(rows))
    cut = np.delete(rows, slice(330, 470))  # most of the first turn is missing
    assert len(turns_of(cut, stops_of(cut))) == len(whole) - 1
