"""ResultCard: a verdict in words, figures with their units, and the comparison with the seeds' own ways."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFrame, QGridLayout, QLabel, QVBoxLayout, QWidget

from imugui.views import theme
from imugui.views.calibrate_look import Figure, Verdict
from imugui.views.controls import clear
from imugui.views.labels import Chip, ElidedLabel, muted

_WORDS = ("Clean", "Suspect", "Contaminated", "Good", "Usable", "Rough", "Refused")


class Figures(QWidget):
    """Label at the left, value at the right, one line each."""

    def __init__(self) -> None:
        super().__init__()
        self._grid = QGridLayout(self)
        self._grid.setContentsMargins(0, 0, 0, 0)
        self._grid.setHorizontalSpacing(12)
        self._grid.setVerticalSpacing(4)
        self._grid.setColumnStretch(0, 1)
        self._labels: list[tuple[QLabel, QLabel]] = []

    def show_figures(self, figures: tuple[Figure, ...]) -> None:
        """Show these figures; their places are kept as long as their number is the same."""
        if len(figures) != len(self._labels):
            clear(self._grid)
            self._labels = [self._add(row) for row in range(len(figures))]
        for (name, value), figure in zip(self._labels, figures, strict=True):
            name.setText(figure.label)
            value.setText(
                figure.value if figure.tone == "neutral" else f"{theme.tone_glyph(figure.tone)} {figure.value}"
            )
            for label in (name, value):
                label.setToolTip(figure.tip)
            value.setAccessibleName(f"{figure.label}: {figure.value}")

    def texts(self) -> list[str]:
        """Label and value of each line."""
        return [f"{name.text()}: {value.text()}" for name, value in self._labels]

    def _add(self, row: int) -> tuple[QLabel, QLabel]:
        name, value = muted(), QLabel()
        value.setTextFormat(Qt.TextFormat.PlainText)
        self._grid.addWidget(name, row, 0)
        self._grid.addWidget(value, row, 1, Qt.AlignmentFlag.AlignRight)
        return name, value


class ResultCard(QFrame):
    """Empty until there is a verdict."""

    def __init__(self) -> None:
        super().__init__()
        self.setProperty("role", "card")
        self.chip = Chip(_WORDS, "Verdict")
        self.reason = QLabel()
        self.reason.setWordWrap(True)
        self.reason.setTextFormat(Qt.TextFormat.PlainText)
        self.figures = Figures()
        self._table = QGridLayout()
        self._table.setHorizontalSpacing(10)
        self._table.setVerticalSpacing(3)
        column = QVBoxLayout(self)
        column.setContentsMargins(14, 12, 14, 12)
        column.setSpacing(8)
        column.addWidget(self.chip, 0, Qt.AlignmentFlag.AlignLeft)
        column.addWidget(self.reason)
        column.addWidget(self.figures)
        column.addLayout(self._table)
        self._comparison: tuple[tuple[str, ...], ...] = ()

    def show_verdict(self, verdict: Verdict, comparison: tuple[tuple[str, ...], ...] = ()) -> None:
        """Show a verdict, and a table whose first row is its head."""
        self.chip.show_state(verdict.tone, verdict.word)
        self.reason.setText(" ".join(filter(None, (verdict.reason, verdict.keep))))
        self.figures.show_figures(verdict.figures)
        if comparison != self._comparison:
            self._comparison = comparison
            self._fill_table()

    def table_texts(self) -> tuple[tuple[str, ...], ...]:
        """The rows of the comparison, its head first."""
        return self._comparison

    def _fill_table(self) -> None:
        clear(self._table)
        for row, cells in enumerate(self._comparison):
            for column, text in enumerate(cells):
                label = ElidedLabel(text) if column == 0 else QLabel(text)
                label.setFont(theme.font("small"))
                label.setProperty("role", "muted" if row == 0 or column == 0 else "")
                self._table.addWidget(label, row, column)
                if column:
                    label.setAlignment(Qt.AlignmentFlag.AlignRight)
        self._table.setColumnStretch(0, 1)
