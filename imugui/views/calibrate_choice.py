"""Choice: the ways to calibrate one part, each with what it is worth, the best first."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QShowEvent
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QVBoxLayout, QWidget

from imugui.views.calibrate_look import Guide
from imugui.views.controls import Button, clear
from imugui.views.labels import heading, muted


class Choice(QWidget):
    """Emits ``chosen`` with the key of a guide, or ``closed``."""

    chosen = Signal(str)
    closed = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.title = heading("")
        self.back = Button("Back", "Back to the overview (Backspace)")
        self.back.clicked.connect(self.closed)
        self._first: Button | None = None
        self._cards = QVBoxLayout()
        self._cards.setSpacing(10)
        head = QHBoxLayout()
        head.addWidget(self.title, 1)
        head.addWidget(self.back)
        column = QVBoxLayout(self)
        column.setContentsMargins(16, 14, 16, 14)
        column.setSpacing(12)
        column.addLayout(head)
        column.addLayout(self._cards)
        column.addStretch(1)

    def offer(self, title: str, guides: list[Guide]) -> None:
        """Show the guides of one part; the first is recommended and in focus."""
        self.title.setText(f"{title}: choose a way")
        clear(self._cards)
        for place, guide in enumerate(guides):
            self._cards.addWidget(self._card(guide, first=place == 0))

    def showEvent(self, event: QShowEvent) -> None:
        super().showEvent(event)
        if self._first is not None:
            self._first.setFocus(Qt.FocusReason.OtherFocusReason)

    def _card(self, guide: Guide, first: bool) -> QFrame:
        card = QFrame()
        card.setProperty("role", "card")
        start = Button("Start", f"Start: {guide.title}", role="primary" if first else "")
        start.setAccessibleName(f"Start: {guide.title}")
        start.clicked.connect(lambda: self.chosen.emit(guide.key))
        name = QLabel(guide.title + ("   recommended" if first else ""))
        name.setProperty("role", "heading")
        words = QVBoxLayout()
        words.setSpacing(3)
        for label in (name, QLabel(guide.words), muted(guide.accuracy)):
            label.setWordWrap(True)
            words.addWidget(label)
        row = QHBoxLayout(card)
        row.setContentsMargins(16, 12, 12, 12)
        row.addLayout(words, 1)
        row.addWidget(start)
        if first:
            self._first = start
        return card
