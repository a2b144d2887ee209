"""Events of a recording: what happened beside the samples, one JSON object a line."""

from __future__ import annotations

import dataclasses
import json
import math
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

from imugui.texts import from_json

KINDS = (
    "start",  # what the filter and the clock knew when recording began
    "connect",
    "lost",
    "disconnect",
    "filter",  # another filter, other parameters, magnetometer on or off
    "origin",
    "heading",  # called right by definition, by a registration: from there on the filter's sigma of it counts
    "restart",  # the filter began again, because what came did not follow what was
    "marker",
    "guidance",  # a registration or a reading of the Guide page
    "game",  # settings, inputs and results of the Target page
    "note",  # another filter took over from one that no longer believed itself, or that one came back
    "problem",
    "stop",
)


@dataclass(frozen=True)
class Event:
    """Something that happened before sample number ``sample`` (of this recording, from 0), at sample time t (s)."""

    kind: str
    t: float = math.nan
    sample: int = 0
    text: str = ""
    data: dict[str, Any] = field(default_factory=dict)


def to_line(event: Event) -> str:
    """One line of JSON; numbers come back bit for bit. NaN is written as JavaScript writes it."""
    return json.dumps(dataclasses.asdict(event)) + "\n"


def from_lines(lines: Iterable[str]) -> tuple[list[Event], int]:
    """The events, and how many lines were none (a killed program leaves half a line)."""
    events, bad = [], 0
    for line in lines:
        event = _from_line(line)
        if event is None:
            bad += bool(line.strip())
        else:
            events.append(event)
    return events, bad


def _from_line(line: str) -> Event | None:
    try:
        values = from_json(line)
        event = Event(
            str(values["kind"]), float(values["t"]), int(values["sample"]), str(values["text"]), dict(values["data"])
        )
    except (ValueError, KeyError, TypeError, OverflowError, RecursionError):
        return None
    return event if event.kind in KINDS and event.sample >= 0 else None
