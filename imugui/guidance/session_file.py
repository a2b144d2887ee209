"""Session file: plans, registration, tool axis and readings as JSON, so that nothing is lost when the program ends.

It is written after every change, to a new file that then takes the old one's place. What is read is not trusted:
each plan and each reading that is wrong is left out with a sentence; a file that cannot be read is set aside.
"""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from imugui import __version__
from imugui.guidance.plan import Plan
from imugui.guidance.reading import Reading, Vector, plain, plan_from, reading_from, unit_vector
from imugui.guidance.registration import Registration
from imugui.guidance.registration import from_dict as registration_from
from imugui.paths import replace_file
from imugui.texts import from_json

MARK, VERSION = "imugui_guidance", 1
LARGEST = 64 << 20
"""bytes; a reading has about two thousand."""


@dataclass(frozen=True)
class Kept:
    """What outlives the program. ``registration`` is only a record: its heading ends with the stream."""

    plans: tuple[Plan, ...] = ()
    registration: Registration | None = None
    tool_axis: Vector = (1.0, 0.0, 0.0)
    tool_axis_quality_deg: float = 0.0
    readings: tuple[Reading, ...] = ()


def to_text(kept: Kept) -> str:
    """The session as JSON."""
    head = {MARK: VERSION, "made_with": f"imugui {__version__}"}
    body = {
        "plans": [dataclasses.asdict(plan) for plan in kept.plans],
        "registration": kept.registration.to_dict() if kept.registration else None,
        "tool_axis": kept.tool_axis,
        "tool_axis_quality_deg": kept.tool_axis_quality_deg,
        "readings": [reading.to_dict() for reading in kept.readings],
    }
    return json.dumps(plain({**head, **body}), indent=1, allow_nan=False, ensure_ascii=False) + "\n"


def from_text(text: str) -> tuple[Kept, list[str]]:
    """The session in a JSON text, and a sentence for each thing left out. ValueError: no session at all."""
    try:
        values = from_json(text)
    except (ValueError, RecursionError):
        raise ValueError("it is not valid JSON: broken or cut short") from None
    if not isinstance(values, dict) or type(values.get(MARK)) is not int:
        raise ValueError("it is no guidance session of imugui")
    if values[MARK] > VERSION:
        raise ValueError(f"it was made by a newer imugui (version {values[MARK]}, this one reads {VERSION})")
    left_out: list[str] = []
    found = Kept(
        plans=tuple(_list(values, "plans", plan_from, left_out)),
        registration=_one(values, "registration", registration_from, None, left_out),
        tool_axis=_one(values, "tool_axis", _axis, Kept.tool_axis, left_out),
        tool_axis_quality_deg=_one(values, "tool_axis_quality_deg", _quality, 0.0, left_out),
        readings=tuple(_list(values, "readings", reading_from, left_out)),
    )
    return found, left_out


def save(path: Path, kept: Kept) -> None:
    """Write the session; raises OSError. Killed at any moment, it leaves the old file or the new one."""
    path.parent.mkdir(parents=True, exist_ok=True)
    replace_file(path, to_text(kept))


def load(path: Path) -> tuple[Kept, list[str]]:
    """Read the session: (what could be read, a sentence for each thing that could not). Never raises for its content.

    A file of which anything is left out is set aside whole, and what is good of it is saved in its place.
    """
    try:
        with path.open("rb") as stream:
            data = stream.read(LARGEST + 1)
        if len(data) > LARGEST:
            raise ValueError(f"it is larger than {LARGEST >> 20} MB")
        kept, left_out = from_text(data.decode("utf-8"))
    except FileNotFoundError:
        return Kept(), []
    except OSError as error:
        return Kept(), [f"The guidance session could not be read: {error.strerror}."]
    except ValueError as error:
        reason = "it is not a text file" if isinstance(error, UnicodeDecodeError) else str(error)
        return Kept(), [f"The guidance session {path.name} is not used: {reason}.", *_set_aside(path)]
    return kept, [*left_out, *_set_aside(path), *_written(path, kept)] if left_out else []


def _written(path: Path, kept: Kept) -> list[str]:
    try:
        save(path, kept)
    except OSError as error:
        return [f"What is good of it could not be saved: {error.strerror}."]
    return []


def _set_aside(path: Path) -> list[str]:
    """Keep the file under a name that is free, and say which."""
    number = 1
    while (other := path.with_name(f"{path.stem}.broken-{number}{path.suffix}")).exists():
        number += 1
    try:
        path.replace(other)
    except OSError as error:
        return [f"It could not be set aside: {error.strerror}."]
    return [f"The old file is kept as {other.name}."]


def _list(values: dict[str, Any], key: str, made: Callable[[Any], Any], left_out: list[str]) -> list[Any]:
    """Every good item of a list; a sentence for each of the others."""
    items, found = values.get(key, []), []
    if not isinstance(items, list):
        left_out.append(f"The {key} are left out: they are no list.")
        return []
    for number, item in enumerate(items, 1):
        try:
            found.append(made(item))
        except (ValueError, TypeError, OverflowError) as error:
            left_out.append(f"Number {number} of the {key} is left out: {error}")
    return found


def _one(values: dict[str, Any], key: str, made: Callable[[Any], Any], default: Any, left_out: list[str]) -> Any:
    if values.get(key) is None:
        return default
    try:
        return made(values[key])
    except (ValueError, TypeError, OverflowError, AttributeError) as error:
        left_out.append(f"The {key.replace('_', ' ')} is left out: {error}")
        return default


def _axis(value: Any) -> Vector:
    return unit_vector(value, "It")


def _quality(value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not 0.0 <= value <= 90.0:
        raise ValueError("it must be a number of degrees from 0 to 90.")
    return float(value)
