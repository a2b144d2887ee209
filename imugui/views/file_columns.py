"""What is known of the columns of a file before it is opened: what was said of it or its like, else a guess."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from imugui.formats.column_map import ColumnMap
from imugui.formats.columns import MAP_NAMES, read_name
from imugui.formats.guess import Guess, belonging_files, guess_files
from imugui.formats.layout import HEAD, Layout, TableError, read_layout
from imugui.formats.plan import Plan, plan_file
from imugui.formats.preview import preview
from imugui.formats.table import part_path
from imugui.recording import is_recording
from imugui.views.boards import keep_options, kept_options
from imugui.views.settings_store import SettingsStore
from imugui.workers.session import Options

NOTHING_SAID = Options()
NEEDED = {"no accelerometer": {"ax"}, "no gyroscope": {"gx"}}
"""What an attitude takes, and what to call its absence."""


@dataclass(frozen=True)
class Opening:
    """How a file is opened: with these options at once, or only after a person has looked at the columns."""

    options: Options
    asks: bool = False
    words: str = ""  # what was assumed or remembered, "" when there is nothing to say
    tone: str = "info"  # or "warn"


class FileColumns:
    """Remembers files that were picked together, and what was said of files with the same header."""

    def __init__(self, settings_store: SettingsStore) -> None:
        self._settings_store = settings_store
        self._together: dict[str, list[Path]] = {}

    def pick(self, paths: Sequence[str]) -> None:
        """Take files that were picked together; the first stands for all."""
        self._together[paths[0]] = [Path(path) for path in paths]

    def opening(self, address: str, said: Options) -> Opening:
        """How to open a file of which ``said`` was said before; what cannot be read is left to whoever opens it."""
        path = Path(address)
        if said != NOTHING_SAID or not _is_plain(path):
            return _with_warning(Opening(said), said.tables)
        try:
            remembered = self._of_its_kind(path)
            if remembered != NOTHING_SAID:
                words = "its columns are read as you named them for a file like it"
                return _with_warning(Opening(remembered, words=words), remembered.tables)
            plan = self._plan(path)
        except (TableError, OSError):
            return Opening(said)
        if plan.needs_asking:
            return Opening(said, asks=True)
        together = len(self._together.get(address, [])) > 1
        assumed = f"it is assumed: {plan.guess.assumed}" if plan.guess and plan.guess.assumed else ""
        return _with_warning(Opening(Options(tables=plan.maps) if together else said, words=assumed), plan.maps)

    def guess(self, address: str) -> Guess:
        """The guess for a file and those that belong to it. Raises TableError, OSError."""
        path = Path(address)
        return guess_files(self._together.get(address) or belonging_files(path))

    def keep(self, address: str, options: Options) -> None:
        """Remember what a person says, for other files with the same header."""
        kind = _kind_of(Path(address)) if options.tables else ""
        if kind:
            keep_options(self._settings_store, kind, options)

    def _plan(self, path: Path) -> Plan:
        files = self._together.get(str(path), [])
        if len(files) < 2:
            return plan_file(path)
        guess = guess_files(files)
        return Plan("", guess.maps, guess)

    def _of_its_kind(self, path: Path) -> Options:
        """What was said of a file with the same header, if all the files it is about are here too."""
        kind = _kind_of(path)
        kept = kept_options(self._settings_store, kind) if kind else NOTHING_SAID
        files = [part_path(path, table) for table in kept.tables]
        if not files or not all(file.is_file() for file in files):
            return NOTHING_SAID
        # an equal header may hide other units
        tables = [(_layout_of(file), table) for file, table in zip(files, kept.tables, strict=True)]
        return NOTHING_SAID if preview(tables).contradicts else kept


def _with_warning(opening: Opening, maps: Sequence[ColumnMap]) -> Opening:
    """Say that there will be no attitude, where tables lack what it takes."""
    slots = {column.slot for one in maps for name in one.columns if (column := read_name(name, MAP_NAMES))}
    if {"linx", "gravx"} <= slots:
        slots.add("ax")
    lacks = [words for words, needed in NEEDED.items() if slots and not needed <= slots]
    if not lacks:
        return opening
    warning = f"there is {' and '.join(lacks)} in it: its signals can be looked at, but no attitude can be computed"
    return replace(opening, words="; ".join(filter(None, (warning, opening.words))), tone="warn")


def _is_plain(path: Path) -> bool:
    """Whether it can be looked at without waiting: a file or a folder, but no recording and no device."""
    return not is_recording(path) and (path.is_file() or path.is_dir())


def _kind_of(path: Path) -> str:
    """The key for files with the same header; "" where there is none."""
    if not path.is_file():
        return ""
    try:
        layout = _layout_of(path)
    except (TableError, OSError):
        return ""
    digest = hashlib.sha256(layout.signature.encode()).hexdigest()[:16]
    return f"table {digest} {' '.join(layout.names)[:60]}" if layout.signature else ""


def _layout_of(path: Path) -> Layout:
    with path.open("rb") as stream:
        return read_layout(stream.read(HEAD))
