"""Runs of the game as a table."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

from PySide6.QtCore import QAbstractTableModel, QModelIndex, QPersistentModelIndex, Qt

from imugui.targeting.measures import MEASURES, Run
from imugui.views import theme

Index = QModelIndex | QPersistentModelIndex


def _measure(name: str) -> Callable[[Run], str]:
    """The column of a measure: its digits, a dash for what is not known."""
    digits = MEASURES[name].digits

    def cell(run: Run) -> str:
        value = getattr(run, name)
        return f"{value:.{digits}f}" if math.isfinite(value) else "–"

    return cell


def _block(run: Run) -> str:
    return "practice" if run.practice else str(run.block or "–")


COLUMNS: dict[str, tuple[Callable[[Run], str], str]] = {
    "Person": (lambda run: run.participant, "The code of who played"),
    "Condition": (lambda run: run.condition, "The mapping"),
    "Block": (_block, "Practice is left out of every comparison"),
    "Targets": (lambda run: str(run.targets), "How many targets were done"),
    "Time s": (_measure("elapsed_time_s"), "Elapsed time of the run, as in the thesis"),
    "Per target": (_measure("movement_time_s"), "Mean movement time per target, s"),
    "Bits/s": (_measure("throughput"), "Effective throughput, where a person selects"),
    "Nominal": (_measure("nominal_throughput"), "Nominal throughput, bits/s"),
    "Errors %": (_measure("error_percent"), "Targets that were selected without a match"),
    "Over": (_measure("overshoots"), "Overshoots per target"),
    "Clicks": (_measure("activations"), "Activations (button clicks), as in the thesis"),
    "Turn °": (_measure("mean_largest_rotation_deg"), "Mean of the largest rotation per activation, as in the thesis"),
}
"""Heading -> what stands in the column, and its tooltip."""

WIDTHS = (84, 128, 76, 68, 68, 84, 68, 76, 80, 60, 64, 64)
FIRST_NUMBER = 3


class RunModel(QAbstractTableModel):
    """One row for each run, the newest at the end."""

    def __init__(self) -> None:
        super().__init__()
        self.runs: tuple[Run, ...] = ()

    def show_runs(self, runs: Sequence[Run]) -> None:
        """Show these."""
        self.beginResetModel()
        self.runs = tuple(runs)
        self.endResetModel()

    def rowCount(self, parent: Index | None = None) -> int:
        return 0 if parent is not None and parent.isValid() else len(self.runs)

    def columnCount(self, parent: Index | None = None) -> int:
        return 0 if parent is not None and parent.isValid() else len(COLUMNS)

    def headerData(self, section: int, orientation: Qt.Orientation, role: int = Qt.ItemDataRole.DisplayRole) -> Any:
        level = orientation == Qt.Orientation.Horizontal
        if role == Qt.ItemDataRole.ToolTipRole and level:
            return list(COLUMNS.values())[section][1]
        if role != Qt.ItemDataRole.DisplayRole:
            return None
        return list(COLUMNS)[section] if level else str(section + 1)

    def data(self, index: Index, role: int = Qt.ItemDataRole.DisplayRole) -> Any:
        if not index.isValid():
            return None
        run, (cell, words) = self.runs[index.row()], list(COLUMNS.values())[index.column()]
        if role in (Qt.ItemDataRole.DisplayRole, Qt.ItemDataRole.AccessibleTextRole):
            return cell(run)
        if role == Qt.ItemDataRole.ToolTipRole:
            return "\n".join(filter(None, (words, run.throughput_word)))
        if role == Qt.ItemDataRole.TextAlignmentRole and index.column() >= FIRST_NUMBER:
            return Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
        if role == Qt.ItemDataRole.ForegroundRole and run.practice:
            return theme.palette().muted
        return None
