"""A replay in words."""

from __future__ import annotations

import math

import pytest

from imugui.recording import Event
from imugui.views.replay_words import clock_words, event_words, next_speed
from imugui.workers.session import SPEEDS


@pytest.mark.parametrize(
    ("seconds", "words"),
    [
        (0.0, "00:00.0"),
        (7.35, "00:07.3"),
        (59.99, "00:59.9"),
        (754.5, "12:34.5"),
        (3723.4, "1:02:03.4"),
        (-1.0, "00:00.0"),
    ],
)
def test_clock(seconds: float, words: str) -> None:
    assert clock_words(seconds) == words


def test_tenths_do_not_fall_behind() -> None:
    assert [clock_words(tenth / 10) for tenth in range(1, 9)] == [f"00:00.{tenth}" for tenth in range(1, 9)]


def test_events() -> None:
    assert event_words(Event("marker", text="marker 3"), 12.3) == "00:12.3  marker 3"
    assert event_words(Event("marker", text="tip down"), 12.3) == "00:12.3  marker: tip down"
    assert event_words(Event("filter", text="madgwick"), 1.0) == "00:01.0  filter changed: madgwick"
    assert event_words(Event("restart"), 1.0) == "00:01.0  filter restarted"


def test_speeds_step_within_the_table() -> None:
    assert next_speed(1.0, 1) == 2.0
    assert next_speed(1.0, -1) == 0.5
    assert next_speed(SPEEDS[0], -1) == SPEEDS[0]
    assert next_speed(16.0, 1) == math.inf
    assert next_speed(math.inf, 1) == math.inf
    assert next_speed(math.inf, -1) == 16.0
