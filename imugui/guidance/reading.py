"""Reading: one capture of the tool's direction, with everything that is needed to judge and to compute it again."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from imugui.fusion.quaternion import Floats
from imugui.guidance.aiming import axis_error
from imugui.guidance.plan import FRAME, Plan, list_problems, title
from imugui.guidance.registration import Registration, tool_direction
from imugui.guidance.registration import from_dict as registration_from

NAN = math.nan
Vector = tuple[float, float, float]
LONGEST_TEXT = 400
LARGEST_NUMBER = 1e12  # in any unit of a reading; what is larger overflows where it is squared


@dataclass(frozen=True)
class Reading:
    """What was captured. Vectors are unit and in the frame named; times are the samples' own, s; NaN: not known.

    ``error_deg`` is the angle between direction and plan, ``medial_deg`` and ``cranial_deg`` its parts in the log map
    at the plan. ``sigma_deg``: the error to expect of it (sigma.py). ``steadiness_deg_s``: how fast the axis moved.
    ``heading_sigma_deg``: 1 sigma of the heading in it, told by ``heading_from``, a key of sigma.SOURCES.
    ``rows``: first and last attitude number of the hold of which ``direction`` is the mean. ``relative``: it was
    measured against a reference board, so the recording of one board cannot give it again.
    """

    number: int
    plan: Plan
    direction: Vector
    plan_direction: Vector
    error_deg: float
    medial_deg: float
    cranial_deg: float
    sigma_deg: float
    t: float
    rows: tuple[int, int]
    registration: Registration
    tool_axis: Vector
    twist_deg: float = NAN
    steadiness_deg_s: float = NAN
    heading_age_s: float = NAN
    heading_sigma_deg: float = NAN
    heading_from: str = ""
    time_to_green_s: float = NAN
    time_in_green_s: float = NAN
    duration_s: float = NAN
    overshoots: int = 0
    profile: str = ""
    filter: str = ""
    use_mag: bool = False
    relative: bool = False
    version: str = ""
    utc: str = ""
    frame: str = FRAME

    @property
    def name(self) -> str:
        """The plan's name."""
        return self.plan.name

    @property
    def side(self) -> str:
        """The plan's side."""
        return self.plan.side

    @property
    def title(self) -> str:
        """Name and side, as in "L4 left"."""
        return title(self.plan)

    @property
    def registration_id(self) -> str:
        """Identity of the registration it was taken with."""
        return self.registration.id

    def to_dict(self) -> dict[str, Any]:
        """Plain values for JSON; numbers that are not known are null."""
        values: dict[str, Any] = plain(dataclasses.asdict(self))
        return values


def mean_direction(registration: Registration, quats: ArrayLike, tool_axis: ArrayLike) -> Floats:
    """The unit mean direction (3,) in RAS of a tool in a hold: attitudes (n, 4) box -> earth, axis (3,) in the box."""
    mean = tool_direction(registration, np.asarray(quats, float), tool_axis).mean(axis=0)
    return np.asarray(mean / np.linalg.norm(mean))


def recompute(reading: Reading, quats: ArrayLike) -> float:
    """Degrees between the stored direction and the one from the attitudes (n, 4) of the reading's rows; NaN for none.

    Exactly 0 when the attitudes are those it was made of, to the last digit.
    """
    quats = np.asarray(quats, float).reshape(-1, 4)
    if len(quats) == 0:
        return NAN
    again = mean_direction(reading.registration, quats, reading.tool_axis)
    return math.degrees(float(axis_error(again, reading.direction)))


def reading_from(values: Any) -> Reading:
    """The reading in plain values; unknown keys are ignored. ValueError: one sentence that says what is wrong."""
    if not isinstance(values, Mapping):
        raise ValueError("A reading must be a table of named values.")
    taken: dict[str, Any] = {}
    for item in dataclasses.fields(Reading):
        if item.name in values:
            taken[item.name] = _value(item, values[item.name])
        elif item.default is dataclasses.MISSING:
            raise ValueError(f"The reading has no {item.name}.")
    if taken.get("frame", FRAME) != FRAME:
        raise ValueError(f"The reading is in the frame {taken['frame']!r:.40}, not in {FRAME}.")
    reading = Reading(**taken)
    off_deg = math.degrees(float(axis_error(reading.direction, reading.plan_direction)))
    if not abs(off_deg - reading.error_deg) < 1e-6:
        raise ValueError(
            f"The reading says {reading.error_deg:g}° of error, but its directions are {off_deg:g}° apart."
        )
    return reading


def plan_from(values: Any) -> Plan:
    """The plan in plain values; unknown keys are ignored. ValueError: one sentence that says what is wrong."""
    if not isinstance(values, Mapping):
        raise ValueError("A plan must be a table of named values.")
    names = {item.name: item for item in dataclasses.fields(Plan)}
    taken = {key: _number_or(value, names[key].default) for key, value in values.items() if key in names}
    plan = Plan(**taken)
    wrong = list_problems([plan])[0]
    if wrong:
        raise ValueError(next(iter(wrong.values())))
    return plan


def plain(value: Any) -> Any:
    """The same with lists for tuples and null for every number that is not known."""
    if isinstance(value, dict):
        return {key: plain(one) for key, one in value.items()}
    if isinstance(value, list | tuple):
        return [plain(one) for one in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def unit_vector(value: Any, name: str) -> Vector:
    """Three numbers of length 1; ValueError otherwise."""
    if not isinstance(value, list | tuple) or len(value) != 3 or not all(_is_number(one) for one in value):
        raise ValueError(f"{name} must be three numbers.")
    x, y, z = map(float, value)
    if not abs(math.hypot(x, y, z) - 1.0) < 1e-6:
        raise ValueError(f"{name} is no direction: its length is not 1.")
    return x, y, z


def _value(item: dataclasses.Field[Any], value: Any) -> Any:
    """A value in the type of its field."""
    if item.name in _PARTS:
        return _PARTS[item.name](value)
    if item.type == "Vector":
        return unit_vector(value, item.name)
    if item.type == "float":
        return _float(value, item)
    if item.type == "bool" and isinstance(value, bool):
        return value
    if item.type == "int" and isinstance(value, int) and not isinstance(value, bool) and value >= 0:
        return value
    if item.type == "str" and isinstance(value, str) and len(value) <= LONGEST_TEXT:
        return value
    raise ValueError(f"{item.name} must be {_KINDS[str(item.type)]}.")


_KINDS = {"bool": "true or false", "int": "a whole number from 0", "str": f"a text of up to {LONGEST_TEXT} characters"}


def _float(value: Any, item: dataclasses.Field[Any]) -> float:
    if value is None:
        value = NAN
    may_be_open = item.name in ("t", "sigma_deg") or item.default is not dataclasses.MISSING
    if not (_is_number(value) or (may_be_open and value != value)):
        raise ValueError(f"{item.name} must be a number.")
    return float(value)


def _rows(value: Any) -> tuple[int, int]:
    whole = isinstance(value, list | tuple) and len(value) == 2 and all(type(one) is int for one in value)
    if not whole or not 0 <= value[0] <= value[1]:
        raise ValueError("rows must be the first and the last attitude number.")
    return value[0], value[1]


def _registration(value: Any) -> Registration:
    if not isinstance(value, dict):
        raise ValueError("registration must be a table of named values.")
    return registration_from(value)


_PARTS = {"plan": plan_from, "rows": _rows, "registration": _registration}


def _number_or(value: Any, default: Any) -> Any:
    """A plan's number, open (NaN) for null; ValueError for one without end, also where the plan has no use for it."""
    if isinstance(value, float) and math.isinf(value):
        raise ValueError(f"A plan's number cannot be {value}.")
    if type(default) is not float:
        return value
    if value is None or value != value:
        return NAN  # one and the same, so that plans compare equal
    return float(value) if _is_number(value) else value


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and abs(value) <= LARGEST_NUMBER
