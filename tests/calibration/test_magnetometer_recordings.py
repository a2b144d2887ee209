"""Magnetometer, alarm and axes on real recordings, with the figures of the reference's section 5."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from imugui.calibration.alarm import FieldAlarm
from imugui.calibration.alignment import fine_rotation
from imugui.calibration.axes import gyr_map, mag_map
from imugui.calibration.ellipsoid import Ellipsoid, Floats, li_griffiths, min_max, sphere
from imugui.calibration.gate import judge
from imugui.calibration.geometric import tukey
from imugui.calibration.magnetometer import MagnetometerFlow
from imugui.calibration.seeds import final_bar
from imugui.formats import FORMATS
from imugui.formats.base import Options
from imugui.fusion.quaternion import conjugate, rotate
from imugui.samples import GRAVITY, SAMPLE, Rows, empty_rows

UT_PER_COUNT = 100.0 / 1090.0  # HMC5883L, 1090 counts per gauss
BLOCKS = 5


def table(path: Path, columns: int) -> Floats:
    return np.loadtxt(path, delimiter=",", skiprows=1, usecols=range(columns))


def fresh(rows: Floats) -> Floats:
    """Rows whose last three columns are not those of the row before."""
    changed = (np.diff(rows[:, -3:], axis=0) != 0).any(axis=1)
    return rows[np.concatenate(([True], changed))]


def mag_rows(t: Floats, mag: Floats) -> Rows:
    rows = empty_rows(SAMPLE, len(t))
    rows["t"], rows["mag"] = t, mag
    return rows


def fit_of(points: Floats) -> Ellipsoid:
    fit = tukey(points)
    assert fit is not None
    return fit


@pytest.fixture(scope="module")
def full_sphere(data_dir: Path) -> tuple[Floats, Floats]:
    """Times and field (uT) of the HMC5883L, repeats dropped."""
    rows = fresh(table(data_dir / "calibration/mpu6050_hmc5883l_full_sphere_mag.csv", 4))
    return rows[:, 0], rows[:, 1:] * UT_PER_COUNT


@pytest.fixture(scope="module")
def full_sphere_imu(data_dir: Path) -> tuple[Floats, Floats, Floats]:
    """Times, rates, accelerations of the MPU-6050 on the same board."""
    rows = table(data_dir / "calibration/mpu6050_hmc5883l_full_sphere_imu.csv", 7)
    return rows[:, 0], np.radians(rows[:, 4:7] / 131.0), rows[:, 1:4] / 4096.0 * GRAVITY


@pytest.fixture(scope="module")
def broad33(data_dir: Path) -> Floats:
    """t, field (3), optical attitude (4); a magnet is on the board until 58 s."""
    rows = np.genfromtxt(data_dir / "calibration/broad33_magnet_removed.csv", delimiter=",", skip_header=1)
    return np.asarray(rows[:, [0, 7, 8, 9, 10, 11, 12, 13]])


def test_a_full_sphere(full_sphere: tuple[Floats, Floats]) -> None:
    points = full_sphere[1]
    fit = fit_of(points)
    assert fit.residual(points) <= 0.005
    assert fit.axis_ratio == pytest.approx(1.23, abs=0.01)
    assert min_max(points).residual(points) == pytest.approx(0.029, abs=0.001)
    assert sphere(points).residual(points) == pytest.approx(0.055, abs=0.001)
    assert judge(points).light == "green"


def test_a_full_sphere_on_held_out_blocks(full_sphere: tuple[Floats, Floats]) -> None:
    points = full_sphere[1]
    shares = []
    for block in np.array_split(np.arange(len(points)), BLOCKS):
        fit = fit_of(np.delete(points, block, axis=0))
        shares.append(fit.distances(points[block]) / fit.radius)
    assert np.concatenate(shares).std() <= 0.007


def test_a_full_sphere_with_outliers(full_sphere: tuple[Floats, Floats]) -> None:
    points = full_sphere[1].copy()
    rng = np.random.default_rng(0)
    wrong = rng.uniform(size=len(points)) < 0.02
    points[wrong] += rng.normal(size=(int(wrong.sum()), 3)) * 40.0
    plain = li_griffiths(points)
    assert plain is not None
    assert fit_of(points).residual(points[~wrong]) <= 0.005
    assert plain.residual(points[~wrong]) > 0.015
    assert judge(points).light == "green"


def test_the_flow_accepts_a_full_sphere(full_sphere: tuple[Floats, Floats]) -> None:
    flow = MagnetometerFlow()
    flow.feed(mag_rows(*full_sphere))
    found = flow.result()
    assert found.accepted, found.reason
    assert flow.done  # no gyroscope in these rows: no check
    assert found.verdict.residual <= 0.007


def test_a_magnet_on_the_board(broad33: Floats) -> None:
    moving = broad33[(broad33[:, 0] >= 8.0) & (broad33[:, 0] <= 48.0)]
    points = moving[:, 1:4]
    verdict = judge(points)
    assert verdict.accepted
    assert verdict.fit is not None
    assert np.linalg.norm(verdict.fit.bias - (-4.2, 0.2, 28.2)) < 2.0
    assert direction_error_deg(verdict.fit, moving) <= 2.6
    assert direction_error_deg(min_max(points), moving) > 10.0
    assert np.linalg.norm(min_max(points).bias - (-4.2, 0.2, 28.2)) > 10.0


def direction_error_deg(fit: Ellipsoid, rows: Floats) -> float:
    """Against optics, rms, after removing one constant rotation."""
    rows = rows[np.isfinite(rows).all(axis=1)]
    quat, field = rows[:, 4:], fit.apply(rows[:, 1:4])
    field /= np.linalg.norm(field, axis=1, keepdims=True)
    turn = np.eye(3)
    for _ in range(20):
        north = rotate(quat, field @ turn.T).mean(axis=0)
        seen = rotate(conjugate(quat), north / np.linalg.norm(north))
        left, _, right = np.linalg.svd(seen.T @ field)
        turn = left @ np.diag([1.0, 1.0, np.linalg.det(left @ right)]) @ right
    cosine = np.clip((field @ turn.T * seen).sum(axis=1), -1.0, 1.0)
    return float(np.degrees(np.sqrt((np.arccos(cosine) ** 2).mean())))


def test_the_alarm_sees_the_magnet_go(broad33: Floats) -> None:
    t, points = broad33[:, 0], broad33[:, 1:4]
    fit = judge(points[(t >= 8.0) & (t <= 48.0)]).fit
    assert fit is not None
    alarm = FieldAlarm(fit.radius)
    corrected = fit.apply(points)
    lights = np.array([alarm.update(t[i : i + 1], corrected[i : i + 1]) for i in range(len(t))])
    assert not (lights[(t >= 8.0) & (t <= 57.0)] == "red").any()
    red = t[(t > 57.0) & (lights == "red")]
    assert 58.1 <= red[0] <= 59.1


def test_the_magnet_going_spoils_a_calibration(broad33: Floats) -> None:
    verdict = judge(broad33[broad33[:, 0] >= 8.0, 1:4])
    assert not verdict.accepted
    assert verdict.word == "contaminated"


def test_circles_in_a_car_are_refused(data_dir: Path) -> None:
    rows = np.loadtxt(data_dir / "gnss/vn100_circles_imu.csv", delimiter=",", skiprows=1)
    mag = 1e6 * rows[:, 7:10]
    verdict = judge(fresh(mag))
    assert verdict.light == "red"
    assert "one axis only" in verdict.sentence
    flow = MagnetometerFlow()
    flow.feed(mag_rows(rows[:, 0], mag))
    assert not flow.result().accepted
    found = mag_map(rows[:, 4:7], mag)
    assert not found.accepted
    assert "Not enough data" in found.reason


def test_lying_still_is_refused(data_dir: Path) -> None:
    rows = fresh(table(data_dir / "calibration/mpu6050_hmc5883l_static_10min_mag.csv", 4))
    flow = MagnetometerFlow()
    flow.feed(mag_rows(rows[:, 0], rows[:, 1:] * UT_PER_COUNT))
    assert flow.progress == 0.0
    assert "held still" in flow.result().reason
    assert not flow.done


def test_the_screw_assistants_board(data_dir: Path) -> None:
    points = np.loadtxt(data_dir / "boards/lines-magnetometer-unique.csv", delimiter=",", skiprows=1)[:, 1:4]
    verdict = judge(points)
    assert verdict.fit is not None
    assert fit_of(points).residual(points) <= 0.042
    assert verdict.fit.residual(points) <= 0.042
    assert min_max(points).residual(points) == pytest.approx(0.067, abs=0.001)
    np.testing.assert_allclose(verdict.fit.bias, (11.17, -11.02, -59.21), atol=1.5)
    assert final_bar(points) == pytest.approx(93, abs=1)


@pytest.mark.parametrize("run", [1, 3])
def test_the_rc_cars_runs_are_refused(data_dir: Path, run: int) -> None:
    decoder = FORMATS["triplets"].decoder(Options())
    rows = decoder.feed((data_dir / f"boards/triplets-car-run{run}.txt").read_bytes(), 0.0)
    assert len(rows) > 400
    rows["t"] = 0.104 * np.arange(len(rows))
    flow = MagnetometerFlow()
    flow.feed(rows)
    found = flow.result()
    assert not found.accepted
    assert found.reason
    assert not judge(rows["mag"][np.isfinite(rows["mag"]).all(axis=1)]).accepted


def test_the_axes_of_the_full_sphere(
    full_sphere: tuple[Floats, Floats], full_sphere_imu: tuple[Floats, Floats, Floats]
) -> None:
    t_mag, mag = full_sphere
    t, gyr, acc = full_sphere_imu
    field = fit_of(mag).apply(mag)
    there = np.column_stack([np.interp(t_mag, t, column) for column in acc.T])
    compass = mag_map(there, field)
    assert compass.accepted
    assert compass.name == "+x +y +z"
    assert compass.best_deg < 3.5
    for t_seen, seen in ((t_mag, field), (t, acc)):
        found = gyr_map(t, gyr, t_seen, seen)
        assert found.name == "-x -y +z"
        assert found.accepted
        assert found.margin >= 2.0


@pytest.mark.parametrize("name", ["03_undisturbed_slow_rotation_C", "05_undisturbed_slow_rotation_with_breaks_B"])
def test_aligned_axes_stay_aligned(data_dir: Path, name: str) -> None:
    """Optics say 0.4 to 1.1 degrees."""
    with np.load(data_dir / f"broad/{name}.npz") as trial:
        part = slice(int(10 * trial["rate"]), int(60 * trial["rate"]))
        bias = trial["gyr"][: int(2 * trial["rate"])].mean(axis=0)
        gyr, acc, mag = (trial[key][part].astype(float) for key in ("gyr", "acc", "mag"))
        t = np.arange(len(gyr)) / float(trial["rate"])
    assert mag_map(acc, mag).name == "+x +y +z"
    found = fine_rotation(t, gyr - bias, t, mag, acc=acc)
    assert found.accepted, found.reason
    assert found.angle_deg <= 1.2
