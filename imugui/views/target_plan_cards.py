"""Cards of a study's plan: the people, as codes, and the conditions."""

from __future__ import annotations

import re
from collections.abc import Mapping

from PySide6.QtCore import Signal, Slot
from PySide6.QtWidgets import QFormLayout, QLineEdit, QSpinBox, QVBoxLayout

from imugui.targeting.settings import PRESETS, Control
from imugui.targeting.study_plan import MOST_PEOPLE, codes
from imugui.views.controls import Button, StillBox, clear
from imugui.views.guide_parts import Card, row_of
from imugui.views.labels import ElidedLabel, muted
from imugui.views.target_words import control_words

TEXT_MARGIN = 6  # px; Qt gives a spin box no padding on this side
AS_PLAYED = "as in the Play tab"


class PeopleCard(Card):
    """How many take part, and their codes."""

    changed = Signal()

    def __init__(self, people: tuple[str, ...]) -> None:
        super().__init__("Participants")
        self.count = QSpinBox()
        self.count.setRange(1, MOST_PEOPLE)
        self.count.setAccessibleName("Number of participants")
        self.count.setToolTip("Their codes become P01, P02, …")
        self.count.lineEdit().setTextMargins(TEXT_MARGIN, 0, 0, 0)
        self.codes = QLineEdit()
        self.codes.setAccessibleName("Codes of the participants")
        self.codes.setToolTip("One code for each person, with spaces between. Never names.")
        form = QFormLayout()
        form.addRow("Number", self.count)
        form.addRow("Codes", self.codes)
        self.add(form, muted("Codes, never names: who is who stays outside of this program."))
        self.set_people(people)
        self.count.valueChanged.connect(self._counted)
        self.codes.editingFinished.connect(self._typed)

    def people(self) -> tuple[str, ...]:
        """The codes."""
        return tuple(re.split(r"[\s,;]+", self.codes.text().strip(" ,;\t")))

    def set_people(self, people: tuple[str, ...]) -> None:
        """Show these codes."""
        self.count.blockSignals(True)
        self.count.setValue(len(people))
        self.count.blockSignals(False)
        self.codes.setText(" ".join(people))
        self.codes.setCursorPosition(0)

    @Slot()
    def _counted(self) -> None:
        self.set_people(codes(self.count.value()))
        self.changed.emit()

    @Slot()
    def _typed(self) -> None:
        self.set_people(self.people())
        self.changed.emit()


class ConditionsCard(Card):
    """The mappings that are compared, each with a name."""

    changed = Signal()

    def __init__(self, conditions: Mapping[str, Control]) -> None:
        super().__init__("Conditions")
        self._controls = list(conditions.values())
        self._played = Control()
        self.names: list[QLineEdit] = []
        self._rows = QVBoxLayout()
        self._rows.setSpacing(2)
        self.more = StillBox("Mapping to add", "A set of values, or the mapping that is set in the Play tab")
        for name in (*PRESETS, AS_PLAYED):
            self.more.add(name, name)
        self.add_button = Button("Add", "Add this mapping as a condition")
        self.add_button.clicked.connect(self._add)
        self.add(self._rows, row_of(self.more, self.add_button))
        self._show(tuple(conditions))

    def conditions(self) -> dict[str, Control]:
        """The mappings by name; two of one name are one."""
        return dict(zip(self._names(), self._controls, strict=True))

    @property
    def twice(self) -> str:
        """A name that is there twice; empty when there is none."""
        names = self._names()
        return next((name for name in names if names.count(name) > 1), "")

    def set_played(self, control: Control) -> None:
        """The mapping that is set in the Play tab."""
        self._played = control

    def _names(self) -> list[str]:
        return [line.text().strip() for line in self.names]

    @Slot()
    def _add(self) -> None:
        chosen = self.more.currentData()
        names = self._names()
        wanted = "custom" if chosen == AS_PLAYED else chosen
        name = next(one for one in (wanted, *(f"{wanted} {k}" for k in range(2, 100))) if one not in names)
        self._controls.append(PRESETS.get(chosen, self._played))
        self._show((*names, name))
        self.changed.emit()

    def _remove(self, place: int) -> None:
        names = self._names()
        del names[place], self._controls[place]
        self._show(tuple(names))
        self.changed.emit()

    def _show(self, names: tuple[str, ...]) -> None:
        clear(self._rows)
        self.names = []
        for place, (name, control) in enumerate(zip(names, self._controls, strict=True)):
            self._rows.addWidget(self._row(place, name, control))

    def _row(self, place: int, name: str, control: Control) -> Card:
        line = QLineEdit(name)
        line.setAccessibleName(f"Name of condition {place + 1}")
        line.setToolTip("How this condition is called on screen and in the results")
        line.editingFinished.connect(self.changed)
        remove = Button("Remove", f"Take {name} out of the study", small=True)
        remove.setEnabled(len(self._controls) > 1)
        remove.clicked.connect(lambda: self._remove(place))
        self.names.append(line)
        words = ElidedLabel(control_words(control))
        words.setProperty("role", "muted")
        card = Card()
        card.body.setContentsMargins(10, 8, 10, 8)
        row = row_of(line, remove, stretch=False)
        return card.add(row, words)
