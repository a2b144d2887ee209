"""The values of a plan as a person writes them: in a table's cell, in a CSV file."""

from __future__ import annotations

import math
import re
from typing import Any

from imugui.guidance.plan import FIELDS, KINDS, MAY_BE_OPEN, REFERENCES, SIDES, Plan, field_problem

NUMBER = re.compile(r"[+-]?(\d+(\.\d*)?|\.\d+)([eE][+-]?\d{1,3})?", re.ASCII)
CHOICES = {"kind": KINDS, "side": SIDES, "reference": REFERENCES}
SHORT = {"side": {"l": "left", "r": "right"}}
"""Other spellings, in lower case -> the value."""
OPEN = ("", "any", "none", "-")
"""What may stand for a number that is left open."""


def parse_field(name: str, text: str) -> Any:
    """The value that a text means for the field ``name``; an empty text means the field's default.

    Numbers take a decimal point or a single decimal comma, and a degree sign or mm. ValueError: one sentence for the
    person who wrote it, also when the value is out of range.
    """
    text = text.strip()
    default = FIELDS[name].default
    if type(default) is float:
        value: Any = _number(name, text, default)
    elif text == "" and name != "name":
        value = default
    else:
        value = _choice(name, text) if name in CHOICES else text
    wrong = field_problem(name, value)
    if wrong:
        raise ValueError(wrong)
    return value


def field_text(plan: Plan, name: str) -> str:
    """A plan's value as text that ``parse_field`` reads back exactly; a number that is left open is empty."""
    value = getattr(plan, name)
    if not isinstance(value, float):
        return str(value)
    return "" if math.isnan(value) else repr(value).removesuffix(".0")


def _number(name: str, text: str, default: float) -> float:
    if text.casefold() in OPEN and name in MAY_BE_OPEN:
        return math.nan
    if text == "":
        return default
    plain = text.removesuffix("mm").removesuffix("°").strip().replace("\N{MINUS SIGN}", "-")
    if "." not in plain:
        plain = plain.replace(",", ".", 1)
    if not NUMBER.fullmatch(plain):
        raise ValueError(f"{FIELDS[name].metadata['label']} must be a number, not {text!r:.40}.")
    return float(plain)


def _choice(name: str, text: str) -> str:
    known = {choice.casefold(): choice for choice in CHOICES[name]}
    lower = text.casefold()
    return known.get(lower) or SHORT.get(name, {}).get(lower, text)
