"""The record button, its keys and its news, with a real session and real files."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QDesktopServices
from pytestqt.qtbot import QtBot

from imugui import paths
from imugui.recording import read_recording
from imugui.views.main_window import MainWindow
from imugui.views.record_tools import IDLE
from imugui.views.settings_store import SettingsStore
from imugui.workers.session import Session, Source, State

Key = Qt.Key


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Where recordings go."""
    monkeypatch.setattr(paths, "documents_folder", lambda: tmp_path / "recordings")
    return tmp_path / "recordings"


@pytest.fixture
def window(
    session: Session, settings_store: SettingsStore, folder: Path, shown: Callable[[Any], Any]
) -> Iterator[MainWindow]:
    one = shown(MainWindow(session, settings_store))
    one.activateWindow()
    yield one
    one.close()


def stream(window: MainWindow, qtbot: QtBot) -> None:
    window.session.connect_to(Source("simulator", "aiming"))
    qtbot.waitUntil(lambda: window.session.status().state is State.STREAMING)
    window.slow_refresh()


def record_some(window: MainWindow, qtbot: QtBot, rows: int = 40) -> Path:
    """Record with the key until so many rows are written, and leave it running."""
    qtbot.keyClick(window, Key.Key_R)
    qtbot.waitUntil(lambda: window.session.recording is not None and window.session.recording.rows >= rows)
    return window.session.recording.path


def test_nothing_can_be_recorded_unless_connected(window: MainWindow, qtbot: QtBot) -> None:
    button = window.bar.tools.record.button
    assert not button.isEnabled()
    assert "Connect a board first" in button.toolTip()
    qtbot.keyClick(window, Key.Key_R)
    assert "Connect a board first" in window.banner.text()
    qtbot.keyClick(window, Key.Key_M)
    assert "press R" in window.banner.text()
    assert window.session.recording is None


def test_record_mark_and_stop_by_key(window: MainWindow, qtbot: QtBot, folder: Path) -> None:
    stream(window, qtbot)
    button = window.bar.tools.record.button
    width = button.width()
    path = record_some(window, qtbot)
    assert path.parent == folder
    window.slow_refresh()
    assert button.text().strip() != IDLE
    assert button.width() == width
    assert window.bar.recording.isVisible()
    for number in (1, 2):
        qtbot.keyClick(window, Key.Key_M)
        assert window.bar.recording.text().endswith(f"marker {number}")
    window.slow_refresh()
    assert window.bar.recording.text().endswith("marker 2")  # still to be read
    count = window.session.recording.rows
    qtbot.waitUntil(lambda: window.session.recording.rows > count)
    qtbot.keyClick(window, Key.Key_R)
    assert window.session.recording is None
    assert window.banner.text().startswith("Recorded ")
    assert path.name in window.banner.text()
    assert not window.bar.recording.isVisible()
    assert [one.text for one in read_recording(path).events if one.kind == "marker"] == ["marker 1", "marker 2"]


def test_what_was_recorded_can_be_opened_and_shown(
    window: MainWindow, qtbot: QtBot, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    stream(window, qtbot)
    path = record_some(window, qtbot)
    qtbot.mouseClick(window.bar.tools.record.button, Qt.MouseButton.LeftButton)
    offers = {window.banner.offers.itemAt(i).widget().text(): window.banner.offers.itemAt(i).widget() for i in range(2)}
    assert list(offers) == ["Open", "Show in folder"]
    told: list[Any] = []
    monkeypatch.setattr(QDesktopServices, "openUrl", told.append)
    offers["Show in folder"].click()
    assert told[0].toLocalFile() == str(folder)
    offers["Open"].click()
    assert window.session.source.transport == "replay"
    assert window.session.source.address == str(path)
    assert window.banner.text() == ""
    qtbot.waitUntil(lambda: window.session.player is not None)
    window.slow_refresh()
    assert window.replay.isVisible()


def test_disconnecting_ends_the_recording_and_says_so(window: MainWindow, qtbot: QtBot) -> None:
    stream(window, qtbot)
    path = record_some(window, qtbot)
    window.session.disconnect_source()
    window.slow_refresh()
    assert path.name in window.banner.text()
    assert read_recording(path).warnings == ()


def test_a_folder_that_cannot_be_made_is_explained(window: MainWindow, qtbot: QtBot, folder: Path) -> None:
    folder.write_text("a file is in the way")
    stream(window, qtbot)
    qtbot.keyClick(window, Key.Key_R)
    assert window.banner.tone == "bad"
    assert window.session.recording is None


def test_an_error_that_ended_it_stays_on_show(window: MainWindow, qtbot: QtBot) -> None:
    stream(window, qtbot)
    record_some(window, qtbot)
    window.session.message.emit("error", "The disk is full.")
    window.session.stop_recording()
    window.slow_refresh()
    assert window.banner.text() == "The disk is full."
    assert window.banner.offers.count() == 2  # what was written can be opened


def test_the_bar_fits_the_smallest_screen_with_a_serial_port(window: MainWindow) -> None:
    window.bar.source.choose_source("serial", "/dev/ttyUSB0")
    window.slow_refresh()
    assert window.bar.baud.isVisible()
    assert window.minimumSizeHint().width() <= 1024
