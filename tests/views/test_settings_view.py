"""The Settings page."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from PySide6.QtCore import Qt, QUrl
from PySide6.QtGui import QDesktopServices
from PySide6.QtWidgets import QLabel
from pytestqt.qtbot import QtBot

from imugui import __version__
from imugui.views.controls import Button
from imugui.views.settings_store import SettingsStore
from imugui.views.settings_view import SettingsView
from imugui.views.shortcuts import KEYS
from imugui.workers.session import Session


@pytest.fixture
def view(session: Session, settings_store: SettingsStore, shown: Callable[[Any], Any]) -> SettingsView:
    return shown(SettingsView(session, settings_store))


def texts(view: SettingsView) -> str:
    return "\n".join(label.text() for label in view.findChildren(QLabel))


def test_a_change_acts_at_once(view: SettingsView, settings_store: SettingsStore) -> None:
    view.form.editor("convention").setCurrentText("NED")
    view.form.editor("decimals").setValue(2)
    assert (settings_store.settings.convention, settings_store.settings.decimals) == ("NED", 2)


def test_a_change_from_elsewhere_is_shown(view: SettingsView, settings_store: SettingsStore) -> None:
    settings_store.update(convention="NWU", window="kept")
    view.slow_refresh()
    assert view.form.value().convention == "NWU"
    view.form.editor("decimals").setValue(0)
    assert settings_store.settings.window == "kept"


def test_says_what_the_program_is_and_is_not(view: SettingsView) -> None:
    said = texts(view)
    assert __version__ in said
    assert "MIT licence" in said
    assert "not a medical device" in said


@pytest.mark.parametrize("key", KEYS, ids=lambda key: key.action)
def test_every_key_is_listed(view: SettingsView, key: Any) -> None:
    assert key.keys in texts(view)
    assert key.words in texts(view)


def test_folders_are_opened_even_before_they_exist(
    view: SettingsView, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    opened: list[QUrl] = []
    monkeypatch.setattr(QDesktopServices, "openUrl", opened.append)
    buttons = [button for button in view.findChildren(Button) if button.text() == "Open folder"]
    for button in buttons:
        qtbot.mouseClick(button, Qt.MouseButton.LeftButton)
    assert len(opened) == len(buttons) == 2
    assert all(Path(url.toLocalFile()).is_dir() for url in opened)
