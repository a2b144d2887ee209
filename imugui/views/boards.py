"""What the user once said of a board (columns, units, sensor family), kept under the board's identity."""

from __future__ import annotations

import re
from collections.abc import Sequence

from imugui.formats.column_map import from_json
from imugui.formats.families import FAMILIES
from imugui.views.settings_store import SettingsStore
from imugui.views.source_box import Choice
from imugui.workers.session import Options, Port

FEWEST = 3  # values that make a line of numbers
_NUMBERS = re.compile(r"[-+0-9.][-+0-9.eE,;\t ]*$")


def identity(choice: Choice, ports: list[Port]) -> str:
    """The same for the same board at the same port, and for the same file."""
    port = next((port for port in ports if port.device == choice.address), None)
    about = f"{port.hint or port.description}" if port and choice.transport == "serial" else ""
    return " ".join(filter(None, (choice.transport, choice.address, about)))


def kept_options(settings_store: SettingsStore, board: str) -> Options:
    """What was said of this board; anything that makes no sense is left out."""
    kept = settings_store.store.boards.get(board, {})
    columns = kept.get("columns", [])
    named = isinstance(columns, list) and all(isinstance(name, str) for name in columns)
    kept_tables = kept.get("tables", [])
    tables = [from_json(values) for values in kept_tables] if isinstance(kept_tables, list) else []
    return Options(
        family=kept["family"] if kept.get("family") in FAMILIES else "",
        columns=tuple(columns) if named else (),
        delimiter=kept["delimiter"] if isinstance(kept.get("delimiter"), str) else "",
        tables=tuple(table for table in tables if table) if None not in tables else (),
    )


def bare_lines(texts: Sequence[str]) -> list[str]:
    """The lines of numbers in entries of the link log, which put a reason before them."""
    found = (_NUMBERS.search(text) for text in texts)
    return [match[0] for match in found if match and len(re.split(r"[,;\s]+", match[0].strip())) >= FEWEST]


def keep_options(settings_store: SettingsStore, board: str, options: Options) -> None:
    """Remember what was said of this board."""
    tables = [table.to_json() for table in options.tables]
    values = {"family": options.family, "columns": list(options.columns), "delimiter": options.delimiter}
    settings_store.keep_board(board, values | ({"tables": tables} if tables else {}))
