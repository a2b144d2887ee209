"""What every entry of STREAM_FORMATS promises: the same rows for any cut, nothing lost uncounted, no exception."""

from __future__ import annotations

import tracemalloc
from dataclasses import asdict
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from imugui.formats import FORMATS, STREAM_FORMATS, Decoder, LinkLog, Options
from imugui.samples import GRAVITY, SAMPLE, Rows, empty_rows

DEG = np.pi / 180
NAMES = STREAM_FORMATS
HALF_STEP = {  # half a step of the last digit or count on the wire, for gyr, acc, mag, temp_c
    "accel-lines": (0.005 * DEG, 0.005 * GRAVITY, 0.005, 0.005),
    "triplets": (0.005 * DEG, 0.005 * GRAVITY, 0.0005, None),
    "colon-line": (0.5 / 16.4 * DEG, 0.5 / 16384 * GRAVITY, None, 0.5 / 340),
    "csv-line": (0.0, 0.0, 0.0, 0.0),
}
BAD_NUMBERS = ("1_0", "infinity", "0x10", "1,5", "--1", "1.2.3", "e5", "\u0661", "1e", "+", "1d5", "nane")


def moving_rows(n: int, seed: int = 1) -> Rows:
    """n plausible rows of a board in the hand, in SI."""
    random = np.random.default_rng(seed)
    rows = empty_rows(SAMPLE, n)
    rows["t"] = np.arange(n) / 100
    rows["gyr"] = random.normal(0.0, 1.0, (n, 3))
    rows["acc"] = random.normal((0.0, 1.0, 9.7), 0.5, (n, 3))
    rows["mag"] = random.normal((20.0, 5.0, -40.0), 2.0, (n, 3))
    rows["temp_c"] = 25.31
    rows["status"] = random.integers(0, 3, n)
    return rows


def stream(name: str, rows: Rows) -> bytes:
    encoder = FORMATS[name].encoder()
    return encoder.preamble() + encoder.encode(rows)


def decoder_of(name: str) -> Decoder:
    return FORMATS[name].decoder(Options())


def read(decoder: Decoder, data: bytes, cuts: list[int] | None = None) -> Rows:
    """All rows of ``data``, fed in the pieces that ``cuts`` make."""
    edges = [0, *sorted(cut % (len(data) + 1) for cut in cuts or []), len(data)]
    pieces = [data[start:end] for start, end in pairwise(edges)]
    return np.concatenate([decoder.feed(piece, 7.0) for piece in pieces] + [decoder.flush(7.0)])


def corrupted(data: bytes, share: float, seed: int) -> bytes:
    random = np.random.default_rng(seed)
    bytes_ = np.frombuffer(data, np.uint8).copy()
    hit = random.random(len(bytes_)) < share
    bytes_[hit] = random.integers(0, 256, hit.sum())
    return bytes_.tobytes()


@pytest.mark.parametrize("name", NAMES)
def test_rows_come_back_within_the_last_digit(name: str) -> None:
    rows = moving_rows(300)
    decoder = decoder_of(name)
    back = read(decoder, stream(name, rows))
    assert decoder.counts.samples == decoder.counts.messages == len(back) == 300
    assert decoder.counts.bad_messages == 0
    for field, step in zip(("gyr", "acc", "mag", "temp_c"), HALF_STEP[name], strict=True):
        if step is None:
            assert np.isnan(back[field]).all()
        else:
            assert np.abs(back[field] - rows[field]).max() <= step * (1 + 1e-9)
    if name in ("colon-line", "csv-line"):
        assert (back["status"] == rows["status"]).all()


@pytest.mark.parametrize("name", NAMES)
def test_rows_carry_their_arrival(name: str) -> None:
    decoder = decoder_of(name)
    data = stream(name, moving_rows(4))
    middle = len(data) // 2
    first, second = decoder.feed(data[:middle], 1.0), decoder.feed(data[middle:], 2.0)
    assert len(first) + len(second) == 4
    assert (first["t_arrival"] == 1.0).all()
    assert (second["t_arrival"] == 2.0).all()
    assert decoder.has_time == (name == "csv-line")
    if not decoder.has_time:
        assert (second["t"] == 2.0).all()
    assert first.dtype == SAMPLE
    first["t"] = 0.0  # rows belong to the caller


@pytest.mark.parametrize("name", NAMES)
@settings(max_examples=25, deadline=None)
@given(
    cuts=st.lists(st.integers(0, 10_000), max_size=30),
    share=st.sampled_from((0.0, 0.002, 0.05)),
    seed=st.integers(0, 10_000),
)
def test_cuts_change_nothing(name: str, cuts: list[int], share: float, seed: int) -> None:
    data = corrupted(stream(name, moving_rows(25, seed)), share, seed)
    whole, pieces, bytewise = decoder_of(name), decoder_of(name), decoder_of(name)
    expected = read(whole, data)
    for decoder, where in ((pieces, cuts), (bytewise, list(range(len(data))))):
        rows = read(decoder, data, where)
        assert rows.tobytes() == expected.tobytes()
        assert decoder.counts == whole.counts
        assert decoder.log.entries() == whole.log.entries()
        assert decoder.seen == whole.seen


@pytest.mark.parametrize("name", NAMES)
@settings(max_examples=25, deadline=None)
@given(seed=st.integers(0, 10_000), share=st.floats(0.01, 0.3), glued=st.booleans())
def test_noise_is_counted_and_the_next_good_message_is_taken(name: str, seed: int, share: float, glued: bool) -> None:
    decoder = decoder_of(name)
    read(decoder, stream(name, moving_rows(2)))
    noisy = corrupted(FORMATS[name].encoder().encode(moving_rows(30, seed)), share, seed)
    if glued:
        noisy = noisy.replace(b"\r\n", b"", 7)
    before = asdict(decoder.counts)
    decoder.feed(noisy, 1.0)
    decoder.feed(b"\r\n", 1.0)
    after = asdict(decoder.counts)
    seen = {key: after[key] - before[key] for key in after}
    assert seen["bytes"] == len(noisy) + 2
    if seen["messages"] < 30:
        assert seen["bad_messages"] + seen["chatter"] + seen["overlong"] > 0
        assert len(decoder.log) > 0
    good = moving_rows(3, 5)
    back = read(decoder, FORMATS[name].encoder().encode(good))
    assert np.abs(back["acc"][-3:] - good["acc"]).max() < 0.06
    assert len(back) in (3, 4)  # 4: a message that the noise left whole except for its last line


@pytest.mark.parametrize("name", [name for name in NAMES if name != "accel-lines"])
@settings(max_examples=25, deadline=None)
@given(seed=st.integers(0, 10_000), share=st.floats(0.0, 0.2))
def test_every_line_is_counted_once(name: str, seed: int, share: float) -> None:
    data = corrupted(stream(name, moving_rows(20, seed)), share, seed)
    decoder = decoder_of(name)
    read(decoder, data)
    lines = [line for line in data.split(b"\n") if line.strip(b"\r")]
    blank = sum(line.isspace() for line in lines)
    counts = decoder.counts
    assert counts.messages + counts.bad_messages + counts.chatter + counts.overlong == len(lines) - blank


@pytest.mark.parametrize("name", NAMES)
@settings(max_examples=60, deadline=None)
@given(chunks=st.lists(st.binary(max_size=300), max_size=20))
def test_no_bytes_raise(name: str, chunks: list[bytes]) -> None:
    decoder = decoder_of(name)
    for chunk in chunks:
        decoder.feed(chunk, 0.0)
    decoder.resync()
    decoder.flush(0.0)
    assert decoder.counts.bytes == sum(map(len, chunks))


@pytest.mark.parametrize("name", NAMES)
@settings(max_examples=60, deadline=None)
@given(
    text=st.text(st.sampled_from("0123456789.,;:-+#eE \tnaifovACELGYROMTPxyz_\r\n()/"), max_size=400),
)
def test_no_text_raises(name: str, text: str) -> None:
    decoder = decoder_of(name)
    rows = read(decoder, text.encode())
    assert np.isfinite(rows["acc"]).all()
    assert np.isfinite(rows["gyr"]).all()
    assert np.isfinite(rows["t"]).all()


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("token", BAD_NUMBERS)
def test_only_plain_numbers_are_numbers(name: str, token: str) -> None:
    decoder = decoder_of(name)
    rows = moving_rows(3)
    encoder = FORMATS[name].encoder()
    decoder.feed(encoder.preamble() + encoder.encode(rows[:1]), 0.0)
    line = encoder.encode(rows[1:2])
    number = {"accel-lines": 1, "triplets": 0, "colon-line": 2, "csv-line": 1}[name]
    separator = {"accel-lines": b" ", "triplets": b",", "colon-line": b":", "csv-line": b","}[name]
    words = line.split(separator)
    words[number - (name == "colon-line")] = token.encode()
    assert len(decoder.feed(separator.join(words), 0.0)) == 0
    assert decoder.counts.bad_messages == 1
    assert len(decoder.feed(encoder.encode(rows[2:]), 0.0)) == 1


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize(
    ("field", "value"),
    [("acc", (500.0, 0.0, 0.0)), ("gyr", (0.0, 0.0, 80.0)), ("acc", (np.nan, 0.0, 9.8)), ("gyr", (0.0, np.nan, 0.0))],
)
def test_impossible_values_are_bad(name: str, field: str, value: tuple[float, float, float]) -> None:
    rows = moving_rows(3)
    rows[field][1] = value
    decoder = decoder_of(name)
    if name == "colon-line":  # its sixteen bits hold 2 g and 2000 deg/s: such a line only arises on the way
        good, bad, last = (FORMATS[name].encoder().encode(rows[k : k + 1]) for k in range(3))
        words = bad.split(b":")
        words[1 if field == "acc" else 4] = b"nan" if np.isnan(value).any() else b"900000"
        back = read(decoder, good + b":".join(words) + last)
    else:
        back = read(decoder, stream(name, rows))
    assert len(back) == 2
    assert (decoder.counts.bad_messages, decoder.counts.impossible) == (1, 1)
    assert any(kind == "bad" and "impossible" in text for _, kind, text in decoder.log.entries())


@pytest.mark.parametrize("name", NAMES)
def test_a_sensor_that_does_not_answer_gives_no_rows(name: str) -> None:
    rows = moving_rows(5)
    for field in ("acc", "gyr", "mag"):
        rows[field] = 0.0
    decoder = decoder_of(name)
    assert len(read(decoder, stream(name, rows))) == 0
    assert decoder.counts.bad_messages == 5


@pytest.mark.parametrize("name", [name for name in NAMES if HALF_STEP[name][2] is not None])
def test_a_missing_field_leaves_the_row(name: str) -> None:
    rows = moving_rows(3)
    rows["mag"][0] = np.nan
    rows["mag"][1] = 0.0
    back = read(decoder_of(name), stream(name, rows))
    assert np.isnan(back["mag"][:2]).all()
    assert np.isfinite(back["mag"][2]).all()
    assert np.isfinite(back["acc"]).all()


@pytest.mark.parametrize("name", NAMES)
def test_reopening_drops_the_half_line_only(name: str) -> None:
    rows = moving_rows(6)
    encoder = FORMATS[name].encoder()
    decoder = decoder_of(name)
    decoder.feed(encoder.preamble() + encoder.encode(rows[:2]) + encoder.encode(rows[2:3])[:-7], 0.0)
    decoder.resync()
    cut = encoder.encode(rows[3:4])[9:]
    back = decoder.feed(cut + encoder.encode(rows[4:]), 0.0)
    assert np.abs(back["acc"] - rows["acc"][4:]).max() < 0.06
    assert decoder.counts.messages == 4
    assert decoder.counts.bad_messages == 0  # the cut was ours, and the log says so
    assert any(kind == "note" and "opening" in text for _, kind, text in decoder.log.entries())


@pytest.mark.parametrize("name", NAMES)
def test_only_the_first_line_after_reopening_is_excused(name: str) -> None:
    decoder = decoder_of(name)
    decoder.feed(stream(name, moving_rows(1)), 0.0)
    decoder.resync()
    decoder.feed(b"1,2\xff;\n\xfe\xff\n", 0.0)
    assert decoder.counts.bad_messages == 1


@pytest.mark.parametrize("name", NAMES)
def test_a_stream_without_line_ends_needs_little_memory(name: str) -> None:
    decoder = decoder_of(name)
    decoder.feed(stream(name, moving_rows(2)), 0.0)
    tracemalloc.start()
    for _ in range(500):
        decoder.feed(b"\xaa" * 4000, 0.0)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 200_000
    assert decoder.counts.overlong == 1
    back = decoder.feed(b"\r\n" + FORMATS[name].encoder().encode(moving_rows(2)), 0.0)
    assert len(back) == 2
    assert any("2000000 bytes" in text for _, _, text in decoder.log.entries())


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("length", [4096, 4097, 5000])
@pytest.mark.parametrize("step", [7, 4095, 100_000])
def test_a_line_is_too_long_however_it_is_cut(name: str, length: int, step: int) -> None:
    decoder = decoder_of(name)
    data = b"x" * length + b"\r\n" + stream(name, moving_rows(1))
    rows = [decoder.feed(data[k : k + step], 0.0) for k in range(0, len(data), step)]
    assert sum(map(len, rows)) == 1
    assert decoder.counts.overlong == (length > 4096)


@pytest.mark.parametrize("name", NAMES)
def test_the_log_is_bounded_and_counts_what_fell_out(name: str) -> None:
    decoder = decoder_of(name)
    decoder.feed(b"hello there\r\n" * 2000, 3.0)
    assert decoder.counts.chatter == 2000
    assert len(decoder.log) == LinkLog.CAPACITY
    assert decoder.log.dropped == 2000 - LinkLog.CAPACITY
    assert decoder.log.entries()[-1] == (3.0, "chatter", "hello there")


@pytest.mark.parametrize("name", NAMES)
def test_preamble_is_no_error(name: str) -> None:
    decoder = decoder_of(name)
    assert len(decoder.feed(FORMATS[name].encoder().preamble(), 0.0)) == 0
    assert decoder.counts.bad_messages == 0


@pytest.mark.parametrize("name", NAMES)
def test_other_buffers_than_bytes_are_read(name: str) -> None:
    data = stream(name, moving_rows(3))
    assert len(decoder_of(name).feed(bytearray(data), 0.0)) == 3


def test_a_long_entry_says_what_was_left_out() -> None:
    log = LinkLog()
    log.add(0.0, "bad", "x" * 1000)
    assert log.entries()[0][2].endswith("(800 more characters)")


def test_an_unknown_family_is_named() -> None:
    for name in NAMES:
        with pytest.raises(ValueError, match="no sensor family called 'mpu9999'"):
            FORMATS[name].decoder(Options(family="mpu9999"))


@pytest.mark.parametrize("name", NAMES)
def test_entries_are_complete(name: str) -> None:
    entry = FORMATS[name]
    assert entry.name == name
    assert entry.title
    assert entry.hint.endswith(".")
    assert 115200 in entry.bauds
    assert entry.rate_hz > 0
    assert decoder_of(name).rate_hz == entry.rate_hz
