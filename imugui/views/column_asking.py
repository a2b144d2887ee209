"""Asking for columns: the dialog for a file or for a board, filled with what was said before or is guessed."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from pathlib import Path

from PySide6.QtWidgets import QWidget

from imugui.formats.column_map import ColumnMap
from imugui.formats.guess import Guess, TableGuess, guess
from imugui.formats.layout import read_layout
from imugui.formats.sheet import Sheet
from imugui.views.column_map_dialog import ColumnMapDialog
from imugui.views.column_table import said_before
from imugui.views.file_columns import FileColumns
from imugui.workers.session import Options


def dialog_for_file(files: FileColumns, address: str, said: Options, parent: QWidget | None = None) -> ColumnMapDialog:
    """The dialog for a file and those that belong to it, as said before or as guessed. TableError, OSError."""
    guess = files.guess(address)
    tables = tuple(_as_said_before(table, _map_of(table, said.tables)) for table in guess.tables)
    return ColumnMapDialog(Guess(tables), Path(address).name, said.family, parent=parent)


def dialog_for_board(lines: Sequence[str], name: str, said: Options, parent: QWidget | None = None) -> ColumnMapDialog:
    """The dialog for the lines that a board sent. Raises TableError when there are none to name."""
    guessed = guess([Sheet("", read_layout("\n".join([*lines, ""]).encode(), whole=True))])
    columns = ColumnMap(said.columns) if len(said.columns) == guessed.tables[0].layout.width else None
    tables = (_as_said_before(guessed.tables[0], columns),)
    return ColumnMapDialog(Guess(tables), name, said.family, of_board=True, parent=parent)


def _map_of(table: TableGuess, maps: Sequence[ColumnMap]) -> ColumnMap | None:
    """What was said of a table before, if its columns still are as many."""
    fits = [one for one in maps if one.file == table.file and len(one.columns) == table.layout.width]
    return fits[0] if fits else None


def _as_said_before(table: TableGuess, column_map: ColumnMap | None) -> TableGuess:
    """A table as a person named it before; without that as it is."""
    if column_map is None:
        return table
    keep = (column_map.keep_column, column_map.keep_value) if column_map.keep_column >= 0 else None
    columns = tuple(said_before(name) for name in column_map.columns)
    return dataclasses.replace(table, columns=columns, keep=keep, rate_hz=column_map.rate_hz)
