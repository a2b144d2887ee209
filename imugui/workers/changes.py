"""What the events of a recording did to the pipeline that ran: for computing it again, and for replay."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from imugui.fusion.pipeline import Pipeline
from imugui.recording import Event
from imugui.samples import GRAVITY, SAMPLE, empty_rows

Change = Callable[[Pipeline, dict[str, Any]], Pipeline]


def exchanged(old: Pipeline, data: dict[str, Any]) -> Pipeline:
    """Another filter or other parameters, as a "filter" event tells."""
    pipeline = Pipeline.from_settings(data["pipeline"])
    if data["carry_on"]:
        pipeline.continue_from(old)
    return pipeline


def with_origin(pipeline: Pipeline, data: dict[str, Any]) -> Pipeline:
    """The same pipeline with the origin of an "origin" event."""
    pipeline.set_origin(data["quat"])
    return pipeline


def restarted(pipeline: Pipeline, _: dict[str, Any]) -> Pipeline:
    """The same pipeline, begun again."""
    pipeline.restart()
    return pipeline


CHANGES: dict[str, Change] = {"filter": exchanged, "origin": with_origin, "restart": restarted}


def rehearse(start: Event, events: list[Event]) -> None:
    """Do all that was recorded once, on a board at rest: KeyError, TypeError or ValueError where it cannot be done."""
    still = empty_rows(SAMPLE, 2)
    still["gyr"], still["acc"], still["mag"] = 0.0, (0.0, 0.0, GRAVITY), (0.0, 20.0, -40.0)
    try:
        pipeline = Pipeline.from_state(start.data["pipeline"])
        for event in (one for one in events if one.kind in CHANGES):
            pipeline = CHANGES[event.kind](pipeline, event.data)
            still["t"] = (0.0, 0.01)
            pipeline.step(still)
    except (ArithmeticError, AttributeError, LookupError) as error:
        raise ValueError(f"{type(error).__name__}: {error}") from error


def start_of(events: list[Event]) -> Event | None:
    """The event that holds what filter and clock knew when the recording began."""
    return next((event for event in events if event.kind == "start"), None)
