"""The foot of the Guide page: whether the proof is being kept, and what this program is not."""

from __future__ import annotations

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QFrame, QHBoxLayout

from imugui.views.controls import Button
from imugui.views.guide_parts import note
from imugui.views.labels import ElidedLabel, ToneLabel
from imugui.views.record_control import why_not
from imugui.views.record_words import elapsed_words
from imugui.workers.session import Session, Status

NOT_MEDICAL = "Research tool, not a medical device"
NOTHING = "Nothing is recorded"
AGAINST = "One board's recording does not prove readings against the reference."
WHY = "Without a recording no reading can be computed again."


class GuideFoot(QFrame):
    """Emits ``record_wanted`` when the person wants a recording to begin."""

    record_wanted = Signal()

    def __init__(self, session: Session) -> None:
        super().__init__()
        self.setProperty("role", "bar")
        self._session = session
        self.state = ToneLabel(f"▲ {NOTHING}")
        self.why = ElidedLabel()
        self.why.setProperty("role", "muted")
        self.button = Button("Record", f"Start a recording. {WHY}", "toggle_recording", "record", small=True)
        self.button.clicked.connect(self.record_wanted)
        self.line = note(NOT_MEDICAL)
        row = QHBoxLayout(self)
        row.setContentsMargins(16, 4, 16, 4)
        row.setSpacing(12)
        row.addWidget(self.state)
        row.addWidget(self.button)
        row.addWidget(self.why, 1)
        row.addWidget(self.line)

    def refresh(self, status: Status) -> None:
        """Follow the session."""
        running = self._session.recording
        nothing = running is None and bool(why_not(status))
        if nothing:
            self.state.show_phrase("neutral", "")
            self.why.show_line("")
        elif running is None:
            self.state.show_phrase("warn", NOTHING)
            self.why.show_line(WHY if self._session.relative is None else AGAINST)
        else:
            self.state.show_phrase("good", f"Recording {elapsed_words(running.elapsed_s)}")
            kept = f"Readings are kept in {running.path.name}."
            self.why.show_line(kept if self._session.relative is None else AGAINST)
        self.button.setVisible(running is None and not nothing)
