"""Guessing a foreign table: which column is what, in which unit, how sure that is, and why in words."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from imugui.formats.column_map import ColumnMap
from imugui.formats.columns import ACC, GRAVITY_PART, GYR, LINEAR, MAG
from imugui.formats.layout import HEAD, Layout, TableError, read_layout
from imugui.formats.placing import ColumnGuess, Placing
from imugui.formats.sheet import Sheet
from imugui.formats.spelling import SENSOR_WORDS, words_of
from imugui.formats.table import ONLY_GRAVITY, ONLY_LINEAR
from imugui.formats.units import SURE, Guessed, worst

MOST_FILES = 16  # of one folder that are looked at
FARTHEST_START_S = 600.0  # between tables of one recording
ESSENTIAL = {*ACC, *GYR, *MAG, *LINEAR, *GRAVITY_PART, "t"}
SENSORS = {"ax": "accelerometer", "linx": "linear acceleration", "gravx": "gravity", "gx": "gyroscope",
           "mx": "magnetometer", "t": "time"}  # fmt: skip


@dataclass(frozen=True)
class TableGuess:
    """One table with a guess for each column, and for its rate where it has no times."""

    file: str
    layout: Layout
    columns: tuple[ColumnGuess, ...]
    keep: tuple[int, float] | None = None
    rate_hz: float = 0.0  # 0: it has times
    rate: Guessed = field(default_factory=lambda: Guessed("Hz", SURE, "from its times"))

    @property
    def is_used(self) -> bool:
        """Whether anything but its time is read."""
        return any(column.slot not in ("", "t") for column in self.columns)

    @property
    def column_map(self) -> ColumnMap:
        """The guess as it would be used."""
        keep_column, keep_value = self.keep or (-1, 0.0)
        names = tuple(column.name for column in self.columns)
        layout = self.layout
        return ColumnMap(names, layout.delimiter, layout.decimal, layout.skip_lines, keep_column, keep_value,
                         self.rate_hz, self.file)  # fmt: skip


@dataclass(frozen=True)
class Guess:
    """One table, or several that belong together; the opened one first."""

    tables: tuple[TableGuess, ...]

    @property
    def used(self) -> tuple[TableGuess, ...]:
        """The tables that something is read from."""
        return tuple(table for table in self.tables if table.is_used)

    @property
    def maps(self) -> tuple[ColumnMap, ...]:
        """Column maps of the tables that something is read from."""
        return tuple(table.column_map for table in self.used)

    @property
    def slots(self) -> set[str]:
        """Everything that was found."""
        return {column.slot for table in self.used for column in table.columns}

    @property
    def level(self) -> str:
        """How far the guess as a whole can be trusted: as its weakest sensor or time base."""
        columns = [column.level for table in self.used for column in table.columns if column.slot in ESSENTIAL]
        return worst([*columns, *(table.rate.level for table in self.used)])

    @property
    def problem(self) -> str:
        """Why nothing can be read, in words; "" when something can."""
        slots = self.slots
        if not slots & {"ax", "gx", "mx", "linx", "gravx"}:
            names = [name for table in self.tables for name in table.layout.names if name]
            seen = f"names its columns {', '.join(names[:12])}" if names else "has no line with names"
            return f"no sensor's three axes were recognised; the table {seen}"
        whole = "ax" in slots or {"linx", "gravx"} <= slots
        return "" if whole or not slots & {"linx", "gravx"} else ONLY_LINEAR if "linx" in slots else ONLY_GRAVITY

    @property
    def assumed(self) -> str:
        """What is not written in the file, in words; "" when all is."""
        said = []
        for table in self.used:
            for column in table.columns:
                if column.slot in SENSORS and column.level != SURE:
                    said.append(f"{SENSORS[column.slot]} in {column.unit} ({column.reason})")
            if table.rate.level != SURE:
                said.append(f"{table.rate_hz:g} Hz ({table.rate.reason})")
        return "; ".join(said)


def guess_files(paths: Sequence[Path]) -> Guess:
    """Guess files that are read as one, the opened one first. Raises OSError; TableError about the first one."""
    sheets: list[Sheet] = []
    for path in paths[:MOST_FILES]:
        with path.open("rb") as stream:
            head = stream.read(HEAD + 1)
        try:
            layout = read_layout(head[:HEAD], whole=len(head) <= HEAD)
        except TableError:
            if not sheets and path == paths[-1]:
                raise
            continue
        sheets.append(Sheet(path.name, layout))
    if not sheets:
        raise TableError("none of the files is a table of numbers")
    return guess(sheets)


def belonging_files(path: Path) -> list[Path]:
    """The file itself with those beside it that are named alike but for a sensor's word; of a folder, its tables."""
    if path.is_dir():
        return sorted(file for file in path.iterdir() if file.suffix.lower() in (".csv", ".txt"))[:MOST_FILES]
    words = words_of(path.stem)
    common = [word for word in words if word not in SENSOR_WORDS]
    if len(common) == len(words):
        return [path]
    others = sorted(file for file in path.parent.glob(f"*{path.suffix}") if file != path and file.is_file())
    alike = [file for file in others if [word for word in words_of(file.stem) if word not in SENSOR_WORDS] == common]
    return [path, *alike][:MOST_FILES]


def guess(sheets: Sequence[Sheet]) -> Guess:
    """Guess tables that belong together, the opened one first."""
    sheets = _of_one_time(sheets)
    found = Placing(sheets)
    tables = []
    for number, sheet in enumerate(sheets):
        columns = tuple(found.column(number, column) for column in range(sheet.layout.width))
        used = any(column.slot for column in columns)
        rate_hz, rate = found.rate(sheet) if used and sheet.time is None else (0.0, Guessed("Hz", SURE, "from times"))
        tables.append(
            TableGuess(sheet.file if len(sheets) > 1 else "", sheet.layout, columns, sheet.keep, rate_hz, rate)
        )
    return Guess(tuple(tables))


def _of_one_time(sheets: Sequence[Sheet]) -> list[Sheet]:
    """Without those that have no time, or were begun at another time than the first."""
    first = sheets[0].seconds
    if len(sheets) == 1 or first is None:
        return [sheets[0]]
    starts = [math.nan if sheet.seconds is None else sheet.seconds[0] - first[0] for sheet in sheets]
    return [sheet for sheet, start in zip(sheets, starts, strict=True) if abs(start) < FARTHEST_START_S]
