"""The record button, and the line that says how the recording goes."""

from __future__ import annotations

from PySide6.QtCore import QTimer, Slot
from PySide6.QtGui import QFontMetrics
from PySide6.QtWidgets import QHBoxLayout, QWidget

from imugui.views.controls import Button
from imugui.views.labels import ToneLabel
from imugui.views.record_control import why_not
from imugui.views.record_words import elapsed_words, free_words, is_low, size_words
from imugui.views.shortcuts import tip
from imugui.workers.session import RecordingStatus, Session, Status

FLASH_MS = 1500
IDLE, WIDEST = "Record", "0:00:00"
START_WORDS = "Record the board into a new folder, with raw bytes, samples and attitudes"
FRAME = 46  # px: icon, gaps and edges of the button


class RecordTools(QWidget):
    """As wide while it records as when it does not."""

    def __init__(self, session: Session) -> None:
        super().__init__()
        self._session = session
        self.button = Button(IDLE, START_WORDS, "toggle_recording", "record")
        metrics = QFontMetrics(self.button.font())
        self.button.setFixedWidth(max(map(metrics.horizontalAdvance, (IDLE, WIDEST))) + FRAME)
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.addWidget(self.button)

    def refresh(self, status: Status) -> None:
        """Follow the session."""
        running = self._session.recording
        why = "" if running is not None else why_not(status)
        self.button.setEnabled(not why)
        self.button.setText(elapsed_words(running.elapsed_s) if running is not None else IDLE)
        self.button.set_icon("stop" if running is not None else "record")
        self.button.set_role("recording" if running is not None else "")
        self.button.setAccessibleName("Stop recording" if running is not None else "Record")
        words = "Stop recording" if running is not None else why or START_WORDS
        self.button.setToolTip(tip("toggle_recording", words))


class RecordLine(ToneLabel):
    """Beside the verdict while a recording runs: size, free space when it is short, and each marker for a moment."""

    def __init__(self, session: Session) -> None:
        super().__init__("Recording  888.8 MB")
        self._session = session
        self._flash = QTimer(self)
        self._flash.setSingleShot(True)
        self._flash.setInterval(FLASH_MS)
        self.hide()

    def refresh(self) -> None:
        """Follow the session."""
        running = self._session.recording
        self.setVisible(running is not None)
        if running is not None and not self._flash.isActive():
            self._show(running)

    @Slot(int)
    def show_marker(self, number: int) -> None:
        """Confirm a marker."""
        self.show_phrase("good", f"marker {number}")
        self._flash.start()

    def _show(self, running: RecordingStatus) -> None:
        words = f"Recording  {size_words(running.size_bytes)}"
        if is_low(running):
            self.show_phrase("warn", f"{words}; {free_words(running)}")
        else:
            self.show_phrase("neutral", words)
        self.setToolTip(f"{running.path}\n{free_words(running)}\n{tip('mark', 'Put a marker')}")
        self.setAccessibleName(self.text())
