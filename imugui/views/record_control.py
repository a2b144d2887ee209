"""RecordControl: start, stop and mark by button or key, and news of recordings that ended."""

from __future__ import annotations

import dataclasses
import datetime
from pathlib import Path

from PySide6.QtCore import QObject, QUrl, Signal, Slot
from PySide6.QtGui import QDesktopServices

from imugui import paths
from imugui.views.record_words import free_words, is_low, recording_path
from imugui.workers.session import RecordingStatus, Session, State, Status

NOTHING_TO_RECORD = (
    State.IDLE,
    State.OPENING,
    State.MISSING,
    State.BUSY,
    State.DENIED,
    State.AWAY,
    State.TAKEN,
    State.NO_BLUETOOTH,
    State.ENDED,
    State.FAILED,
)


class RecordControl(QObject):
    """Watches only the recordings that it began itself; those of a collection report to their page."""

    ended = Signal(object)  # RecordingStatus
    marked = Signal(int)  # number of the marker in this recording
    said = Signal(str, str)  # tone, sentence

    def __init__(self, session: Session) -> None:
        super().__init__()
        self._session = session
        self._mine: RecordingStatus | None = None  # as last seen
        self._warned = False
        self._markers = 0
        self._marked_path: Path | None = None

    @Slot()
    def toggle(self) -> None:
        """Start a recording, or stop the one that runs."""
        if self._session.recording is not None:
            self._look()
            self._session.stop_recording()
            self.refresh()
        else:
            self._start()

    @Slot()
    def mark(self) -> None:
        """Put a marker into the recording at this moment."""
        running = self._session.recording
        if running is None:
            self.said.emit("warn", "A marker needs a recording: press R to start one.")
            return
        if running.path != self._marked_path:
            self._marked_path, self._markers = running.path, 0
        self._markers += 1
        self._session.mark(f"marker {self._markers}")
        self.marked.emit(self._markers)

    def refresh(self) -> None:
        """Notice that the recording ended, whoever ended it, or that the disk fills up."""
        running = self._look()
        mine = self._mine
        if mine is not None and (running is None or running.path != mine.path):
            self._mine = None
            self.ended.emit(dataclasses.replace(mine, size_bytes=folder_size(mine.path)))
        elif running is not None and is_low(running) and not self._warned:
            self._warned = True
            self.said.emit("warn", f"The disk is nearly full: {free_words(running)}.")

    def _start(self) -> None:
        if why := why_not(self._session.status()):
            self.said.emit("warn", why)
            return
        path = recording_path(paths.documents_folder(), "", datetime.datetime.now())
        self._warned = False
        if self._session.record(path):
            self._mine = self._session.recording
            self.refresh()

    def _look(self) -> RecordingStatus | None:
        running = self._session.recording
        if self._mine is not None and running is not None and running.path == self._mine.path:
            self._mine = running
        return running


def why_not(status: Status) -> str:
    """Why nothing can be recorded now, in words; "" when it can."""
    if status.state in NOTHING_TO_RECORD:
        return "Connect a board first: there is nothing to record."
    return ""


def folder_size(folder: Path) -> int:
    """Bytes of the files in a folder; 0 when it is gone."""
    try:
        return sum(path.stat().st_size for path in folder.iterdir())
    except OSError:
        return 0


def show_in_folder(path: Path) -> None:
    """Open the file manager where a recording is; where that is gone, at the nearest folder there is."""
    there = next((one for one in path.parents if one.is_dir()), path)
    QDesktopServices.openUrl(QUrl.fromLocalFile(str(there)))
