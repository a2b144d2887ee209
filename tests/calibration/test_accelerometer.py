"""The accelerometer's calibration against the reference's figures and against the virtual board's truth."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from imugui.calibration.accelerometer import many
from imugui.calibration.accelerometer_flows import FLOWS, METHODS, AccelerometerFlow
from imugui.calibration.coverage import fibonacci
from imugui.calibration.gravity_fit import MG, fit_gravity, leave_one_out, norms, rms
from imugui.calibration.positions import face_of, positions_of, stops_of
from imugui.samples import GRAVITY, Rows
from imugui.simulation.board import VirtualBoard
from imugui.simulation.errors import PRESETS

Real = Callable[[str], Rows]
Held = Callable[..., tuple[VirtualBoard, Rows]]


def fed(rows: Rows, method: str = "many") -> AccelerometerFlow:
    flow = AccelerometerFlow(method)
    flow.feed(rows)
    return flow


def means(rows: Rows) -> np.ndarray:
    """The mean raw accelerations of the positions."""
    return np.array([position.acc for position in positions_of(stops_of(rows))])


@pytest.mark.parametrize("count", [9, 10, 12])
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_a_datasheet_board_is_corrected_to_a_third_of_a_mg(count: int, seed: int, held: Held) -> None:
    board, rows = held(count, seed)
    flow = fed(rows)
    result = flow.result()
    assert result.accepted, result.reason
    assert flow.done
    assert result.residual_mg <= 0.3
    # and in all other attitudes too, which the fit has not seen
    raw = board.sensors.acc.apply(fibonacci(200) * GRAVITY)
    assert rms(norms(np.array(result.matrix), np.array(result.bias), raw) - GRAVITY) / MG <= 0.3


def test_uncorrected_the_same_board_is_off_by_tens_of_mg(held: Held) -> None:
    board, _ = held(9, 1)
    raw = board.sensors.acc.apply(fibonacci(200) * GRAVITY)
    assert rms(norms(np.eye(3), np.zeros(3), raw) - GRAVITY) / MG > 10.0


def test_xsens(load_real: Real) -> None:
    rows = load_real("xsens")
    assert len(stops_of(rows)) == 38
    result = fed(rows).result()
    assert result.accepted
    assert result.residual_mg <= 0.15
    assert result.loo_mg <= 0.5
    six = fit_gravity(means(rows), 6)
    assert rms(leave_one_out(six)) / MG == pytest.approx(9.0, abs=1.0)
    assert fed(rows, "six").result().residual_mg == pytest.approx(13.8, abs=1.0)


def test_mpu6050(load_real: Real) -> None:
    flow = fed(load_real("mpu6050"))
    result = flow.result()
    assert len(flow.positions) == 10
    assert result.accepted, result.reason
    assert result.residual_mg <= 0.1
    assert result.loo_mg <= 1.0
    assert np.array(result.bias) / GRAVITY * 16384 == pytest.approx([728, -358, -1833], abs=25)
    scale = np.diag(result.matrix) * GRAVITY / 16384
    assert scale == pytest.approx([6.020e-4, 5.963e-4, 5.862e-4], rel=2e-3)
    assert fed(load_real("mpu6050"), "six").result().residual_mg == pytest.approx(1.9, abs=0.2)


def test_what_the_positions_leave_open_is_said_in_degrees_and_words(load_real: Real) -> None:
    """The MPU-6050's ten positions fit to 0.03 mg and still leave the x-y cross-axis term open."""
    flow = fed(load_real("mpu6050"))
    assert flow.result().tilt_deg > 1.0
    assert not flow.done
    assert flow.missing == ("the edge between +x and +y up",)
    assert fed(load_real("xsens")).result().tilt_deg < 0.05


def test_nilspod_six_faces(load_real: Real) -> None:
    flow = fed(load_real("nilspod"), "six")
    assert flow.done
    assert all(flow.faces.values())
    assert flow.result().residual_mg == pytest.approx(0.1, abs=0.1)
    assert flow.result().tilt_deg >= 0.8  # six faces fit themselves: the rest is not known


@pytest.mark.parametrize("seed", [4, 5])
def test_the_faces_may_come_in_any_order(seed: int, held: Held) -> None:
    _, rows = held(6, seed)
    parts = np.array_split(rows, 6)
    flow = AccelerometerFlow("six")
    for step, k in enumerate(np.random.default_rng(seed).permutation(6)):
        assert not flow.done
        assert len(flow.missing) == 6 - step
        flow.feed(parts[k])
    assert flow.done
    assert flow.result().accepted


def test_progress_comes_from_positions_and_not_from_time(held: Held) -> None:
    _, rows = held(9, 1)
    one = rows[:250]
    flow = AccelerometerFlow()
    seen = []
    for k in range(8):
        again = one.copy()
        again["t"] = one["t"] + k * 2.5
        flow.feed(again)
        seen.append(flow.progress)
    assert len(flow.positions) == 1
    assert len(set(seen)) == 1
    assert not flow.done
    assert "1 positions" in flow.result().reason


def test_positions_nearer_than_five_degrees_are_one(held: Held) -> None:
    _, rows = held(9, 1)
    twice = np.concatenate((rows, rows))
    twice["t"] = np.arange(len(twice)) / 100
    assert len(positions_of(stops_of(twice))) == 9


def test_too_few_positions_are_refused_and_the_missing_named(held: Held) -> None:
    _, rows = held(9, 1)
    flow = fed(rows[:2000])  # four positions
    assert not flow.result().accepted
    assert "at least 6" in flow.result().reason
    assert {"y down", "z down"} <= set(flow.missing)


def test_positions_in_one_plane_leave_too_much_open(held: Held) -> None:
    angles = np.linspace(0, 2 * np.pi, 9, endpoint=False)
    ring = np.column_stack((np.cos(angles), np.sin(angles), np.zeros(9))) * GRAVITY
    fit = fit_gravity(ring + 1e-3 * np.random.default_rng(0).normal(size=ring.shape), 9)
    assert np.degrees(fit.predicted_tilt) > 2.0
    assert np.isfinite(fit.matrix).all()


def test_moved_or_mis_scaled_data_are_refused(held: Held) -> None:
    _, rows = held(12, 1)
    wrong = rows.copy()
    wrong["acc"] /= GRAVITY  # in g
    assert not fed(wrong).result().accepted
    assert "unit" in fed(wrong).result().reason


def test_flat_says_how_poor_it_is() -> None:
    result = fed(VirtualBoard("rest", 100.0, PRESETS["mpu9250"], 1).rows(300), "flat").result()
    assert result.accepted, result.reason
    assert "z up" in result.reason
    assert result.tilt_deg >= 5.0


def test_six_parameters_below_nine_positions(held: Held) -> None:
    _, rows = held(8, 2)
    result = many(positions_of(stops_of(rows)))
    assert result.accepted, result.reason
    assert "6 parameters" in result.reason
    assert result.tilt_deg >= 0.8
    assert np.count_nonzero(np.array(result.matrix)) == 3


def test_every_way_is_offered_with_its_accuracy() -> None:
    assert list(FLOWS) == [*METHODS, "free fall"]
    for start in FLOWS.values():
        flow = start()
        assert flow.title
        assert "deg" in flow.accuracy
        assert flow.progress == 0.0
        assert not flow.done
        assert not flow.result().accepted
        assert flow.missing
        assert flow.sentence.endswith(".")


@pytest.mark.parametrize(
    ("acc", "face"), [((0, 0, 9.8), "z up"), ((-9, 2, 1), "x down"), ((0, -9.8, 3), "y down"), ((7, 7, 0), "")]
)
def test_faces_are_recognised(acc: tuple[float, float, float], face: str) -> None:
    assert face_of(np.array(acc, float)) == face
