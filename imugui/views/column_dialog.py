"""The dialog in which the user names the columns and units of a board that sends bare numbers, once per board."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from PySide6.QtCore import Qt, Signal, Slot
from PySide6.QtGui import QIcon
from PySide6.QtWidgets import (
    QDialog,
    QDialogButtonBox,
    QDoubleSpinBox,
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QScrollArea,
    QSpinBox,
    QVBoxLayout,
    QWidget,
)

from imugui.formats.families import FAMILIES
from imugui.views.column_names import MEANINGS, QUANTITIES, Meaning, cells, meaning_of, width_of
from imugui.views.controls import StillBox, clear
from imugui.views.labels import ToneLabel, heading, muted
from imugui.workers.session import Options

USUAL_WIDTH = 6
WIDEST = 40
PER_ROW = 3
EXPLAINED = (
    "This board sends numbers without saying what they are. Name each column once; imugui remembers it for this board. "
    "At least the three accelerations and the three angular rates are needed."
)


class ColumnDialog(QDialog):
    """``lines`` are the newest lines that the board sent, to compare with; may be empty."""

    named = Signal(object)  # Options

    def __init__(self, lines: Sequence[str], options: Options, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle("Columns and units")
        self.setModal(True)
        self.resize(760, 620)
        self._lines = lines[-3:]
        self._delimiter = options.delimiter
        width = len(options.columns) or min(WIDEST, width_of(self._lines, options.delimiter)) or USUAL_WIDTH
        self._start = meaning_of(options.columns, width)
        self.meanings: list[StillBox] = []
        self.units: dict[str, StillBox] = {}
        self.counts: dict[str, QDoubleSpinBox] = {}
        self.width_box = self._width_box(width)
        self.family = _family_box(options.family)
        self.problem = ToneLabel()
        self._columns = QWidget()
        self._grid = QGridLayout(self._columns)
        self._lay_out()
        self._show_columns()

    def meaning(self) -> Meaning:
        """What is said on screen."""
        return Meaning(
            tuple(box.currentData() for box in self.meanings),
            {key: box.currentData() for key, box in self.units.items()},
            {key: box.value() for key, box in self.counts.items()},
        )

    def options(self) -> Options:
        """The same as Options."""
        return Options(self.family.currentData(), self.meaning().names(), self._delimiter)

    def accept(self) -> None:
        self.named.emit(self.options())
        super().accept()

    @Slot()
    def _judge(self) -> None:
        wrong = self.meaning().problem()
        names = ", ".join(name for name in self.meaning().names())
        self.problem.show_phrase("warn" if wrong else "good", wrong or f"Complete: {names}")
        self.problem.setToolTip(names)
        self._buttons.button(QDialogButtonBox.StandardButton.Ok).setEnabled(not wrong)

    @Slot()
    def _width_changed(self) -> None:
        said = self.meaning()
        width = self.width_box.value()
        slots = said.slots + meaning_of((), width).slots[len(said.slots) :]
        self._start = Meaning(slots[:width], said.units, said.counts)
        self._show_columns()

    def _show_columns(self) -> None:
        """One box for each column, with the values that came in it."""
        clear(self._grid)
        rows = [cells(line, self._delimiter) for line in self._lines]
        self.meanings = []
        for i, slot in enumerate(self._start.slots):
            box = StillBox(f"Column {i + 1}", "What this column means")
            for name, title in MEANINGS.items():
                box.add(title, name)
            box.choose(slot)
            box.currentIndexChanged.connect(self._judge)
            seen = "   ".join(row[i] for row in rows if i < len(row)) or "no value seen yet"
            place = self._grid, i // PER_ROW * 2, i % PER_ROW
            place[0].addWidget(muted(f"{i + 1}:  {seen}"), place[1], place[2])
            place[0].addWidget(box, place[1] + 1, place[2])
            self.meanings.append(box)
        for one, following in pairwise([self.width_box, *self.meanings]):
            QWidget.setTabOrder(one, following)
        self._judge()

    def _lay_out(self) -> None:
        self._grid.setContentsMargins(0, 0, 8, 0)
        self._grid.setHorizontalSpacing(16)
        area = QScrollArea()
        area.setWidgetResizable(True)
        area.setWidget(self._columns)
        self._buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Ok | QDialogButtonBox.StandardButton.Cancel)
        self._buttons.button(QDialogButtonBox.StandardButton.Ok).setText("Use these columns")
        for button in self._buttons.buttons():
            button.setIcon(QIcon())  # some desktops put pictures of their own here
        self._buttons.accepted.connect(self.accept)
        self._buttons.rejected.connect(self.reject)
        width = QHBoxLayout()
        width.addWidget(heading("Columns"))
        width.addStretch(1)
        width.addWidget(QLabel("Number of columns"))
        width.addWidget(self.width_box)
        column = QVBoxLayout(self)
        column.setContentsMargins(20, 20, 20, 20)
        column.setSpacing(12)
        column.addWidget(muted(EXPLAINED))
        column.addLayout(width)
        column.addWidget(area, 1)
        column.addWidget(heading("Units"))
        column.addLayout(self._unit_grid())
        column.addWidget(self.problem)
        column.addWidget(self._buttons)

    def _unit_grid(self) -> QGridLayout:
        grid = QGridLayout()
        grid.setHorizontalSpacing(12)
        for row, (key, quantity) in enumerate(QUANTITIES.items()):
            unit = StillBox(f"Unit of {quantity.title.lower()}", "Unit in which the board writes it")
            for name, title in quantity.units.items():
                unit.add(title, name)
            unit.choose(self._start.units[key])
            unit.currentIndexChanged.connect(self._judge)
            counts = _counts_box(quantity.title, self._start.counts[key])
            counts.valueChanged.connect(self._judge)
            self.units[key], self.counts[key] = unit, counts
            for place, widget in enumerate((QLabel(quantity.title), unit, muted("counts per unit"), counts)):
                grid.addWidget(widget, row, place)
        grid.addWidget(QLabel("Sensor family"), len(QUANTITIES), 0)
        grid.addWidget(self.family, len(QUANTITIES), 1, 1, 3)
        grid.setColumnStretch(1, 1)
        grid.setColumnStretch(3, 1)
        return grid

    def _width_box(self, width: int) -> QSpinBox:
        box = QSpinBox()
        box.setRange(1, WIDEST)
        box.setValue(width)
        box.setAlignment(Qt.AlignmentFlag.AlignRight)
        box.setAccessibleName("Number of columns")
        box.setToolTip("How many values each line has")
        box.valueChanged.connect(self._width_changed)
        return box


def _counts_box(title: str, value: float) -> QDoubleSpinBox:
    box = QDoubleSpinBox()
    box.setDecimals(4)
    box.setRange(0.0001, 1e9)
    box.setValue(value)
    box.setAlignment(Qt.AlignmentFlag.AlignRight)
    box.setAccessibleName(f"Counts per unit of {title.lower()}")
    box.setToolTip("For raw counts: how many make one unit, such as 16384 per g. 1 for numbers that are in the unit")
    return box


def _family_box(name: str) -> StillBox:
    box = StillBox("Sensor family", "How the magnetometer sits beside the accelerometer")
    box.add("not said", "")
    for key, family in FAMILIES.items():
        box.add(family.title, key)
    box.choose(name)
    return box
