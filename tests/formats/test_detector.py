"""Finding a format: a verdict in words for every kind of stream, and no row lost on the way."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from imugui.formats import FORMATS, STREAM_FORMATS, Options
from imugui.formats.detector import ENOUGH, Detector, detect_file
from imugui.samples import GRAVITY, SAMPLE, Rows, empty_rows

NAMES = STREAM_FORMATS


def turning_rows(n: int) -> Rows:
    rows = empty_rows(SAMPLE, n)
    rows["t"] = np.arange(n) / 100
    rows["acc"], rows["mag"], rows["temp_c"] = (0.0, 0.1, GRAVITY), (20.0, 5.0, -40.0), 25.0
    rows["gyr"] = np.sin(np.arange(3 * n)).reshape(n, 3)
    return rows


def stream(name: str, n: int) -> bytes:
    encoder = FORMATS[name].encoder()
    return encoder.preamble() + encoder.encode(turning_rows(n))


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("size", [1, 50, 100_000])
def test_every_format_is_found_and_no_row_is_lost(name: str, size: int) -> None:
    data = stream(name, 20)
    detector = Detector()
    for k, start in enumerate(range(0, len(data), size)):
        detector.feed(data[start : start + size], k * 0.01)
    assert detector.verdict.kind == "format"
    assert detector.verdict.format == name
    decoder, rows = detector.take()
    assert len(rows) == 20
    assert (np.diff(rows["t_arrival"]) >= 0).all()
    if size == 50:
        assert len(set(rows["t_arrival"])) > 10  # each with the arrival of its own chunk
    assert len(detector.take()[1]) == 0
    assert decoder.counts.samples == 20
    assert len(decoder.feed(FORMATS[name].encoder().encode(turning_rows(2)), 9.0)) == 2


@pytest.mark.parametrize("name", NAMES)
def test_a_few_messages_are_enough_and_fewer_are_not(name: str) -> None:
    encoder = FORMATS[name].encoder()
    detector = Detector()
    detector.feed(encoder.preamble() + encoder.encode(turning_rows(ENOUGH - 1)), 0.0)
    assert detector.verdict.format == ""
    with pytest.raises(LookupError):
        detector.take()
    detector.feed(encoder.encode(turning_rows(1)), 0.1)
    assert detector.verdict.format == name
    assert len(detector.take()[1]) == ENOUGH


def test_the_sentence_says_what_was_seen() -> None:
    detector = Detector()
    detector.feed(b"", 0.0)
    detector.feed(stream("accel-lines", 37), 1.0)
    detector.feed(b"GYRO 1 2\r\n", 2.2)
    sentence = detector.verdict.sentence
    assert sentence.startswith("accel-lines: 37 messages in 1.2 s, 3 other lines, 1 bad message, the last 'malformed")
    assert sentence.endswith("(g, deg/s, uT; MPU-9250: magnetometer axes turned)")


def test_a_cut_beginning_is_forgiven_in_mid_stream() -> None:
    detector = Detector(mid_stream=True)
    detector.feed(stream("triplets", 6)[-250:], 0.0)
    decoder, rows = detector.take()
    assert len(rows) >= 3
    assert decoder.counts.bad_messages == 0


def test_noise_among_good_lines_does_not_hide_the_format() -> None:
    detector = Detector()
    lines = stream("triplets", 30).split(b"\r\n")
    for k in range(2, 30, 3):
        lines[k] = b"\xfe\x12" + lines[k][5:]
    detector.feed(b"\r\n".join(lines), 0.0)
    assert detector.verdict.format == "triplets"


def test_mostly_bad_lines_are_no_format() -> None:
    detector = Detector()
    detector.feed(b"1,2,3;4,5\r\n" * 10 + stream("triplets", 5), 0.0)
    assert detector.conclude().format == ""
    assert "5 good messages but more bad ones" in detector.verdict.sentence


@pytest.mark.parametrize(
    ("data", "kind", "words"),
    [
        (b"", "silent", "silent: no byte in 2.0 s"),
        (bytes(range(128, 256)) * 20, "garbage", "2,560 bytes, none of them a line of text"),
        (b"\x00" * 10, "garbage", "10 bytes, none of them"),
        (b"\xaa\x0a" * 500, "garbage", "1,000 bytes, none of them"),
        (b"x" * 3000, "garbage", "3,000 bytes, none of them"),
        (b"Yaw, Pitch, Roll: ready\r\nhello\r\n", "text", "lines of text but no known message, such as 'Yaw, Pitch"),
        (
            b"RESET\r\n\r\ndevice error\r\n",
            "text",
            "the board says 'device error': the board did not find its MPU-9250",
        ),
        (b"1 -22.39 -22.19 -51.93\n" * 9, "text", "lines of numbers in no known format, such as '1 -22.39"),
        (b"t,ax,ay,az\r\n0,0,0,9.8\r\n", "text", "no column for gx, gy, gz"),
    ],
)
def test_what_is_no_format_is_said(data: bytes, kind: str, words: str) -> None:
    detector = Detector()
    detector.feed(b"", 0.0)
    detector.feed(data, 1.0)
    detector.feed(b"", 2.0)
    verdict = detector.conclude()
    assert (verdict.kind, verdict.format) == (kind, "")
    assert words in verdict.sentence


@pytest.mark.parametrize("is_port", [True, False])
def test_only_a_port_has_a_baud_rate_to_doubt(is_port: bool) -> None:
    detector = Detector(mid_stream=is_port)
    detector.feed(b"\xaa" * 100, 0.0)
    assert ("baud" in detector.verdict.sentence) == is_port


def test_messages_that_cannot_be_true_are_a_verdict_of_their_own() -> None:
    detector = Detector()
    detector.feed(b"GO\r\n" + b"0.00,0.00,0.00;0.00,0.00,0.00;0.00,0.00,0.00;\r\n" * 40, 0.0)
    assert detector.verdict.format == ""
    verdict = detector.conclude()
    assert (verdict.kind, verdict.format) == ("impossible", "triplets")
    assert "all zero, the sensor does not answer" in verdict.sentence
    decoder, rows = detector.take()
    assert len(rows) == 0
    assert decoder.counts.impossible == 40


def test_a_board_that_recovers_is_no_longer_impossible() -> None:
    detector = Detector()
    detector.feed(b"0.00,0.00,0.00;0.00,0.00,0.00;0.00,0.00,0.00;\r\n" * 40, 0.0)
    detector.conclude()
    detector.feed(stream("triplets", 5), 1.0)
    assert detector.verdict.kind == "format"
    assert len(detector.take()[1]) == 5


def test_only_the_formats_asked_for_are_looked_for() -> None:
    detector = Detector(formats=("triplets",))
    detector.feed(stream("accel-lines", 10), 0.0)
    assert detector.conclude().format == ""
    assert detector.log_entries()


def test_what_the_user_named_is_used() -> None:
    columns = ("ax_g", "ay_g", "az_g", "gx_dps", "gy_dps", "gz_dps")
    detector = Detector(Options(columns=columns))
    detector.feed(b"0.1 0.2 1.0 3 4 5\r\n" * 5, 0.0)
    assert detector.verdict.format == "csv-line"


@pytest.mark.parametrize("name", NAMES)
def test_small_and_large_files(name: str, tmp_path: Path) -> None:
    small, large = tmp_path / "small", tmp_path / "large"
    small.write_bytes(stream(name, 1).rstrip())
    large.write_bytes(stream(name, 3000))
    assert detect_file(small).format == name
    assert detect_file(large).format == name


def test_an_empty_file_and_a_missing_one(tmp_path: Path) -> None:
    (tmp_path / "empty").write_bytes(b"")
    assert detect_file(tmp_path / "empty").kind == "silent"
    with pytest.raises(OSError, match="missing"):
        detect_file(tmp_path / "missing")


@pytest.mark.parametrize(
    ("file", "kind", "name"),
    [
        ("boards/triplets-car-run1.txt", "format", "triplets"),
        ("boards/triplets-car-run3.txt", "format", "triplets"),
        ("boards/xio-known-turns.csv", "format", "csv-line"),
        ("boards/triplets-startup1-moving.csv", "format", "csv-line"),
        ("boards/lines-magnetometer-raw-and-calibrated.txt", "text", ""),
        ("boards/lines-magnetometer-unique.csv", "text", ""),
        ("boards/README.md", "text", ""),
        ("calibration/mpu6050_multiposition.csv", "impossible", "csv-line"),
        ("calibration/mpu6050_hmc5883l_full_sphere_mag.csv", "text", ""),
        ("gnss/drive_gga_1hz.nmea", "text", ""),
        ("gnss/vn100_circles_raw.vnymr", "text", ""),
        ("broad/07_undisturbed_fast_rotation_B.npz", "garbage", ""),
    ],
)
def test_recorded_files(data_dir: Path, file: str, kind: str, name: str) -> None:
    found = detect_file(data_dir / file)
    assert (found.kind, found.format) == (kind, name)
    assert len(found.sentence) > 20
