"""Texts from outside: JSON whose strings any file can hold."""

from __future__ import annotations

import json
import re
from typing import Any

HALF = re.compile(r"\\u[dD][89a-fA-F]")
"""The escape of one half of a character, "\\ud83d" say; alone it is no character, and no file can hold it."""


def from_json(text: str, **options: Any) -> Any:
    """The plain values in a JSON text, with U+FFFD for half characters; raises what ``json.loads`` raises."""
    values = json.loads(text, **options)
    return _whole(values) if HALF.search(text) else values


def _whole(value: Any) -> Any:
    if isinstance(value, str):
        return value.encode("utf-16", "surrogatepass").decode("utf-16", "replace")
    if isinstance(value, dict):
        return {_whole(key): _whole(one) for key, one in value.items()}
    return [_whole(one) for one in value] if isinstance(value, list) else value
