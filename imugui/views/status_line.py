"""The status line: always tells the truth about the stream; a click opens the link log."""

from __future__ import annotations

import dataclasses
import math
from collections import deque

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QMouseEvent, QPainter, QPaintEvent
from PySide6.QtWidgets import QFrame, QHBoxLayout

from imugui.views import theme
from imugui.views.controls import Button
from imugui.views.labels import ToneLabel
from imugui.views.status_words import PARTS, SPARE, Phrase
from imugui.workers.session import Status

HEIGHT = 34
LEFT, RIGHT = 16, 8
_GAP = 20
_WORST_OF = 8  # slow refreshes: one second


class StatusLine(QFrame):
    """One label for each of PARTS."""

    clicked = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.setProperty("role", "bar")
        self.setFixedHeight(HEIGHT)
        self.setCursor(Qt.CursorShape.PointingHandCursor)
        self.setAccessibleName("Status line")
        self._ages: deque[float] = deque(maxlen=_WORST_OF)
        self.labels = {name: ToneLabel(part.widest) for name, part in PARTS.items()}
        row = QHBoxLayout(self)
        row.setContentsMargins(LEFT, 0, RIGHT, 0)
        row.setSpacing(_GAP)
        for name, label in self.labels.items():
            label.setToolTip(PARTS[name].tip)
            label.setAccessibleName(PARTS[name].tip)
            row.addWidget(label)
        row.addStretch(1)
        self.button = Button(
            "Link log", "Everything on the link that was not data", "show_link_log", role="quiet", small=True
        )
        self.button.clicked.connect(self.clicked)
        row.addWidget(self.button)

    def refresh(self, status: Status) -> None:
        """Show a snapshot; to be called 8 times a second."""
        self._ages.append(status.age_ms)
        shown = dataclasses.replace(status, age_ms=self._worst_age())
        phrases = {name: part.phrase(shown) for name, part in PARTS.items()}
        for name, phrase in phrases.items():
            self.labels[name].show_phrase(phrase.tone, phrase.text)
            self.labels[name].setAccessibleDescription(phrase.text)
        self._make_room(phrases)

    def _make_room(self, phrases: dict[str, Phrase]) -> None:
        """Show what there is; in a narrow window the least important calm words go first, for words must not be cut."""
        shown = {name for name, phrase in phrases.items() if phrase.text}
        for name in SPARE:
            if sum(self.labels[one].sizeHint().width() + _GAP for one in shown) <= self._room():
                break
            if phrases[name].tone == "neutral":
                shown.discard(name)
        for name, label in self.labels.items():
            label.setVisible(name in shown)

    def _room(self) -> int:
        return self.width() - LEFT - RIGHT - self.button.sizeHint().width()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Thin lines between the places."""
        super().paintEvent(event)
        painter = QPainter(self)
        painter.setPen(theme.pen(theme.palette().line))
        shown = [label for label in self.labels.values() if label.isVisible()]
        for label in shown[1:]:
            x = label.x() - _GAP // 2
            painter.drawLine(x, 10, x, self.height() - 10)
        painter.end()

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        if event.button() == Qt.MouseButton.LeftButton and self.rect().contains(event.position().toPoint()):
            self.clicked.emit()

    def _worst_age(self) -> float:
        if math.isnan(self._ages[-1]):
            self._ages.clear()
            return math.nan
        return max(self._ages)
