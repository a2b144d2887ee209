"""Status: one snapshot of everything the connection bar, the status line and reports show."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from imugui.samples import Rows
from imugui.workers.verdict import State


@dataclass(frozen=True)
class Status:
    """Numbers that do not apply are NaN, words that do not apply are empty."""

    state: State = State.IDLE
    sentence: str = ""
    source: str = ""
    format: str = ""
    seen: str = ""
    baud: int = 0
    rate_hz: float = 0.0
    jitter_ms: float = math.nan
    messages: int = 0
    bad_messages: int = 0
    samples: int = 0
    gaps: int = 0
    gap_s: float = 0.0
    missed_rows: int = 0
    age_ms: float = math.nan
    has_mag: bool = False
    mag_trust: str = "none"  # "none", "off", "disturbed", "uncalibrated", "good"
    mag_alarm: str = "off"  # "off", "green", "yellow", "red": the field against the calibration's
    mag_norm_ut: float = math.nan
    temp_c: float = math.nan
    profile: str = ""
    filter: str = ""
    filter_note: str = ""  # why another filter has taken over for now
    board: str = ""  # what a wireless board tells of itself: maker, model, firmware
    battery_percent: float = math.nan
    rssi_dbm: float = math.nan  # of the newest advertisement: a link's own signal is not told by most systems
    overflow: int = 0  # messages that came faster than they could be taken in


def board_facts(transport: Any) -> dict[str, Any]:
    """What a transport knows of a wireless board, under the names of Status; empty for others."""
    facts = getattr(transport, "facts", None)
    if facts is None:
        return {}
    about = " ".join(facts.about.values())
    return {
        "board": about,
        "battery_percent": facts.battery_percent,
        "rssi_dbm": facts.rssi_dbm,
        "overflow": facts.overflow,
    }


@dataclass(frozen=True)
class RelativeStatus:
    """What a page says of the relative attitude. Ages in ms, of the newest attitude; numbers not known are NaN."""

    tool_age_ms: float
    reference_age_ms: float
    aligned: bool  # the two headings can be compared
    same_north: bool  # by the magnetometers of both
    aligned_s: float  # seconds since the two boards were aligned; NaN when they were not
    residual_deg: float  # how differently the two boards were held then, apart from the heading


def mag_trust(rows: Rows, use_mag: bool, calibrated: bool, alarm: str = "off") -> tuple[str, float]:
    """(word, median field in uT) from the newest ATTITUDE rows, shape (n,), and the light of the field's alarm.

    A field that is merely quiet may still be off by tens of degrees: it is "good" only with a calibration.
    """
    mag = rows["mag"][np.isfinite(rows["mag"]).all(axis=1)] if len(rows) else np.empty((0, 3))
    if len(mag) == 0:
        return "none", math.nan
    norm = float(np.median(np.linalg.norm(mag, axis=1)))
    if not use_mag:
        return "off", norm
    if alarm == "red" or float(np.mean(rows["disturbed"])) > 0.5:
        return "disturbed", norm
    return ("good" if calibrated else "uncalibrated"), norm
