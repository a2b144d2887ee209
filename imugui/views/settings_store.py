"""SettingsStore: what the program remembers, held for the whole window, in its file a moment after a change."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import Any

from PySide6.QtCore import QObject, QTimer, Signal, Slot

from imugui.settings import Settings, Store, load, save

SAVE_DELAY_MS = 400  # dragging a number writes the file once, not a hundred times


class SettingsStore(QObject):
    """``store`` is replaced whole on each change; ``changed`` follows at once, the file after a short pause."""

    changed = Signal()
    failed = Signal(str)  # the file cannot be written; said once until it works again

    def __init__(self, path: Path | None = None) -> None:
        """Read the file; with None the defaults are taken and nothing is written."""
        super().__init__()
        self.store, self.problems = load(path) if path else (Store(), [])
        self._path = path
        self._unsaved = False
        self._said = False
        self._timer = QTimer(self)
        self._timer.setSingleShot(True)
        self._timer.setInterval(SAVE_DELAY_MS)
        self._timer.timeout.connect(self.flush)

    @property
    def settings(self) -> Settings:
        """The settings as they are now."""
        return self.store.settings

    @property
    def path(self) -> Path | None:
        """The file, or None."""
        return self._path

    def update(self, **changes: Any) -> None:
        """Change settings by name; raises TypeError on a name that is none."""
        self._take(dataclasses.replace(self.store, settings=dataclasses.replace(self.store.settings, **changes)))

    def keep_filter(self, name: str, values: dict[str, Any]) -> None:
        """Remember a filter's parameters."""
        self._take(dataclasses.replace(self.store, filters=self.store.filters | {name: values}))

    def keep_board(self, identity: str, values: dict[str, Any]) -> None:
        """Remember what the user said of one board."""
        self._take(dataclasses.replace(self.store, boards=self.store.boards | {identity: values}))

    @Slot()
    def flush(self) -> None:
        """Write the file now if anything changed."""
        self._timer.stop()
        if self._path is None or not self._unsaved:
            return
        try:
            save(self._path, self.store)
        except OSError as error:
            self._complain(error)
            return
        self._unsaved = False
        self._said = False

    def _take(self, store: Store) -> None:
        if store == self.store:
            return
        self.store = store
        self._unsaved = True
        self._timer.start()
        self.changed.emit()

    def _complain(self, error: OSError) -> None:
        if self._said:
            return
        self._said = True
        where = self._path.parent if self._path else ""
        why = error.strerror or str(error)
        self.failed.emit(f"The settings cannot be saved in {where}: {why}. They hold until imugui is closed.")
