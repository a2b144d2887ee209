"""What the user once said of a board (columns, units, sensor family), kept under the board's identity."""

from __future__ import annotations

import dataclasses
from pathlib import Path

from imugui.formats.families import FAMILIES
from imugui.views.settings_store import SettingsStore
from imugui.views.source_box import Choice
from imugui.workers.session import Options, Port

LOOK_BYTES = 4096


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
    return Options(
        family=kept["family"] if kept.get("family") in FAMILIES else "",
        columns=tuple(columns) if named else (),
        delimiter=kept["delimiter"] if isinstance(kept.get("delimiter"), str) else "",
    )


def first_lines(path: Path) -> list[str]:
    """The first lines of a file as text; none when it cannot be read."""
    try:
        with path.open("rb") as stream:
            return stream.read(LOOK_BYTES).decode("latin-1").splitlines()[:-1]
    except OSError:
        return []


def keep_options(settings_store: SettingsStore, board: str, options: Options) -> None:
    """Remember what was said of this board."""
    settings_store.keep_board(board, dataclasses.asdict(options) | {"columns": list(options.columns)})
