"""The verdict: the state of the link as shape, word and colour, and the sentence that says why and what next."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QHBoxLayout, QLabel, QSizePolicy, QWidget

from imugui.views.controls import Button
from imugui.views.labels import Chip, ElidedLabel
from imugui.workers.session import State, Status

NEEDS_COLUMNS = (State.NO_MESSAGES, State.IMPOSSIBLE)
CSV = "csv-line"


class VerdictRow(QWidget):
    """One line while all is well; with a warning or an error the whole sentence, and what helps."""

    log_wanted = Signal()
    columns_wanted = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.chip = Chip(name="State")
        self._line = ElidedLabel()
        self._line.setProperty("role", "muted")
        self._whole = QLabel()
        self._whole.setWordWrap(True)
        self._whole.setTextFormat(Qt.TextFormat.PlainText)
        self._whole.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self._whole.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
        self.log_button = Button("Link log", "See what came from the board", "show_link_log", small=True)
        words = "Say what each column of this board means, and its unit"
        self.columns_button = Button("Name columns…", words, small=True)
        self.log_button.clicked.connect(self.log_wanted)
        self.columns_button.clicked.connect(self.columns_wanted)
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(12)
        row.addWidget(self.chip, 0, Qt.AlignmentFlag.AlignTop)
        row.addWidget(self._line, 1)
        row.addWidget(self._whole, 1)
        row.addWidget(self.columns_button, 0, Qt.AlignmentFlag.AlignTop)
        row.addWidget(self.log_button, 0, Qt.AlignmentFlag.AlignTop)
        self.refresh(Status())

    def sentence(self) -> str:
        """The sentence on show, uncut."""
        return self._line.whole

    def refresh(self, status: Status, plays_table: bool = False) -> None:
        """Show a snapshot; ``plays_table``: the columns of the file that is played can be looked at."""
        state = status.state
        trouble = state.tone in ("warn", "bad")
        self.chip.show_state(state.tone, state.word)
        self._line.show_line(status.sentence)
        if trouble and self._whole.text() != status.sentence:
            self._whole.setText(status.sentence)
        self._line.setVisible(not trouble)
        self._whole.setVisible(trouble)
        self.log_button.setVisible(trouble)
        named = plays_table and status.format == CSV
        self.columns_button.setVisible(state in NEEDS_COLUMNS or named or (trouble and _is_about_columns(status)))


def _is_about_columns(status: Status) -> bool:
    return status.format == CSV or "name the columns" in status.sentence
