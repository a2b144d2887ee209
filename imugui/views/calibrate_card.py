"""PartCard: one part of a board on the overview: its state, how good, since when, and the way to calibrate it."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QVBoxLayout

from imugui.views.calibrate_parts import Part, PartState
from imugui.views.controls import Button
from imugui.views.labels import Chip, ElidedLabel, heading, muted

WORDS = ("Not calibrated", "Calibrated", "Good", "Old", "Suspect")


class PartCard(QFrame):
    """Emits ``wanted`` when its button is pressed."""

    wanted = Signal()

    def __init__(self, part: Part) -> None:
        super().__init__()
        self.setProperty("role", "card")
        self.chip = Chip(WORDS, part.title)
        self.good = QLabel()
        self.good.setTextFormat(Qt.TextFormat.PlainText)
        self.good.setWordWrap(True)
        self.words = muted(part.words)
        self.when = ElidedLabel()
        self.when.setProperty("role", "muted")
        self.when.setFont(self.words.font())
        self.button = Button("Calibrate", f"{part.title}: {part.words}")
        self.button.setAccessibleName(f"Calibrate {part.title.lower()}")
        self.button.clicked.connect(self.wanted)
        head = QHBoxLayout()
        head.addWidget(heading(part.title), 1)
        head.addWidget(self.chip)
        foot = QHBoxLayout()
        foot.addWidget(self.when, 1)
        foot.addWidget(self.button)
        column = QVBoxLayout(self)
        column.setContentsMargins(16, 12, 12, 12)
        column.setSpacing(6)
        column.addLayout(head)
        column.addWidget(self.words)
        column.addWidget(self.good)
        column.addStretch(1)
        column.addLayout(foot)
        self.show_state(PartState(), "")

    def show_state(self, state: PartState, barred: str) -> None:
        """Show a state; ``barred`` says why this part cannot be calibrated now, or is empty."""
        self.chip.show_state(state.tone, state.word)
        self.good.setText(state.good)
        self.good.setVisible(bool(state.good))
        self.words.setVisible(not state.good)
        self.when.show_line(barred or state.when)
        self.button.setEnabled(not barred)
        self.button.setText("Again" if state.tone != "neutral" else "Calibrate")
