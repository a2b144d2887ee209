"""The guided flow on virtual boards: full sessions, and those that must never end well."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace

import numpy as np
import pytest

from imugui.calibration.coverage import fibonacci
from imugui.calibration.ellipsoid import Ellipsoid
from imugui.calibration.heldout import Comparison
from imugui.calibration.magnetometer import MagnetometerFlow, MagnetometerResult
from imugui.calibration.turning import side, turn_next
from imugui.fusion.correction import Correction
from imugui.fusion.quaternion import from_rotation_vector
from imugui.samples import Rows
from imugui.simulation.board import EarthField, VirtualBoard
from imugui.simulation.errors import PRESETS
from imugui.simulation.path import Floats, Path

RATE_HZ = 50.0
BLOCK = 6  # rows, as a page at 8 Hz feeds them
BOARD = replace(PRESETS["mpu9250"], mag_rate_hz=0.0)
SEED = 3


class AboutZ(Path):
    """Rests for two seconds and then turns about the vertical; the board's z stays up."""

    def __init__(self, rate: float = 0.5) -> None:
        self.rate = rate

    def quats(self, t: Floats) -> Floats:
        angle = self.rate * np.maximum(np.asarray(t) - 2.0, 0.0)
        return from_rotation_vector(angle[:, None] * np.array([0.0, 0.0, 1.0]))


def board_rows(motion: str | Path, seconds: float, seed: int = SEED, norm_ut: float = 48.0, start: float = 0.0) -> Rows:
    rows = VirtualBoard(motion, RATE_HZ, BOARD, seed, EarthField(norm_ut)).rows(int(seconds * RATE_HZ))
    rows["t"] += start
    return rows


def blocks(rows: Rows) -> Iterator[Rows]:
    for i in range(0, len(rows), BLOCK):
        yield rows[i : i + BLOCK]


def feed(flow: MagnetometerFlow, rows: Rows) -> list[float]:
    """The progress after each block."""
    progress = []
    for block in blocks(rows):
        flow.feed(block)
        progress.append(flow.progress)
    return progress


def direction_error_deg(found: MagnetometerResult, motion: str = "free", seed: int = SEED) -> float:
    """True rms error over the sphere after the one rotation that no cloud can tell."""
    truth = VirtualBoard(motion, RATE_HZ, BOARD, seed).perfect_correction()
    true = fibonacci(500)
    raw = 48.0 * true @ np.linalg.inv(truth["mag_matrix"]).T + truth["mag_bias"]
    corrected = (raw - found.bias) @ found.matrix.T
    corrected /= np.linalg.norm(corrected, axis=1, keepdims=True)
    left, _, right = np.linalg.svd(true.T @ corrected)
    turned = corrected @ (left @ right).T
    return float(np.degrees(np.sqrt((np.linalg.norm(np.cross(turned, true), axis=1) ** 2).mean())))


def with_outliers(rows: Rows, share: float = 0.02) -> Rows:
    rng = np.random.default_rng(5)
    wrong = rng.uniform(size=len(rows)) < share
    rows["mag"][wrong] += 60.0 * rng.normal(size=(int(wrong.sum()), 3))
    return rows


def calibrated(seed: int) -> Correction:
    """A perfect correction of the board's gyroscope and accelerometer."""
    known = VirtualBoard("free", RATE_HZ, BOARD, seed).perfect_correction()
    return Correction(**{name: value for name, value in known.items() if not name.startswith("mag")})


@pytest.fixture(scope="module")
def session() -> tuple[MagnetometerFlow, list[float]]:
    """Turned to all sides for a minute, with outliers; then laid flat and turned once around.

    The gyroscope and the accelerometer were calibrated before.
    """
    flow = MagnetometerFlow(before=calibrated(SEED))
    progress = feed(flow, with_outliers(board_rows("free", 60.0)))
    progress += feed(flow, board_rows(AboutZ(), 20.0, start=60.0))
    return flow, progress


def test_a_full_session_ends_accepted(session: tuple[MagnetometerFlow, list[float]]) -> None:
    flow, progress = session
    found = flow.result()
    assert flow.done
    assert flow.missing == ()
    assert progress[-1] == 1.0
    assert found.accepted, found.reason
    assert "°" in found.reason
    assert found.verdict.light == "green"
    assert found.check is not None
    assert found.check.deviation_deg < 2.0
    assert found.check.dip_deg == pytest.approx(65.0, abs=4.0)
    assert found.check.field_spread < 0.02


def test_its_directions_are_right_to_a_tenth_of_a_degree(session: tuple[MagnetometerFlow, list[float]]) -> None:
    found = session[0].result()
    assert direction_error_deg(found) <= 0.1


def test_the_axes_are_turned_into_those_of_the_gyroscope(session: tuple[MagnetometerFlow, list[float]]) -> None:
    """This board's magnetometer is turned by 5 degrees against the rest, which no cloud can tell."""
    found = session[0].result()
    truth = VirtualBoard("free", RATE_HZ, BOARD, SEED).perfect_correction()["mag_matrix"]
    left, _, right = np.linalg.svd(found.matrix @ np.linalg.inv(truth))
    assert found.alignment is not None
    assert found.alignment.accepted
    assert found.alignment.angle_deg == pytest.approx(4.9, abs=0.7)
    assert np.degrees(np.arccos((np.trace(left @ right) - 1.0) / 2.0)) < 0.7


def test_the_result_holds_what_a_profile_keeps(session: tuple[MagnetometerFlow, list[float]]) -> None:
    found = session[0].result()
    assert found.samples > 500
    assert found.dip_deg == pytest.approx(65.0, abs=5.0)
    assert 25.0 <= found.temp_c <= 30.0
    assert len(found.cells) >= 65
    corrected = found.correction(Correction())
    np.testing.assert_allclose(corrected.mag_bias, found.bias)


def test_outliers_are_shown_apart(session: tuple[MagnetometerFlow, list[float]]) -> None:
    flow, _ = session
    cloud = flow.cloud()
    assert flow.fit is not None
    off = np.abs(flow.fit.distances(cloud.outliers)) / flow.fit.radius
    assert len(cloud.outliers) > 5
    assert off.min() > np.abs(flow.fit.distances(cloud.kept)).max() / flow.fit.radius
    assert len(cloud.seen) > 1000
    assert len(flow.cloud(100).seen) == 100


def test_the_sentence_leads_into_the_largest_gap() -> None:
    """The direction told is one where nothing has been seen, and turning there closes it."""
    flow = MagnetometerFlow()
    feed(flow, board_rows("free", 12.0))
    assert flow.verdict.fit is not None
    gap = flow.turn_next.copy()
    assert np.linalg.norm(gap) == pytest.approx(1.0)
    seen = flow.buffer.points - flow.verdict.fit.bias
    nearest = (seen @ gap / np.linalg.norm(seen, axis=1)).max()
    assert np.degrees(np.arccos(nearest)) == pytest.approx(flow.verdict.gap_deg, abs=8.0)
    assert flow.sentence == turn_next(gap, flow._dip())
    before = flow.verdict.gap_deg
    feed(flow, board_rows("free", 40.0)[int(12 * RATE_HZ) :])
    assert flow.verdict.gap_deg < before


def test_holding_still_gains_nothing() -> None:
    flow = MagnetometerFlow()
    feed(flow, board_rows("free", 12.0))
    held = board_rows("rest", 30.0, start=12.0)
    feed(flow, held[: int(2 * RATE_HZ)])
    before = flow.progress
    assert 0.1 < before < 0.9
    assert set(feed(flow, held[int(2 * RATE_HZ) :])) == {before}


def never_done(rows: Rows, flow: MagnetometerFlow | None = None) -> MagnetometerFlow:
    flow = flow or MagnetometerFlow()
    for block in blocks(rows):
        flow.feed(block)
        assert not flow.done
    assert not flow.result().accepted
    assert flow.result().reason
    assert flow.missing
    return flow


def test_held_still_it_never_ends() -> None:
    flow = never_done(board_rows("rest", 60.0))
    assert flow.progress == 0.0
    assert "held still: turn" in flow.sentence


def test_about_one_axis_it_never_ends() -> None:
    flow = never_done(board_rows(AboutZ(), 60.0))
    assert "one axis only (z): tip" in flow.sentence


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_with_a_stuck_axis_it_never_ends(axis: int) -> None:
    rows = board_rows("free", 60.0)
    rows["mag"][:, axis] = 17.25
    flow = never_done(rows)
    assert f"{'xyz'[axis]} axis is stuck" in flow.sentence


def test_beside_a_strong_magnet_it_never_ends() -> None:
    flow = never_done(board_rows("free", 60.0, norm_ut=190.0))
    assert "magnet" in flow.sentence
    assert flow.progress == 0.0


def test_where_the_field_is_uneven_it_never_ends() -> None:
    """A magnet on the table: the hand that turns the board also moves it through the magnet's field."""
    rows = board_rows("free", 60.0)
    rows["mag"] += 25.0 * np.random.default_rng(0).normal(size=3) * np.sin(1.7 * rows["t"])[:, None]
    flow = never_done(rows)
    assert "magnet" in flow.sentence


def test_repeated_values_are_one_measurement() -> None:
    flow = MagnetometerFlow()
    rows = board_rows("free", 8.0)
    rows["mag"] = rows["mag"][np.arange(len(rows)) // 10 * 10]
    feed(flow, rows)
    assert len(flow.cloud().seen) == len(rows) / 10


def test_bad_rows_are_passed_over() -> None:
    flow, clean = MagnetometerFlow(), MagnetometerFlow()
    rows = board_rows("free", 10.0)
    feed(clean, rows[::2])
    rows["mag"][1::4] = np.nan
    rows["mag"][3::8] = 1e9
    rows["t"][7::8] = np.nan
    feed(flow, rows)
    assert flow.progress == pytest.approx(clean.progress)
    flow.feed(rows[:0])


def test_without_a_magnetometer_nothing_happens() -> None:
    rows = board_rows("free", 10.0)
    rows["mag"] = np.nan
    never_done(rows)


def test_a_person_may_stop_turning_when_the_gate_accepts() -> None:
    flow = MagnetometerFlow()
    assert not flow.finish_turning()
    feed(flow, board_rows("free", 16.0))
    assert flow.verdict.accepted
    assert flow.check is None
    assert flow.finish_turning()
    assert "lay the board flat" in flow.sentence


def test_a_recording_without_the_check_still_has_a_verdict() -> None:
    flow = MagnetometerFlow()
    flow.feed(board_rows("free", 60.0))
    found = flow.result()
    assert not flow.done
    assert found.accepted
    assert found.check is None


def test_without_a_gyroscope_there_is_no_check() -> None:
    flow = MagnetometerFlow()
    rows = board_rows("free", 60.0)
    rows["gyr"] = np.nan
    feed(flow, rows)
    assert flow.done


def test_a_check_turn_finds_a_field_that_has_changed() -> None:
    flow = MagnetometerFlow()
    feed(flow, board_rows("free", 60.0))
    turn = board_rows(AboutZ(), 20.0, start=60.0)
    turn["mag"] += (12.0, 0.0, 0.0)  # a screwdriver was laid on the board
    feed(flow, turn)
    found = flow.result()
    assert flow.done
    assert not found.accepted
    assert "check turn found a fault" in found.reason


def test_a_wrong_vertical_is_not_blamed_on_the_field() -> None:
    flow = MagnetometerFlow()
    for rows in (board_rows("free", 60.0), board_rows(AboutZ(), 20.0, start=60.0)):
        rows["acc"] += (1.5, 0.0, 0.0)
        feed(flow, rows)
    found = flow.result()
    assert not found.accepted
    assert "accelerometer is not calibrated" in found.reason


def test_a_good_old_calibration_is_kept() -> None:
    rows = board_rows("free", 60.0)
    first = MagnetometerFlow()
    first.feed(rows)
    before = first.result().correction(Correction())
    again = MagnetometerFlow(before=before)
    again.feed(board_rows("free", 60.0))
    found = again.result()
    assert not found.accepted
    assert found.comparison is not None
    assert found.comparison.keep_old
    assert "the old one is kept" in found.reason


def test_a_bad_old_calibration_is_replaced() -> None:
    flow = MagnetometerFlow(before=Correction(mag_bias=(20.0, 0.0, 0.0)))
    flow.feed(board_rows("free", 60.0))
    found = flow.result()
    assert found.accepted
    assert found.comparison is not None
    assert found.comparison.old > 0.1


@pytest.mark.parametrize(
    ("old", "new", "kept"), [(0.02, 0.018, True), (0.02, 0.01, False), (0.05, 0.045, False), (0.05, 0.06, True)]
)
def test_the_rule_for_keeping(old: float, new: float, kept: bool) -> None:
    comparison = Comparison(old, new)
    assert comparison.keep_old is kept
    assert ("kept" in comparison.sentence) is kept


@pytest.mark.parametrize(
    ("direction", "said"),
    [
        ((0.0, 0.0, 1.0), "+z side"),
        ((-1.0, 0.1, 0.0), "−x side"),
        ((0.7, 0.0, -0.7), "edge between +x and −z"),
        ((0.6, -0.6, 0.55), "corner of +x, −y, +z"),
    ],
)
def test_sides_are_named(direction: Iterable[float], said: str) -> None:
    assert said in side(np.array(list(direction)))


def test_where_to_point_depends_on_the_dip() -> None:
    assert "floor" in turn_next((0.0, 0.0, 1.0), 65.0)
    assert "ceiling" in turn_next((0.0, 0.0, 1.0), -60.0)
    assert turn_next((1.0, 0.0, 0.0), 5.0) == "Turn the board until its +x side points to the magnetic north."


def test_the_fit_shown_begins_as_a_sphere() -> None:
    flow = MagnetometerFlow()
    shown: list[Ellipsoid] = []
    for block in blocks(board_rows("free", 30.0)):
        flow.feed(block)
        if flow.fit is not None:
            shown.append(flow.fit)
    assert "sphere" in shown[0].method
    assert "ellipsoid" in shown[-1].method
