"""The first lines of one table, with what each column is and its unit above them."""

from __future__ import annotations

from collections import Counter

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QScrollArea, QVBoxLayout, QWidget

from imugui.formats.columns import MAP_NAMES, read_name
from imugui.formats.guess import TableGuess
from imugui.formats.placing import ColumnGuess
from imugui.formats.units import SURE, UNSURE, canonical
from imugui.views import theme
from imugui.views.column_words import LEVEL_WORDS, ROLES, SHORT_ROLES, siblings, units_of
from imugui.views.controls import StillBox
from imugui.views.labels import ElidedLabel, ToneLabel
from imugui.views.unit_box import UnitBox

LINES = 6  # of numbers that are shown
COLUMN_WIDTH = 178
BY_HAND = "as you say"


class ColumnCard(QFrame):
    """One column: its name in the file, what it is, its unit, how sure that is, and its first values."""

    def __init__(self, number: int, name: str, values: list[str]) -> None:
        super().__init__()
        self.setProperty("role", "card")
        self.setFixedWidth(COLUMN_WIDTH)
        title = ElidedLabel(name or f"column {number}")
        title.setFont(theme.font("small"))
        title.setProperty("role", "" if name else "muted")
        self.role = StillBox(f"Column {number}, {name}: what it is", "What this column means")
        self.role.setSizeAdjustPolicy(StillBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
        self.role.setMinimumContentsLength(6)
        for slot, words in ROLES.items():
            self.role.add(words, slot, short=SHORT_ROLES.get(slot, ""))
        self.unit = UnitBox(f"Column {number}, {name}: unit")
        self.mark = ToneLabel()
        cells = QLabel("\n".join(value or "·" for value in values))
        cells.setFont(theme.font("small"))
        cells.setProperty("role", "muted")
        cells.setTextFormat(Qt.TextFormat.PlainText)
        cells.setAlignment(Qt.AlignmentFlag.AlignRight)
        column = QVBoxLayout(self)
        column.setContentsMargins(10, 8, 10, 10)
        column.setSpacing(6)
        for widget in (title, self.role, self.unit, self.mark, cells):
            column.addWidget(widget)
        column.addStretch(1)

    def show_guess(self, guessed: ColumnGuess) -> None:
        """Mark how sure the guess is, and say why in the tooltip."""
        tone, word = LEVEL_WORDS[guessed.level]
        word = BY_HAND if guessed.reason == BY_HAND else word
        shaped = f"{theme.tone_glyph(tone)} {word}" if tone == "neutral" else word
        self.mark.show_phrase(tone if guessed.slot else "neutral", shaped if guessed.slot else "")
        for widget in (self, self.role, self.unit, self.mark):
            widget.setToolTip(guessed.reason)
        self.role.setAccessibleDescription(f"{self.mark.text()}: {guessed.reason}")


class ColumnTable(QScrollArea):
    """Shows a guess, and lets a person change it."""

    changed = Signal()

    def __init__(self, table: TableGuess) -> None:
        super().__init__()
        self.table = table
        self._said = list(table.columns)
        self.cards = [
            ColumnCard(number + 1, name, [row[number] for row in table.layout.cells[:LINES]])
            for number, name in enumerate(table.layout.names)
        ]
        self.setAccessibleName(f"Columns of {table.file or 'the table'}")
        self.setWidgetResizable(True)
        self.setVerticalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        inner = QWidget()
        row = QHBoxLayout(inner)
        row.setContentsMargins(0, 0, 0, 4)
        row.setSpacing(8)
        for number, card in enumerate(self.cards):
            guessed = self._said[number]
            card.role.choose(guessed.slot)
            card.unit.offer(guessed.slot, guessed.unit)
            card.show_guess(guessed)
            card.role.currentIndexChanged.connect(lambda _, number=number: self._role_changed(number))
            card.unit.unit_changed.connect(lambda number=number: self._unit_changed(number))
            row.addWidget(card)
        row.addStretch(1)
        self.setWidget(inner)
        bar = self.horizontalScrollBar().sizeHint().height()
        self.setFixedHeight(inner.sizeHint().height() + bar + 4)

    def names(self) -> tuple[str, ...]:
        """The columns as a column map names them."""
        return tuple(guessed.name for guessed in self._said)

    def slots(self) -> set[str]:
        """Everything that some column is said to be."""
        return {guessed.slot for guessed in self._said} - {""}

    def doubtful(self) -> list[str]:
        """What should be checked, as it is called on screen."""
        return [ROLES[guessed.slot] for guessed in self._said if guessed.slot and guessed.level == UNSURE]

    def twice(self) -> str:
        """What two columns are said to be, as it is called on screen; "" when all differ."""
        counts = Counter(guessed.slot for guessed in self._said if guessed.slot)
        return next((ROLES[slot] for slot, count in counts.items() if count > 1), "")

    def _role_changed(self, number: int) -> None:
        slot = self.cards[number].role.currentData()
        guessed = self.table.columns[number]
        if slot != guessed.slot:
            guessed = ColumnGuess(slot, self._unit_for(slot), SURE, BY_HAND if slot else "not used, as you say")
        self.cards[number].unit.offer(slot, guessed.unit)
        self._say(number, guessed)
        self.changed.emit()

    def _unit_changed(self, number: int) -> None:
        """The three axes of a sensor share their unit."""
        unit, slot = self.cards[number].unit.unit(), self._said[number].slot
        for other, guessed in enumerate(self._said):
            if guessed.slot in siblings(slot) and guessed.unit != unit:
                self._say(other, ColumnGuess(guessed.slot, unit, SURE, BY_HAND))
                self.cards[other].unit.offer(guessed.slot, unit)
        self.changed.emit()

    def _unit_for(self, slot: str) -> str:
        """The unit that the other axes of the same sensor have, or the usual one."""
        near = [guessed.unit for guessed in self._said if slot and guessed.slot in siblings(slot)]
        return next(iter([*near, *units_of(slot)]), "")

    def _say(self, number: int, guessed: ColumnGuess) -> None:
        self._said[number] = guessed
        self.cards[number].show_guess(guessed)


def said_before(name: str) -> ColumnGuess:
    """A column as a column map names it, which a person has said once."""
    column = read_name(name, MAP_NAMES)
    if column is None:
        return ColumnGuess(reason="not used, as you said before")
    _, sign, unit = name.partition(f"{column.slot}_")
    return ColumnGuess(column.slot, canonical(column.slot, unit if sign else column.unit), SURE, "as you said before")
