"""The Plan step: the trajectories in a table, one of them field by field, import and export."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from PySide6.QtCore import QModelIndex, Qt, Signal, Slot
from PySide6.QtWidgets import (
    QAbstractItemView,
    QFileDialog,
    QHBoxLayout,
    QTableView,
    QVBoxLayout,
    QWidget,
)

from imugui.guidance.plan import CONVENTION, Plan
from imugui.guidance.plan_file import load_plans, write_plans
from imugui.views import theme
from imugui.views.controls import Button
from imugui.views.guide_parts import Card, Complaint, column_of, dress_table, row_of
from imugui.views.guide_plan_editor import PlanEditor
from imugui.views.guide_plan_model import PlanModel
from imugui.views.guide_plan_sheet import PlanSheet
from imugui.views.labels import heading, muted

FILES = "Plans (*.csv *.txt *.tsv);;All files (*)"
MOST_TOLD = 4
WIDTHS = (90, 62, 104, 108, 72, 56, 48)


class PlanPanel(QWidget):
    """Whatever can be used already is told at once; what is wrong stays in its field and says so."""

    changed = Signal()
    said = Signal(str, str)  # tone, sentence
    finished = Signal()  # on to the next step

    def __init__(self) -> None:
        super().__init__()
        self.sheet = PlanSheet()
        self.model = PlanModel(self.sheet)
        self.table = QTableView()
        self.editor = PlanEditor(self.sheet)
        self.count = heading("")
        self.trouble = Complaint("What is wrong with the plans")
        self._make_buttons()
        self._make_table()
        self._lay_out()
        self.model.dataChanged.connect(self._cell_edited)
        self.editor.edited.connect(self._field_edited)
        self.table.selectionModel().currentRowChanged.connect(self._selected)
        self._told()

    def plans(self) -> list[Plan]:
        """The plans that can be used."""
        return self.sheet.plans

    def load(self, plans: Sequence[Plan]) -> None:
        """Show these plans instead."""
        self.sheet.load(plans)
        self._reset(0 if plans else -1)

    @Slot()
    def add(self) -> None:
        """One more plan, and on to its fields."""
        self._reset(self.sheet.add())
        self.editor.level.setFocus(Qt.FocusReason.TabFocusReason)  # which selects the text
        self.changed.emit()

    @Slot()
    def delete(self) -> None:
        """Delete the plan that is selected."""
        row = self.table.currentIndex().row()
        if row >= 0:
            self.sheet.remove(row)
            self._reset(min(row, len(self.sheet.drafts) - 1))
            self.changed.emit()

    @Slot()
    def ask_import(self) -> None:
        """Ask for a file of plans."""
        name, _ = QFileDialog.getOpenFileName(self, "Import plans", "", FILES)
        if name:
            self.import_file(Path(name))

    def import_file(self, path: Path) -> None:
        """Put the plans of a CSV file behind those there are; every line that is wrong is named."""
        try:
            plans, wrong = load_plans(path)
        except OSError as error:
            self._tell([f"{path.name} cannot be read: {error.strerror or error}."])
            return
        self.sheet.append(plans)
        self._reset(len(self.sheet.drafts) - 1)
        self._tell([*wrong, *self._row_problems()])
        self.said.emit("info" if plans else "warn", f"{len(plans)} plans taken from {path.name}.")
        self.changed.emit()

    @Slot()
    def ask_export(self) -> None:
        """Ask where the plans shall be written."""
        name, _ = QFileDialog.getSaveFileName(self, "Export plans", "plans.csv", FILES)
        if not name:
            return
        try:
            Path(name).write_text(write_plans(self.sheet.plans), encoding="utf-8")
        except OSError as error:
            self.said.emit("error", f"The plans cannot be written to {name}: {error.strerror or error}.")
            return
        self.said.emit("info", f"{len(self.sheet.plans)} plans are in {name}.")

    # inside

    def _reset(self, row: int) -> None:
        """Show the sheet as it is, with a row selected."""
        self.model.refresh()
        if row >= 0:
            self.table.setCurrentIndex(self.model.index(row, 0))
        self.editor.show_row(row)
        self._told()

    @Slot(QModelIndex, QModelIndex)
    def _selected(self, index: QModelIndex, _before: QModelIndex) -> None:
        self.editor.show_row(index.row())

    @Slot()
    def _cell_edited(self) -> None:
        self.editor.show_row(self.table.currentIndex().row())
        self._told()
        self.changed.emit()

    @Slot()
    def _field_edited(self) -> None:
        self.table.viewport().update()
        self._told()
        self.changed.emit()

    def _told(self) -> None:
        """How many plans there are, and what is wrong with which."""
        drafts, good = len(self.sheet.drafts), len(self.sheet.plans)
        noun = "trajectory" if drafts == 1 else "trajectories"
        self.count.setText(f"{drafts} {noun}" if good == drafts else f"{good} of {drafts} trajectories can be used")
        self._tell(self._row_problems())
        for button in (self.delete_button, self.export_button):
            button.setEnabled(drafts > 0)
        self.next_button.setEnabled(good > 0)

    def _row_problems(self) -> list[str]:
        return [f"Row {row}: {said}" for row, wrong in enumerate(self.sheet.problems, 1) for said in wrong.values()]

    def _tell(self, wrong: list[str]) -> None:
        more = [f"and {len(wrong) - MOST_TOLD} more."] if len(wrong) > MOST_TOLD else []
        self.trouble.show_wrong("\n".join([*wrong[:MOST_TOLD], *more]))

    def _make_buttons(self) -> None:
        self.add_button = Button("Add", "One more trajectory: the other side, or the next level")
        self.delete_button = Button("Delete", "Delete the trajectory that is selected")
        self.import_button = Button("Import…", "Add trajectories from a CSV file", icon="open")
        self.export_button = Button("Export…", "Write all trajectories into a CSV file")
        self.next_button = Button("Next: tool axis", "On to the next step", role="primary")
        self.add_button.clicked.connect(self.add)
        self.delete_button.clicked.connect(self.delete)
        self.import_button.clicked.connect(self.ask_import)
        self.export_button.clicked.connect(self.ask_export)
        self.next_button.clicked.connect(self.finished)

    def _make_table(self) -> None:
        table = self.table
        table.setModel(self.model)
        table.setAccessibleName("Trajectories")
        table.setToolTip("Press F2 or double click to change a cell")
        table.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
        trigger = QAbstractItemView.EditTrigger
        table.setEditTriggers(trigger.DoubleClicked | trigger.EditKeyPressed)
        dress_table(table, WIDTHS)

    def _lay_out(self) -> None:
        left = QVBoxLayout()
        left.setContentsMargins(16, 12, 8, 12)
        left.setSpacing(10)
        left.addWidget(self.count)
        left.addWidget(self.table, 1)
        left.addWidget(self.trouble)
        buttons = row_of(self.add_button, self.delete_button, self.import_button, self.export_button)
        buttons.addWidget(self.next_button)
        left.addLayout(buttons)
        note = muted(CONVENTION)
        note.setFont(theme.font("small"))
        column = column_of(Card("Selected").add(self.editor), Card("What the angles mean").add(note))
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(0)
        row.addLayout(left, 1)
        row.addWidget(column)
