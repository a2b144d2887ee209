"""What the events of a recording did to the pipeline that ran: for computing it again, and for replay."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from imugui.fusion.pipeline import Pipeline
from imugui.recording.events import Event
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


def referred(pipeline: Pipeline, _: dict[str, Any]) -> Pipeline:
    """The same pipeline, whose heading is right by definition from a "heading" event on."""
    pipeline.refer_heading()
    return pipeline


def restarted(pipeline: Pipeline, _: dict[str, Any]) -> Pipeline:
    """The same pipeline, begun again."""
    pipeline.restart()
    return pipeline


CHANGES: dict[str, Change] = {"filter": exchanged, "origin": with_origin, "heading": referred, "restart": restarted}


def rehearse(start: Event, events: list[Event]) -> None:
    """Do all that was recorded once, on a board at rest: KeyError, TypeError or ValueError where it cannot be done."""
    try:
        pipeline = Pipeline.from_state(start.data["pipeline"])
        _hold_still(pipeline)
        for event in (one for one in events if one.kind in CHANGES):
            pipeline = CHANGES[event.kind](pipeline, event.data)
            _hold_still(pipeline)
    except (ArithmeticError, AttributeError, LookupError) as error:
        raise ValueError(f"{type(error).__name__}: {error}") from error


def _hold_still(pipeline: Pipeline) -> None:
    """Feed two samples that follow what the pipeline has seen."""
    still = empty_rows(SAMPLE, 2)
    still["gyr"], still["acc"], still["mag"] = 0.0, (0.0, 0.0, GRAVITY), ((0.0, 20.0, -40.0), (0.0, 20.0, -40.1))
    still["t"] = np.nan_to_num(pipeline.state()["t"]) + np.array((0.01, 0.02))
    pipeline.step(still)


def start_of(events: list[Event]) -> Event | None:
    """The event that holds what filter and clock knew when the recording began."""
    return next((event for event in events if event.kind == "start"), None)
