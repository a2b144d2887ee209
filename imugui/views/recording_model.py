"""The list of recordings, read lazily in a thread of its own."""

from __future__ import annotations

import datetime
import math
from pathlib import Path
from typing import Any

from PySide6.QtCore import QAbstractListModel, QModelIndex, QObject, QPersistentModelIndex, Qt, Signal, Slot

from imugui.recording.summary import UNKNOWN, Summary, recordings_in, summarise
from imugui.views.job import Job, Jobs
from imugui.views.record_words import length_words, size_words

Index = QModelIndex | QPersistentModelIndex
PATH = Qt.ItemDataRole.UserRole
SUMMARY = Qt.ItemDataRole.UserRole + 1


class RecordingModel(QAbstractListModel):
    """The recordings of a folder, newest first; each summary comes when it was read."""

    _found = Signal(object)  # from the thread: the paths, or when one was changed and its summary
    counted = Signal(int)  # the folder was looked at: so many recordings

    def __init__(self, parent: QObject) -> None:
        super().__init__(parent)
        self._paths: list[Path] = []
        self._known: dict[Path, tuple[int, Summary]] = {}  # when it was changed last, in ns, and what was read
        self._jobs = Jobs(self)
        self._job: Job | None = None
        self._found.connect(self._take)

    def read(self, folder: Path, leave_out: Path | None) -> None:
        """Look at the folder again; the recording that runs is left out."""
        if self._job is not None:
            self._job.cancel()
        known = dict(self._known)

        def work(job: Job) -> None:
            found = [path for path in recordings_in(folder) if path != leave_out]
            job.progress(0.0)
            self._found.emit(found)
            for path in found:
                job.progress(0.0)
                changed = _changed_ns(path)
                if known.get(path, (None,))[0] != changed:
                    self._found.emit((changed, summarise(path)))

        self._job = self._jobs.start(work, self._read, self._unreadable)

    def stop(self) -> None:
        """End the threads."""
        self._jobs.stop()

    def rowCount(self, parent: Index | None = None) -> int:
        return 0 if parent is not None and parent.isValid() else len(self._paths)

    def data(self, index: Index, role: int = Qt.ItemDataRole.DisplayRole) -> Any:
        if not index.isValid():
            return None
        path = self._paths[index.row()]
        summary = self._known.get(path, (0, None))[1]
        if role == PATH:
            return path
        if role == SUMMARY:
            return summary
        if role in (Qt.ItemDataRole.DisplayRole, Qt.ItemDataRole.AccessibleTextRole):
            return f"{title_of(path, summary)}: {facts_of(summary)}"
        if role == Qt.ItemDataRole.ToolTipRole:
            return "\n".join(filter(None, (str(path), summary.note if summary else "")))
        return None

    def row_of(self, path: Path) -> int:
        """Its row, or -1."""
        return self._paths.index(path) if path in self._paths else -1

    @Slot(object)
    def _take(self, part: Any) -> None:
        if isinstance(part, list):
            self._take_paths(part)
            return
        changed, summary = part
        self._known[summary.path] = (changed, summary)
        row = self.row_of(summary.path)
        if row >= 0:
            self.dataChanged.emit(self.index(row), self.index(row))

    def _take_paths(self, found: list[Path]) -> None:
        if found != self._paths:
            self.beginResetModel()
            self._paths = found
            self._known = {path: what for path, what in self._known.items() if path in set(found)}
            self.endResetModel()
        self.counted.emit(len(found))

    @Slot(object)
    def _read(self, _: object) -> None:
        self._job = None

    @Slot(str)
    def _unreadable(self, _: str) -> None:
        self._take_paths([])


def _changed_ns(path: Path) -> int:
    try:
        return max(part.stat().st_mtime_ns for part in (path, *path.iterdir()))
    except (OSError, ValueError):
        return 0


def title_of(path: Path, summary: Summary | None) -> str:
    """When it was made, in local time, and its label."""
    try:
        started = datetime.datetime.fromisoformat(summary.started_utc if summary else "").astimezone()
    except (ValueError, OverflowError):
        return path.stem
    return "  ".join(filter(None, (f"{started:%Y-%m-%d %H:%M:%S}", summary.label if summary else "")))


def facts_of(summary: Summary | None) -> str:
    """Length, rate, gaps, size, board."""
    if summary is None:
        return "reading…"
    if summary.problem:
        return summary.problem
    gaps = {UNKNOWN: "gaps not counted", 0: "no gaps", 1: "1 gap"}.get(summary.gaps, f"{summary.gaps} gaps")
    rate = "? Hz" if math.isnan(summary.rate_hz) else f"{summary.rate_hz:.1f} Hz"
    cut = () if summary.complete else ("cut off",)
    facts = (length_words(summary.length_s), rate, gaps, *cut, size_words(summary.size_bytes), summary.board)
    return " · ".join(filter(None, facts))
