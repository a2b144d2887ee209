"""Reading foreign tables through column maps: one file or several that belong together, as SAMPLE rows."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path

import numpy as np

from imugui.formats.base import Counts, Options
from imugui.formats.column_map import ColumnMap
from imugui.formats.csv_line import CsvLineDecoder
from imugui.formats.layout import HEAD, TableError
from imugui.formats.merge import Part, is_complete, merge
from imugui.samples import Rows

BLOCK = 1 << 18
Watch = Callable[[float], None]
"""Is told the share (0 to 1) that is done; raises to give up."""
MOST_ROWS = 8_000_000
"""About 1 GB in memory; 11 hours at 200 Hz."""
ONLY_LINEAR = (
    "only acceleration without gravity (linear acceleration), from which no attitude can be told: "
    "record the accelerometer with gravity, or the gravity along with it"
)
ONLY_GRAVITY = "only the gravity that the device worked out: record the accelerometer itself along with it"


def read_table(
    path: Path,
    maps: Sequence[ColumnMap],
    family: str = "",
    rate_hz: float = 0.0,
    watch: Watch | None = None,
) -> tuple[Rows, CsvLineDecoder]:
    """All rows of a table, or of several that lie in one folder, and the decoder with counts, log and words.

    ``rate_hz`` goes before the maps' own for tables without times. ``watch`` is told the share that was read. Raises
    OSError, TableError in words, and what ``watch`` raises.
    """
    options = Options(family)
    files = [part_path(path, one) for one in maps]
    for file in files:
        refuse_too_long(file)
    chunks = _Chunks(files, watch)
    read = [decode(one, chunks.of(file), options) for one, file in zip(maps, files, strict=True)]
    rows = join(read, maps, rate_hz)
    if len(rows) == 0:
        raise TableError(f"no sample found. {read[0][0].seen}{_example(read[0][0])}")
    return rows, _one_decoder(read, maps, len(rows))


def part_path(path: Path, column_map: ColumnMap) -> Path:
    """Where the file of a map lies when ``path``, the folder or one of the files, was opened."""
    if not column_map.file:
        return path
    return (path if path.is_dir() else path.parent) / column_map.file


def refuse_too_long(file: Path) -> None:
    """Raise TableError when a file holds more rows than fit in memory, judged from its beginning; OSError."""
    size = file.stat().st_size
    with file.open("rb") as stream:
        head = stream.read(HEAD)
    rows = size * (head.count(b"\n") + 1) / max(1, len(head))
    if rows > MOST_ROWS:
        raise TableError(
            f"about {rows / 1e6:,.0f} million rows, more than the {MOST_ROWS // 1_000_000} million that are opened at "
            "once: cut the file into pieces"
        )


def decode(
    column_map: ColumnMap, chunks: Iterable[bytes], options: Options | None = None
) -> tuple[CsvLineDecoder, Rows]:
    """The rows of one table, shape (n,), with NaN for what it does not hold, and what was found on the way."""
    decoder = CsvLineDecoder(options or Options(), column_map)
    blocks = [decoder.feed(chunk, 0.0) for chunk in _after_lines(chunks, column_map.skip_lines, decoder)]
    rows = np.concatenate([*blocks, decoder.flush(0.0)])
    rows["t_arrival"] = np.nan
    return decoder, _without_damaged(rows, decoder)


def join(read: Sequence[tuple[CsvLineDecoder, Rows]], maps: Sequence[ColumnMap], rate_hz: float = 0.0) -> Rows:
    """The rows of all tables on one time base. Raises TableError when they cannot be brought together."""
    forces = {decoder.table.force for decoder, _ in read if decoder.table} - {""}
    if "total" not in forces and forces and forces != {"linear", "gravity"}:
        raise TableError(ONLY_LINEAR if "linear" in forces else ONLY_GRAVITY)
    for (decoder, rows), one in zip(read, maps, strict=True):
        if decoder.has_time:
            continue
        if len(read) > 1 or not is_complete(rows):
            raise TableError(f"{one.file or 'the table'} has no column with times to bring its values together by")
        rows["t"] = np.arange(len(rows)) / (rate_hz or decoder.rate_hz)
    return merge([Part(rows, decoder.table.force if decoder.table else "") for decoder, rows in read])


class _Chunks:
    """The bytes of some files in blocks; tells ``watch`` which share of them all was read."""

    def __init__(self, files: Sequence[Path], watch: Watch | None) -> None:
        self._size = max(1, sum(file.stat().st_size for file in files))
        self._watch = watch
        self._done = 0

    def of(self, file: Path) -> Iterator[bytes]:
        """The blocks of one file; raises OSError, and what ``watch`` raises."""
        with file.open("rb") as stream:
            while chunk := stream.read(BLOCK):
                yield chunk
                self._done += len(chunk)
                if self._watch is not None:
                    self._watch(self._done / self._size)


def _after_lines(chunks: Iterable[bytes], skip: int, decoder: CsvLineDecoder) -> Iterator[bytes]:
    """The bytes after so many lines, up to where the file is no text any more (a hole, or a broken download)."""
    for chunk in chunks:
        text, hole, _ = chunk.partition(b"\0")
        while skip and text:
            _, end, text = text.partition(b"\n")
            skip -= bool(end)
        yield text
        if hole:
            decoder.counts.bad_messages += 1
            decoder.log.add(0.0, "bad", "binary data: the rest of the file is left out")
            return


def _without_damaged(rows: Rows, decoder: CsvLineDecoder) -> Rows:
    """Where most rows are whole, one without acceleration or turn rate is a damaged line."""
    used = decoder.table.used if decoder.table else ()
    needed = [name for name, slot in (("acc", "ax"), ("gyr", "gx")) if slot in used]
    if not needed or not is_complete(rows):
        return rows
    good = np.logical_and.reduce([np.isfinite(rows[name]).all(axis=1) for name in needed])
    damaged = len(rows) - int(good.sum())
    if damaged:
        decoder.counts.bad_messages += damaged
        decoder.counts.messages -= damaged
        decoder.counts.samples -= damaged
        decoder.log.add(0.0, "bad", f"{damaged} lines without acceleration or turn rate")
    return rows[good]


def _one_decoder(
    read: Sequence[tuple[CsvLineDecoder, Rows]], maps: Sequence[ColumnMap], samples: int
) -> CsvLineDecoder:
    """The first decoder with the counts, the log and the words of all; a line is a message, not always a sample."""
    first = read[0][0]
    first.counts.samples = samples
    if len(read) == 1:
        return first
    first.seen = "; ".join(f"{one.file}: {decoder.seen}" for (decoder, _), one in zip(read, maps, strict=True))
    for decoder, _ in read[1:]:
        decoder.counts.samples = 0
        for item in dataclasses.fields(Counts):
            setattr(first.counts, item.name, getattr(first.counts, item.name) + getattr(decoder.counts, item.name))
        for entry in decoder.log.entries():
            first.log.add(*entry)
    return first


def _example(decoder: CsvLineDecoder) -> str:
    bad = next((text for _, kind, text in decoder.log.entries() if kind == "bad"), "")
    return f"; the first line that was refused: {bad[:120]}" if bad else ""
