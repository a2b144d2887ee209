"""Editable fields: one declaration gives a dataclass field its default, label, unit and range.

Forms, settings files and command-line help read the same metadata.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping, Sequence
from typing import Any


def field(
    default: Any,
    label: str,
    *,
    unit: str = "",
    low: float | None = None,
    high: float | None = None,
    step: float | None = None,
    choices: tuple[str, ...] = (),
    tip: str = "",
) -> Any:
    """A dataclass field a person can edit. ``low`` and ``high`` are inclusive, in ``unit``."""
    metadata = {"label": label, "unit": unit, "low": low, "high": high, "step": step, "choices": choices, "tip": tip}
    return dataclasses.field(default=default, metadata=metadata)


def problem(item: dataclasses.Field[Any], value: Any) -> str | None:
    """What is wrong with ``value`` for this field, in words, or None."""
    kind = type(item.default)
    if kind is float and isinstance(value, int) and not isinstance(value, bool):
        value = _as_float(value)
    if type(value) is not kind:
        return f"{item.name}: expected {kind.__name__}, got {type(value).__name__}"
    low, high, choices = (item.metadata.get(key) for key in ("low", "high", "choices"))
    if choices and value not in choices:
        return f"{item.name}: {value!r} is none of {', '.join(choices)}"
    if isinstance(value, float) and not math.isfinite(value):
        return f"{item.name}: not a number"
    if (low is not None and value < low) or (high is not None and value > high):
        return f"{item.name}: {value} is outside {low} to {high}"
    return None


def from_words(cls: type[Any], words: Sequence[str]) -> Any:
    """An instance of dataclass ``cls`` with what "name=value" words say; ValueError in words when one says nothing."""
    kinds: dict[str, Any] = {item.name: type(item.default) for item in dataclasses.fields(cls)}
    values: dict[str, Any] = {}
    for name, _, text in (word.partition("=") for word in words):
        if name not in kinds:
            raise ValueError(f"there is no {name!r}; there are {', '.join(kinds) or 'none'}")
        try:
            values[name] = SWITCHES[text.lower()] if kinds[name] is bool else kinds[name](text)
        except (KeyError, ValueError):
            raise ValueError(f"{name}: {text!r} is not {NEEDED[kinds[name]]}") from None
    found, problems = from_mapping(cls, values)
    if problems:
        raise ValueError("; ".join(problems))
    return found


NEEDED = {float: "a number", int: "a whole number", bool: "on or off"}
SWITCHES = {"on": True, "true": True, "1": True, "off": False, "false": False, "0": False}


def _as_float(value: int) -> float:
    """The nearest float; infinite where there is none."""
    try:
        return float(value)
    except OverflowError:
        return math.inf


def from_mapping(cls: type[Any], values: Mapping[str, Any]) -> tuple[Any, list[str]]:
    """An instance of dataclass ``cls``; unknown keys are ignored, each bad value falls back to its default.

    Returns the instance and one sentence for each value that was not taken.
    """
    taken: dict[str, Any] = {}
    problems: list[str] = []
    for item in dataclasses.fields(cls):
        if item.name not in values:
            continue
        value = values[item.name]
        wrong = problem(item, value)
        if wrong:
            problems.append(wrong)
        else:
            taken[item.name] = float(value) if type(item.default) is float else value
    return cls(**taken), problems
