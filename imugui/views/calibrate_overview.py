"""Overview: what of this board is calibrated, when and how good, and the one next step."""

from __future__ import annotations

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QFrame, QGridLayout, QHBoxLayout, QVBoxLayout, QWidget

from imugui.views.calibrate_card import PartCard
from imugui.views.calibrate_parts import PARTS, PartState, next_part
from imugui.views.controls import Button
from imugui.views.labels import heading, muted

COLUMNS = 2
ALL_DONE = "Everything that this board needs is calibrated."
NO_BOARD = "Connect a board to calibrate it; profiles can be looked at without one."
NO_MAG = "This board has no magnetometer."


class Overview(QWidget):
    """Emits ``wanted`` with the key of a part."""

    wanted = Signal(str)

    def __init__(self) -> None:
        super().__init__()
        self._next = ""
        self.headline = heading("")
        self.words = muted()
        self.next = Button("Next step", "Calibrate what is missing first", role="primary")
        self.next.setMinimumHeight(40)
        self.next.clicked.connect(lambda: self.wanted.emit(self._next))
        self.cards = {name: PartCard(part) for name, part in PARTS.items()}
        for name, card in self.cards.items():
            card.wanted.connect(lambda name=name: self.wanted.emit(name))
        self._lay_out()

    def show_states(self, states: dict[str, PartState], connected: bool, has_mag: bool) -> None:
        """Show the state of every part."""
        for name, card in self.cards.items():
            no_mag = PARTS[name].needs_mag and not has_mag
            card.show_state(states[name], "No board is connected." if not connected else NO_MAG if no_mag else "")
        done = sum(states[name].tone in ("good", "warn") for name in PARTS)
        self._next = next_part(states, has_mag) if connected else ""
        self.headline.setText(f"{done} of {len(PARTS)} parts calibrated")
        self.words.setText(self._advice(connected))
        self.next.setVisible(bool(self._next))
        if self._next:
            self.next.setText(f"Next: {PARTS[self._next].title}")
            self.next.setAccessibleName(f"Next step: calibrate the {PARTS[self._next].title.lower()}")

    def _advice(self, connected: bool) -> str:
        if not connected:
            return NO_BOARD
        return PARTS[self._next].words if self._next else ALL_DONE

    def _lay_out(self) -> None:
        said = QVBoxLayout()
        said.setSpacing(2)
        said.addWidget(self.headline)
        said.addWidget(self.words)
        head = QFrame()
        head.setProperty("role", "card")
        row = QHBoxLayout(head)
        row.setContentsMargins(16, 12, 12, 12)
        row.addLayout(said, 1)
        row.addWidget(self.next)
        grid = QGridLayout()
        grid.setSpacing(10)
        for place, card in enumerate(self.cards.values()):
            grid.addWidget(card, place // COLUMNS, place % COLUMNS)
        for line in range(COLUMNS):
            grid.setColumnStretch(line, 1)
        column = QVBoxLayout(self)
        column.setContentsMargins(16, 14, 0, 10)
        column.setSpacing(10)
        column.addWidget(head)
        column.addLayout(grid, 1)
