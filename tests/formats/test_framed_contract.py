"""What every framed entry of FORMATS promises: one chunk is one message, any other length is bad, nothing raises."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from imugui.formats import FORMATS, STREAM_FORMATS, Decoder, LinkLog, Options
from imugui.formats.detect import BaudSearch
from imugui.formats.detector import Detector
from imugui.samples import GRAVITY, SAMPLE, Rows, empty_rows

DEG = np.pi / 180
NAMES = tuple(name for name, entry in FORMATS.items() if entry.framed)
HALF_STEP = {  # half a count on the wire, for gyr, acc, mag, temp_c
    "motion-card": (0.5 / 16.4 * DEG, 0.5 / 16384 * GRAVITY, None, 0.5 / 340),
    "thingy-motion": (0.5 / 32 * DEG, 0.5 / 1024 * GRAVITY, 0.5 / 16, None),
    "wit-motion": (0.5 / 16.384 * DEG, 0.5 / 2048 * GRAVITY, None, None),
}


def moving_rows(n: int, seed: int = 1) -> Rows:
    """n plausible rows of a board in the hand, in SI."""
    random = np.random.default_rng(seed)
    rows = empty_rows(SAMPLE, n)
    rows["gyr"] = random.normal(0.0, 1.0, (n, 3))
    rows["acc"] = random.normal((0.0, 1.0, 9.7), 0.5, (n, 3))
    rows["mag"] = random.normal((20.0, 5.0, -40.0), 2.0, (n, 3))
    rows["temp_c"] = 25.31
    rows["status"] = random.integers(0, 3, n)
    return rows


def messages(name: str, rows: Rows) -> list[bytes]:
    """What the board notifies, one by one."""
    data, size = FORMATS[name].encoder().encode(rows), FORMATS[name].message_bytes
    assert len(data) == size * len(rows)
    return [data[at : at + size] for at in range(0, len(data), size)]


def decoder_of(name: str, options: Options | None = None) -> Decoder:
    return FORMATS[name].decoder(options or Options())


@pytest.mark.parametrize("name", NAMES)
def test_rows_come_back_within_half_a_count(name: str) -> None:
    rows = moving_rows(300)
    decoder = decoder_of(name)
    back = np.concatenate([decoder.feed(message, 7.0) for message in messages(name, rows)])
    assert decoder.counts.samples == decoder.counts.messages == len(back) == 300
    assert decoder.counts.bad_messages == 0
    for field, step in zip(("gyr", "acc", "mag", "temp_c"), HALF_STEP[name], strict=True):
        if step is None:
            assert np.isnan(back[field]).all()
        else:
            assert np.abs(back[field] - rows[field]).max() <= step * (1 + 1e-9)


@pytest.mark.parametrize("name", NAMES)
def test_each_notification_is_a_row_with_its_arrival(name: str) -> None:
    decoder = decoder_of(name)
    for k, message in enumerate(messages(name, moving_rows(5))):
        rows = decoder.feed(message, float(k))
        assert rows.dtype == SAMPLE
        assert rows["t"].tolist() == rows["t_arrival"].tolist() == [float(k)]
        rows["t"] = 0.0  # rows belong to the caller
    assert not decoder.has_time


@pytest.mark.parametrize("name", NAMES)
@given(chunks=st.lists(st.binary(max_size=70), max_size=20))
def test_whatever_comes_is_counted_once_and_nothing_raises(name: str, chunks: list[bytes]) -> None:
    decoder = decoder_of(name)
    rows = sum(len(decoder.feed(chunk, 0.0)) for chunk in chunks)
    decoder.resync()
    counts = decoder.counts
    assert len(decoder.flush(0.0)) == 0
    assert counts.bytes == sum(map(len, chunks))
    assert counts.messages == counts.samples == rows
    assert counts.messages + counts.bad_messages + counts.chatter == sum(map(bool, chunks))
    wrong = sum(len(chunk) not in (0, FORMATS[name].message_bytes) for chunk in chunks)
    assert counts.bad_messages >= wrong


@pytest.mark.parametrize("name", NAMES)
@given(data=st.data())
def test_any_message_of_the_right_length_gives_possible_values_or_is_bad(name: str, data: st.DataObject) -> None:
    size = FORMATS[name].message_bytes
    decoder = decoder_of(name)
    rows = decoder.feed(data.draw(st.binary(min_size=size, max_size=size)), 0.0)
    assert len(rows) + decoder.counts.bad_messages + decoder.counts.chatter == 1
    assert np.isfinite(rows["acc"]).all()
    assert np.isfinite(rows["gyr"]).all()


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("change", [-1, 1, None], ids=["cut", "longer", "two glued"])
def test_any_other_length_is_bad_and_the_next_message_is_taken(name: str, change: int | None) -> None:
    good, next_one = messages(name, moving_rows(2))
    wrong = {-1: good[:-1], 1: good + b"\0", None: good + good}[change]
    decoder = decoder_of(name)
    assert len(decoder.feed(wrong, 1.0)) == 0
    assert decoder.counts.bad_messages == 1
    assert decoder.log.entries() == [(1.0, "bad", decoder.log.entries()[0][2])]
    assert f"{len(wrong)} bytes instead of {len(good)}" in decoder.log.entries()[0][2]
    assert len(decoder.feed(next_one, 2.0)) == 1


@pytest.mark.parametrize("name", NAMES)
def test_a_sensor_that_does_not_answer_gives_no_rows(name: str) -> None:
    rows = moving_rows(5)
    for field in ("acc", "gyr", "mag"):
        rows[field] = 0.0
    decoder = decoder_of(name)
    assert sum(len(decoder.feed(message, 0.0)) for message in messages(name, rows)) == 0
    assert (decoder.counts.bad_messages, decoder.counts.impossible) == (5, 5)


@pytest.mark.parametrize("name", NAMES)
def test_beyond_the_range_the_board_sends_its_largest_count(name: str) -> None:
    rows = moving_rows(1)
    rows["gyr"] = (1e3, 0.0, -1e3)
    back = decoder_of(name).feed(messages(name, rows)[0], 0.0)
    assert len(back) == 0 or (back["gyr"][0, 0] > 17.0 and back["gyr"][0, 2] < -17.0)


@pytest.mark.parametrize("name", NAMES)
def test_missing_values_can_be_encoded(name: str) -> None:
    rows = moving_rows(2)
    rows["mag"], rows["temp_c"], rows["status"] = np.nan, np.nan, -1
    decoder = decoder_of(name)
    back = np.concatenate([decoder.feed(message, 0.0) for message in messages(name, rows)])
    assert np.isnan(back["mag"]).all()
    assert (back["status"] <= 0).all()


@pytest.mark.parametrize("name", NAMES)
def test_a_wrong_scale_is_noticed(name: str) -> None:
    rows = moving_rows(200)
    rows["acc"] *= 0.2
    decoder = decoder_of(name)
    for message in messages(name, rows):
        decoder.feed(message, 0.0)
    assert decoder.seen.endswith("but |acc| is mostly 0.198 g: is its unit right?")


@pytest.mark.parametrize("name", NAMES)
def test_the_log_is_bounded(name: str) -> None:
    decoder = decoder_of(name)
    for _ in range(700):
        decoder.feed(b"hello", 0.0)
    assert decoder.counts.bad_messages == 700
    assert decoder.log.dropped == 700 - LinkLog.CAPACITY


@pytest.mark.parametrize("name", NAMES)
def test_other_buffers_than_bytes_are_read(name: str) -> None:
    assert len(decoder_of(name).feed(bytearray(messages(name, moving_rows(1))[0]), 0.0)) == 1


@pytest.mark.parametrize("name", NAMES)
def test_an_unknown_family_is_named(name: str) -> None:
    with pytest.raises(ValueError, match="no sensor family called 'mpu9999'"):
        decoder_of(name, Options(family="mpu9999"))


@pytest.mark.parametrize("name", NAMES)
def test_entries_are_complete(name: str) -> None:
    entry = FORMATS[name]
    assert entry.name == name
    assert entry.title
    assert entry.hint.endswith(".")
    assert entry.bauds == ()
    assert entry.encoder().preamble() == b""
    assert decoder_of(name).rate_hz == entry.rate_hz > 0


def test_a_framed_format_is_never_found_on_a_serial_port() -> None:
    """Fifteen bytes of noise at a time look like the card's messages; among other formats they must not be."""
    card = messages("motion-card", moving_rows(50))
    for detector in (Detector(mid_stream=True), Detector(formats=tuple(FORMATS))):
        for k, message in enumerate(card):
            detector.feed(message, 0.01 * k)
        assert detector.conclude().format == ""
    search = BaudSearch((115200,), 0.0, formats=tuple(FORMATS))
    for k, message in enumerate(card):
        search.feed(message, 0.01 * k)
    assert search.verdict.format == ""


def test_a_framed_format_that_was_asked_for_is_tried() -> None:
    detector = Detector(formats=("motion-card",))
    for k, message in enumerate(messages("motion-card", moving_rows(5))):
        detector.feed(message, 0.01 * k)
    assert detector.conclude().format == "motion-card"


def test_stream_formats_and_framed_ones_are_all() -> None:
    assert sorted((*STREAM_FORMATS, *NAMES)) == sorted(FORMATS)
    assert set(NAMES) == set(HALF_STEP)
