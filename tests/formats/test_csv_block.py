"""Large pieces of a table give the rows, counts and words that its lines give one by one."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

import numpy as np
import pytest

from imugui.formats import FORMATS, Options
from imugui.formats import csv_line as module
from imugui.formats.csv_line import CsvLineDecoder
from imugui.samples import SAMPLE, Rows, empty_rows


def rows_of_a_hand(n: int = 900) -> Rows:
    random = np.random.default_rng(1)
    rows = empty_rows(SAMPLE, n)
    rows["t"] = np.arange(n) / 100
    rows["gyr"] = random.normal(0.0, 1.0, (n, 3))
    rows["acc"] = random.normal((0.0, 1.0, 9.7), 0.5, (n, 3))
    rows["mag"] = random.normal((20.0, 5.0, -40.0), 2.0, (n, 3))
    return rows


def text_of(rows: Rows) -> bytes:
    encoder = FORMATS["csv-line"].encoder()
    return encoder.preamble() + encoder.encode(rows)


def read(data: bytes, piece: int) -> tuple[CsvLineDecoder, bytes]:
    decoder = CsvLineDecoder(Options())
    blocks = [decoder.feed(data[start : start + piece], 3.0) for start in range(0, len(data), piece)]
    return decoder, np.concatenate([*blocks, decoder.flush(3.0)]).tobytes()


Change = Callable[[bytes], bytes]
CHANGES: dict[str, Change] = {
    "as it is": lambda data: data,
    "LF": lambda data: data.replace(b"\r\n", b"\n"),
    "a comment in the middle": lambda data: data[:90000] + data[90000:].replace(b"\r\n", b"\r\n# note\r\n", 1),
    "a word": lambda data: data[:90000] + data[90000:].replace(b",", b",x", 1),
    "two points": lambda data: data[:90000] + data[90000:].replace(b".", b"..", 1),
    "a blank": lambda data: data[:90000] + data[90000:].replace(b".", b" ", 1),
    "a stray CR": lambda data: data[:90000] + data[90000:].replace(b".", b".\r", 1),
    "a digit after CR": lambda data: data[:90000] + data[90000:].replace(b"\r\n", b"\r5\n", 1),
    "huge": lambda data: data[:90000] + data[90000:].replace(b".", b"e200.", 1).replace(b"e200.", b"e200", 1),
    "cut at the end": lambda data: data[:-30],
    "no field": lambda data: data.replace(b",-3", b",").replace(b",-4", b","),
    "binary": lambda data: data[:90000] + b"\0\xff" + data[90000:],
}


@pytest.mark.parametrize("name", CHANGES)
def test_pieces_of_a_file_are_read_as_its_lines(name: str) -> None:
    data = CHANGES[name](text_of(rows_of_a_hand()))
    one, rows = read(data, 1000)
    many, rows_at_once = read(data, 1 << 16)
    assert rows_at_once == rows
    assert dataclasses.asdict(many.counts) == dataclasses.asdict(one.counts)
    assert many.log.entries() == one.log.entries()
    assert many.seen == one.seen


@pytest.mark.parametrize("with_position", [False, True])
def test_statuses_positions_and_gaps_come_through(with_position: bool) -> None:
    rows = rows_of_a_hand()
    rows["status"] = np.arange(len(rows)) % 3
    rows["temp_c"][::2] = 21.5
    rows["mag"][100:700] = np.nan
    if with_position:
        for name in ("lat", "lon", "alt", "speed", "course_deg"):
            rows[name][::5] = 12.5
    data = text_of(rows)
    assert read(data, 1 << 16)[1] == read(data, 1000)[1]


def test_a_usual_file_goes_the_quick_way(monkeypatch: pytest.MonkeyPatch) -> None:
    quick: list[int] = []
    rows_of = module.rows_of

    def count(*arguments: object) -> Rows | None:
        rows = rows_of(*arguments)  # type: ignore[arg-type]
        quick.append(0 if rows is None else len(rows))
        return rows

    monkeypatch.setattr(module, "rows_of", count)
    read(text_of(rows_of_a_hand()), 1 << 15)
    assert sum(quick) > 500
