"""What the events of a recording did to the pipeline that ran: for computing it again, and for replay."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from imugui.fusion.pipeline import Pipeline
from imugui.recording import Event

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


def start_of(events: list[Event]) -> Event | None:
    """The event that holds what filter and clock knew when the recording began."""
    return next((event for event in events if event.kind == "start"), None)
