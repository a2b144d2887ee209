"""Guessing tables of other programs: every sample file and recording opens in the right units, or says why not."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from imugui.formats.guess import Guess, belonging_files, guess, guess_files
from imugui.formats.layout import TableError, read_layout
from imugui.formats.sheet import Sheet
from imugui.formats.table import read_table
from imugui.formats.units import LIKELY, SURE, UNSURE
from imugui.samples import GRAVITY, Rows
from imugui.simulation.board import VirtualBoard

SAMPLES = Path(__file__).resolve().parent.parent / "data"
AXES = "xyz"


def opened(path: Path) -> tuple[Guess, Rows]:
    found = guess_files(belonging_files(path))
    assert found.problem == ""
    return found, read_table(path, found.maps)[0]


def guessed(text: str, file: str = "") -> Guess:
    return guess([Sheet(file, read_layout(text.encode(), whole=True))])


def names(found: Guess) -> list[str]:
    return [column.name for column in found.tables[0].columns]


def moving(acc_scale: float, gyr_scale: float, header: str, digits: int = 6, start: float = 1.5) -> str:
    """A table of a board that is turned to all sides, 100 rows a second, with scaled values."""
    rows = VirtualBoard("free", 100.0, seed=4).rows(600)[int(start * 100) :]
    values = np.column_stack([rows["t"], rows["acc"] * acc_scale, rows["gyr"] * gyr_scale])
    return header + "\n" + "\n".join(",".join(f"{value:.{digits}f}" for value in row) for row in values) + "\n"


SEVEN = "t,ax,ay,az,gx,gy,gz"


# tables of other programs


@pytest.mark.parametrize(
    ("file", "level"),
    [
        ("x-imu3/Inertial.csv", LIKELY),
        ("x-imu3/Magnetometer.csv", LIKELY),
        ("phyphox/Accelerometer.csv", SURE),
        ("phyphox/Gyroscope.csv", SURE),
        ("phyphox-semicolon/Gyroscope.csv", SURE),
        ("phyphox-tab/Magnetometer.csv", SURE),
        ("phyphox", SURE),
        ("sensor-logger-android/Accelerometer.csv", LIKELY),
        ("sensor-logger-android/TotalAcceleration.csv", LIKELY),
        ("sensor-logger-iphone/Gyroscope.csv", LIKELY),
        ("sensor-logger-combined.csv", LIKELY),
        ("matlab-writetable.csv", SURE),
        ("matlab-writetimetable.csv", LIKELY),
    ],
)
def test_tables_of_other_programs_open_in_si(file: str, level: str) -> None:
    """All were written from the same motion of the virtual board (tests/data/make_tables.py)."""
    found, rows = opened(SAMPLES / file)
    assert found.level == level
    assert len(rows) == 200
    assert np.median(np.linalg.norm(rows["acc"], axis=1)) == pytest.approx(GRAVITY, rel=0.01)
    assert rows["acc"][:20, 2] == pytest.approx(GRAVITY, rel=0.02)  # it lies face up at first, on an iPhone too
    assert np.abs(rows["gyr"]).max() == pytest.approx(2.708, abs=0.001)
    assert np.diff(rows["t"]) == pytest.approx(0.02, abs=1e-6)
    if "timetable" not in file:
        field = np.linalg.norm(rows["mag"], axis=1)
        assert np.nanmedian(field) == pytest.approx(48.5, rel=0.05)


def test_a_table_without_a_field_has_none() -> None:
    assert np.isnan(opened(SAMPLES / "matlab-writetimetable.csv")[1]["mag"]).all()


def test_arbitrary_units_of_a_field_are_said() -> None:
    assert "arbitrary units" in guess_files(belonging_files(SAMPLES / "x-imu3/Inertial.csv")).assumed


def test_an_iphone_without_whole_acceleration_gives_the_sum_of_its_parts_with_the_sign_turned(tmp_path: Path) -> None:
    for name in ("Accelerometer", "Gravity", "Gyroscope", "Magnetometer"):
        (tmp_path / f"{name}.csv").write_bytes((SAMPLES / f"sensor-logger-iphone/{name}.csv").read_bytes())
    found, rows = opened(tmp_path / "Gyroscope.csv")
    assert found.level == UNSURE
    assert "iPhone reverses the sign" in found.assumed
    whole = opened(SAMPLES / "sensor-logger-android/Gyroscope.csv")[1]
    assert rows["acc"] == pytest.approx(whole["acc"], abs=1e-6)
    assert rows["gyr"] == pytest.approx(whole["gyr"], abs=1e-6)


def test_acceleration_without_gravity_is_refused_in_words(tmp_path: Path) -> None:
    for name in ("Accelerometer", "Gyroscope"):
        (tmp_path / f"{name}.csv").write_bytes((SAMPLES / f"sensor-logger-android/{name}.csv").read_bytes())
    found = guess_files(belonging_files(tmp_path / "Gyroscope.csv"))
    assert "without gravity" in found.problem
    assert "record the accelerometer with gravity" in found.problem


def test_files_of_another_recording_do_not_belong(tmp_path: Path) -> None:
    for name in ("Gyroscope.csv", "run2 Accelerometer.csv", "Gyroscope.md", "notes.csv"):
        (tmp_path / name).write_bytes((SAMPLES / "phyphox/Gyroscope.csv").read_bytes())
    assert belonging_files(tmp_path / "Gyroscope.csv") == [tmp_path / "Gyroscope.csv"]
    late = (SAMPLES / "x-imu3/Magnetometer.csv").read_text().replace("\n5", "\n99995").replace("\n6", "\n99996")
    (tmp_path / "Magnetometer.csv").write_text(late)
    (tmp_path / "Inertial.csv").write_bytes((SAMPLES / "x-imu3/Inertial.csv").read_bytes())
    assert {table.file for table in guess_files(belonging_files(tmp_path / "Inertial.csv")).used} == {"Inertial.csv"}


# real recordings


@pytest.mark.parametrize(
    ("file", "acc", "field", "rate_hz"),
    [
        ("boards/xio-known-turns.csv", GRAVITY, 49.0, 256.0),
        ("boards/triplets-startup1-moving.csv", GRAVITY, None, None),
        ("boards/triplets-startup3-quiet.csv", GRAVITY, None, None),
        ("boards/lines-magnetometer-unique.csv", None, 76.4, 8.0),
        ("boards/lines-magnetometer-raw-and-calibrated.txt", None, 76.4, None),
        ("calibration/broad11_slow_translation_30s.csv", GRAVITY, 44.4, 95.24),
        ("calibration/mpu6050_hmc5883l_full_sphere_imu.csv", GRAVITY, 59.1, 476.2),
        ("calibration/mpu6050_multiposition.csv", GRAVITY, None, 100.0),
        ("gnss/car_50hz_gnss10hz.csv", GRAVITY, None, 50.32),
        ("gnss/vn100_circles_imu.csv", GRAVITY, 47.6, 40.76),
    ],
)
def test_recordings_open_in_si(
    data_dir: Path, file: str, acc: float | None, field: float | None, rate_hz: float | None
) -> None:
    found, rows = opened(data_dir / file)
    for name, expected, tolerance in (("acc", acc, 0.1), ("mag", field, 0.02)):
        if expected is None:
            assert np.isnan(rows[name]).all()
        else:
            assert np.nanmedian(np.linalg.norm(rows[name], axis=1)) == pytest.approx(expected, rel=tolerance)
    if rate_hz is not None:
        assert 1.0 / np.median(np.diff(rows["t"])) == pytest.approx(rate_hz, rel=0.01)
    else:
        assert "no times" in found.assumed
        assert found.level == UNSURE


def test_one_kind_of_interleaved_lines_is_kept(data_dir: Path) -> None:
    found, rows = opened(data_dir / "boards/lines-magnetometer-raw-and-calibrated.txt")
    assert found.tables[0].keep == (0, 1.0)
    assert len(rows) == 19246
    assert (np.diff(rows["mag"], axis=0) != 0.0).any(axis=1).sum() + 1 == 1111  # repeats stay bit for bit


def test_positions_and_their_units(data_dir: Path) -> None:
    found, rows = opened(data_dir / "gnss/car_50hz_gnss10hz.csv")
    named = {column.slot: column.unit for column in found.tables[0].columns}
    assert named["speed"] == "km/h"  # not written in the file: it agrees with the positions
    assert named["gx"] == "deg/s"
    assert rows["speed"].max() == pytest.approx(14.0, abs=3.0)
    assert rows["lat"][0] == pytest.approx(51.0396, abs=1e-3)
    assert rows["t"][0] == pytest.approx(1395837505.119)


def test_a_file_without_any_scale_is_unsure_and_says_so(data_dir: Path) -> None:
    found = guess_files([data_dir / "calibration/xsens_multiposition.csv"])
    assert found.level == UNSURE
    assert "raw counts whose scale or zero is not known" in found.assumed


@pytest.mark.parametrize("file", ["gnss/drive_gga_1hz.nmea", "gnss/vn100_circles_raw.vnymr"])
def test_sentences_of_a_protocol_are_not_guessed(data_dir: Path, file: str) -> None:
    assert "no line with names" in guess_files([data_dir / file]).problem


# units


@pytest.mark.parametrize(
    ("scale", "digits", "unit"),
    [(1.0, 4, "m/s2"), (1 / GRAVITY, 5, "g"), (16384 / GRAVITY, 0, "g/16384"), (4096 / GRAVITY, 0, "g/4096")],
)
def test_the_unit_of_acceleration_from_gravity(scale: float, digits: int, unit: str) -> None:
    found = guessed(moving(scale, 1.0, SEVEN, digits))
    assert found.tables[0].columns[1].unit == unit
    assert "gravity reads" in found.tables[0].columns[1].reason


@pytest.mark.parametrize(
    ("scale", "digits", "unit"),
    [
        (1.0, 5, "rad/s"),
        (np.degrees(1.0), 4, "deg/s"),
        (np.degrees(131.0), 0, "dps/131"),
        (np.degrees(32.8), 0, "dps/32.8"),
    ],
)
def test_the_unit_of_the_gyroscope_from_how_gravity_turns(scale: float, digits: int, unit: str) -> None:
    column = guessed(moving(1.0, scale, SEVEN, digits)).tables[0].columns[4]
    assert (column.unit, column.level) == (unit, SURE)
    assert "agrees with how gravity turns" in column.reason


def test_a_written_unit_that_the_numbers_contradict_is_unsure() -> None:
    column = guessed(moving(1.0, 1.0, "t_s,ax_g,ay_g,az_g,gx_rads,gy_rads,gz_rads")).tables[0].columns[1]
    assert (column.unit, column.level) == ("m/s2", UNSURE)
    assert "named g" in column.reason
    column = guessed(moving(1.0, 1.0, "t_s,ax,ay,az,gx_dps,gy_dps,gz_dps")).tables[0].columns[4]
    assert column.level == UNSURE
    assert "gravity turns as if it were rad/s" in column.reason


def test_at_rest_the_size_of_the_noise_tells_the_unit() -> None:
    def still(gyr: float) -> str:
        lines = (f"{k / 100},0.0{k % 2},0,9.81,{gyr},0.0{k % 3},0" for k in range(200))
        return SEVEN + "\n" + "\n".join(lines) + "\n"

    assert guessed(still(1.5)).tables[0].columns[4].unit == "deg/s"
    assert guessed(still(0.003)).tables[0].columns[4].unit == "rad/s"
    assert guessed(still(0.003)).level == LIKELY


@pytest.mark.parametrize(
    ("scale", "unit"), [(1.0, "uT"), (0.01, "G"), (10.0, "mG"), (1e-3, "mT"), (1e-6, "T"), (1000.0, "nT")]
)
def test_the_unit_of_a_field_from_the_earths(scale: float, unit: str) -> None:
    lines = [f"{k / 10},{20.5 * scale:.9g},{-3.25 * scale:.9g},{(-40.1 - k / 100) * scale:.9g}" for k in range(40)]
    found = guessed("t_s,mx,my,mz\n" + "\n".join(lines) + "\n")
    assert found.tables[0].columns[1].unit == unit
    assert found.problem == ""


# time


@pytest.mark.parametrize(
    ("step", "start", "unit"),
    [
        (0.01, 0.0, "s"), (10, 500, "ms"), (10_000, 0, "us"), (10_000_000, 0, "ns"),
        (0.02, 1.7e9, "s"), (20, 1.7e12, "ms"), (20_000_000, 1.7e18, "ns"),
    ],
)  # fmt: skip
def test_the_unit_of_time_from_its_spacing(step: float, start: float, unit: str) -> None:
    lines = [f"{start + k * step:.15g},{20 + k % 2},-3,-40" for k in range(100)]
    column = guessed("time,mx_uT,my_uT,mz_uT\n" + "\n".join(lines) + "\n").tables[0].columns[0]
    assert (column.slot, column.unit) == ("t", unit)


def test_a_counter_is_no_time_and_a_rate_in_the_file_is_used() -> None:
    body = "\n".join(f"{k},0,0,1,0,0,{k % 2}" for k in range(60)) + "\n"
    found = guessed("# Fs=104 Hz\nn,ax_g,ay_g,az_g,gx_dps,gy_dps,gz_dps\n" + body)
    assert names(found)[0] == "-"
    assert (found.tables[0].rate_hz, found.tables[0].rate.level) == (104.0, SURE)


def test_a_rate_can_be_told_from_turning() -> None:
    lines = moving(1.0, 1.0, SEVEN, start=0.0).splitlines()
    text = "\n".join(line.partition(",")[2] for line in lines) + "\n"
    found = guessed(text.replace("gx,gy,gz", "gx_rads,gy_rads,gz_rads"))
    assert found.tables[0].rate_hz == pytest.approx(100.0, rel=0.1)
    assert found.tables[0].rate.level == UNSURE


def test_of_two_times_the_better_one_is_taken() -> None:
    lines = [f"{1_700_000_000_000_000_000 + k * 10_000_000},{k / 100},{20 + k % 2},-3,-40" for k in range(60)]
    found = guessed("time,seconds_elapsed,z,y,x\n" + "\n".join(lines) + "\n", "Magnetometer.csv")
    assert names(found) == ["-", "t_s", "mz_uT", "my_uT", "mx_uT"]


# without names


def test_bare_numbers_are_guessed_but_never_sure() -> None:
    found = guessed(moving(1 / GRAVITY, np.degrees(1.0), SEVEN).partition("\n")[2])
    assert names(found) == ["t_s", "ax_g", "ay_g", "az_g", "gx_deg/s", "gy_deg/s", "gz_deg/s"]
    assert found.level == UNSURE
    assert all("no header line" in column.reason for column in found.tables[0].columns)


def test_what_has_no_place_is_named() -> None:
    found = guessed("humidity,pressure,lux\n1,2,3.5\n2,3,4.5\n3,4,5.5\n")
    assert "humidity, pressure, lux" in found.problem


@given(st.lists(st.lists(st.floats(width=32), min_size=4, max_size=4), min_size=2, max_size=30), st.booleans())
@example([[0.0, 0.0, 1.0, 0.0], [0.0, 0.0, float("inf"), 0.0]], False)
def test_no_numbers_raise(rows: list[list[float]], named: bool) -> None:
    text = "t,ax,ay,az\n" * named + "\n".join(",".join(f"{value:g}" for value in row) for row in rows) + "\n"
    try:
        found = guessed(text)
    except TableError:
        return
    assert all(column.reason for column in found.tables[0].columns)
