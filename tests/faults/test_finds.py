"""What the fuzzer found, one test each: it must not come back."""

from __future__ import annotations

import dataclasses
import json
import math

import numpy as np
import pytest

from imugui.calibration.parts import GyroscopePart
from imugui.fields import from_mapping
from imugui.formats import FORMATS, Options
from imugui.fusion.pipeline import Pipeline
from imugui.recording.events import Event, from_lines, to_line
from imugui.ring import Ring
from imugui.samples import ATTITUDE, SAMPLE
from imugui.settings import Settings
from imugui.targeting.trials import Trial, read_trials, trials_csv
from imugui.workers.fusion_worker import FusionWorker

START = Event("start", 0.0, 0, "", {"pipeline": Pipeline("complementary").state()})


def test_a_glued_line_of_nine_values_is_bad() -> None:
    decoder = FORMATS["colon-line"].decoder(Options())
    assert len(decoder.feed(b"#:1:2:16384:4:5:6:7:0:12\r\n#:0:0:16384:0:0:0:25:0:\r\n", 1.0)) == 1
    assert decoder.counts.bad_messages == 1


@pytest.mark.parametrize("change", [{"t": 10**400}, {"sample": math.inf}, {"sample": "1" * 5000}])
def test_an_event_with_an_impossible_number_is_damage(change: dict[str, object]) -> None:
    good = Event("marker", 0.5, 3, "here")
    line = json.dumps({**dataclasses.asdict(good), **change})
    assert from_lines([line, to_line(good)]) == ([good], 1)


@pytest.mark.parametrize(
    "data", [{}, {"carry_on": True, "pipeline": {}}, {"carry_on": True, "pipeline": []}, {"pipeline": None}]
)
def test_a_recorded_change_that_cannot_be_made_is_refused_before_it_is_played(data: dict[str, object]) -> None:
    worker = FusionWorker(Ring(SAMPLE, 10), Ring(ATTITUDE, 10), Pipeline("complementary"))
    with pytest.raises((KeyError, TypeError, ValueError)):
        worker.follow([START, Event("filter", 0.1, 5, "mahony", data)], 0)
    assert worker.pipeline.filter_name == "complementary"
    assert not worker._followed


@pytest.mark.parametrize("date", ["9999-12-31T23:59:59", "0001-01-01T00:00:00+14:00", "1969-12-31"])
def test_a_date_at_the_end_of_the_calendar_is_none(date: str) -> None:
    with pytest.raises(ValueError, match="no ISO 8601 date"):
        GyroscopePart("at rest", date)


@pytest.mark.parametrize("value", [10**400, -(10**400), math.inf, math.nan])
def test_a_number_that_is_no_float_keeps_the_default(value: float) -> None:
    found, problems = from_mapping(Settings, {"field_ut": value})
    assert found == Settings()
    assert len(problems) == 1


def test_a_count_beyond_all_counting_is_not_taken() -> None:
    good = Trial("study", "P1", "speed", 1, movement_time_s=1.0)
    text = trials_csv([good, dataclasses.replace(good, overshoots=10**400)])
    found, problems = read_trials(text)
    assert len(found) == 1
    assert "overshoots" in problems[0]


def test_the_first_rows_of_a_burst_have_times_of_their_own() -> None:
    from imugui.workers.intake import Intake
    from imugui.workers.transport import Source

    class Port:
        def set_baud(self, baud: int) -> None:
            """Not asked for."""

    into = Intake(Source("serial", "COM3", "triplets", 115200))
    into.opened(Port(), 0.0)
    rows = into.feed(b"0.01,-0.02,1.00;1.0,2.0,3.0;100.0,200.0,300.0;\r\n" * 6, 1.0)
    assert len(rows) >= 5
    assert np.diff(rows["t"]).min() > 0.0
