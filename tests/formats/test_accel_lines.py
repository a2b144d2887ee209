"""accel-lines: the screw assistant's four lines, the FaBo example, and messages with lines lost."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from imugui.formats import FORMATS, Options
from imugui.formats.accel_lines import AccelLinesDecoder
from imugui.samples import GRAVITY, SAMPLE, Rows, empty_rows

ACCEL, GYRO, MAG, TEMP = b"ACCEL 0.01 -0.02 1.00", b"GYRO 1.50 -0.25 90.00", b"MAG -22.39 -22.19 -51.93", b"TEMP 25.31"
MESSAGE = [ACCEL, GYRO, MAG, TEMP]


def read(*lines: bytes, options: Options | None = None, end: bytes = b"\r\n") -> tuple[AccelLinesDecoder, Rows]:
    decoder = AccelLinesDecoder(options or Options())
    rows = [decoder.feed(b"".join(line + end for line in lines), 0.0), decoder.flush(0.0)]
    return decoder, np.concatenate(rows)


@pytest.mark.parametrize("end", [b"\r\n", b"\n", b"\r\r\n"])
def test_values_arrive_in_si_and_in_the_accelerometers_axes(end: bytes) -> None:
    _, (row,) = read(*MESSAGE, end=end)
    assert row["acc"] == pytest.approx(np.array((0.01, -0.02, 1.0)) * GRAVITY)
    assert row["gyr"] == pytest.approx(np.radians((1.5, -0.25, 90.0)))
    assert row["mag"] == pytest.approx((-22.19, -22.39, 51.93))  # (my, mx, -mz)
    assert row["temp_c"] == 25.31
    assert row["status"] == -1


def test_a_message_is_complete_at_temp() -> None:
    decoder = AccelLinesDecoder(Options())
    given = [len(decoder.feed(line + b"\r\n", float(k))) for k, line in enumerate(MESSAGE)]
    assert given == [0, 0, 0, 1]


def test_a_message_without_temp_is_complete_at_the_next_one() -> None:
    decoder, rows = read(ACCEL, GYRO, MAG, *MESSAGE)
    assert len(rows) == 2
    assert np.isnan(rows["temp_c"][0])
    assert decoder.counts.bad_messages == 0


def test_the_last_message_of_a_file_needs_no_temp() -> None:
    decoder, rows = read(*MESSAGE, ACCEL, GYRO, MAG)
    assert len(rows) == 2
    assert decoder.counts.bad_messages == 0


@pytest.mark.parametrize(
    "lines",
    [
        [ACCEL, MAG, TEMP],
        [GYRO, MAG, TEMP],
        [MAG, TEMP],
        [TEMP],
        [ACCEL, b"GYRO 1.50 -0.25", MAG, TEMP],
        [ACCEL, b"GYRO 1.50 -0.25 9", MAG, TEMP],  # cut
        [b"ACCEL 0.01 -0.0x2 1.00", GYRO, MAG, TEMP],
        [b"ACCEL nan -0.02 1.00", GYRO, MAG, TEMP],
        [b"ACCEL ovf -0.02 1.00", GYRO, MAG, TEMP],
        [b"AC\xfeEL 0.01 -0.02 1.00", GYRO, MAG, TEMP],
        [b"ACxEL 0.01 -0.02 1.00", GYRO, MAG, TEMP],
        [b"AC1CEL 0.01 -0.02 1.00", GYRO, MAG, TEMP],
        [b"ACCEL  -0.02 1.00", GYRO, MAG, TEMP],
        [ACCEL + GYRO, MAG, TEMP],
    ],
)
def test_a_message_without_a_good_accel_and_gyro_is_bad_once(lines: list[bytes]) -> None:
    decoder, rows = read(*MESSAGE, *lines, *MESSAGE)
    assert len(rows) == 2
    assert (decoder.counts.messages, decoder.counts.bad_messages) == (2, 1)


@pytest.mark.parametrize("mag", [b"MAG nan nan nan", b"MAG ovf -22.19 -51.93", b"MAG 0.00 0.00 0.00", None])
def test_a_message_without_a_field_still_gives_a_row(mag: bytes | None) -> None:
    decoder, rows = read(*[line for line in (ACCEL, GYRO, mag, TEMP) if line])
    assert len(rows) == 1
    assert np.isnan(rows["mag"]).all()
    assert rows["temp_c"][0] == 25.31
    assert decoder.counts.bad_messages == 0


@pytest.mark.parametrize(
    "mag", [b"MAG -22.39 -22.19", b"MAG -22.39 -22.19 -51", b"MAG 123456.00 1.00 2.00", b"MAG - 1 2"]
)
def test_a_damaged_or_impossible_field_is_counted_and_spoils_only_itself(mag: bytes) -> None:
    decoder, rows = read(ACCEL, GYRO, mag, TEMP)
    assert len(rows) == 1
    assert np.isnan(rows["mag"]).all()
    assert (decoder.counts.messages, decoder.counts.bad_messages) == (1, 1)


@pytest.mark.parametrize("temp", [b"TEMP", b"TEMP 999.00", b"TEMP 25.31 1.00", b"TEMP --"])
def test_a_damaged_or_impossible_temperature_spoils_only_itself(temp: bytes) -> None:
    decoder, rows = read(ACCEL, GYRO, MAG, temp, *MESSAGE)
    assert len(rows) == 2
    assert np.isnan(rows["temp_c"][0])
    assert rows["mag"][0] == pytest.approx((-22.19, -22.39, 51.93))
    assert decoder.counts.bad_messages == 1


def test_banner_and_other_text_are_chatter() -> None:
    decoder, rows = read(b"RESET", b"", b"configuring device.", b"configured FaBo 9Axis I2C Brick", *MESSAGE)
    assert len(rows) == 1
    assert (decoder.counts.chatter, decoder.counts.bad_messages) == (3, 0)
    assert decoder.log.entries()[-1][2] == "configured FaBo 9Axis I2C Brick"


def test_text_inside_a_message_does_not_disturb_it() -> None:
    decoder, rows = read(ACCEL, GYRO, b"warning: low battery", MAG, TEMP)
    assert len(rows) == 1
    assert np.isfinite(rows["mag"]).all()
    assert decoder.counts.chatter == 1


def test_the_fabo_example_is_read_alike() -> None:
    decoder, (row,) = read(
        b"ax: 0.01 ay: -0.02 az: 1.00",
        b"gx: 1.50 gy: -0.25 gz: 90.00",
        b"mx: -22.39 my: -22.19 mz: -51.93",
        b"temp: 25.31",
    )
    assert row.tobytes() == read(*MESSAGE)[1].tobytes()
    assert decoder.counts.bad_messages == 0
    assert read(b"ax: 0.01 az: -0.02 ay: 1.00")[0].counts.bad_messages == 1


def test_other_spacing_and_decimals_are_read() -> None:
    _, rows = read(b"ACCEL\t0.012 -0.023  1.004", b" GYRO 1 -2 90", b"MAG -2.2e1 -22.0 -51.0", b"TEMP 25")
    assert len(rows) == 1
    assert rows["mag"][0] == pytest.approx((-22.0, -22.0, 51.0))


def test_an_aligned_board_keeps_its_axes() -> None:
    _, (row,) = read(*MESSAGE, options=Options(family="aligned"))
    assert row["mag"] == pytest.approx((-22.39, -22.19, -51.93))


def test_half_a_message_before_the_port_was_opened_is_no_error() -> None:
    decoder = AccelLinesDecoder(Options())
    decoder.feed(b"\r\n".join([ACCEL, GYRO]) + b"\r\n", 0.0)
    decoder.resync()
    rows = decoder.feed(b"\r\n".join([MAG[5:], TEMP, *MESSAGE, *MESSAGE, b""]), 0.0)
    assert len(rows) == 2
    assert decoder.counts.bad_messages == 0
    assert sum(kind == "note" for _, kind, _ in decoder.log.entries()) >= 2


def test_encoder_prints_the_boards_lines() -> None:
    rows = empty_rows(SAMPLE, 2)
    rows["acc"], rows["gyr"] = (0.0, -0.02 * GRAVITY, GRAVITY), np.radians((1.5, -0.25, 90.0))
    rows["mag"][0], rows["temp_c"][0] = (-22.19, -22.39, 51.93), 25.31
    encoder = FORMATS["accel-lines"].encoder()
    assert encoder.preamble().endswith(b"configured FaBo 9Axis I2C Brick\r\n")
    assert encoder.encode(rows) == (
        b"ACCEL 0.00 -0.02 1.00\r\nGYRO 1.50 -0.25 90.00\r\nMAG -22.39 -22.19 -51.93\r\nTEMP 25.31\r\n"
        b"ACCEL 0.00 -0.02 1.00\r\nGYRO 1.50 -0.25 90.00\r\nMAG nan nan nan\r\nTEMP nan\r\n"
    )


def screw_assistant(data_dir: Path) -> bytes:
    """The board's bytes: its recorded field, with the acceleration and turn rate of a hand-held tool."""
    recorded = (data_dir / "boards/lines-magnetometer-raw-and-calibrated.txt").read_text().splitlines()
    raw = [line.split()[1:] for line in recorded if line.startswith("1 ")]
    random = np.random.default_rng(3)
    acc = random.normal((0.0, 0.0, 1.0), 0.02, (len(raw), 3))
    gyr = random.normal(0.0, 5.0, (len(raw), 3))
    line = "ACCEL %.2f %.2f %.2f\r\nGYRO %.2f %.2f %.2f\r\nMAG %.2f %.2f %.2f\r\nTEMP 25.31\r\n"
    columns = zip(acc.tolist(), gyr.tolist(), raw, strict=True)
    return "".join(line % (*a, *g, *map(float, m)) for a, g, m in columns).encode()


@pytest.mark.parametrize("chunk", [61, 65536])
def test_the_screw_assistants_field_changes_as_often_as_it_was_measured(data_dir: Path, chunk: int) -> None:
    data = screw_assistant(data_dir)
    decoder = AccelLinesDecoder(Options())
    rows = np.concatenate([decoder.feed(data[k : k + chunk], 0.0) for k in range(0, len(data), chunk)])
    assert len(rows) == 19_246
    assert decoder.counts.bad_messages == 0
    changes = 1 + int((np.diff(rows["mag"], axis=0) != 0).any(axis=1).sum())
    assert changes == 1_111
