"""What the program remembers of its user: one frozen dataclass, kept as JSON.

Loading is tolerant: unknown keys are ignored, each bad value falls back to its default and is reported; a file that
cannot be read at all is set aside, never overwritten. Saving writes a temporary file and renames it.
"""

from __future__ import annotations

import dataclasses
import json
import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from imugui.fields import field, from_mapping

FILE_NAME = "settings.json"


@dataclass(frozen=True)
class Settings:
    """Every value has a default, so that an empty file is a valid one."""

    theme: str = field("system", "Colours", choices=("system", "light", "dark"), tip="Follow the system, or choose")
    convention: str = field(
        "ENU",
        "Display convention",
        choices=("ENU", "NWU", "NED"),
        tip="Axes of the earth for the angles on screen. Inside, and in files, imugui always uses ENU",
    )
    decimals: int = field(1, "Decimals of angles", low=0, high=2, tip="A cheap board cannot support more than one")
    field_ut: float = field(
        0.0,
        "Earth's field here",
        unit="µT",
        low=0.0,
        high=70.0,
        step=0.5,
        tip="Strength at your place, from a map or model (22 to 67 µT); 0: not known. A magnetometer calibration that "
        "finds another strength is refused",
    )
    transport: str = field("simulator", "Last kind of source")
    address: str = field("aiming", "Last source")
    format: str = field("auto", "Last format")
    baud: int = field(0, "Last baud rate", low=0, high=12_000_000, tip="0 finds it by itself")
    filter: str = field("vqf", "Filter")
    use_mag: bool = field(True, "Use the magnetometer")
    window: str = field("", "Window place")


@dataclass(frozen=True)
class Store:
    """The settings with what belongs to single boards and filters, as kept in one file."""

    settings: Settings = Settings()
    filters: dict[str, dict[str, Any]] = dataclasses.field(default_factory=dict)
    """Parameters by filter name."""
    boards: dict[str, dict[str, Any]] = dataclasses.field(default_factory=dict)
    """What the user said of one board, by its identity: columns and units, sensor family."""


def load(path: Path) -> tuple[Store, list[str]]:
    """Read the settings file; returns the store and one sentence for each thing that was not taken."""
    try:
        text = path.read_text(encoding="utf-8")
    except FileNotFoundError:
        return Store(), []
    except (OSError, UnicodeDecodeError) as error:
        return Store(), [f"The settings could not be read ({error}); the defaults are used.", *_set_aside(path)]
    try:
        values = json.loads(text)
    except (ValueError, RecursionError):
        return Store(), ["The settings file is not valid JSON; the defaults are used.", *_set_aside(path)]
    if not isinstance(values, dict):
        return Store(), ["The settings file holds no settings; the defaults are used.", *_set_aside(path)]
    settings, problems = from_mapping(Settings, _section(values, "settings"))
    boards, filters = (_tables(_section(values, key)) for key in ("boards", "filters"))
    return Store(settings, filters, boards), [f"Setting not taken, default used: {one}." for one in problems]


def save(path: Path, store: Store) -> None:
    """Write the settings file whole; raises OSError when the folder cannot be written."""
    path.parent.mkdir(parents=True, exist_ok=True)
    text = json.dumps(dataclasses.asdict(store), indent=1, allow_nan=False)
    temporary = path.with_suffix(".tmp")
    with temporary.open("w", encoding="utf-8") as stream:
        stream.write(text)
        stream.flush()
        os.fsync(stream.fileno())
    temporary.replace(path)


def _section(values: dict[str, Any], key: str) -> dict[str, Any]:
    section = values.get(key)
    return section if isinstance(section, dict) else {}


def _tables(section: dict[str, Any]) -> dict[str, dict[str, Any]]:
    return {key: value for key, value in section.items() if isinstance(value, dict)}


def _set_aside(path: Path) -> list[str]:
    kept = path.with_suffix(".broken.json")
    try:
        path.replace(kept)
    except OSError:
        return []
    return [f"The old file is kept as {kept.name}."]
