"""The strip above the connection bar while there are two boards: which is in front, and the one against the other."""

from __future__ import annotations

from collections import deque

import numpy as np
from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QFontMetrics
from PySide6.QtWidgets import QButtonGroup, QCheckBox, QFrame, QHBoxLayout, QToolButton, QVBoxLayout

from imugui.views import theme
from imugui.views.controls import Button
from imugui.views.labels import ElidedLabel, ToneLabel, muted
from imugui.views.relative_words import HOW_TO_ALIGN, IN_FRAME, age_words, relative_words
from imugui.workers.session import RelativeStatus, Session

BOARDS = ("Board 1 (tool)", "Board 2 (reference)")
PAD = 20
WORST_OF = 8  # slow refreshes: one second
TIP = (
    "Show and guide board 1 in the frame of board 2: what both do together does not count. Each sample of the tool "
    "waits for the reference's next one; where one link is later than the other by 10 ms, turning at 100 °/s shows 1°"
)


class BoardStrip(QFrame):
    """Tabs and one option; hidden while there is one board."""

    chosen = Signal(int)
    removed = Signal()
    relative_wanted = Signal(bool)

    def __init__(self) -> None:
        super().__init__()
        self.setProperty("role", "bar")
        self.setAccessibleName("Boards")
        self._group = QButtonGroup(self)
        self.tabs = [self._tab(number, name) for number, name in enumerate(BOARDS)]
        self.remove_button = Button("✕", "Disconnect board 2 and take it away", role="quiet", small=True)
        self.remove_button.setFixedWidth(34)
        self.remove_button.setAccessibleName("Remove board 2")
        self.remove_button.clicked.connect(self.removed)
        self.relative = QCheckBox(IN_FRAME)
        self.relative.setAccessibleName(IN_FRAME)
        self.relative.setToolTip(TIP)
        self.relative.clicked.connect(self.relative_wanted)
        self.state = ToneLabel(f"{theme.tone_glyph('good')} Aligned 88 min ago")
        self.hint = muted(HOW_TO_ALIGN)
        self.ages = ElidedLabel()
        self.ages.setProperty("role", "muted")
        self.ages.setFont(theme.font("small"))
        self._ages: deque[tuple[float, float]] = deque(maxlen=WORST_OF)
        self._offers = True
        self._lay_out()
        self.hide()

    def show_chosen(self, number: int, offers_relative: bool) -> None:
        """Mark the board in front; the option is there where it acts."""
        self.tabs[number].setChecked(True)
        self._offers = offers_relative
        for widget in (self.relative, self.state, self.ages):
            widget.setVisible(offers_relative)

    def refresh(self, tool: Session) -> None:
        """Follow the first board's session."""
        relative = tool.relative
        self.relative.setChecked(relative is not None)
        self.hint.setVisible(self._offers and relative is not None and not relative.aligned)
        if relative is None:
            self.state.show_phrase("neutral", "")
            self.ages.show_line("")
            self._ages.clear()
        else:
            self._show(relative.status())

    def _show(self, status: RelativeStatus) -> None:
        self.state.show_phrase(*relative_words(status))
        self._ages.append((status.tool_age_ms, status.reference_age_ms))
        tool, reference = (float(np.fmax.reduce(ages)) for ages in zip(*self._ages, strict=True))
        self.ages.show_line(age_words(tool, reference))

    def _tab(self, number: int, name: str) -> QToolButton:
        tab = QToolButton()
        tab.setText(name)
        tab.setCheckable(True)
        tab.setProperty("role", "rail")
        tab.setFont(theme.font("small"))
        tab.setToolTip(f"Connect, calibrate, record and see {name[:7].lower()}")
        tab.setAccessibleName(name)
        tab.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        bold = tab.font()
        bold.setBold(True)
        tab.setMinimumWidth(QFontMetrics(bold).horizontalAdvance(name) + PAD)
        tab.clicked.connect(lambda: self.chosen.emit(number))
        self._group.addButton(tab)
        return tab

    def _lay_out(self) -> None:
        row = QHBoxLayout()
        row.setSpacing(6)
        for widget in (*self.tabs, self.remove_button):
            row.addWidget(widget)
        row.addSpacing(16)
        row.addWidget(self.relative)
        row.addWidget(self.state)
        row.addSpacing(8)
        row.addWidget(self.ages, 1)
        row.addStretch(0)
        column = QVBoxLayout(self)
        column.setContentsMargins(12, 4, 12, 2)
        column.setSpacing(2)
        column.addLayout(row)
        column.addWidget(self.hint)
