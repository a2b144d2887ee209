"""The plans as a table that can be edited in place."""

from __future__ import annotations

import math
from typing import Any

from PySide6.QtCore import QAbstractTableModel, QModelIndex, QPersistentModelIndex, Qt

from imugui.guidance.plan import ANGLES, FIELDS, Plan
from imugui.views import theme
from imugui.views.guide_plan_sheet import PlanSheet

Index = QModelIndex | QPersistentModelIndex
COLUMNS = ("name", "side", "first", "second", "depth_mm", "tolerance_deg", "amber_deg")
HEADS = ("Level", "Side", "Axial", "Sagittal", "Depth", "Green", "Amber")
"""The two angles are yaw and pitch where the plan is a plain one."""
WAYS = {
    "axial_deg": ("medial", "lateral"),
    "sagittal_deg": ("cranial", "caudal"),
    "yaw_deg": ("left", "right"),
    "pitch_deg": ("down", "up"),
}


def field_at(kind: str, column: int) -> str:
    """The field of a plan that stands in a column."""
    name = COLUMNS[column]
    return {"first": ANGLES[kind][0], "second": ANGLES[kind][1]}.get(name, name)


def cell_words(plan: Plan, name: str) -> str:
    """A value as read, never a bare sign: "12° medial"."""
    value = getattr(plan, name)
    if not isinstance(value, float):
        return str(value)
    if math.isnan(value):
        return "any" if name == "roll_deg" else "–"
    if name not in WAYS:
        return f"{value:g}{FIELDS[name].metadata['unit']}"
    positive, negative = WAYS[name]
    return f"{abs(value):g}° {negative if value < 0.0 else positive}"


class PlanModel(QAbstractTableModel):
    """A window on a PlanSheet; a text that is wrong stays in its cell, marked, with the reason as its tooltip."""

    def __init__(self, sheet: PlanSheet) -> None:
        super().__init__()
        self.sheet = sheet

    def refresh(self) -> None:
        """Read the sheet anew, after it was changed from outside."""
        self.beginResetModel()
        self.endResetModel()

    def rowCount(self, parent: Index | None = None) -> int:
        return 0 if parent is not None and parent.isValid() else len(self.sheet.drafts)

    def columnCount(self, parent: Index | None = None) -> int:
        return 0 if parent is not None and parent.isValid() else len(COLUMNS)

    def flags(self, index: Index) -> Qt.ItemFlag:
        flag = Qt.ItemFlag
        return flag.ItemIsEnabled | flag.ItemIsSelectable | flag.ItemIsEditable

    def headerData(self, section: int, orientation: Qt.Orientation, role: int = Qt.ItemDataRole.DisplayRole) -> Any:
        if role == Qt.ItemDataRole.TextAlignmentRole:
            return Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter
        if role != Qt.ItemDataRole.DisplayRole:
            return None
        if orientation == Qt.Orientation.Vertical:
            return str(section + 1)
        plain = bool(self.sheet.drafts) and all(draft.kind == "plain" for draft in self.sheet.drafts)
        return ({"Axial": "Yaw", "Sagittal": "Pitch"} if plain else {}).get(HEADS[section], HEADS[section])

    def data(self, index: Index, role: int = Qt.ItemDataRole.DisplayRole) -> Any:
        if not index.isValid():
            return None
        row = index.row()
        draft = self.sheet.drafts[row]
        name = field_at(draft.kind, index.column())
        wrong = self.sheet.problems[row].get(name, "")
        if role == Qt.ItemDataRole.EditRole:
            return draft.texts.get(name, "")
        if role in (Qt.ItemDataRole.DisplayRole, Qt.ItemDataRole.AccessibleTextRole):
            text = draft.texts.get(name, "") if wrong else cell_words(self.sheet.plan(row), name)
            return f"{theme.tone_glyph('bad')} {text}" if wrong else text
        if role == Qt.ItemDataRole.ToolTipRole:
            return wrong or FIELDS[name].metadata["tip"] or FIELDS[name].metadata["label"]
        if role == Qt.ItemDataRole.ForegroundRole and wrong:
            return theme.palette().bad
        return None

    def setData(self, index: Index, value: Any, role: int = Qt.ItemDataRole.EditRole) -> bool:
        if role != Qt.ItemDataRole.EditRole or not index.isValid():
            return False
        row = index.row()
        self.sheet.edit(row, **{field_at(self.sheet.drafts[row].kind, index.column()): str(value)})
        self.dataChanged.emit(self.index(0, 0), self.index(len(self.sheet.drafts) - 1, len(COLUMNS) - 1))
        return True
