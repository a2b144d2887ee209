"""The readings as a table."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

from PySide6.QtCore import QAbstractTableModel, QModelIndex, QPersistentModelIndex, Qt

from imugui.guidance.aiming import Aim, band
from imugui.guidance.plan import plan_words
from imugui.guidance.reading import Reading
from imugui.guidance.report_numbers import COMPONENTS, signed, spread
from imugui.views import theme

Index = QModelIndex | QPersistentModelIndex
TONES = {"green": "good", "amber": "warn", "red": "bad"}


def _number(value: float, unit: str = "°", decimals: int = 1) -> str:
    return f"{value:.{decimals}f}{unit}" if math.isfinite(value) else "–"


def _across(reading: Reading) -> str:
    return signed(reading.medial_deg, *COMPONENTS[reading.plan.kind][0])


def _along(reading: Reading) -> str:
    return signed(reading.cranial_deg, *COMPONENTS[reading.plan.kind][1])


def tone_of(reading: Reading) -> str:
    """Good inside the tolerance, warn inside the wider one, else bad."""
    return TONES[band(Aim(math.radians(reading.error_deg), (0.0, 0.0)), reading.plan)]


COLUMNS: dict[str, Callable[[Reading], str]] = {
    "Trajectory": lambda reading: f"{theme.tone_glyph(tone_of(reading))} {reading.title}",
    "Plan": lambda reading: plan_words(reading.plan),
    "Error": lambda reading: f"{_number(reading.error_deg)} ±{_number(reading.sigma_deg)}",
    "Across": _across,
    "Along": _along,
    "To green": lambda reading: _number(reading.time_to_green_s, " s"),
    "Overshoots": lambda reading: str(reading.overshoots),
}
TIPS = {
    "Error": "Angle between tool and plan, and what 9 of 10 errors of it stay within",
    "Across": "Where the tool was against the plan",
    "Along": "Where the tool was against the plan",
    "To green": "From the first trusted sample to the first one inside the tolerance",
    "Overshoots": "How often the tool left green again",
}


def summary_words(readings: Sequence[Reading]) -> str:
    """Mean, standard deviation, root mean square and largest of the errors."""
    found = spread([reading.error_deg for reading in readings])
    said = {"mean": found.mean, "SD": found.sd, "RMS": found.rms, "largest": found.worst}
    return "Error: " + ", ".join(f"{name} {_number(value, decimals=2)}" for name, value in said.items())


class ReadingModel(QAbstractTableModel):
    """One row for each reading, the newest at the end."""

    def __init__(self) -> None:
        super().__init__()
        self.readings: list[Reading] = []

    def show_readings(self, readings: Sequence[Reading]) -> None:
        """Show these."""
        if list(readings) != self.readings:
            self.beginResetModel()
            self.readings = list(readings)
            self.endResetModel()

    def rowCount(self, parent: Index | None = None) -> int:
        return 0 if parent is not None and parent.isValid() else len(self.readings)

    def columnCount(self, parent: Index | None = None) -> int:
        return 0 if parent is not None and parent.isValid() else len(COLUMNS)

    def headerData(self, section: int, orientation: Qt.Orientation, role: int = Qt.ItemDataRole.DisplayRole) -> Any:
        if role != Qt.ItemDataRole.DisplayRole:
            return None
        level = orientation == Qt.Orientation.Horizontal
        return list(COLUMNS)[section] if level else str(self.readings[section].number)

    def data(self, index: Index, role: int = Qt.ItemDataRole.DisplayRole) -> Any:
        if not index.isValid():
            return None
        reading, name = self.readings[index.row()], list(COLUMNS)[index.column()]
        if role in (Qt.ItemDataRole.DisplayRole, Qt.ItemDataRole.AccessibleTextRole):
            return COLUMNS[name](reading)
        if role == Qt.ItemDataRole.ToolTipRole:
            about = f"Taken {reading.utc}, registration {reading.registration_id}, {reading.profile or 'no profile'}"
            return "\n".join(filter(None, (TIPS.get(name, ""), about)))
        if role == Qt.ItemDataRole.ForegroundRole and name in ("Trajectory", "Error"):
            return theme.tone_colour(tone_of(reading))
        return None
