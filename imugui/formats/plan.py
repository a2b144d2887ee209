"""How a file will be opened: by a board's format, or as a foreign table through column maps."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from pathlib import Path

from imugui.formats.base import Decoder, Options
from imugui.formats.column_map import ColumnMap
from imugui.formats.columns import read_name
from imugui.formats.csv_line import CsvLineEncoder
from imugui.formats.detector import detect_file
from imugui.formats.evidence import scale
from imugui.formats.guess import Guess, TableGuess, belonging_files, guess_files
from imugui.formats.layout import TableError
from imugui.formats.table import Watch, read_table, refuse_too_long
from imugui.formats.units import SURE, UNSURE
from imugui.samples import Rows

CSV = "csv-line"
ASK = "name the columns, in the window or with --columns"


@dataclass(frozen=True)
class Plan:
    """What a file is: ``format`` reads it by itself, or, with "", ``maps`` do. ``guess`` is what they rest on."""

    format: str
    maps: tuple[ColumnMap, ...] = ()
    guess: Guess | None = None  # None: nothing is guessed

    @property
    def needs_asking(self) -> bool:
        """Whether a person should look at the columns before the file is opened."""
        return self.guess is not None and (bool(self.guess.problem) or self.guess.level == UNSURE)


def plan_file(path: Path, options: Options | None = None) -> Plan:
    """Look at the beginning of a file, or of the tables of a folder. Raises OSError; TableError in words."""
    options = options or Options()
    if path.is_dir():
        return _plan_table(guess_files(belonging_files(path)), options)
    found = detect_file(path)
    if found.format not in ("", CSV):
        return Plan(found.format)
    refuse_too_long(path)
    try:
        guess = guess_files(belonging_files(path))
    except TableError as error:
        if found.format:
            return Plan(found.format)
        raise TableError(f"{found.sentence}; {error}" if found.kind == "text" else str(error)) from error
    if found.format and guess.tables[0].layout.names[: len(CsvLineEncoder.IMU)] == CsvLineEncoder.IMU:
        return Plan(found.format)  # imugui's own
    plan = _plan_table(guess, options)
    # what its header says in full needs no map, and its columns may even change on the way
    by_itself = found.kind == "format" and plan.guess and len(plan.maps) == 1 and guess.level == SURE
    return Plan(CSV) if by_itself and _is_as_named(guess.used[0]) else plan


def read_foreign(
    path: Path, options: Options, rate_hz: float = 0.0, watch: Watch | None = None
) -> tuple[Rows, Decoder] | str:
    """The rows of a foreign table and what was found in it, or the name of the format that reads the file by itself.

    ``rate_hz`` and ``watch`` as in read_table. Raises OSError, and TableError in words that name what has no place.
    """
    plan = Plan("", options.tables) if options.tables else plan_file(path, options)
    if plan.format:
        return plan.format
    if plan.guess and plan.guess.problem:
        raise TableError(f"{plan.guess.problem}: {ASK}")
    assumed = f"; assumed: {plan.guess.assumed}" if plan.guess and plan.guess.assumed else ""
    try:
        rows, decoder = read_table(path, plan.maps, options.family, rate_hz, watch)
    except TableError as error:
        raise TableError(f"{error}{assumed}") from error
    decoder.seen += assumed
    return rows, decoder


def _plan_table(guess: Guess, options: Options) -> Plan:
    """The columns as a person named them, or as guessed."""
    if not options.columns:
        return Plan("", guess.maps, guess)
    column_map = dataclasses.replace(guess.tables[0].column_map, columns=options.columns)
    width = guess.tables[0].layout.width
    if len(options.columns) != width:
        raise TableError(
            f"{len(options.columns)} columns are named, the file has {width}: name each one, an empty name skips it"
        )
    if column_map.problem:
        raise TableError(f"the columns as they are named: {column_map.problem}")
    return Plan("", (column_map,))


def _is_as_named(table: TableGuess) -> bool:
    """Whether csv-line would read the same from the header line."""
    for name, guessed in zip(table.layout.names, table.columns, strict=True):
        column = read_name(name)
        plain = (column.slot, column.factor) if column else ("", None)
        factor = scale(guessed.slot, guessed.unit) if guessed.unit else 1.0
        if plain != ((guessed.slot, factor) if guessed.slot else ("", None)):
            return False
    return True
