"""The replay bar plays, seeks and changes speed; the timeline shows what was recorded."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from pytestqt.qtbot import QtBot

from imugui.formats.csv_line import CsvLineEncoder
from imugui.samples import SAMPLE, empty_rows
from imugui.views.main_window import MainWindow
from imugui.views.replay_words import RESTARTED
from imugui.views.settings_store import SettingsStore
from imugui.views.timeline import EDGE, Tick, Timeline
from imugui.workers.session import Session, Source

Key = Qt.Key
RATE, SECONDS = 100, 60


@pytest.fixture
def file(tmp_path: Path) -> Path:
    """A minute of a board at rest that is turned once."""
    rows = empty_rows(SAMPLE, RATE * SECONDS)
    rows["t"] = np.arange(len(rows)) / RATE
    rows["acc"] = (0.0, 0.0, 9.81)
    rows["gyr"] = 0.0
    rows["gyr"][3000:3050, 2] = 1.0
    path = tmp_path / "run.csv"
    encoder = CsvLineEncoder()
    path.write_bytes(encoder.preamble() + encoder.encode(rows))
    return path


@pytest.fixture
def window(
    session: Session, settings_store: SettingsStore, file: Path, shown: Callable[[Any], Any], qtbot: QtBot
) -> Iterator[MainWindow]:
    one = shown(MainWindow(session, settings_store))
    one.activateWindow()
    one.bar.button.setFocus()
    session.connect_to(Source("replay", str(file)))
    qtbot.waitUntil(lambda: session.player is not None)
    one.slow_refresh()
    yield one
    one.close()


def place(timeline: Timeline, share: float) -> QPoint:
    return QPoint(round(EDGE + share * (timeline.width() - 2 * EDGE)), timeline.height() // 2)


def test_it_is_seen_only_while_a_file_is_played(window: MainWindow) -> None:
    assert window.replay.isVisible()
    assert window.replay.clock.text().endswith(" / 00:59.9")
    window.session.disconnect_source()
    window.slow_refresh()
    assert not window.replay.isVisible()
    window.session.connect_to(Source("simulator", "rest"))
    window.slow_refresh()
    assert not window.replay.isVisible()


def test_play_and_pause_by_key_and_button(window: MainWindow, qtbot: QtBot) -> None:
    player = window.session.player
    assert window.replay.timeline.hasFocus()  # Space must not disconnect
    qtbot.keyClick(window.replay.timeline, Key.Key_Space)
    assert not player.playing
    assert window.replay.play_button.accessibleName() == "Play"
    qtbot.mouseClick(window.replay.play_button, Qt.MouseButton.LeftButton)
    assert player.playing
    assert window.replay.play_button.accessibleName() == "Pause"


def test_a_paused_replay_shows_where_it_stands(window: MainWindow, qtbot: QtBot) -> None:
    qtbot.waitUntil(lambda: window.session.attitude.count > 5)
    window.session.player.pause()
    window.slow_refresh()
    window.refresh()
    assert window.pages["live"].angles.readouts["Yaw"].text() != "---.-"


def test_keys_seek_and_say_that_the_filter_restarts(window: MainWindow, qtbot: QtBot) -> None:
    player = window.session.player
    player.pause()
    window.replay.seek(20.0)
    timeline = window.replay.timeline
    assert window.replay.note.text().endswith(RESTARTED)
    for key, there in ((Key.Key_Right, 25.0), (Key.Key_Left, 20.0), (Key.Key_Home, 0.0), (Key.Key_Left, 0.0)):
        qtbot.keyClick(timeline, key)
        assert player.position_s == pytest.approx(there, abs=0.05)
    qtbot.keyClick(timeline, Key.Key_End)
    assert player.position_s == pytest.approx(player.duration_s, abs=0.05)


def test_keys_and_the_list_change_the_speed(window: MainWindow, qtbot: QtBot) -> None:
    player = window.session.player
    qtbot.keyClick(window.replay.timeline, Key.Key_Greater, Qt.KeyboardModifier.ShiftModifier)
    assert player.speed == 2.0
    qtbot.keyClick(window.replay.timeline, Key.Key_Less)
    assert player.speed == 1.0
    row = window.replay.speed.count() - 1
    window.replay.speed.setCurrentIndex(row)
    window.replay.speed.activated.emit(row)
    assert player.speed == float("inf")


def test_a_spare_key_stays_with_the_widget_that_needs_it(window: MainWindow, qtbot: QtBot) -> None:
    playing = window.session.player.playing
    window.bar.source.setFocus()
    qtbot.keyClick(window.bar.button, Key.Key_Space)
    assert window.session.source is None  # the button was pressed
    assert playing


def test_loop(window: MainWindow, qtbot: QtBot) -> None:
    qtbot.mouseClick(window.replay.loop_button, Qt.MouseButton.LeftButton)
    assert window.session.player.loop
    window.slow_refresh()
    assert window.replay.loop_button.isChecked()


def test_a_click_on_the_timeline_goes_there(window: MainWindow, qtbot: QtBot) -> None:
    player = window.session.player
    player.pause()
    window.slow_refresh()
    count = window.session.attitude.count
    timeline = window.replay.timeline
    qtbot.mouseClick(timeline, Qt.MouseButton.LeftButton, pos=place(timeline, 0.5))
    assert player.position_s == pytest.approx(30.0, abs=0.3)
    assert window.replay.play_button.accessibleName() == "Play"
    qtbot.waitUntil(lambda: not player.playing)  # when the attitude there was seen
    assert window.session.attitude.count > count
    assert player.position_s == pytest.approx(30.0, abs=0.3)


def test_dragging_seeks_at_most_twenty_times_a_second(shown: Callable[[Any], Any], qtbot: QtBot) -> None:
    timeline = shown(Timeline())
    timeline.resize(600, timeline.height())
    timeline.show_recording(60.0, [])
    told: list[float] = []
    timeline.sought.connect(told.append)
    qtbot.mousePress(timeline, Qt.MouseButton.LeftButton, pos=place(timeline, 0.0))
    for step in range(1, 41):
        qtbot.mouseMove(timeline, place(timeline, step / 50))
        timeline._want(float(place(timeline, step / 50).x()))
    assert len(told) < 40
    qtbot.waitUntil(lambda: told[-1] == pytest.approx(48.0, abs=0.2))
    qtbot.mouseRelease(timeline, Qt.MouseButton.LeftButton, pos=place(timeline, 0.8))
    assert not timeline.dragging


def test_the_timeline_shows_curve_events_and_words(shown: Callable[[Any], Any]) -> None:
    timeline = shown(Timeline())
    timeline.resize(616, timeline.height())
    timeline.show_recording(60.0, [])
    bare = timeline.grab().toImage()
    times = np.linspace(0.0, 60.0, 100)
    timeline.show_band((times, np.zeros(100), np.where(times > 30.0, 1.0, 0.0)))
    curve = timeline.grab().toImage()
    assert curve != bare
    at = place(timeline, 0.75)
    assert curve.pixelColor(at) != bare.pixelColor(at)
    timeline.show_recording(60.0, [Tick(15.0, "marker", "00:15.0  marker 1")])
    assert timeline.words_at(place(timeline, 0.25).x()) == "00:15.0  marker 1"
    assert timeline.words_at(place(timeline, 0.5).x()) == "00:30.0"
    assert timeline.grab().toImage() != bare


def test_the_overview_of_the_file_is_drawn(window: MainWindow, qtbot: QtBot) -> None:
    timeline = window.replay.timeline
    qtbot.waitUntil(lambda: timeline._band is not None)
    times, _, high = timeline._band
    assert times[np.argmax(high)] == pytest.approx(30.0, abs=0.5)
