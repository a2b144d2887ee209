"""What columns and units are called on screen."""

from __future__ import annotations

from imugui.formats.columns import QUANTITIES
from imugui.formats.units import CHOICES, LIKELY, SURE, UNSURE

NOT_USED = ""
_TRIPLES = {
    "a": "Acceleration",
    "g": "Angular rate",
    "m": "Magnetic field",
    "lin": "Acceleration without gravity,",
    "grav": "Gravity",
}
ROLES: dict[str, str] = {
    NOT_USED: "not used",
    "t": "Time",
    **{f"{kind}{axis}": f"{title} {axis}" for kind, title in _TRIPLES.items() for axis in "xyz"},
    "temp_c": "Temperature",
    "status": "Status or button",
    "lat": "Latitude",
    "lon": "Longitude",
    "alt": "Altitude",
    "speed": "Speed over ground",
    "course_deg": "Course over ground",
}
"""What a column can be: slot of a column map, and title."""

SHORT_ROLES = {
    **{f"lin{axis}": f"Linear acc. {axis}" for axis in "xyz"},
    **dict.fromkeys(("status",), "Status"),
    "speed": "Speed",
    "course_deg": "Course",
}
"""Titles for the closed box, where they are shorter."""

_UNITS = {
    "m/s2": "m/s²",
    "m/s2*-1": "m/s², sign reversed",
    "g*-1": "g, sign reversed",
    "deg/s": "°/s",
    "mdps": "m°/s",
    "uT": "µT",
    "uT*50": "arbitrary (1 = 50 µT)",
    "us": "µs",
    "C": "°C",
    "deg": "°",
}
_COUNTED = {"g": "g", "dps": "°/s", "mG": "mG", "G": "G", "uT": "µT"}

LEVEL_WORDS = {SURE: ("good", "sure"), LIKELY: ("neutral", "likely"), UNSURE: ("warn", "please check")}
"""Tone and word for how far a guess can be trusted."""


def unit_title(unit: str) -> str:
    """A unit as it is shown: "m/s²", "16384 counts per g"."""
    base, sign, counts = unit.rpartition("/")
    if sign and base in _COUNTED:
        return f"{counts} counts per {_COUNTED[base]}"
    return _UNITS.get(unit, unit)


def short_unit(unit: str) -> str:
    """The same for a narrow box."""
    base, sign, counts = unit.rpartition("/")
    if sign and base in _COUNTED:
        return f"{counts} per {_COUNTED[base]}"
    return {"m/s2*-1": "−1 m/s²", "g*-1": "−1 g", "uT*50": "arbitrary"}.get(unit, unit_title(unit))


def units_of(slot: str) -> tuple[str, ...]:
    """The units to choose from for a slot; none when it has none."""
    return CHOICES.get(QUANTITIES.get(slot, slot), ())


def siblings(slot: str) -> tuple[str, ...]:
    """The slots of the same sensor, which share a unit."""
    stem = slot[:-1]
    return tuple(f"{stem}{axis}" for axis in "xyz") if f"{stem}x" in ROLES else (slot,)
