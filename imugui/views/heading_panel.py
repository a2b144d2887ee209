"""Heading and what the detectors say: rest, and the magnetic field."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFrame, QHBoxLayout, QVBoxLayout

from imugui.views.compass import Compass
from imugui.views.labels import Chip
from imugui.views.live_words import heading_reason
from imugui.workers.session import Status

COMPASS = 124
NO_DATA = ("neutral", "no data")
REST = {True: ("good", "At rest"), False: ("neutral", "Moving")}
FIELD = {
    "good": ("good", "Field good"),
    "uncalibrated": ("warn", "Not calibrated"),
    "disturbed": ("warn", "Field disturbed"),
    "off": ("neutral", "Field not used"),
    "none": ("neutral", "No field"),
}


class HeadingPanel(QFrame):
    """Compass with two chips beneath."""

    def __init__(self) -> None:
        super().__init__()
        self.setProperty("role", "card")
        self.compass = Compass()
        self.compass.setFixedSize(COMPASS, COMPASS)
        self.rest = Chip(tuple(word for _, word in REST.values()), "Motion")
        self.field = Chip(tuple(word for _, word in FIELD.values()), "Magnetic field")
        self.rest.setToolTip("At rest the filter measures the gyroscope's bias")
        self.field.setToolTip("Whether the field is the earth's alone, so that the heading can be trusted")
        chips = QHBoxLayout()
        chips.setSpacing(8)
        chips.addStretch(1)
        chips.addWidget(self.rest)
        chips.addWidget(self.field)
        chips.addStretch(1)
        column = QVBoxLayout(self)
        column.setContentsMargins(16, 12, 16, 12)
        column.setSpacing(10)
        column.addWidget(self.compass, 0, Qt.AlignmentFlag.AlignHCenter)
        column.addLayout(chips)
        self._reason = ""

    def show_heading(self, heading_deg: float) -> None:
        """Point the compass, degrees clockwise from magnetic north."""
        self.compass.set_heading(heading_deg, self._reason)

    def show_flags(self, status: Status, rest: bool) -> None:
        """Show what the detectors say."""
        self._reason = heading_reason(status)
        self.rest.show_state(*REST[rest])
        self.field.show_state(*FIELD[status.mag_trust])

    def blank(self) -> None:
        """There are no data."""
        self.compass.set_heading(None)
        self.rest.show_state(*NO_DATA)
        self.field.show_state(*NO_DATA)
