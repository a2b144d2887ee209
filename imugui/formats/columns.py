"""Column names of tables: which SAMPLE value a name means, and in which unit."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from operator import itemgetter

from imugui.formats.families import Axes
from imugui.formats.values import RAD_PER_DEG
from imugui.samples import GRAVITY

IMU = ("gx", "gy", "gz", "ax", "ay", "az", "mx", "my", "mz", "temp_c", "status")
POSITION = ("lat", "lon", "alt", "speed", "course_deg")
SLOTS = ("t", *IMU, *POSITION)
"""The values of a row, in the order of SAMPLE."""
ACC, GYR, MAG = ("ax", "ay", "az"), ("gx", "gy", "gz"), ("mx", "my", "mz")
REQUIRED = ACC + GYR
LINEAR, GRAVITY_PART = ("linx", "liny", "linz"), ("gravx", "gravy", "gravz")
"""What phones write apart: acceleration without gravity, and gravity; their sum is what an accelerometer measures."""
STATUS = SLOTS.index("status")

STEMS = {
    "a": ("a", "acc", "accel", "accelerometer", "acceleration"),
    "g": ("g", "gyr", "gyro", "gyroscope", "w", "omega", "angularvelocity", "angularrate", "rotationrate"),
    "m": ("m", "mag", "magn", "magnetometer", "magneticfield", "h"),
}
NAMES: dict[str, str] = {
    **{stem + axis: kind + axis for kind, stems in STEMS.items() for stem in stems for axis in "xyz"},
    **{axis + stem: kind + axis for kind, stems in STEMS.items() for stem in stems[1:4] for axis in "xyz"},
    **dict.fromkeys(("t", "time", "timestamp", "seconds", "millis", "micros"), "t"),
    **dict.fromkeys(("temp", "temperature", "tempc"), "temp_c"),
    **dict.fromkeys(("status", "button"), "status"),
    **dict.fromkeys(("lat", "latitude"), "lat"),
    **dict.fromkeys(("lon", "lng", "long", "longitude"), "lon"),
    **dict.fromkeys(("alt", "altitude"), "alt"),
    **dict.fromkeys(("speed", "groundspeed"), "speed"),
    **dict.fromkeys(("course", "coursedeg", "courseoverground", "cog"), "course_deg"),
}
"""Names, without blanks, points, dashes and underscores, in lower case."""
MAP_NAMES = NAMES | {slot: slot for slot in LINEAR + GRAVITY_PART}
"""Those that a column map uses."""
QUANTITIES = {
    **{slot: slot[0] for slot in ACC + GYR + MAG},
    **dict.fromkeys(LINEAR + GRAVITY_PART, "a"),
}
"""The key of UNITS for slots that share one; any other slot is its own."""

_DEG = {"deg": 1.0, "degrees": 1.0}
UNITS: dict[str, dict[str, float]] = {
    "a": {"g": GRAVITY, "mg": GRAVITY / 1000, "m/s2": 1.0, "mps2": 1.0, "ms2": 1.0, "ms-2": 1.0, "m/s/s": 1.0},
    "g": {
        **dict.fromkeys(("rad/s", "rads", "radps", "rps"), 1.0),
        **dict.fromkeys(("deg/s", "degs", "degps", "dps"), RAD_PER_DEG),
        "mdps": RAD_PER_DEG / 1000,
    },
    "m": {"ut": 1.0, "g": 100.0, "gauss": 100.0, "mg": 0.1, "mgauss": 0.1, "nt": 0.001, "mt": 1000.0, "t": 1e6},
    "t": {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9},
    "temp_c": {"c": 1.0, "degc": 1.0, "celsius": 1.0},
    "status": {},
    "lat": _DEG,
    "lon": _DEG,
    "alt": {"m": 1.0},
    "speed": {"m/s": 1.0, "mps": 1.0, "ms": 1.0, "km/h": 1 / 3.6, "kmh": 1 / 3.6, "kn": 0.514444, "knots": 0.514444},
    "course_deg": _DEG,
}
"""What one unit is worth in SAMPLE's."""
NAMED_UNITS = {"seconds": "s", "millis": "ms", "micros": "us", "tempc": "c"}

LONGEST_NAME = 200
"""Characters; a longer cell is no name, and would take the patterns below for ever."""
_FACTOR = re.compile(r"(.*?)([*/])\s*(-?[0-9]+(?:\.[0-9]+)?(?:[eE][+-]?[0-9]+)?)")
_BRACKETS = re.compile(r"(.*?)\s*[(\[{]\s*(.*?)\s*[)\]}]")
_SIGNS = str.maketrans({"²": "2", "^": "", "µ": "u", "μ": "u", "°": "deg", " ": "", "·": "", "*": ""})


@dataclass(frozen=True)
class Column:
    """What one column holds: a slot, and what its number must be multiplied by (None: its unit is unknown)."""

    slot: str
    factor: float | None
    unit: str  # as written, "" when none was given


def read_name(name: str, names: Mapping[str, str] = NAMES) -> Column | None:
    """The column a name means, such as ``acc_x_mps2``, ``Gyroscope Y (deg/s)`` or ``ax_g/16384``; None if unknown.

    A unit stands in brackets or after the last underscore; ``/number`` or ``*number`` after it scales raw counts,
    a negative one turns the axis round.
    """
    text = name.strip().strip("\"'").strip()
    if len(text) > LONGEST_NAME:
        return None
    scale = 1.0
    if scaling := _FACTOR.fullmatch(text):
        text = scaling[1].strip()
        scale = float(scaling[3]) if scaling[2] == "*" else 1 / float(scaling[3]) if float(scaling[3]) else 1.0
    stem, unit = text, ""
    if brackets := _BRACKETS.fullmatch(text):
        stem, unit = brackets[1], brackets[2]
    elif _key(text) not in names:
        stem, _, unit = text.rpartition("_")
    key = _key(stem)
    if key not in names:
        return None
    unit = unit or NAMED_UNITS.get(key, "")
    factor = factor_of(names[key], unit) if unit else 1.0
    return Column(names[key], None if factor is None else factor * scale, unit)


def factor_of(slot: str, unit: str) -> float | None:
    """What one ``unit`` is worth in SAMPLE's unit of a slot; None when it is no unit of that slot."""
    return UNITS.get(QUANTITIES.get(slot, slot), {}).get(plain_unit(unit))


def plain_unit(unit: str) -> str:
    """A unit without its special signs, in lower case: "m/s2" for "m/s²", "deg/s" for "°/s"."""
    return unit.lower().translate(_SIGNS)


def _key(name: str) -> str:
    return re.sub(r"[\s_.\-]", "", name.lower())


Found = dict[str, tuple[int, Column]]
"""By slot: the place of its column, and what it holds."""


@dataclass(frozen=True)
class Table:
    """How the lines of one table become rows."""

    delimiter: bytes
    width: int  # columns
    shape: bytes  # a full line without its numbers
    indices: tuple[int, ...]  # for each of SLOTS its column; ``width`` when there is none (status: one more)
    factors: tuple[float, ...]  # for each column, () when all are 1
    sums: tuple[tuple[int, int], ...]  # columns to which another one is added
    force: str  # what the acceleration is: "total", "linear" (without gravity), "gravity", or "" without one
    used: tuple[str, ...]
    partial: bool  # some sensors may be missing
    words: str  # for the user
    problem: str  # why no row can be made, "" when it can

    @cached_property
    def pick(self) -> Callable[[Sequence[float]], tuple[float, ...]]:
        """From a line's numbers, and NaN and NO_STATUS after them, to SLOTS."""
        return itemgetter(*self.indices)

    def without_time(self) -> Table:
        """The same table when its time column turns out to hold no numbers."""
        used = tuple(slot for slot in self.used if slot != "t")
        return replace(self, indices=(self.width, *self.indices[1:]), used=used, words=f"{self.words}, time not used")


def table_from(names: Sequence[str], delimiter: bytes, mag_axes: Axes, partial: bool = False) -> Table:
    """The table that a row of column names describes; its problem says what is missing.

    ``partial``: one sensor is enough, and acceleration may come as its two parts (LINEAR, GRAVITY_PART).
    """
    found = _find(names, MAP_NAMES if partial else NAMES)
    problem = _problem(found, partial)
    if not all(axis in found for axis in MAG):
        found = {slot: place for slot, place in found.items() if slot not in MAG}
    words = _words(found)
    force, sums = _join_parts(found)
    sources = {slot: index for slot, (index, _) in found.items()}
    factors = [1.0] * len(names)
    for index, column in found.values():
        factors[index] = column.factor or 1.0
    for index, other in sums:
        factors[other] = factors[index]
    if "mx" in sources:
        wire = [sources[axis] for axis in MAG]
        for axis, (i, sign) in zip(MAG, mag_axes, strict=True):
            sources[axis] = wire[i]
            factors[wire[i]] *= sign
    absent = {"status": len(names) + 1}
    return Table(
        delimiter,
        len(names),
        delimiter * (len(names) - 1),
        tuple(sources.get(slot, absent.get(slot, len(names))) for slot in SLOTS),
        tuple(factors) if any(factor != 1.0 for factor in factors) else (),
        sums,
        force,
        tuple(found),
        partial,
        words,
        problem,
    )


def _find(names: Sequence[str], known: Mapping[str, str]) -> Found:
    found: Found = {}
    for index, name in enumerate(names):
        column = read_name(name, known)
        if column and (column.slot not in found or (column.unit and not found[column.slot][1].unit)):
            found[column.slot] = index, column
    return found


def _join_parts(found: Found) -> tuple[str, tuple[tuple[int, int], ...]]:
    """Let the parts of the acceleration stand for the whole where there is none: what it then is, and which columns
    are added to which.
    """
    parts = {"linear": LINEAR, "gravity": GRAVITY_PART}
    there = [kind for kind, axes in parts.items() if all(axis in found for axis in axes)]
    if "ax" in found or not there:
        return "total" if "ax" in found else "", ()
    for slot, axis in zip(ACC, parts[there[0]], strict=True):
        found[slot] = found[axis]
    if len(there) == 1:
        return there[0], ()
    return "total", tuple((found[one][0], found[other][0]) for one, other in zip(LINEAR, GRAVITY_PART, strict=True))


def _problem(found: Found, partial: bool) -> str:
    triples = (ACC, GYR, MAG, LINEAR, GRAVITY_PART) if partial else ()
    begun = [slot for axes in triples if any(axis in found for axis in axes) for slot in axes]
    missing = [slot for slot in (begun if partial else REQUIRED) if slot not in found]
    if missing:
        return f"no column for {', '.join(missing)}"
    if partial and not found.keys() - {"t"}:
        return "no column with measurements"
    unknown = [f"{slot} in {column.unit!r}" for slot, (_, column) in found.items() if column.factor is None]
    return f"unknown unit: {', '.join(unknown)}" if unknown else ""


def _words(found: Found) -> str:
    """What was understood: the columns and the units of the three sensors."""
    units = []
    for slot, si in (("t", "s"), ("ax", "m/s2"), ("linx", "m/s2"), ("gravx", "m/s2"), ("gx", "rad/s"), ("mx", "uT")):
        if slot in found:
            units.append(found[slot][1].unit or f"{si} (not said)")
    return f"columns {' '.join(found)}" + (f" in {', '.join(units)}" if units else "")
