"""Finding the baud rate, against a simulated serial line: what a receiver at one rate hears of a sender at another."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from imugui.formats import FORMATS, STREAM_FORMATS, Options
from imugui.formats.columns import IMU
from imugui.formats.detect import BAUDS, BUDGET, PATIENCE, BaudSearch, candidate_bauds
from imugui.samples import GRAVITY, SAMPLE, Rows, empty_rows

MESSAGES = 10
STEP = 0.02  # s between two reads
CSV = Options(columns=("t", "ax", "ay", "az", "gx", "gy", "gz", "mx", "my", "mz", "temp_c", "status"))


def heard(data: bytes, sent: int, rate: int) -> bytes:
    """What an 8N1 receiver at ``rate`` makes of bytes sent without pause at ``sent`` baud."""
    frames = np.ones((len(data), 10), np.uint8)
    frames[:, 0] = 0
    frames[:, 1:9] = np.unpackbits(np.frombuffer(data, np.uint8)[:, np.newaxis], axis=1, bitorder="little")
    line = np.append(frames.ravel(), [1] * 40).astype(np.int8)
    falls = np.flatnonzero(np.diff(line, prepend=1) == -1) / sent
    sampling = (np.arange(8) + 1.5) / rate
    received, t = bytearray(), 0.0
    while (k := np.searchsorted(falls, t)) < len(falls):
        bits = line[np.minimum(((falls[k] + sampling) * sent).astype(int), len(line) - 1)]
        received += np.packbits(bits, bitorder="little").tobytes()
        t = falls[k] + 9.5 / rate
    return bytes(received)


def board_rows() -> Rows:
    random = np.random.default_rng(4)
    rows = empty_rows(SAMPLE, MESSAGES)
    rows["t"] = np.round(np.arange(MESSAGES) / 100, 2)
    rows["acc"] = np.round(random.normal((0.0, 0.0, GRAVITY), 0.5, (MESSAGES, 3)), 3)
    rows["gyr"] = np.round(random.normal(0.0, 0.5, (MESSAGES, 3)), 4)
    rows["mag"] = np.round(random.normal((20.0, 5.0, -40.0), 2.0, (MESSAGES, 3)), 2)
    rows["temp_c"], rows["status"] = 25.31, 0
    return rows


@cache
def sent_messages(name: str) -> tuple[bytes, ...]:
    encoder = FORMATS[name].encoder()
    rows = board_rows()
    preamble = b"" if name == "csv-line" else encoder.preamble()
    return preamble, *(encoder.encode(rows[k : k + 1]) for k in range(MESSAGES))


@cache
def received_message(name: str, k: int, sent: int, rate: int) -> bytes:
    return heard(sent_messages(name)[k], sent, rate)


class Line:
    """A board that says nothing for a while, then its banner, then messages at an even rate."""

    def __init__(self, name: str, sent: int, silent: float, rate_hz: float) -> None:
        self._name, self._sent = name, sent
        self._next = silent
        self._k = 0
        longest = max(map(len, sent_messages(name)))
        self._period = max(1 / rate_hz, longest * 10 / sent)

    def read(self, t: float, baud: int) -> bytes:
        received = b""
        while self._next <= t:
            received += received_message(self._name, self._k, self._sent, baud)
            self._k = 1 + self._k % MESSAGES
            self._next += self._period
        return received


def search(line: Line, bauds: tuple[int, ...], options: Options) -> tuple[BaudSearch, float]:
    found = BaudSearch(bauds, 0.0, options)
    t = 0.0
    while not found.done:
        t += STEP
        found.feed(line.read(t, found.baud), t)
    return found, t


@pytest.mark.parametrize("name", STREAM_FORMATS)
@pytest.mark.parametrize("sent", BAUDS)
@pytest.mark.parametrize(("silent", "rate_hz"), [(0.0, 100.0), (2.0, 100.0), (0.5, 10.0)])
def test_the_rate_is_found_in_time(name: str, sent: int, silent: float, rate_hz: float) -> None:
    found, t = search(Line(name, sent, silent, rate_hz), candidate_bauds(), CSV if name == "csv-line" else Options())
    assert found.verdict.format == name
    assert found.baud == sent
    assert found.verdict.sentence.endswith(f"at {sent} baud")
    assert t <= BUDGET + STEP
    decoder, rows = found.detector.take()
    assert len(rows) >= 1
    assert decoder.counts.bad_messages == 0


def test_the_simulated_line_carries_bytes_at_its_own_rate_only() -> None:
    data = bytes(range(256))
    assert heard(data, 115200, 115200) == data
    assert heard(data, 115200, 116000) == data  # within what a receiver tolerates
    assert data[:10] not in heard(data, 115200, 57600)
    assert heard(b"0123", 230400, 250000) == b"pqrs"  # looks like text, and is wrong


def test_the_hint_comes_first() -> None:
    assert candidate_bauds()[:2] == (115200, 250000)
    assert candidate_bauds(9600)[:2] == (9600, 115200)
    assert sorted(candidate_bauds(9600)) == sorted(candidate_bauds())
    assert candidate_bauds(74880)[0] == 74880


def test_a_board_that_starts_after_its_boot_loader_is_heard_at_the_first_rate() -> None:
    found, t = search(Line("accel-lines", 115200, PATIENCE - 0.1, 138.6), candidate_bauds(), Options())
    assert found.verdict.format == "accel-lines"
    assert t < PATIENCE + 0.1


def test_noise_at_boot_does_not_condemn_a_rate_for_good() -> None:
    found = BaudSearch(candidate_bauds(), 0.0)
    line = Line("triplets", 115200, 0.3, 100.0)
    found.feed(bytes(range(128, 256)), 0.02)
    assert found.baud != 115200
    t = 0.02
    while not found.done:
        t += STEP
        found.feed(line.read(t, found.baud), t)
    assert (found.baud, found.verdict.format) == (115200, "triplets")
    assert t <= BUDGET


@pytest.mark.parametrize(
    ("chunk", "kind", "words"),
    [
        (b"", "silent", "silent: no byte in"),
        (bytes(range(128, 256)), "garbage", "bytes arrive but make no text at any baud rate tried (115200, 250000"),
        (b"hello\r\n", "text", "no known message, such as 'hello' at 115200 baud"),
    ],
)
def test_what_is_no_format_is_said_in_time(chunk: bytes, kind: str, words: str) -> None:
    found = BaudSearch(candidate_bauds(), 10.0)
    t = 10.0
    while not found.done:
        t += STEP
        found.feed(chunk if found.baud == 115200 or kind == "garbage" else b"", t)
    assert t <= 10.0 + BUDGET + STEP
    assert (found.verdict.kind, found.verdict.format) == (kind, "")
    assert words in found.verdict.sentence


def test_at_the_end_the_best_rate_is_kept_and_may_still_succeed() -> None:
    found = BaudSearch((9600, 115200, 57600), 0.0)
    t = 0.0
    while not found.done:
        t += STEP
        found.feed(b"still waiting\r\n" if found.baud == 115200 else b"\xf0" * 30, t)
    assert (found.baud, found.verdict.kind) == (115200, "text")
    found.detector.feed(b"".join(sent_messages("triplets")), t)
    assert found.verdict.format == "triplets"
    assert found.verdict.sentence.endswith("at 115200 baud")


def test_a_dead_sensor_ends_the_search_at_its_rate() -> None:
    found = BaudSearch(candidate_bauds(), 0.0)
    t = 0.0
    while not found.done:
        t += STEP
        found.feed(b"0.00,0.00,0.00;0.00,0.00,0.00;0.00,0.00,0.00;\r\n", t)
    assert (found.verdict.kind, found.verdict.format, found.baud) == ("impossible", "triplets", 115200)
    assert t < 2.0


def test_one_rate_without_a_name_and_few_formats() -> None:
    found = BaudSearch((0,), 0.0, formats=("triplets",))
    found.feed(b"".join(sent_messages("triplets")), 0.1)
    assert found.done
    assert found.verdict.format == "triplets"
    assert "baud" not in found.verdict.sentence


def test_named_columns_match_the_row() -> None:
    assert set(CSV.columns) == {"t", *IMU}
