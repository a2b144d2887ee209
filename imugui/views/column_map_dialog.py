"""The dialog in which a person checks or says what the columns of a table are: of a file, or of a board's lines."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np
from PySide6.QtCore import Qt, Signal, Slot
from PySide6.QtGui import QIcon
from PySide6.QtWidgets import (
    QDialog,
    QDialogButtonBox,
    QDoubleSpinBox,
    QHBoxLayout,
    QLabel,
    QStackedWidget,
    QTabBar,
    QVBoxLayout,
    QWidget,
)

from imugui.formats.column_map import WIDEST_RATE, ColumnMap
from imugui.formats.columns import table_from
from imugui.formats.families import ALIGNED, FAMILIES
from imugui.formats.guess import Guess, TableGuess
from imugui.formats.layout import Layout
from imugui.formats.preview import preview
from imugui.formats.units import UNSURE
from imugui.views import theme
from imugui.views.column_table import ColumnTable
from imugui.views.column_words import ROLES
from imugui.views.controls import StillBox
from imugui.views.labels import Chip, ElidedLabel, muted
from imugui.views.map_preview import MapPreview
from imugui.workers.session import Options

SIZE = (980, 680)
OF_A_FILE = (
    "Above each column stands what imugui takes it for. Check what is marked, change what is wrong. It is remembered "
    "for this file, and for others with the same header."
)
OF_A_BOARD = (
    "This board sends numbers without saying what they are. Name each column once; imugui remembers it for this board. "
    "At least the three accelerations and the three angular rates are needed."
)
DELIMITERS = {",": "commas", ";": "semicolons", "\t": "tabs", " ": "blanks", "|": "bars"}
ALL_LINES = "all lines"
CHIPS = {"good": "Can be used", "warn": "Please check", "bad": "Not usable yet"}
MOST_KEYS = 12


class ColumnMapDialog(QDialog):
    """``name`` is shown in the title. ``of_board``: the lines came from a port, so they have no rate to be said."""

    named = Signal(object)  # Options

    def __init__(
        self, guess: Guess, name: str, family: str = "", of_board: bool = False, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self.setWindowTitle(f"Columns of {name}")
        self.setModal(True)
        self.resize(*SIZE)
        self._of_board = of_board
        self.tables = [ColumnTable(table) for table in guess.tables]
        self.tabs = _tabs(guess.tables)
        self._stack = QStackedWidget()
        self.keep = StillBox("Lines that are read", "Where lines of several kinds alternate: which of them are read")
        self.rate = _rate_box(next((table for table in guess.tables if table.rate_hz), None))
        self.family = _family_box(family)
        self._rate_label = QLabel("No times. Samples a second")
        self._family_label = QLabel("Sensor family")
        self.preview = MapPreview()
        self.chip = Chip(tuple(CHIPS.values()), "Columns")
        self.verdict = QLabel()
        self.verdict.setWordWrap(True)
        self.verdict.setTextFormat(Qt.TextFormat.PlainText)
        self._buttons = _buttons()
        self._fill_keep(guess.tables[0])
        self._lay_out()
        self._connect_parts()
        self.judge()

    def maps(self) -> list[tuple[Layout, ColumnMap]]:
        """The tables that something is read from, as they are said now."""
        said = []
        for number, table in enumerate(self.tables):
            if not table.slots() - {"t"}:
                continue
            keep = self.keep.currentData() if number == 0 else None
            column_map = dataclasses.replace(table.table.column_map, columns=table.names(), keep_column=-1)
            if keep is not None:
                column_map = dataclasses.replace(column_map, keep_column=keep[0], keep_value=keep[1])
            rate_hz = 0.0 if "t" in table.slots() else self.rate.value()
            said.append((table.table.layout, dataclasses.replace(column_map, rate_hz=rate_hz)))
        return said

    def options(self) -> Options:
        """The same as Options of a source."""
        maps = tuple(column_map for _, column_map in self.maps())
        family = self.family.currentData()
        if self._of_board:
            return Options(family, maps[0].columns, maps[0].delimiter)
        return Options(family, tables=maps)

    def accept(self) -> None:
        self.named.emit(self.options())
        super().accept()

    @Slot()
    def judge(self) -> None:
        """Show what the columns give as they are said now, and whether that can be used."""
        maps = self.maps()
        found = preview(maps)
        problem = self._named_twice() or (self._too_little(maps) if self._of_board else "") or found.problem
        self.preview.show_preview(found)
        self._buttons.button(QDialogButtonBox.StandardButton.Ok).setEnabled(not problem)
        used = set().union(*(table.slots() for table in self.tables))
        needs_rate = not self._of_board and "t" not in used
        self._rate_label.setVisible(needs_rate)
        self.rate.setVisible(needs_rate)
        self._family_label.setVisible("mx" in used)
        self.family.setVisible("mx" in used)
        tone, words = self._verdict(problem, any(one.tone == "warn" for one in found.findings))
        self.chip.show_state(tone, CHIPS[tone])
        self.verdict.setText(words)

    def _verdict(self, problem: str, speaks_against: bool) -> tuple[str, str]:
        """Tone and words about the whole."""
        doubtful = [title for table in self.tables for title in table.doubtful()]
        doubtful += ["the rate"] if self._rate_is_a_guess() else []
        if problem:
            return "bad", f"{problem[:1].upper()}{problem[1:]}."
        if doubtful:
            more = f" and {len(doubtful) - 3} more" if len(doubtful) > 3 else ""
            return "warn", f"Not certain: {', '.join(doubtful[:3])}{more}. Their tooltips say why."
        return (
            ("warn", "Look first at what is marked above.")
            if speaks_against
            else ("good", "Nothing speaks against it.")
        )

    def _rate_is_a_guess(self) -> bool:
        """Whether a rate is needed that neither the file nor a person has said."""
        table = next((one.table for one in self.tables if one.table.rate_hz), None)
        guessed = table is not None and table.rate.level == UNSURE and self.rate.value() == table.rate_hz
        return guessed and not self.rate.isHidden()

    def _named_twice(self) -> str:
        """Which column is said twice, in one table or in two, in words."""
        seen: dict[str, str] = {}
        for table in self.tables:
            if twice := table.twice():
                return f"{twice} is said of two columns"
            for slot in table.slots() - {"t"}:
                if slot in seen:
                    return f"{ROLES[slot]} is said in {seen[slot]} and in {table.table.file}"
                seen[slot] = table.table.file
        return ""

    def _too_little(self, maps: Sequence[tuple[Layout, ColumnMap]]) -> str:
        """What a board's lines lack, for a link takes nothing but whole samples."""
        names = maps[0][1].columns if maps else ()
        return table_from(names, b",", ALIGNED).problem

    def _fill_keep(self, table: TableGuess) -> None:
        """Offer the values of the first column when there are few of them."""
        self.keep.add(ALL_LINES, None)
        values = np.unique(table.layout.numbers[:, 0])
        values = values[np.isfinite(values)]
        if len(values) <= MOST_KEYS:
            for value in values.tolist():
                self.keep.add(f"only lines that begin with {value:g}", (0, value), short=f"lines with {value:g}")
        if table.keep is not None:
            self.keep.setCurrentIndex(1 + values.tolist().index(table.keep[1]))
        self.keep.setVisible(table.keep is not None)
        for box in (self.keep, self.family):
            box.setSizeAdjustPolicy(StillBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
            box.setMinimumContentsLength(12)

    def _connect_parts(self) -> None:
        for table in self.tables:
            table.changed.connect(self.judge)
        self.tabs.currentChanged.connect(self._stack.setCurrentIndex)
        self.keep.currentIndexChanged.connect(self.judge)
        self.rate.valueChanged.connect(self.judge)
        self._buttons.accepted.connect(self.accept)
        self._buttons.rejected.connect(self.reject)

    def _lay_out(self) -> None:
        for table in self.tables:
            self._stack.addWidget(table)
        self._stack.setFixedHeight(max(table.height() for table in self.tables))
        self.tabs.setVisible(len(self.tables) > 1)
        written = ElidedLabel(_layout_words(self.tables[0].table.layout))
        written.setProperty("role", "muted")
        written.setFont(theme.font("small"))
        said = QHBoxLayout()
        said.setSpacing(12)
        said.addWidget(written, 1)
        for widget in (self.keep, self._rate_label, self.rate, self._family_label, self.family):
            said.addWidget(widget)
        column = QVBoxLayout(self)
        column.setContentsMargins(20, 20, 20, 20)
        column.setSpacing(12)
        column.addWidget(muted(OF_A_BOARD if self._of_board else OF_A_FILE))
        column.addWidget(self.tabs)
        column.addWidget(self._stack)
        column.addLayout(said)
        column.addWidget(self.preview, 1)
        verdict = QHBoxLayout()
        verdict.setSpacing(12)
        verdict.addWidget(self.chip, 0, Qt.AlignmentFlag.AlignTop)
        verdict.addWidget(self.verdict, 1)
        column.addLayout(verdict)
        column.addWidget(self._buttons)


def _tabs(tables: Sequence[TableGuess]) -> QTabBar:
    bar = QTabBar()
    bar.setAccessibleName("Files that are read as one")
    bar.setExpanding(False)
    bar.setDrawBase(False)
    for table in tables:
        bar.addTab(table.file)
    return bar


def _layout_words(layout: Layout) -> str:
    """How the file is written, in words."""
    words = f"{layout.width} columns between {DELIMITERS[layout.delimiter]}"
    words += ", decimal commas" if layout.decimal == "," else ""
    lines = f"{layout.skip_lines} lines" if layout.skip_lines != 1 else "1 line"
    return f"{words}, {lines} above the numbers" if layout.skip_lines else words


def _rate_box(table: TableGuess | None) -> QDoubleSpinBox:
    box = QDoubleSpinBox()
    box.setDecimals(2)
    box.setFixedWidth(130)
    box.setRange(0.01, WIDEST_RATE)
    box.setValue(table.rate_hz if table else 100.0)
    box.setSuffix(" Hz")
    box.setKeyboardTracking(False)
    box.setAlignment(Qt.AlignmentFlag.AlignRight)
    box.setAccessibleName("Samples a second")
    box.setToolTip(table.rate.reason if table else "How many lines there are for each second")
    return box


def _buttons() -> QDialogButtonBox:
    box = QDialogButtonBox(QDialogButtonBox.StandardButton.Ok | QDialogButtonBox.StandardButton.Cancel)
    use = box.button(QDialogButtonBox.StandardButton.Ok)
    use.setText("Use these columns")
    use.setProperty("role", "primary")
    for button in box.buttons():
        button.setIcon(QIcon())  # some desktops put pictures of their own here
    return box


def _family_box(name: str) -> StillBox:
    box = StillBox("Sensor family", "How the magnetometer sits beside the accelerometer")
    box.add("not said", "")
    for key, family in FAMILIES.items():
        box.add(family.title, key)
    box.choose(name)
    return box
