"""UnitBox: the units of one column."""

from __future__ import annotations

import math

from PySide6.QtCore import Qt, Signal, Slot
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QLineEdit

from imugui.formats.evidence import scale
from imugui.formats.units import canonical
from imugui.views.column_words import short_unit, unit_title, units_of
from imugui.views.controls import StillBox

OTHER = "other"


class UnitBox(StillBox):
    """A list of units; with the last entry a person types another one, such as g/10000."""

    unit_changed = Signal()

    def __init__(self, name: str) -> None:
        super().__init__(name, "Unit of this column")
        self._slot = ""
        self._unit = ""
        self.setSizeAdjustPolicy(StillBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
        self.setMinimumContentsLength(6)
        self.activated.connect(self._picked)

    def unit(self) -> str:
        """The unit as column maps write it; "" where there is none."""
        return self._unit

    def offer(self, slot: str, unit: str) -> None:
        """Show the units of a slot, and one of them chosen."""
        self._slot, self._unit = slot, unit
        self._end_typing()
        units = units_of(slot)
        self.blockSignals(True)
        self.clear()
        for one in [*units, *([unit] if unit and unit not in units else [])]:
            self.add(unit_title(one), one, short=short_unit(one))
        if units:
            self.add("other…", OTHER)
        self.choose(unit)
        self.blockSignals(False)
        self.setEnabled(bool(units))

    def choose_unit(self, unit: str) -> None:
        """Take a unit, also one that the list does not hold, as if a person had chosen it."""
        if unit != self._unit:
            self.offer(self._slot, unit)
            self.unit_changed.emit()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if self.isEditable() and event.key() == Qt.Key.Key_Escape:
            self.offer(self._slot, self._unit)
        else:
            super().keyPressEvent(event)

    @Slot(int)
    def _picked(self, row: int) -> None:
        if self.isEditable():
            return
        if self.itemData(row) == OTHER:
            self._begin_typing()
        else:
            self.choose_unit(self.itemData(row))

    def _begin_typing(self) -> None:
        edit = QLineEdit()
        self.setLineEdit(edit)
        self.setInsertPolicy(StillBox.InsertPolicy.NoInsert)
        self.setCompleter(None)  # type: ignore[arg-type]
        edit.setText(f"{self._unit.partition('*')[0].rpartition('/')[0] or self._unit}/")
        edit.setToolTip("A unit, or counts per unit: g/10000, dps/14.375")
        edit.setAccessibleName(f"{self.accessibleName()}, typed")
        edit.editingFinished.connect(self._typed)
        edit.setFocus()

    @Slot()
    def _typed(self) -> None:
        if not self.isEditable():
            return
        text = self.currentText().strip()
        self.offer(self._slot, self._unit)
        if not math.isnan(scale(self._slot, text)):
            self.choose_unit(canonical(self._slot, text))

    def _end_typing(self) -> None:
        edit = self.lineEdit()
        if edit is not None:
            edit.blockSignals(True)
            self.setEditable(False)
