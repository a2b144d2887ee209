"""Profiles as JSON. What is read is not trusted; what is written replaces the old file whole or not at all."""

from __future__ import annotations

import dataclasses
import json
from pathlib import Path
from typing import Any

from imugui import __version__
from imugui.calibration.parts import NAN, PARTS, Part
from imugui.calibration.profile import Board, Profile
from imugui.paths import replace_file
from imugui.texts import from_json

VERSION = 2
ADDED = {"gyroscope": ("matrix_sigma", "matrix_date", "matrix_temp_c")}
"""What files of version 1 do not have."""
MARK = "imugui_profile"
LARGEST = 1 << 20
"""bytes; a real profile has some thousands."""
LONGEST_NAME = 300
LONGEST_DELAYS_MS = (50.0, 200.0)


class ProfileError(Exception):
    """A profile that cannot be used; the message is one line that says why."""


def to_text(profile: Profile) -> str:
    """The profile as JSON; values that are not known are null."""
    head = {MARK: VERSION, "made_with": f"imugui {__version__}", "board": dataclasses.asdict(profile.board)}
    parts = {name: dataclasses.asdict(part) for name, part in profile.parts.items()}
    values = _nulls({**head, "rate_hz": profile.rate_hz, "delays_ms": profile.delays_ms, **parts})
    return json.dumps(values, indent=1, allow_nan=False, ensure_ascii=False) + "\n"


def from_text(text: str) -> Profile:
    """The profile in a JSON text; ProfileError when it holds none that can be used. Unknown keys are ignored."""
    try:
        values = from_json(text)
    except (ValueError, RecursionError):
        raise ProfileError("not valid JSON: the file is broken or cut short") from None
    if not isinstance(values, dict) or MARK not in values:
        raise ProfileError("not a profile of imugui")
    version = values[MARK]
    if type(version) is not int or version < 1:
        raise ProfileError("not a profile of imugui: its version is no number")
    if version > VERSION:
        raise ProfileError(f"made by a newer imugui (profile version {version}, this one reads {VERSION}): update")
    added = ADDED if version < VERSION else {}
    parts = {
        name: _part(name, kind, values[name], added.get(name, ()))
        for name, kind in PARTS.items()
        if values.get(name) is not None
    }
    return Profile(_board(values.get("board")), **parts, **_rest(values))


def save(path: Path, profile: Profile) -> None:
    """Write the profile; raises OSError. Killed at any moment, it leaves the old file or the new one."""
    path.parent.mkdir(parents=True, exist_ok=True)
    replace_file(path, to_text(profile))


def load(path: Path) -> Profile:
    """Read a profile; raises ProfileError with the file's name and OSError. Nothing of a bad file is taken."""
    with path.open("rb") as stream:
        data = stream.read(LARGEST + 1)
    try:
        if len(data) > LARGEST:
            raise ProfileError(f"larger than {LARGEST >> 20} MB: no profile")
        return from_text(data.decode("utf-8"))
    except UnicodeDecodeError:
        raise ProfileError(f"{path.name}: not a text file") from None
    except ProfileError as error:
        raise ProfileError(f"{path.name}: {error}") from None


def _part(name: str, kind: type[Part], values: Any, added: tuple[str, ...]) -> Any:
    if not isinstance(values, dict):
        raise ProfileError(f"{name}: expected named values")
    names = [item.name for item in dataclasses.fields(kind) if item.name in values or item.name not in added]
    missing = [one for one in names if one not in values]
    if missing:
        raise ProfileError(f"{name}: {missing[0]} is missing")
    try:
        return kind(**{one: values[one] for one in names})
    except (ValueError, OverflowError) as error:
        raise ProfileError(f"{name}: {' '.join(str(error).split())}") from None


def _board(values: Any) -> Board:
    if not isinstance(values, dict):
        raise ProfileError("board is missing: whose calibration is this?")
    texts = {key: values.get(key, "") for key in ("transport", "address", "name")}
    for key, text in texts.items():
        if not isinstance(text, str) or len(text) > LONGEST_NAME or not text.isprintable():
            raise ProfileError(f"board: {key} is no plain text of up to {LONGEST_NAME} characters")
    return Board(**texts)


def _rest(values: dict[str, Any]) -> dict[str, Any]:
    rate, made = values.get("rate_hz"), values.get("made_with", "")
    known = isinstance(rate, int | float) and not isinstance(rate, bool) and 0.0 < rate < 1e5
    text = made if isinstance(made, str) and made.isprintable() else ""
    return {
        "rate_hz": float(rate) if known and rate is not None else NAN,
        "made_with": text[:LONGEST_NAME],
        "delays_ms": _delays(values.get("delays_ms")),
    }


def _delays(values: Any) -> tuple[float, float] | None:
    if values is None:
        return None
    numbers = isinstance(values, list) and all(type(one) in (int, float) and one >= 0.0 for one in values)
    if not numbers or len(values) != len(LONGEST_DELAYS_MS) or not _within(values):
        raise ProfileError("delays_ms: expected the delays of gyroscope and magnetometer in ms")
    return float(values[0]), float(values[1])


def _within(values: list[float]) -> bool:
    return all(one <= longest for one, longest in zip(values, LONGEST_DELAYS_MS, strict=True))


def _nulls(value: Any) -> Any:
    """The same with null for every number that is not known."""
    if isinstance(value, dict):
        return {key: _nulls(one) for key, one in value.items()}
    if isinstance(value, list | tuple):
        return [_nulls(one) for one in value]
    return None if isinstance(value, float) and value != value else value
