"""triplets: the receiver's grammar, the recordings of the RC car, and lines that are well formed but false."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from imugui.formats import FORMATS, Options
from imugui.formats.triplets import TripletsDecoder, is_repeated_word
from imugui.samples import GRAVITY, SAMPLE, Rows, empty_rows

GOOD = b"-0.07,0.03,1.10;-1.95,11.72,-17.75;-1876.32,877.25,-7373.72"
POSITION = b"50.816223,12.929423,0;177.30,1.58,372"


def read(data: bytes, options: Options | None = None) -> tuple[TripletsDecoder, Rows]:
    decoder = TripletsDecoder(options or Options())
    return decoder, np.concatenate([decoder.feed(data, 0.0), decoder.flush(0.0)])


def payload(word: int) -> bytes:
    """The line the receiver prints when every word of the radio payload is this one."""
    acc, gyr = f"{word / 8192:.2f}", f"{word * 500 / 32768:.2f}"
    mag = ",".join(f"{word * 1.49939 * sensitivity:.2f}" for sensitivity in (1.23047, 1.22656, 1.18359))
    degrees = f"{word / 100 + word / 1e6:.6f}"
    tail = f"{degrees},{degrees},0;{word / 10:.2f},{word / 100:.2f},{word}"
    return f"{acc},{acc},{acc};{gyr},{gyr},{gyr};{mag};{tail}\r\n".encode()


def test_values_arrive_in_si_and_in_the_accelerometers_axes() -> None:
    _, (row,) = read(GOOD + b";" + POSITION + b"\r\n")
    assert row["acc"] == pytest.approx(np.array((-0.07, 0.03, 1.10)) * GRAVITY)
    assert row["gyr"] == pytest.approx(np.radians((-1.95, 11.72, -17.75)))
    assert row["mag"] == pytest.approx((87.725, -187.632, 737.372))  # (my, mx, -mz), mG / 10
    assert (row["lat"], row["lon"], row["alt"]) == (50.816223, 12.929423, 372)
    assert (row["course_deg"], row["speed"]) == (177.30, 1.58)
    assert row["status"] == -1
    assert np.isnan(row["temp_c"])


@pytest.mark.parametrize("end", [b"\r\n", b"\n", b";\r\n", b";\n", b""])
def test_imu_only_lines_with_and_without_the_last_semicolon(end: bytes) -> None:
    decoder, rows = read(GOOD + end)
    assert len(rows) == 1
    assert np.isnan(rows["lat"]).all()
    assert decoder.rate_hz == 140.0


def test_an_aligned_board_keeps_its_axes() -> None:
    _, (row,) = read(GOOD + b";\r\n", Options(family="aligned"))
    assert row["mag"] == pytest.approx((-187.632, 87.725, -737.372))


def test_start_lines_are_chatter_in_any_order() -> None:
    decoder, rows = read(b"4\r\n500\r\n16\r\n0.0001\r\n" + GOOD + b";\r\nGO\r\n" + GOOD + b";\r\n")
    assert len(rows) == 2
    assert (decoder.counts.chatter, decoder.counts.bad_messages) == (5, 0)


def test_four_groups_are_an_older_firmwares_position_and_speed() -> None:
    _, (row,) = read(GOOD + b";50.816223,12.929423,1.58\r\n")
    assert (row["lat"], row["lon"], row["speed"]) == (50.816223, 12.929423, 1.58)
    assert np.isnan(row["alt"])
    assert np.isnan(row["course_deg"])


@pytest.mark.parametrize(
    "line",
    [
        GOOD + b";50.816223,12.929423,0",  # five groups cut after the fourth
        GOOD + b";50.816223,12.929423,0;",
        GOOD[:-1],  # the bench form, cut in its last number
        GOOD[:-3],
        GOOD[:-8],
        GOOD + b";;",
        GOOD + b";" + POSITION.replace(b",0;", b",1;"),
        GOOD + b";" + POSITION + b";1,2,3",
        GOOD + GOOD,
        b"-0.07,0.03;-1.95,11.72,-17.75;-1876.32,877.25,-7373.72;",
        b"-0.07,,1.10;-1.95,11.72,-17.75;-1876.32,877.25,-7373.72;",
        GOOD.replace(b"11", b"1\xf81"),
    ],
)
def test_damaged_lines_are_bad(line: bytes) -> None:
    decoder, rows = read(line + b"\r\n")
    assert len(rows) == 0
    assert decoder.counts.bad_messages == 1


def test_spaces_exponents_and_not_a_number_are_read() -> None:
    _, rows = read(
        b" -0.07, 0.03, 1.1e0; -1.95,11.72,-17.75; nan,ovf,-inf;\r\n" + GOOD + b"; nan,nan,0;nan,nan,nan\r\n"
    )
    assert len(rows) == 2
    assert np.isnan(rows["mag"][0]).all()
    assert np.isnan(rows["lat"]).all()


@pytest.mark.parametrize("word", [0xD8D8, 0x0808, 0x8080, 0x8008, 0x0101, 0x7F7F, 0xFEFE, 0x2020])
def test_a_repeated_radio_word_is_rejected(word: int) -> None:
    signed = word - 0x10000 if word >= 0x8000 else word
    decoder, rows = read(payload(signed))
    assert len(rows) == 0
    assert (decoder.counts.bad_messages, decoder.counts.impossible) == (1, 1)
    imu_only = b";".join(payload(signed).split(b";")[:3]) + b";\r\n"
    assert len(read(imu_only)[1]) == 0


@pytest.mark.parametrize(
    "tail",
    [
        b"-326.430000,12.929423,0;177.30,1.58,372",
        b"50.816223,-326.430000,0;177.30,1.58,372",
        b"50.816223,12.929423,0;-3264.00,1.58,372",
        b"50.816223,12.929423,0;177.30,-326.40,372",
        b"50.816223,12.929423,0;177.30,1.58,-32640",
    ],
)
def test_a_payload_damaged_in_part_shows_in_the_position(tail: bytes) -> None:
    decoder, rows = read(GOOD + b";" + tail + b"\r\n")
    assert len(rows) == 0
    assert decoder.counts.impossible == 1


def test_a_saturated_field_word_is_beyond_the_sensors_range() -> None:
    decoder, rows = read(b"-0.07,0.03,1.10;-1.95,11.72,-17.75;-60219.00,877.25,-7373.72;\r\n")
    assert len(rows) == 0
    assert decoder.counts.impossible == 1


def test_a_board_at_rest_on_its_corner_is_no_repeated_word() -> None:
    assert not is_repeated_word((0.58, 0.58, 0.58, 0.0, 0.0, 0.0, 180.0, -60.0, 420.0))
    assert len(read(b"0.58,0.58,0.58;0.00,0.00,0.00;180.00,-60.00,420.00;\r\n")[1]) == 1


ZEROS = b"0.00,0.00,0.00;0.00,0.00,0.00;0.00,0.00,7269.02;1.280000,0.000000,0;0.00,0.00,0\r\n"


def test_a_payload_of_zeros_beside_other_words_measures_nothing() -> None:
    decoder, rows = read(GOOD + b";\r\n" + ZEROS + GOOD + b";\r\n" + ZEROS)
    assert len(rows) == 4
    assert not rows["acc"][1::2].any()
    assert np.isnan(rows["mag"][1::2]).all()
    assert np.isnan(rows["lat"]).all()
    assert [kind for _, kind, _ in decoder.log.entries()] == ["note", "note"]


def test_a_receiver_that_missed_its_parameters_gives_no_rows() -> None:
    decoder, rows = read(b"GO\r\n" + ZEROS * 50)
    assert len(rows) == 0
    assert decoder.counts.impossible == 50
    decoder, rows = read(GOOD + b";\r\n" + ZEROS * 50)
    assert len(rows) == 2
    assert decoder.counts.impossible == 49


def test_first_recorded_run(data_dir: Path) -> None:
    decoder, rows = read((data_dir / "boards/triplets-car-run1.txt").read_bytes())
    assert decoder.counts.samples == len(rows) == 987
    assert decoder.counts.bad_messages == 1
    assert decoder.counts.chatter == 0
    assert any("-18493.82" in text for _, kind, text in decoder.log.entries() if kind == "bad")
    assert decoder.rate_hz == 9.6


def test_third_recorded_run(data_dir: Path) -> None:
    decoder, rows = read((data_dir / "boards/triplets-car-run3.txt").read_bytes())
    assert (decoder.counts.samples, decoder.counts.bad_messages) == (494, 0)
    assert 600 < np.median(np.linalg.norm(rows["mag"], axis=1)) < 900
    assert np.median(np.linalg.norm(rows["acc"], axis=1)) == pytest.approx(GRAVITY, rel=0.1)
    assert len(decoder.log) == 0


def test_encoder_prints_what_was_recorded(data_dir: Path) -> None:
    data = (data_dir / "boards/triplets-car-run3.txt").read_bytes()
    _, rows = read(data)
    again = FORMATS["triplets"].encoder().encode(rows)
    # a value that rounds to zero from below prints as -0.00, as on the board
    assert again.replace(b"-0.00,", b"0.00,") == data.replace(b"-0.00,", b"0.00,")


def test_encoder_leaves_the_position_out_where_there_is_none() -> None:
    rows = empty_rows(SAMPLE, 2)
    rows["acc"], rows["gyr"], rows["mag"] = (0.0, 0.0, GRAVITY), 0.0, (1.0, 2.0, 3.0)
    rows["lat"][1], rows["lon"][1] = 50.0, 12.0
    first, second, end = FORMATS["triplets"].encoder().encode(rows).split(b"\r\n")
    assert first == b"0.00,0.00,1.00;0.00,0.00,0.00;20.00,10.00,-30.00;"
    assert second == first + b"50.000000,12.000000,0;nan,nan,nan"
    assert end == b""


@pytest.mark.parametrize("seed", range(3))
def test_a_recorded_run_with_noise_cuts_and_glued_lines(data_dir: Path, seed: int) -> None:
    random = np.random.default_rng(seed)
    data = (data_dir / "boards/triplets-car-run3.txt").read_bytes()
    noisy = np.frombuffer(data, np.uint8).copy()
    hit = random.random(len(noisy)) < 0.05
    noisy[hit] = random.integers(0, 256, hit.sum())
    damaged = noisy.tobytes().replace(b"\r\n", b"", 20)
    decoder = TripletsDecoder(Options())
    start = 0
    while start < len(damaged):
        end = start + int(random.integers(1, 300))
        decoder.feed(damaged[start:end], 0.0)
        start = end
    lines = [line for line in damaged.split(b"\n") if line.strip()]
    counts = decoder.counts
    assert counts.messages + counts.bad_messages + counts.chatter + counts.overlong == len(lines)
    assert counts.bad_messages > 300
    decoder.feed(b"\r\n", 0.0)
    assert len(decoder.feed(data, 0.0)) == 494
