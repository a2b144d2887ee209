"""FilterBoard: what the filter's parameters have to do with the connected board: its delays, and what is learnt."""

from __future__ import annotations

from PySide6.QtCore import Qt, Slot
from PySide6.QtWidgets import QVBoxLayout, QWidget

from imugui.views.controls import Button
from imugui.views.filter_board_words import delays_words, learnt_words
from imugui.views.labels import muted
from imugui.workers.session import Session


class FilterBoard(QWidget):
    """Two quiet paragraphs, each with the one thing that can be done; empty for filters without either."""

    def __init__(self, session: Session) -> None:
        super().__init__()
        self._session = session
        self.learnt = muted()
        self.learnt.setToolTip(
            "What the filter has found beyond the calibration in use, 1 sigma of what it knows least"
        )
        self.why_not = muted()
        self.keep = Button(
            "Keep in the profile",
            "Take what was learnt of the gyroscope into the profile of this board, as a better start for every filter",
            small=True,
        )
        self.delays = muted()
        self.reset = Button("Reset the delays", "Use the delays of the table again, or none without any", small=True)
        self.keep.clicked.connect(self._keep)
        self.reset.clicked.connect(self._reset)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(12)
        for parts in ((self.learnt, self.why_not, self.keep), (self.delays, self.reset)):
            block = QVBoxLayout()
            block.setSpacing(6)
            for part in parts:
                side = Qt.AlignmentFlag.AlignLeft if isinstance(part, Button) else Qt.AlignmentFlag(0)
                block.addWidget(part, 0, side)
            column.addLayout(block)

    def refresh(self) -> None:
        """Follow the session."""
        learnt = self._session.learnt()
        self.learnt.setVisible(learnt is not None)
        self.keep.setVisible(learnt is not None)
        refusal = learnt.refusal if learnt is not None else ""
        if learnt is not None:
            self.learnt.setText(learnt_words(learnt))
            self.keep.setEnabled(not refusal)
        self.why_not.setText(refusal)
        self.why_not.setVisible(bool(refusal))
        self._show_delays()
        self.setVisible(learnt is not None or self._session.has_delays)

    def _show_delays(self) -> None:
        known = self._session.delays
        words = delays_words(known, self._session.board is not None) if self._session.has_delays else ""
        self.delays.setText(words)
        self.delays.setVisible(bool(words))
        self.reset.setVisible(bool(words) and known.own is not None)

    @Slot()
    def _keep(self) -> None:
        self._session.keep_learnt()
        self.refresh()

    @Slot()
    def _reset(self) -> None:
        self._session.reset_delays()
        self.refresh()
