"""The window: pages, keys, timers, messages, dropped files, what it keeps."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from PySide6.QtCore import QMimeData, QPoint, QPointF, Qt, QUrl
from PySide6.QtGui import QDragEnterEvent, QDropEvent
from pytestqt.qtbot import QtBot

from imugui.views import VIEWS, theme
from imugui.views.column_map_dialog import ColumnMapDialog
from imugui.views.main_window import MainWindow
from imugui.views.settings_store import SettingsStore
from imugui.views.shortcuts import KEYS, tip
from imugui.views.view import View
from imugui.workers.session import Session, Source, State

Key = Qt.Key


@pytest.fixture
def window(session: Session, settings_store: SettingsStore, shown: Callable[[Any], Any]) -> Iterator[MainWindow]:
    one = shown(MainWindow(session, settings_store))
    one.activateWindow()
    yield one
    one.close()


def page_name(window: MainWindow) -> str:
    return next(name for name, page in window.pages.items() if page is window.page())


def streaming(window: MainWindow) -> Callable[[], bool]:
    return lambda: window.session.status().state is State.STREAMING and window.session.attitude.count > 5


def test_every_page_can_be_brought_to_the_front(window: MainWindow, qtbot: QtBot) -> None:
    assert page_name(window) == "live"
    for number, name in enumerate(VIEWS, 1):
        qtbot.keyClick(window, str(number))
        assert page_name(window) == name
        assert window.navigation.buttons[name].isChecked()
    for name in VIEWS:
        qtbot.mouseClick(window.navigation.buttons[name], Qt.MouseButton.LeftButton)
        assert page_name(window) == name
        assert not window.grab().isNull()


def test_only_the_page_in_front_is_refreshed(window: MainWindow, monkeypatch: pytest.MonkeyPatch) -> None:
    counts = dict.fromkeys(VIEWS, 0)

    def count(self: View) -> None:
        counts[self.title.lower()] += 1

    for page in VIEWS.values():
        monkeypatch.setattr(page, "refresh", count)
    window.show_page("settings")
    window.refresh()
    assert counts == dict.fromkeys(VIEWS, 0) | {"settings": 2}


def test_the_timers_run_only_while_the_window_is_seen(window: MainWindow) -> None:
    assert window.frames.isActive()
    assert window.frames.interval() == 16
    window.hide()
    assert not window.frames.isActive()
    assert not window.slow.isActive()
    window.show()
    assert window.slow.isActive()


def test_connecting_with_the_keyboard(window: MainWindow, qtbot: QtBot) -> None:
    window.bar.source.choose_source("simulator", "aiming")
    qtbot.keyClick(window, Key.Key_K, Qt.KeyboardModifier.ControlModifier)
    qtbot.waitUntil(streaming(window))
    window.slow_refresh()
    window.refresh()
    live = window.pages["live"]
    assert all(readout.text() != "---.-" for readout in live.angles.readouts.values())
    assert window.status_line.labels["rate"].text().endswith("Hz")
    qtbot.keyClick(window, Key.Key_O)
    assert window.session.has_origin
    assert live.origin.text().startswith("Relative to the origin")
    qtbot.keyClick(window, Key.Key_O, Qt.KeyboardModifier.ShiftModifier)
    assert not window.session.has_origin
    qtbot.keyClick(window, Key.Key_K, Qt.KeyboardModifier.ControlModifier)
    assert window.session.source is None


def test_the_origin_without_data_is_explained(window: MainWindow, qtbot: QtBot) -> None:
    qtbot.keyClick(window, Key.Key_O)
    assert "connect a board" in window.banner.text()
    qtbot.keyClick(window, Key.Key_Escape)
    assert window.banner.text() == ""


def test_view_keys_move_the_camera_of_the_live_page_only(window: MainWindow, qtbot: QtBot) -> None:
    scene = window.pages["live"].scene
    start = scene.camera()
    cameras = []
    for key in (Key.Key_X, Key.Key_Y, Key.Key_Z):
        qtbot.keyClick(window, key)
        cameras.append(scene.camera())
    assert len({start, *cameras}) == 4
    window.show_page("settings")
    qtbot.keyClick(window, Key.Key_H)
    assert scene.camera() == cameras[-1]
    window.show_page("live")
    qtbot.keyClick(window, Key.Key_H)
    assert scene.camera() == start


def test_full_screen(window: MainWindow, qtbot: QtBot) -> None:
    qtbot.keyClick(window, Key.Key_F11)
    assert window.isFullScreen()
    qtbot.keyClick(window, Key.Key_F11)
    assert not window.isFullScreen()


def test_the_link_log_opens_by_key_and_by_the_status_line(window: MainWindow, qtbot: QtBot) -> None:
    qtbot.keyClick(window, Key.Key_L)
    assert window.link_log.isVisible()
    window.link_log.hide()
    qtbot.mouseClick(window.status_line, Qt.MouseButton.LeftButton)
    assert window.link_log.isVisible()


def test_no_key_is_given_twice() -> None:
    keys = [key.keys for key in KEYS]
    assert len(set(keys)) == len(keys)
    assert tip("set_origin", "Words") == "Words (O)"
    assert tip("no such action", "Words") == "Words"


def test_messages_of_the_session_are_shown(window: MainWindow) -> None:
    window.session.message.emit("warn", "Something odd.")
    assert (window.banner.text(), window.banner.tone) == ("Something odd.", "warn")


def test_what_the_verdict_says_is_not_said_twice(window: MainWindow) -> None:
    window.show_message("error", window.session.status().sentence)
    assert window.banner.text() == ""


def test_the_empty_page_starts_the_simulated_board(window: MainWindow, qtbot: QtBot) -> None:
    qtbot.mouseClick(window.pages["live"].empty.buttons()[0], Qt.MouseButton.LeftButton)
    qtbot.waitUntil(streaming(window))
    assert window.session.hand_turned
    assert window.bar.source.choice().key == ("simulator", "hand")


def test_a_dropped_file_is_played(window: MainWindow, qtbot: QtBot, tmp_path: Path) -> None:
    path = tmp_path / "run.csv"
    path.write_bytes(b"t,ax,ay,az,gx,gy,gz\n" + b"".join(b"%.2f,0,0,9.81,0,0,0\n" % (i / 100) for i in range(500)))
    mime = QMimeData()
    mime.setUrls([QUrl.fromLocalFile(str(path))])
    plain = (Qt.DropAction.CopyAction, mime, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier)
    entering = QDragEnterEvent(QPoint(300, 300), *plain)
    window.dragEnterEvent(entering)
    assert entering.isAccepted()
    window.dropEvent(QDropEvent(QPointF(300, 300), *plain))
    assert window.session.source == Source("replay", str(path))
    qtbot.waitUntil(streaming(window))


def test_bare_numbers_are_asked_about_and_then_played(window: MainWindow, qtbot: QtBot, tmp_path: Path) -> None:
    path = tmp_path / "bare.txt"
    path.write_bytes(b"".join(b"%d,0,0,1.0,0,0,0\n" % (i * 10) for i in range(500)))
    window.bar.connect_to("replay", str(path))
    dialog = window.findChild(ColumnMapDialog)
    assert window.session.source is None
    assert len(dialog.tables[0].cards) == 7
    dialog.tables[0].cards[0].unit.choose_unit("ms")
    dialog.accept()
    qtbot.waitUntil(streaming(window))
    assert window.session.status().rate_hz == pytest.approx(100.0, rel=0.01)
    window.slow_refresh()
    assert window.bar.verdict.columns_button.isVisible()


def test_colours_change_at_once(window: MainWindow, settings_store: SettingsStore) -> None:
    for scheme, dark in (("dark", True), ("light", False)):
        settings_store.update(theme=scheme)
        assert theme.is_dark() is dark


def test_the_place_of_the_window_and_the_settings_are_kept(
    session: Session, tmp_path: Path, shown: Callable[[Any], Any], owned: Callable[[Any], Any]
) -> None:
    path = tmp_path / "settings.json"
    window = shown(MainWindow(session, SettingsStore(path)))
    window.resize(1000, 711)
    window.settings_store.update(decimals=0)
    window.close()
    again = owned(MainWindow(session, SettingsStore(path)))
    assert again.height() == 711  # the offscreen platform's screen is 800 pixels wide
    assert again.settings_store.settings.decimals == 0


@pytest.mark.parametrize("kept", ["nonsense", "AAAA", "ä"])
def test_a_bad_place_is_ignored(session: Session, settings_store: SettingsStore, owned: Any, kept: str) -> None:
    settings_store.update(window=kept)
    window = owned(MainWindow(session, settings_store))
    assert (window.width(), window.height()) == (1280, 800)


def test_problems_of_the_settings_file_are_told(session: Session, tmp_path: Path, owned: Any) -> None:
    path = tmp_path / "settings.json"
    path.write_text("{", encoding="utf-8")
    window = owned(MainWindow(session, SettingsStore(path)))
    assert "not valid JSON" in window.banner.text() or "kept as" in window.banner.text()


def test_closing_ends_the_session(window: MainWindow, qtbot: QtBot) -> None:
    window.bar.connect_to("simulator", "rest")
    qtbot.waitUntil(streaming(window))
    window.close()
    assert window.session.source is None
    assert window.ports.isFinished()


def test_fits_the_smallest_screen(window: MainWindow) -> None:
    assert window.minimumSizeHint().width() <= 1024
    assert window.minimumSizeHint().height() <= 680
