"""How files are opened: by a format, as a table, after a question, or not at all and why."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

from imugui.formats import Options
from imugui.formats.layout import TableError
from imugui.formats.plan import plan_file, read_foreign
from imugui.recording import UnreadableError, read_samples
from imugui.samples import GRAVITY

SAMPLES = Path(__file__).resolve().parent.parent / "data"
OWN = "t,ax,ay,az,gx,gy,gz,mx,my,mz,temp_c,status\n" + "0.1,0,0,9.8,5,5,5,,,,,\n" * 20


@pytest.mark.parametrize(
    ("file", "found", "asks"),
    [
        ("boards/triplets-car-run1.txt", "triplets", False),
        ("boards/triplets-car-run3.txt", "triplets", False),
        ("boards/xio-known-turns.csv", "csv-line", False),
        ("boards/triplets-startup1-moving.csv", "", True),
        ("boards/triplets-startup3-quiet.csv", "", True),
        ("boards/lines-magnetometer-raw-and-calibrated.txt", "", True),
        ("boards/lines-magnetometer-unique.csv", "", False),
        ("gnss/car_50hz_gnss10hz.csv", "", False),
        ("calibration/mpu6050_multiposition.csv", "", True),
        ("gnss/vn100_circles_raw.vnymr", "", True),
    ],
)
def test_a_question_is_asked_only_where_it_is_needed(data_dir: Path, file: str, found: str, asks: bool) -> None:
    plan = plan_file(data_dir / file)
    assert (plan.format, plan.needs_asking) == (found, asks)


def test_every_file_of_the_boards_opens(data_dir: Path) -> None:
    files = [file for file in (data_dir / "boards").iterdir() if file.suffix in (".csv", ".txt")]
    assert len(files) == 7
    assert all(len(read_samples(file).rows) > 100 for file in files)


def test_our_own_table_needs_no_guess(tmp_path: Path) -> None:
    path = tmp_path / "own.csv"
    path.write_text(OWN)
    assert plan_file(path).format == "csv-line"
    assert plan_file(path).guess is None


def test_what_is_assumed_is_said() -> None:
    read = read_foreign(SAMPLES / "x-imu3/Inertial.csv", Options())
    assert not isinstance(read, str)
    assert "assumed: magnetometer in uT*50 (arbitrary units" in read[1].seen
    assert read[1].counts.samples == len(read[0]) == 200


def test_columns_that_a_person_names_win(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text("ax,ay,az,gx,gy,gz\n" + "0,0,1,0,0,90\n" * 20)
    rows = read_samples(path, options=Options(columns=("ax_g", "ay_g", "az_g", "gx_dps", "gy_dps", "gz_dps"))).rows
    assert rows["acc"][0, 2] == pytest.approx(GRAVITY)
    assert rows["gyr"][0, 2] == pytest.approx(np.pi / 2)
    with pytest.raises(UnreadableError, match="2 columns are named, the file has 6"):
        read_samples(path, options=Options(columns=("ax", "ay")))
    with pytest.raises(UnreadableError, match="no column for az"):
        read_samples(path, options=Options(columns=("ax", "ay", "-", "gx", "gy", "gz")))


def test_a_folder_of_tables_is_one_recording() -> None:
    rows = read_samples(SAMPLES / "phyphox").rows
    assert len(rows) == 200
    assert np.isfinite(rows["acc"]).all()


@pytest.mark.parametrize(
    ("data", "said"),
    [
        (b"", "the file is empty"),
        (bytes(range(256)) * 300, "binary data"),
        (b"PK\x03\x04" + b"x" * 5000, "ZIP archive"),
        (b"hello\nworld\n", "no known message"),
        (b"t,ax\n", "no known message"),
        (b"time,humidity,lux\n1,2,3\n2,3,4\n3,4,5\n", "humidity, lux: name the columns"),
        (b"t_s,ax_g,ay_g\n" + b"1,2,3\n" * 50, "name the columns"),
        (b"1" * 70_000, "no lines of numbers"),
    ],
)
def test_what_cannot_be_opened_is_said_in_one_line(tmp_path: Path, data: bytes, said: str) -> None:
    path = tmp_path / "odd.csv"
    path.write_bytes(data)
    with pytest.raises(UnreadableError) as error:
        read_samples(path)
    assert said in str(error.value)
    assert str(path) in str(error.value)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("start", [b"", OWN.replace("mx", "magx").encode()])
def test_two_gigabytes_of_nothing_are_refused(tmp_path: Path, start: bytes) -> None:
    path = tmp_path / "huge.csv"
    path.write_bytes(start * (1 + 65536 // max(1, len(start))))
    os.truncate(path, 2 << 30)
    with pytest.raises(TableError, match=r"million rows|binary data"):
        plan_file(path)


def test_a_cut_file_gives_what_it_has(tmp_path: Path) -> None:
    data = (SAMPLES / "matlab-writetable.csv").read_bytes()
    path = tmp_path / "cut.csv"
    path.write_bytes(data[: len(data) // 2 + 7])
    capture = read_samples(path)
    assert 95 < len(capture.rows) < 105
    assert capture.decoder.counts.bad_messages <= 1


def test_a_folder_without_tables_is_said(tmp_path: Path) -> None:
    with pytest.raises(TableError, match="none of the files"):
        plan_file(tmp_path)
