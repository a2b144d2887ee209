"""The virtual board: rows that agree with the truth, errors as large as they say, the same however they are cut."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from imugui import fields
from imugui.fusion import quaternion
from imugui.fusion.correction import Correction
from imugui.samples import GRAVITY, NO_STATUS, Rows
from imugui.simulation.board import EarthField, VirtualBoard
from imugui.simulation.errors import PRESETS, Errors
from imugui.simulation.hand import HandTurned
from imugui.simulation.motions import MOTIONS
from imugui.simulation.path import Floats

DEGREE = np.pi / 180
VECTORS = ("gyr", "acc", "mag")


def same(one: Rows, other: Rows) -> bool:
    """Equal bit by bit, NaN included."""
    return one.tobytes() == other.tobytes()


def runs(values: Floats) -> Floats:
    """Lengths of the runs of identical rows, without the last one, which the end cuts."""
    return np.diff(np.flatnonzero(np.r_[True, (values[1:] != values[:-1]).any(axis=1)]))


def moved(board: VirtualBoard, n: int) -> tuple[Rows, Floats]:
    """n rows with their true attitudes; a board that waits for a hand is dragged about ten times."""
    pieces = []
    for k in range(10):
        if isinstance(board.path, HandTurned):
            board.path.turn(0.4 * (-1) ** (k // 3), 0.1 * k)
        pieces.append((board.rows(n * (k + 1) // 10 - n * k // 10), board.truth))
    return np.concatenate([rows for rows, _ in pieces]), np.concatenate([truth for _, truth in pieces])


@pytest.mark.parametrize("name", MOTIONS)
@pytest.mark.parametrize("rate_hz", [25.0, 138.6, 1000.0])
def test_an_exact_integrator_of_the_ideal_gyroscope_stays_on_the_truth(name: str, rate_hz: float) -> None:
    board = VirtualBoard(name, rate_hz)
    rows, truth = moved(board, round(12 * rate_hz))
    steps = quaternion.from_rotation_vector(rows["gyr"] / rate_hz)
    quats = [truth[0]]
    for step in steps[1:]:
        quats.append(quaternion.multiply(quats[-1], step))
    assert quaternion.angle_between(np.array(quats), truth).max() < 1e-9
    assert rows["t"] == pytest.approx(np.arange(len(rows)) / rate_hz)
    assert np.abs(rows["gyr"][0]).max() < 1e-12


@pytest.mark.parametrize("name", MOTIONS)
def test_without_errors_gravity_and_field_are_those_of_the_earth(name: str) -> None:
    board = VirtualBoard(name, 100.0)
    rows, truth = moved(board, 1500)
    assert np.linalg.norm(rows["acc"], axis=1) == pytest.approx(GRAVITY, rel=1e-12)
    assert np.linalg.norm(rows["mag"], axis=1) == pytest.approx(48.0, rel=1e-12)
    up = quaternion.rotate(truth, rows["acc"]) / GRAVITY
    assert np.abs(up - [0, 0, 1]).max() < 1e-12
    north = quaternion.rotate(truth, rows["mag"])
    assert np.abs(north - 48 * np.array([0, np.cos(65 * DEGREE), -np.sin(65 * DEGREE)])).max() < 1e-11


def test_another_place_has_another_field() -> None:
    board = VirtualBoard("rest", 100.0, field=EarthField(norm_ut=30.0, dip_deg=-20.0))
    field = quaternion.rotate(np.tile(board.path.quats(np.zeros(1)), (5, 1)), board.rows(5)["mag"])
    assert field[0] == pytest.approx([0, 30 * np.cos(20 * DEGREE), 30 * np.sin(20 * DEGREE)])


def test_what_the_board_does_not_know_is_missing() -> None:
    rows = VirtualBoard("turns", 100.0).rows(50)
    assert np.isnan(rows["t_arrival"]).all()
    assert np.isnan(rows["lat"]).all()
    assert (rows["status"] == NO_STATUS).all()
    assert (rows["temp_c"] == 25.0).all()


@settings(max_examples=30, deadline=None)
@given(
    st.sampled_from(list(MOTIONS)),
    st.sampled_from([25.0, 138.6, 1000.0]),
    st.integers(0, 2**32),
    st.lists(st.integers(0, 300), max_size=8),
)
def test_rows_do_not_depend_on_how_many_are_asked_for(name: str, rate_hz: float, seed: int, cuts: list[int]) -> None:
    errors = dataclasses.replace(PRESETS["mpu9250"], mag_rate_hz=8.0, magnet_ut=50.0, magnet_at_s=0.5)
    whole, pieces = (VirtualBoard(name, rate_hz, errors, seed) for _ in range(2))
    rows = whole.rows(sum(cuts) + 10)
    made = [(pieces.rows(n), pieces.truth) for n in [*cuts, 10]]
    assert same(rows, np.concatenate([piece for piece, _ in made]))
    assert np.array_equal(whole.truth, np.concatenate([true for _, true in made]))
    assert pieces.count == len(rows)


def test_equal_seeds_are_equal_and_others_are_not() -> None:
    one, same_seed, other = (VirtualBoard("aiming", 100.0, PRESETS["mpu9250"], seed).rows(300) for seed in (1, 1, 2))
    assert same(one, same_seed)
    assert not np.array_equal(one["gyr"], other["gyr"])
    assert not np.array_equal(one["mag"], other["mag"])


def test_one_error_switched_off_leaves_the_others_as_they_were() -> None:
    full = PRESETS["mpu9250"]
    quiet = dataclasses.replace(full, gyr_noise_dps=0.0, gyr_bias_dps=0.0)
    one, other = (VirtualBoard("rest", 100.0, errors, 4).rows(300) for errors in (full, quiet))
    assert np.array_equal(one["acc"], other["acc"])
    assert np.array_equal(one["mag"], other["mag"])


@pytest.mark.parametrize("rate_hz", [50.0, 200.0, 1000.0])
def test_noise_is_the_density_times_the_root_of_half_the_rate(rate_hz: float) -> None:
    board = VirtualBoard("rest", rate_hz, Errors(gyr_noise_dps=0.01, acc_noise_ug=300.0, mag_noise_ut=0.3), 9)
    rows = board.rows(20_000)
    true_acc = quaternion.rotate(quaternion.conjugate(board.truth), [0, 0, GRAVITY])
    assert rows["gyr"].std(axis=0) == pytest.approx(0.01 * DEGREE * np.sqrt(rate_hz / 2), rel=0.03)
    assert (rows["acc"] - true_acc).std(axis=0) == pytest.approx(300e-6 * GRAVITY * np.sqrt(rate_hz / 2), rel=0.03)
    assert rows["mag"].std(axis=0) == pytest.approx(0.3, rel=0.03)
    assert np.abs(np.corrcoef(rows["gyr"][1:, 0], rows["gyr"][:-1, 0])[0, 1]) < 0.03


def test_the_bias_walks_with_the_root_of_time() -> None:
    ends = [VirtualBoard("rest", 50.0, Errors(gyr_walk_dps=0.01), seed).rows(5000)["gyr"][-1] for seed in range(60)]
    assert np.std(ends) / DEGREE == pytest.approx(0.01 * np.sqrt(100), rel=0.2)


def test_values_lie_on_the_grid_of_the_resolution() -> None:
    errors = Errors(gyr_noise_dps=0.1, acc_noise_ug=900.0, gyr_lsb_dps=0.1, acc_lsb_mg=2.0, mag_lsb_ut=0.6)
    rows = VirtualBoard("free", 100.0, errors).rows(1000)
    for name, step in (("gyr", 0.1 * DEGREE), ("acc", 2e-3 * GRAVITY), ("mag", 0.6)):
        counts = rows[name] / step
        assert np.abs(counts - np.round(counts)).max() < 1e-9
        assert len(np.unique(np.round(counts))) > 10


@pytest.mark.parametrize("preset", ["mpu9250", "mpu9250-calibrated"])
def test_the_constant_errors_stay_within_their_limits_and_are_not_all_alike(preset: str) -> None:
    errors = PRESETS[preset]
    boards = [VirtualBoard("rest", 100.0, errors, seed).sensors for seed in range(50)]
    for name, limits, scale, cross in (
        ("gyr", np.full(3, errors.gyr_bias_dps * DEGREE), errors.gyr_scale_percent, errors.gyr_cross_percent),
        (
            "acc",
            np.array([errors.acc_bias_mg, errors.acc_bias_mg, errors.acc_bias_z_mg]) * 1e-3 * GRAVITY,
            errors.acc_scale_percent,
            errors.acc_cross_percent,
        ),
        ("mag", np.full(3, errors.mag_hard_ut), errors.mag_soft_percent, errors.mag_soft_percent),
    ):
        bias = np.array([getattr(sensors, name).bias for sensors in boards])
        off = np.abs([getattr(sensors, name).matrix - np.eye(3) for sensors in boards]) * 100
        diagonal, others = off[:, np.eye(3, dtype=bool)], off[:, ~np.eye(3, dtype=bool)]
        for values, limit in ((np.abs(bias) / limits, 1.0), (diagonal, scale), (others, cross)):
            assert values.max() <= limit
            assert values.max() > 0.9 * limit
            assert values.mean() == pytest.approx(limit / 2, rel=0.25)


def test_a_perfect_calibration_takes_the_constant_errors_away() -> None:
    constant = dataclasses.replace(
        Errors(),
        gyr_bias_dps=5.0,
        gyr_scale_percent=3.0,
        gyr_cross_percent=2.0,
        acc_bias_mg=60.0,
        acc_bias_z_mg=80.0,
        acc_scale_percent=3.0,
        acc_cross_percent=2.0,
        mag_hard_ut=30.0,
        mag_soft_percent=10.0,
    )
    board, ideal = VirtualBoard("free", 100.0, constant, 3), VirtualBoard("free", 100.0, seed=3)
    raw, true = board.rows(1000), ideal.rows(1000)
    corrected = Correction(**board.perfect_correction()).apply(raw)
    for name in VECTORS:
        assert np.abs(raw[name] - true[name]).max() > 0.01
        assert np.abs(corrected[name] - true[name]).max() < 1e-10


@pytest.mark.parametrize(
    ("rate_hz", "mag_hz", "lengths"), [(138.6, 8.0, {17, 18}), (200.0, 100.0, {2}), (100.0, 8.0, {12, 13})]
)
def test_the_magnetometer_is_held_between_its_measurements(rate_hz: float, mag_hz: float, lengths: set[int]) -> None:
    board = VirtualBoard("turns", rate_hz, dataclasses.replace(PRESETS["mpu9250"], mag_rate_hz=mag_hz, mag_lsb_ut=0.0))
    rows = board.rows(round(60 * rate_hz))
    assert set(runs(rows["mag"]).tolist()) == lengths
    assert len(runs(rows["mag"])) + 1 == pytest.approx(60 * mag_hz, abs=1)


def test_a_new_measurement_belongs_to_the_row_that_brings_it() -> None:
    board = VirtualBoard("free", 138.6, Errors(mag_rate_hz=8.0))
    rows = board.rows(2000)
    new = np.flatnonzero(np.r_[True, (rows["mag"][1:] != rows["mag"][:-1]).any(axis=1)])
    field = quaternion.rotate(board.truth[new], rows["mag"][new])
    assert np.abs(field - board.field.vector()).max() < 1e-10


def test_linear_acceleration_reaches_the_accelerometer_only_when_asked() -> None:
    off, on = (VirtualBoard("driving", 100.0, Errors(linear_acceleration=asked), 2) for asked in (False, True))
    still, moving = off.rows(1000)["acc"], on.rows(1000)["acc"]
    felt = quaternion.rotate(on.truth, moving - still)
    assert np.abs(felt - on.path.acceleration(np.arange(1000) / 100)).max() < 1e-9
    assert np.linalg.norm(felt[500:], axis=1).min() > 1.7
    assert not felt[:150].any()


def test_a_magnet_passes_by() -> None:
    errors = Errors(magnet_ut=60.0, magnet_at_s=4.0, magnet_lasts_s=2.0)
    board = VirtualBoard("rest", 100.0, errors)
    field = quaternion.rotate(board.path.quats(np.arange(1000) / 100), board.rows(1000)["mag"]) - board.field.vector()
    strength = np.linalg.norm(field, axis=1)
    assert strength[:400].max() < 1e-9
    assert strength[600:].max() < 1e-9
    assert strength.max() == pytest.approx(60.0, rel=1e-6)
    assert strength.argmax() == 500


def test_the_board_warms_up_and_its_gyroscope_drifts_with_it() -> None:
    board = VirtualBoard("rest", 10.0, Errors(warm_up_c=10.0, gyr_warm_dps=0.5), 1)
    rows = board.rows(12_000)
    assert rows["temp_c"][0] == 25.0
    assert rows["temp_c"][1200] == pytest.approx(25 + 10 * (1 - np.exp(-1)), abs=1e-9)
    slope = rows["gyr"][1:] / (rows["temp_c"][1:, None] - 25)
    assert slope == pytest.approx(np.tile(slope[0], (len(slope), 1)), abs=1e-9)
    assert 0.01 < np.abs(slope[0]).max() / DEGREE <= 0.5


@pytest.mark.parametrize("rate_hz", [10.0, 138.6, 250.0])
def test_a_car_sends_ten_fixes_a_second(rate_hz: float) -> None:
    board = VirtualBoard("driving", rate_hz)
    rows = board.rows(round(20 * rate_hz))
    fixes = rows[~np.isnan(rows["lat"])]
    assert len(fixes) == pytest.approx(200, abs=1)
    assert np.diff(fixes["t"]) == pytest.approx(0.1, abs=1.001 / rate_hz)
    for name in ("lon", "alt", "speed", "course_deg"):
        assert np.array_equal(np.isnan(rows[name]), np.isnan(rows["lat"]))
    moving = fixes[50:]
    north, east = np.gradient(moving["lat"] * 111_320), np.gradient(moving["lon"] * 111_320 * np.cos(50.8162 * DEGREE))
    off_course = (moving["course_deg"] - np.degrees(np.arctan2(east, north)) + 180) % 360 - 180
    assert np.abs(off_course[1:-1]).max() < 5.0


@pytest.mark.parametrize(("motion", "rate_hz"), [("flying", 100.0), ("rest", 0.0), ("rest", float("nan"))])
def test_an_impossible_board_is_refused_in_words(motion: str, rate_hz: float) -> None:
    with pytest.raises(ValueError, match=r"unknown motion 'flying'; there are hand, rest|rate is 1 to 8000 Hz"):
        VirtualBoard(motion, rate_hz)


@pytest.mark.parametrize("name", PRESETS)
def test_presets_lie_within_their_own_ranges(name: str) -> None:
    read, problems = fields.from_mapping(Errors, dataclasses.asdict(PRESETS[name]))
    assert problems == []
    assert read == PRESETS[name]
