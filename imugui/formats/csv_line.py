"""csv-line: lines of numbers separated by comma, tab, semicolon or blanks, with a header line or named columns.

The header may carry units in brackets or after the last underscore (columns.py); without units SI is taken and
``seen`` says so. ``#`` and ``%`` lines are comments. An empty value is NaN. A decimal comma is accepted only where
semicolons separate the columns; elsewhere it is refused with a reason.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from operator import mul

from imugui.formats.base import Encoder, Options
from imugui.formats.column_map import ColumnMap
from imugui.formats.columns import POSITION, STATUS, Table, table_from
from imugui.formats.csv_block import rows_of
from imugui.formats.families import family
from imugui.formats.lines import MAX_LINE, LineDecoder, readable
from imugui.formats.values import (
    DIGITS,
    LETTERS,
    NAN,
    NUMBER_CHARS,
    GravityWatch,
    how_many,
    number,
)
from imugui.samples import NO_STATUS, Rows

FAMILY = "aligned"
RATE_HZ = 100.0
DELIMITERS = (b",", b";", b"\t", b" ")
EXPONENT_NUMBER_CHARS = NUMBER_CHARS + b"eE"
PADDED_NUMBER_CHARS = EXPONENT_NUMBER_CHARS + b" "
BYTE_ORDER_MARK = b"\xef\xbb\xbf"
REPLACED = ((b" sec", b""), (b",", b"."))
"""In files with a column map: the unit that MATLAB's timetables write after each time; decimal commas."""
LONGEST_HEADER = 1000  # bytes
LARGE = 1 << 14  # bytes of a piece whose lines are tried at once
HEADER_NAMES = 3  # so many known names make a line a header
NO_HEADER = "numbers without a header line: name the columns and units once"

_DATE = re.compile(rb"\d+[-:/]\d+[-:/]\d+.*")
_DECIMAL_COMMA = re.compile(rb"[+-]?\d+,\d+(?:[eE][+-]?\d+)?")


def split(line: bytes, delimiter: bytes) -> list[bytes]:
    """The tokens of a line; any run of blanks is one delimiter when the delimiter is a blank."""
    return line.split() if delimiter == b" " else line.split(delimiter)


class CsvLineDecoder(LineDecoder):
    """Reads ``csv-line`` tables."""

    SEPARATORS = b",;\t "

    def __init__(self, options: Options, column_map: ColumnMap | None = None) -> None:
        """``column_map``: how a file is written, and what its columns mean; some sensors may then be missing."""
        super().__init__()
        self._mag_axes = family(options.family, FAMILY).mag_axes
        self._named = options.columns
        self._delimiters = (options.delimiter.encode(),) if options.delimiter else DELIMITERS
        self._table: Table | None = None
        self._number_chars = PADDED_NUMBER_CHARS
        self._watch = GravityWatch()
        self._replaced: tuple[tuple[bytes, bytes], ...] = ()
        self._kept: tuple[int, float] | None = None
        self.seen = "no header line yet"
        self.rate_hz = RATE_HZ
        if column_map:
            self._follow(column_map)

    @property
    def table(self) -> Table | None:
        """How lines become rows, once that is known."""
        return self._table

    def feed(self, chunk: bytes, t: float) -> Rows:
        """The SAMPLE rows, shape (n,), that ``chunk`` completes; t is its host arrival time, s."""
        for old, new in self._replaced:
            chunk = chunk.replace(old, new)
        rows = self._at_once(chunk, t) if len(chunk) >= LARGE else None
        if rows is None:
            return super().feed(chunk, t)
        self._packed += rows.tobytes()
        return self._collect()

    def _at_once(self, chunk: bytes, t: float) -> Rows | None:
        """The rows of a piece of a file when all of its lines are as usual; None, and nothing is changed, when not."""
        table = self._table
        watched = table is not None and table.force == "total" and not self._watch.trusted
        if table is None or table.problem or watched or self._kept or self._skipped or self._may_be_cut:
            return None
        text = self._pending + chunk
        end = text.rfind(b"\n") + 1
        if end == 0 or len(text) - end > MAX_LINE:
            return None
        rows = rows_of(table, text[:end], self._number_chars, None if self.has_time else t, t)
        if rows is not None:
            self._t, self._pending = t, text[end:]
            self._between_lines = not self._pending
            self.counts.bytes += len(chunk)
        return rows

    def _follow(self, column_map: ColumnMap) -> None:
        self._named = column_map.columns
        self._replaced = REPLACED if column_map.decimal == "," else REPLACED[:1]
        if column_map.keep_column >= 0:
            self._kept = column_map.keep_column, column_map.keep_value
        self.partial = True
        self.rate_hz = column_map.rate_hz or RATE_HZ
        self._adopt(table_from(self._named, column_map.delimiter.encode(), self._mag_axes, partial=True))

    def _line(self, line: bytes) -> None:
        table = self._table
        if table is None or table.problem or line.translate(None, self._number_chars) != table.shape:
            self._unusual(line)
            return
        try:
            values = [float(token) if token else NAN for token in line.split(table.delimiter)]
        except ValueError:
            self._unusual(line)
            return
        self._accept(table, values, line)

    def _accept(self, table: Table, values: list[float], line: bytes) -> None:
        if self._kept and values[self._kept[0]] != self._kept[1]:
            return
        if table.factors:
            values = list(map(mul, values, table.factors))
        for place, added in table.sums:
            values[place] += values[added]
        values += (NAN, NO_STATUS)
        place = table.indices[STATUS]
        status = values[place]
        if abs(status) > 32767:
            self._bad("impossible status", line)
            return
        values[place] = int(status) if status == status else NO_STATUS
        picked = table.pick(values)
        if self.has_time and not abs(picked[0]) < 1e18:
            self._bad("no time", line)
            return
        reason = self._emit(*picked) if self.has_time else self._emit(self._t, *picked[1:])
        if reason:
            self._bad(reason, line)
        elif not self._watch.trusted and table.force == "total" and self._watch.update(*picked[4:7]):
            self.seen = f"{table.words} {self._watch.doubt}".strip()
            self._note(self.seen)

    def _unusual(self, line: bytes) -> None:
        """Headers, comments, lines with nan or quotes, and everything that is not data."""
        line = line.removeprefix(BYTE_ORDER_MARK)
        if line.lstrip().startswith((b"#", b"%")):
            if self._table or not self._header(line.lstrip().lstrip(b"#% "), whole=True):
                self._chatter(line)
            return
        if self._table is None and self._named:
            self._use_named(line)
        values, reason = self._values(self._table, line) if self._table else (None, self._no_table())
        if values is not None and self._table:
            self._accept(self._table, values, line)
        elif not self._header(line):
            is_data = self._not_data(line, reason)
            if is_data and self._table is None:
                self.seen = self._no_table()

    def _no_table(self) -> str:
        return f"{len(self._named)} columns are named, the lines have another number" if self._named else NO_HEADER

    def _values(self, table: Table, line: bytes) -> tuple[list[float] | None, str]:
        """The numbers of a line, or None and why there are none."""
        if table.problem:
            return None, table.problem
        tokens = [token.strip().strip(b'"') for token in split(line, table.delimiter)]
        if table.delimiter == b";":
            tokens = [token.replace(b",", b".") if _DECIMAL_COMMA.fullmatch(token) else token for token in tokens]
        if len(tokens) == table.width + 1 and not tokens[-1]:
            tokens.pop()
        if len(tokens) != table.width:
            return None, f"{len(tokens)} values for {table.width} columns{_comma_hint(table, tokens)}"
        fresh = not self._packed and not self.counts.messages
        if fresh and self.has_time and _DATE.fullmatch(tokens[table.indices[0]]):
            table = self._table = table.without_time()
            self.has_time, self.seen = False, table.words
            self._note(f"the time column holds dates, the time of arrival is used: {self._text(line)}")
        values = [number(token) if token else NAN for token in tokens]
        if any(value is None and index in table.indices for index, value in enumerate(values)):
            return None, f"malformed{_comma_hint(table, tokens)}"
        return [NAN if value is None else value for value in values], ""

    def _header(self, line: bytes, whole: bool = False) -> bool:
        """Whether the line names columns; if so the table is taken over (``whole``: only when it can be used)."""
        letters = how_many(line, LETTERS)
        if len(line) > LONGEST_HEADER or letters < HEADER_NAMES or 2 * letters < how_many(line, DIGITS):
            return False
        text = readable(line) or line.decode("latin-1")
        whole |= readable(line) is None  # units such as a degree sign of another encoding
        tables = [self._table_of(text, delimiter) for delimiter in self._delimiters]
        best = max(tables, key=lambda table: len(table.used))
        few = len(best.used) < max(HEADER_NAMES, best.width / 3)  # a sentence may hold a name or two
        if best.problem and (whole or few):
            return False
        self._chatter(line)
        if not self._named:
            self._adopt(best)
        return True

    def _table_of(self, text: str, delimiter: bytes) -> Table:
        names = text.split() if delimiter == b" " else text.split(delimiter.decode())
        return table_from(names, delimiter, self._mag_axes)

    def _use_named(self, line: bytes) -> None:
        """Take the user's columns into use with the delimiter that cuts this line into as many values."""
        for delimiter in self._delimiters:
            if len(split(line, delimiter)) == len(self._named):
                self._adopt(table_from(self._named, delimiter, self._mag_axes))
                return

    def _adopt(self, table: Table) -> None:
        if self._table == table:
            return
        if self._table:
            self._note("the columns changed")
        self._table = table
        self._number_chars = EXPONENT_NUMBER_CHARS if table.delimiter == b" " else PADDED_NUMBER_CHARS
        self._watch = GravityWatch()
        self.has_time = "t" in table.used
        self.seen = f"{table.words}: {table.problem}" if table.problem else table.words
        self._note(self.seen)


def _comma_hint(table: Table, tokens: Sequence[bytes]) -> str:
    many = table.delimiter == b"," and len(tokens) == 2 * table.width
    if many or any(_DECIMAL_COMMA.fullmatch(token) for token in tokens):
        return " (decimal commas? export with points, or with semicolons between the columns)"
    return ""


class CsvLineEncoder(Encoder):
    """Writes DESIGN's sample table, every number with all its digits; positions as soon as a row has one."""

    IMU = ("t", "ax", "ay", "az", "gx", "gy", "gz", "mx", "my", "mz", "temp_c", "status")

    def __init__(self, with_position: bool = False) -> None:
        self._with_position = with_position

    def preamble(self) -> bytes:
        """The header line."""
        names = self.IMU + POSITION if self._with_position else self.IMU
        return (",".join(names) + "\r\n").encode()

    def encode(self, rows: Rows) -> bytes:
        """One line for each row; a new header line where the first position appears."""
        header = b""
        if not self._with_position and (rows["lat"] == rows["lat"]).any():
            self._with_position = True
            header = self.preamble()
        status = ["" if value == NO_STATUS else str(value) for value in rows["status"].tolist()]
        imu = [rows["t"], *rows["acc"].T, *rows["gyr"].T, *rows["mag"].T, rows["temp_c"]]
        columns = [_texts(column) for column in imu] + [status]
        if self._with_position:
            columns += [_texts(rows[name]) for name in POSITION]
        return header + "".join(",".join(words) + "\r\n" for words in zip(*columns, strict=True)).encode()


def _texts(column: Rows) -> list[str]:
    """Numbers with all their digits, so that they come back the same; empty for NaN."""
    return [repr(value) if value == value else "" for value in column.tolist()]
