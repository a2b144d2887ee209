"""A profile in words for the overview: the state of every part, how good in degrees, since when."""

from __future__ import annotations

import math
from collections.abc import Callable
from datetime import UTC, datetime
from typing import Any

from imugui.calibration.parts import GyroscopePart, Part
from imugui.calibration.profile import LIFE_DAYS, SCALE_LIFE_DAYS, Board, Profile
from imugui.views.calibrate_parts import PARTS, PartState
from imugui.views.calibrate_trust import Field
from imugui.workers.session import Session

NAMES = {
    "gyr": "gyroscope",
    "acc": "accelerometer",
    "axes": "magnetometer",
    "mag": "magnetometer",
    "mounting": "mounting",
    "temperature": "temperature",
}
"""Where the page's parts are in a profile; the axes are part of the magnetometer's."""
DEGREE = math.pi / 180.0
_TONES = {"good": ("good", "Good"), "usable": ("good", "Usable"), "poor": ("warn", "Rough")}
OLD = ("warn", "Old")


def part_states(profile: Profile | None, now: datetime | None = None) -> dict[str, PartState]:
    """The state of each of PARTS."""
    return {name: _state(name, profile, now or datetime.now(UTC)) for name in PARTS}


def advice(first: tuple[str, ...], profile: Profile | None) -> str:
    """Which of these parts had better be calibrated before; empty when all of them are."""
    states = part_states(profile)
    missing = [PARTS[name].title.lower() for name in first if not states[name].good]
    return f"Better after the {' and '.join(missing)}: without, picture and check are less sure." if missing else ""


def field_of(profile: Profile | None) -> Field | None:
    """The field that the profile expects; None without a magnetometer calibration."""
    mag = profile.magnetometer if profile else None
    return Field(mag.field_ut, mag.dip_deg) if mag else None


def fresh_profile(session: Session) -> Profile:
    """An empty profile for the board that is connected."""
    return Profile(session.board or Board())


def age_words(when: datetime, now: datetime) -> str:
    """How long ago: "just now", "3 h ago", "12 days ago", with the day."""
    hours = (now - when).total_seconds() / 3600.0
    local = when.astimezone()
    day = f"{local.day} {local:%b %Y}" if hours > 20.0 else f"{local:%H:%M}"
    if hours < 0.1:
        return "just now"
    if hours < 1.0:
        return f"{60.0 * hours:.0f} min ago"
    return f"{hours:.0f} h ago, {day}" if hours < 48.0 else f"{hours / 24.0:.0f} days ago, {day}"


def _state(name: str, profile: Profile | None, now: datetime) -> PartState:
    part: Any = getattr(profile, NAMES[name]) if profile else None
    if part is None or (name == "axes" and not part.axes):
        return PartState()
    return PartState(
        *_tone(NAMES[name], part, now), _GOOD[name](part, profile), age_words(part.when(), now), part.method
    )


def _tone(name: str, part: Part, now: datetime) -> tuple[str, str]:
    days = (now - part.when()).total_seconds() / 86400.0
    old = days > LIFE_DAYS.get(name, math.inf)
    if isinstance(part, GyroscopePart):
        old |= (now - part.matrix_when()).days > SCALE_LIFE_DAYS
    return OLD if old else _TONES[part.quality]


def _gyr(part: Any, profile: Any) -> str:
    drift = 60.0 * 2.0 * max(part.sigma) / DEGREE
    if not math.isnan(part.matrix_sigma):
        return f"Drifts by at most {drift:.1f}° a minute; scale learnt in motion, to {100 * part.matrix_sigma:.1f} %"
    scale = "" if math.isnan(part.turn_error_deg) else f"; {part.turn_error_deg:.1f}° in a turn"
    return f"Drifts by at most {drift:.1f}° a minute{scale}"


def _acc(part: Any, profile: Any) -> str:
    tilt = f"Roll and pitch to {part.tilt_deg:.2f}°"
    return tilt if math.isnan(part.residual_mg) else f"{tilt}, {part.residual_mg:.1f} mg left"


def _mag(part: Any, profile: Any) -> str:
    return f"Heading to {profile.heading_error_deg:.1f}°, {100 * part.coverage:.0f} % of directions seen"


def _temperature(part: Any, profile: Any) -> str:
    return f"{part.low_c:.0f} to {part.high_c:.0f} °C, to {part.error_dps:.3f} °/s"


_GOOD: dict[str, Callable[[Any, Any], str]] = {
    "gyr": _gyr,
    "acc": _acc,
    "mag": _mag,
    "axes": lambda part, profile: f"Magnetometer axes: {part.axes}",
    "mounting": lambda part, profile: f"Ahead is known to {part.error_deg:.1f}°",
    "temperature": _temperature,
}
