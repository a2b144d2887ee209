"""The message banner: one message at a time, beside the work and never in its way."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QTimer, Slot
from PySide6.QtGui import QPainter, QPaintEvent
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QSizePolicy

from imugui.views import theme
from imugui.views.controls import Button, clear

TONES = {"info": "neutral", "warn": "warn", "error": "bad"}
INFO_STAYS_MS = 8000
OFFER_STAYS_MS = 30000  # with something to choose

Offer = tuple[str, str, Callable[[], object]]  # text of a button, its tooltip, what it does


class Banner(QFrame):
    """The newest message, and how many it covers; news go by themselves, warnings and errors stay until dismissed."""

    def __init__(self) -> None:
        super().__init__()
        self._tone = "neutral"
        self._covered = 0
        self._leave = QTimer(self)
        self._leave.setSingleShot(True)
        self._leave.timeout.connect(self.dismiss)
        self._words = QLabel()
        self._words.setWordWrap(True)
        self._words.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Preferred)
        self._count = QLabel()
        self._count.setProperty("role", "muted")
        self._count.setFont(theme.font("small"))
        row = QHBoxLayout(self)
        row.setContentsMargins(42, 8, 8, 8)
        row.setSpacing(12)
        row.addWidget(self._words, 1)
        row.addWidget(self._count)
        self.offers = QHBoxLayout()
        row.addLayout(self.offers)
        button = Button("Dismiss", "Take this message away", "dismiss_message", role="quiet", small=True)
        button.clicked.connect(self.dismiss)
        row.addWidget(button)
        self.hide()

    @property
    def tone(self) -> str:
        return self._tone

    def text(self) -> str:
        """The message on show, "" when there is none."""
        return "" if self.isHidden() else self._words.text()

    @Slot(str, str)
    def show_message(self, tone: str, text: str) -> None:
        """Show a message of tone "info", "warn" or "error"."""
        if not self.isHidden() and text != self._words.text():
            self._covered += 1
        self._tone = TONES[tone]
        self._words.setText(text)
        self._words.setAccessibleName(f"{tone}: {text}")
        self._count.setText(f"+ {self._covered} before" if self._covered else "")
        clear(self.offers)
        self._leave.stop()
        if tone == "info":
            self._leave.start(INFO_STAYS_MS)
        self.show()
        self.update()

    def offer(self, offers: list[Offer]) -> None:
        """Add buttons to the message on show; each takes the message away when it is used."""
        clear(self.offers)
        for text, words, act in offers:
            button = Button(text, words, small=True)
            button.clicked.connect(act)
            button.clicked.connect(self.dismiss)
            self.offers.addWidget(button)
        if self._leave.isActive():
            self._leave.start(OFFER_STAYS_MS)

    def let_go(self) -> None:
        """Take away news that nobody is offered a choice on: something worse is said elsewhere."""
        if self._tone == "neutral" and self.offers.count() == 0:
            self.dismiss()

    @Slot()
    def dismiss(self) -> None:
        """Take the message away."""
        self._leave.stop()
        self._covered = 0
        self.hide()

    def paintEvent(self, event: QPaintEvent) -> None:
        colour = theme.tone_colour(self._tone)
        painter = QPainter(self)
        painter.fillRect(self.rect(), theme.mix(theme.palette().panel, colour, 0.16))
        painter.fillRect(0, 0, 4, self.height(), colour)
        painter.setPen(colour)
        painter.setFont(theme.font("heading"))
        middle = self._words.geometry().center().y()
        painter.drawText(18, middle + painter.fontMetrics().ascent() // 2 - 2, theme.tone_glyph(self._tone))
        painter.end()
