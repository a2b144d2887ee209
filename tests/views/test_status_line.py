"""The status line: words in their places, nothing jumps, a click opens the link log."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import Any

import pytest
from PySide6.QtCore import Qt
from pytestqt.qtbot import QtBot

from imugui.views.status_line import StatusLine
from imugui.workers.session import State, Status

LIVE = Status(State.STREAMING, "", rate_hz=138.6, age_ms=4.0, messages=100, samples=100, mag_trust="good", filter="vqf")


@pytest.fixture
def line(shown: Callable[[Any], Any]) -> StatusLine:
    one = StatusLine()
    one.resize(940, one.height())
    return shown(one)


def test_words(line: StatusLine) -> None:
    line.refresh(dataclasses.replace(LIVE, gaps=2, gap_s=1.5, bad_messages=1))
    texts = {name: label.text() for name, label in line.labels.items()}
    assert texts["rate"] == "138.6 Hz"
    assert texts["gaps"] == "▲ 2 gaps, 1.5 s lost"
    assert texts["bad"] == "▲ 1 bad of 101"
    assert texts["mag"] == "✓ field good"
    assert line.labels["mag"].tone == "good"
    assert line.labels["temperature"].isHidden()


def test_the_worst_age_of_a_second_is_shown(line: StatusLine) -> None:
    for age_ms in (3.0, 80.0, 4.0):
        line.refresh(dataclasses.replace(LIVE, age_ms=age_ms))
    assert line.labels["age"].text() == "age 80 ms"
    for _ in range(8):
        line.refresh(LIVE)
    assert line.labels["age"].text() == "age 4 ms"
    line.refresh(Status())
    assert line.labels["age"].text() == "age --- ms"


def test_numbers_that_change_move_nothing(line: StatusLine, qtbot: QtBot) -> None:
    places = []
    for rate_hz, age_ms, gaps in ((138.6, 4.0, 0), (99.4, 123.0, 3), (1000.0, 0.4, 28)):
        line.refresh(dataclasses.replace(LIVE, rate_hz=rate_hz, age_ms=age_ms, gaps=gaps, gap_s=gaps))
        line.layout().activate()
        places.append([label.x() for label in line.labels.values()])
    assert places[0] == places[1] == places[2]


def test_everything_fits_into_the_smallest_window(line: StatusLine) -> None:
    line.refresh(
        dataclasses.replace(LIVE, gaps=88, gap_s=48.0, mag_trust="uncalibrated", mag_norm_ut=48.0, temp_c=25.0)
    )
    assert line.minimumSizeHint().width() <= 1024 - 84


def test_a_click_opens_the_log(line: StatusLine, qtbot: QtBot) -> None:
    with qtbot.waitSignal(line.clicked):
        qtbot.mouseClick(line, Qt.MouseButton.LeftButton)
    with qtbot.waitSignal(line.clicked):
        qtbot.mouseClick(line.button, Qt.MouseButton.LeftButton)


@pytest.mark.parametrize("width", [780, 934])
def test_a_narrow_window_leaves_calm_words_out_rather_than_cut_them(
    shown: Callable[[Any], Any], qtbot: QtBot, width: int
) -> None:
    line = shown(StatusLine())
    line.resize(width, line.height())
    status = Status(gaps=1, gap_s=0.1, temp_c=25.0, battery_percent=12.0, rssi_dbm=-62.0, filter="mahony", age_ms=4.0)
    line.refresh(status)
    seen = {name: label for name, label in line.labels.items() if not label.isHidden()}
    assert {"rate", "gaps", "age", "battery"} <= seen.keys()
    assert "filter" not in seen
    qtbot.waitUntil(lambda: all(label.width() >= label.sizeHint().width() for label in seen.values()))
    line.resize(1400, line.height())
    line.refresh(status)
    assert not line.labels["filter"].isHidden()
