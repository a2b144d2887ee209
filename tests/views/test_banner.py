"""The message banner: one at a time, the newest wins, errors stay."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QLabel
from pytestqt.qtbot import QtBot

from imugui.views import banner as module
from imugui.views.banner import Banner
from imugui.views.controls import Button


@pytest.fixture
def banner(shown: Callable[[Any], Any]) -> Banner:
    one = Banner()
    shown(one)
    one.hide()
    return one


def test_shows_and_goes(banner: Banner, qtbot: QtBot) -> None:
    assert banner.text() == ""
    banner.show_message("error", "It broke.")
    assert (banner.text(), banner.tone) == ("It broke.", "bad")
    qtbot.mouseClick(banner.findChild(Button), Qt.MouseButton.LeftButton)
    assert banner.text() == ""


def test_the_newest_wins_and_says_how_many_it_covers(banner: Banner) -> None:
    for text in ("one", "two", "two", "three"):
        banner.show_message("warn", text)
    assert banner.text() == "three"
    assert any(label.text() == "+ 2 before" for label in banner.findChildren(QLabel))
    banner.dismiss()
    banner.show_message("warn", "four")
    assert not any("before" in label.text() for label in banner.findChildren(QLabel))


def test_news_go_by_themselves_but_errors_stay(
    qtbot: QtBot, owned: Callable[[Any], Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "INFO_STAYS_MS", 1)
    banner = owned(Banner())
    banner.show_message("info", "The port is back.")
    banner.show_message("error", "It broke.")
    assert not banner._leave.isActive()
    banner.show_message("info", "The port is back.")
    qtbot.waitUntil(lambda: banner.text() == "")
