"""How a text file of numbers is laid out: delimiter, decimal sign, header, and its first rows."""

from __future__ import annotations

import csv
import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

from imugui.formats.column_map import DELIMITERS
from imugui.formats.columns import UNITS, plain_unit

HEAD = 65536  # bytes of a file that are looked at
MOST_ROWS = 2000
HEADER_LINES = 3  # so many lines above the numbers are searched for names
# each digit can be read in one way only: else a long run of them takes for ever
NUMBER = r"[+-]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d+)?|[+-]?(?:nan|inf)"
ENOUGH_ROWS = 2

_CELL = {
    ".": re.compile(rf"(?:{NUMBER})?(?: sec)?", re.IGNORECASE),
    ",": re.compile(rf"(?:{NUMBER})?(?: sec)?".replace(r"\.", ","), re.IGNORECASE),
}
_MAGIC = {
    b"PK\x03\x04": "a ZIP archive or an Excel workbook: unpack it, or export the sheet as CSV, and open the CSV file",
    b"\x1f\x8b": "a compressed file (gzip): unpack it first",
    b"\xff\xfe": "text in UTF-16: save it as CSV in UTF-8",
    b"\xfe\xff": "text in UTF-16: save it as CSV in UTF-8",
    b"MATLAB": "a MATLAB workspace: export the table with writetable as CSV",
    b"\x89HDF": "an HDF5 or MATLAB 7.3 file: export the table as CSV",
}
_UNIT_WORDS = {unit for units in UNITS.values() for unit in units} | {"a.u.", "au", "counts", "raw", "lsb", "hpa", "-"}


class TableError(ValueError):
    """A file that is no table of numbers, or does not fit its column map; one sentence without the file's name."""


@dataclass(frozen=True)
class Layout:
    """What was found in the first bytes of a file."""

    delimiter: str
    decimal: str
    skip_lines: int  # lines before the first row of numbers
    names: tuple[str, ...]  # one for each column, with its unit; all empty without a header
    above: tuple[str, ...]  # the lines before the numbers
    cells: tuple[tuple[str, ...], ...]  # the first rows, as written
    numbers: NDArray[np.float64]  # the same, shape (rows, columns); NaN where there is no number
    row_bytes: float  # mean length of a row with its line end

    @property
    def width(self) -> int:
        """Number of columns."""
        return len(self.names)

    @property
    def has_header(self) -> bool:
        """Whether any column has a name."""
        return any(self.names)

    def text(self) -> str:
        """The first rows as they stand in the file."""
        return "".join(self.delimiter.join(row) + "\n" for row in self.cells)

    @property
    def signature(self) -> str:
        """The same for files of the same kind; "" without a header, which alone tells one kind from another."""
        return "|".join((self.delimiter, self.decimal, *self.names)) if self.has_header else ""


@dataclass(frozen=True)
class _Reading:
    """The lines as one pair of delimiter and decimal sign cuts them."""

    delimiter: str
    decimal: str
    rows: list[tuple[int, list[str]]]  # line number and cells of each row of numbers
    score: tuple[float, int]


def read_layout(head: bytes, whole: bool = False) -> Layout:
    """The layout of a file from its first bytes; ``whole``: they are all there is. Raises TableError."""
    lines = _lines(head, whole)
    readings = [_read(lines, delimiter, decimal) for delimiter, decimal in product(DELIMITERS, ".,")]
    best = max((reading for reading in readings if reading), key=lambda reading: reading.score, default=None)
    if best is None or len(best.rows) < ENOUGH_ROWS:
        raise TableError("no table: there are no lines of numbers under each other")
    first, cells = best.rows[0]
    width = len(cells)
    above = lines[:first]
    rows = [row for _, row in best.rows if len(row) == width][:MOST_ROWS]
    return Layout(
        best.delimiter,
        best.decimal,
        first,
        _names(above, best.delimiter, width),
        tuple(line for line in above if line.strip()),
        tuple(map(tuple, rows)),
        np.array([[_value(cell, best.decimal) for cell in row] for row in rows]),
        float(np.mean([len(lines[number]) + 2 for number, _ in best.rows])),
    )


def cells_of(line: str, delimiter: str) -> list[str]:
    """The cells of one line, without blanks and quotes around them."""
    if delimiter == " ":
        return [cell.strip('"') for cell in line.split()]
    return [cell.strip().strip('"') for cell in line.split(delimiter)]


def _lines(head: bytes, whole: bool) -> list[str]:
    for magic, words in _MAGIC.items():
        if head.startswith(magic):
            raise TableError(words)
    if not head.strip():
        raise TableError("the file is empty" if whole else "the file begins with nothing but blanks")
    if b"\0" in head:
        raise TableError("no text: it holds binary data")
    try:
        text = head.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        # a character cut at the end is no reason to take another encoding
        cut = not whole and error.start > len(head) - 4
        text = head[: error.start].decode("utf-8-sig") if cut else head.decode("latin-1")
    lines = text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
    return lines if whole or len(lines) == 1 else lines[:-1]


def _read(lines: Sequence[str], delimiter: str, decimal: str) -> _Reading | None:
    """The rows of numbers under one pair of signs, most of which have the same width."""
    if delimiter == decimal:
        return None
    number = _CELL[decimal]
    rows: list[tuple[int, list[str]]] = []
    for index, line in enumerate(lines):
        cells = cells_of(line, delimiter)
        if len(cells) > 1 and _is_row(cells, number):
            rows.append((index, cells))
    if not rows:
        return None
    width, _ = Counter(len(cells) for _, cells in rows).most_common(1)[0]
    begin = next(k for k, (_, cells) in enumerate(rows) if len(cells) == width)
    rows = rows[begin:]
    good = [cells for _, cells in rows if len(cells) == width]
    written = sum(bool(cell) for cells in good for cell in cells)
    numeric = sum(bool(cell and number.fullmatch(cell)) for cells in good for cell in cells)
    share = len(good) / max(1, sum(bool(line.strip()) for line in lines[rows[0][0] :]))
    return _Reading(delimiter, decimal, rows, (round(share * numeric / max(1, written), 2), width))


def _is_row(cells: Sequence[str], number: re.Pattern[str]) -> bool:
    """Whether a line holds numbers: two at least, and half of what is written."""
    written = [cell for cell in cells if cell]
    numeric = sum(number.fullmatch(cell) is not None for cell in written)
    return numeric >= 2 and 2 * numeric >= len(written)


def _value(cell: str, decimal: str) -> float:
    if not cell or not _CELL[decimal].fullmatch(cell):
        return np.nan
    return float(cell.removesuffix(" sec").replace(decimal, ".") or "nan")


def _names(above: Sequence[str], delimiter: str, width: int) -> tuple[str, ...]:
    """Names for the columns from the lines above the numbers, where the last one may hold the units."""
    headers = [_header_cells(line, delimiter, width) for line in above if line.strip()][-HEADER_LINES:]
    last = headers[-1] if headers else None
    if last is None:
        return ("",) * width
    before = next((names for names in reversed(headers[:-1]) if names and not _are_units(names)), None)
    if before and _are_units(last):
        pairs = zip(before, (cell.strip("()[]{} ") for cell in last), strict=True)
        return tuple(f"{name} ({unit})" if unit else name for name, unit in pairs)
    return tuple(last)


def _header_cells(line: str, delimiter: str, width: int) -> list[str] | None:
    """The cells of a line that can be a header: as many as there are columns, most of them no numbers."""
    text = line.strip("\r\n").lstrip("#% ") if line.lstrip()[:1] in ("#", "%") else line
    cells = text.split() if delimiter == " " else next(csv.reader([text], delimiter=delimiter, skipinitialspace=True))
    cells = [cell.strip().strip('"') for cell in cells]
    if len(cells) == width + 1 and not cells[-1]:
        cells.pop()
    cells += [""] * (width - len(cells)) * (len(cells) == width - 1)
    words = sum(bool(cell) and not _CELL["."].fullmatch(cell) for cell in cells)
    return cells if len(cells) == width and 2 * words >= width else None


def _are_units(cells: Sequence[str]) -> bool:
    known = [plain_unit(cell.strip("()[]{} ")) in _UNIT_WORDS for cell in cells if cell]
    return bool(known) and 3 * sum(known) >= 2 * len(known)
