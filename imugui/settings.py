"""What the program remembers of its user: one frozen dataclass, kept as JSON.

Loading is tolerant: unknown keys are ignored, each bad value falls back to its default and is reported; a file that
cannot be read at all, or that a newer imugui wrote, is set aside, never overwritten. Saving writes a temporary file
and renames it.
"""

from __future__ import annotations

import dataclasses
import json
import math
import shutil
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from imugui.fields import field, from_mapping
from imugui.paths import replace_file
from imugui.texts import from_json

FILE_NAME = "settings.json"
MARK, VERSION = "imugui_settings", 1
LARGEST = 1 << 22
"""bytes; what is remembered of a hundred boards has about 100,000."""
DEEPEST = 8
"""How deep values may lie in each other; ours need 4."""


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
    spike_mask: bool = field(False, "Mask spikes of the button")
    source_name: str = field("", "Name of the last source")
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
        text = _text(path)
    except FileNotFoundError:
        return Store(), []
    except (OSError, ValueError) as error:
        return Store(), [f"The settings could not be read ({error}); the defaults are used.", *_set_aside(path)]
    try:
        # what is no number is no value, so that what was read can be written again
        values = from_json(text, parse_constant=lambda _: None, parse_float=_finite)
    except (ValueError, RecursionError):
        return Store(), ["The settings file is not valid JSON; the defaults are used.", *_set_aside(path)]
    if not isinstance(values, dict):
        return Store(), ["The settings file holds no settings; the defaults are used.", *_set_aside(path)]
    settings, problems = from_mapping(Settings, _section(values, "settings"))
    boards, filters = (_tables(_section(values, key)) for key in ("boards", "filters"))
    said = [f"Setting not taken, default used: {one}." for one in problems]
    return Store(settings, filters, boards), [*_from_newer(values, path), *said]


def save(path: Path, store: Store) -> None:
    """Write the settings file whole; raises OSError when the folder cannot be written."""
    path.parent.mkdir(parents=True, exist_ok=True)
    text = json.dumps({MARK: VERSION, **dataclasses.asdict(store)}, indent=1, allow_nan=False)
    replace_file(path, text)


def _text(path: Path) -> str:
    with path.open("rb") as stream:
        data = stream.read(LARGEST + 1)
    if len(data) > LARGEST:
        raise ValueError(f"larger than {LARGEST >> 20} MB")
    return data.decode("utf-8")


def _finite(text: str) -> float | None:
    value = float(text)
    return value if math.isfinite(value) else None


def _from_newer(values: dict[str, Any], path: Path) -> list[str]:
    """What to say of a file that a newer program wrote: this one would drop what it does not know."""
    version = values.get(MARK)
    if type(version) is not int or version <= VERSION:
        return []
    kept = path.with_suffix(".newer.json")
    try:
        shutil.copyfile(path, kept)
    except OSError:
        return ["The settings are from a newer imugui: what this one knows of them is used."]
    return [f"The settings are from a newer imugui: what this one knows is used, and all are kept as {kept.name}."]


def _shallow(value: Any, depth: int = DEEPEST) -> bool:
    """Whether values lie no deeper in each other than this."""
    if not isinstance(value, dict | list):
        return True
    inside = value.values() if isinstance(value, dict) else value
    return depth > 0 and all(_shallow(one, depth - 1) for one in inside)


def _section(values: dict[str, Any], key: str) -> dict[str, Any]:
    section = values.get(key)
    return section if isinstance(section, dict) else {}


def _tables(section: dict[str, Any]) -> dict[str, dict[str, Any]]:
    return {key: value for key, value in section.items() if isinstance(value, dict) and _shallow(value)}


def _set_aside(path: Path) -> list[str]:
    kept = path.with_suffix(".broken.json")
    try:
        path.replace(kept)
    except OSError:
        return []
    return [f"The old file is kept as {kept.name}."]
