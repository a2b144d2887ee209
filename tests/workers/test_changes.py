"""What a recording says was done to the pipeline is rehearsed before it is followed."""

from __future__ import annotations

from copy import deepcopy
from typing import Any

import numpy as np
import pytest

from imugui.fusion.pipeline import Pipeline
from imugui.recording.events import Event
from imugui.samples import GRAVITY, SAMPLE, empty_rows
from imugui.workers.changes import rehearse


@pytest.fixture
def started() -> Event:
    """The event that a recording begins with, of a filter that has seen a second."""
    rows = empty_rows(SAMPLE, 100)
    rows["t"], rows["gyr"], rows["acc"] = np.arange(100) / 100.0, 0.0, (0.0, 0.0, GRAVITY)
    pipeline = Pipeline("mahony")
    pipeline.step(rows)
    return Event("start", 1.0, 0, "", {"pipeline": pipeline.state()})


def test_what_was_recorded_can_be_done_again(started: Event) -> None:
    before = deepcopy(started.data)
    rehearse(started, [started, Event("origin", 1.1, 10, "set", {"quat": (1.0, 0.0, 0.0, 0.0)})])
    assert started.data == before


@pytest.mark.parametrize("spoiled", [[1.0], [0.0] * 7, [None] * 6, "north"])
def test_a_state_that_the_filter_cannot_go_on_from_is_refused(started: Event, spoiled: Any) -> None:
    started.data["pipeline"]["state"]["rest_detector"]["_low"] = spoiled
    with pytest.raises((KeyError, TypeError, ValueError)):
        rehearse(started, [started])
