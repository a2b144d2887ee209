"""TrustStrip: the field as it is now against the profile: strength, dip, and the alarm."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from PySide6.QtWidgets import QFrame, QHBoxLayout

from imugui.samples import Rows
from imugui.views.labels import Chip, ElidedLabel, muted
from imugui.workers.session import Session, Status

LOOK_ROWS = 64
ALARMS = {
    "green": ("good", "Field as calibrated"),
    "yellow": ("warn", "Field off by over 4 %"),
    "red": ("bad", "Field off by over 6 %"),
    "off": ("neutral", "No verdict yet"),
}
UNKNOWN = ("neutral", "Not calibrated")
ADVICE = {
    "yellow": "Something magnetic is near: the heading may be off by a few degrees.",
    "red": "Do not trust the heading. Move away from metal; if it stays, calibrate the magnetometer again.",
}


@dataclass(frozen=True)
class Field:
    """Strength in uT and dip in degrees (below the horizon), NaN where unknown."""

    norm_ut: float = math.nan
    dip_deg: float = math.nan


def measure(rows: Rows) -> Field:
    """Mean strength and dip of corrected ATTITUDE rows, shape (n,)."""
    known = rows[np.isfinite(rows["mag"]).all(axis=1) & np.isfinite(rows["acc"]).all(axis=1)]
    if len(known) == 0:
        return Field()
    norms = np.linalg.norm(known["mag"], axis=1)
    up = (known["acc"] * known["mag"]).sum(axis=1) / np.maximum(norms * np.linalg.norm(known["acc"], axis=1), 1e-12)
    return Field(float(norms.mean()), -math.degrees(math.asin(float(np.clip(up.mean(), -1.0, 1.0)))))


def field_words(now: Field, wanted: Field) -> str:
    """ "48.2 µT (profile 47.9), dip 64.8° (profile 65.1°)"; --- for what is unknown."""
    strength = _pair(now.norm_ut, wanted.norm_ut, " µT")
    return f"{strength},  dip {_pair(now.dip_deg, wanted.dip_deg, '°')}"


def _pair(now: float, wanted: float, unit: str) -> str:
    shown = "---" if math.isnan(now) else f"{now:.1f}"
    return f"{shown}{unit}" + ("" if math.isnan(wanted) else f" (profile {wanted:.1f}{unit})")


class TrustStrip(QFrame):
    """One line at the foot of the page."""

    def __init__(self, session: Session) -> None:
        super().__init__()
        self.session = session
        self.setProperty("role", "bar")
        self.chip = Chip(tuple(word for _, word in (*ALARMS.values(), UNKNOWN)), "Magnetic field")
        self.chip.setToolTip("The field's strength against the profile, at every sample")
        self.words = ElidedLabel()
        self.advice = ElidedLabel()
        self.advice.setProperty("role", "muted")
        row = QHBoxLayout(self)
        row.setContentsMargins(16, 6, 16, 6)
        row.setSpacing(12)
        title = muted("Field now")
        title.setWordWrap(False)
        row.addWidget(title)
        row.addWidget(self.chip)
        row.addWidget(self.words, 3)
        row.addWidget(self.advice, 4)

    def refresh(self, status: Status, wanted: Field | None) -> None:
        """Show the field now; ``wanted`` is the profile's, None without a magnetometer calibration."""
        self.setVisible(status.has_mag)
        if not status.has_mag:
            return
        alarm = status.mag_alarm if wanted is not None else ""
        self.chip.show_state(*ALARMS.get(alarm, UNKNOWN))
        self.words.show_line(field_words(measure(self.session.attitude.last(LOOK_ROWS)), wanted or Field()))
        self.advice.show_line(ADVICE.get(alarm, ""))
        self.advice.setVisible(alarm in ADVICE)
