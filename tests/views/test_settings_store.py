"""SettingsStore: changes are told at once and reach the file a moment later; a failure is said once."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from pytestqt.qtbot import QtBot

from imugui.views.settings_store import SettingsStore


def test_a_change_is_told_at_once_and_saved_soon(qtbot: QtBot, tmp_path: Path) -> None:
    path = tmp_path / "settings.json"
    store = SettingsStore(path)
    with qtbot.waitSignal(store.changed):
        store.update(decimals=2)
    assert store.settings.decimals == 2
    qtbot.waitUntil(path.exists)
    assert json.loads(path.read_text(encoding="utf-8"))["settings"]["decimals"] == 2
    assert SettingsStore(path).settings.decimals == 2


def test_many_changes_are_one_file(qtbot: QtBot, tmp_path: Path) -> None:
    path = tmp_path / "settings.json"
    store = SettingsStore(path)
    store.update(theme="dark")
    store.keep_filter("vqf", {"tau_acc": 2.0})
    store.keep_board("serial COM7", {"columns": ["t_s"]})
    assert not path.exists()
    store.flush()
    again = SettingsStore(path).store
    assert (again.settings.theme, again.filters, again.boards) == (
        "dark",
        {"vqf": {"tau_acc": 2.0}},
        {"serial COM7": {"columns": ["t_s"]}},
    )


def test_no_change_is_no_news(qtbot: QtBot) -> None:
    store = SettingsStore()
    with qtbot.assertNotEmitted(store.changed):
        store.update(decimals=store.settings.decimals)


def test_an_unknown_setting_is_a_defect(qtbot: QtBot) -> None:
    with pytest.raises(TypeError):
        SettingsStore().update(colour="red")


def test_a_file_that_cannot_be_written_is_said_once(qtbot: QtBot, tmp_path: Path) -> None:
    blocked = tmp_path / "folder"
    blocked.write_text("a file where the folder should be", encoding="utf-8")
    store = SettingsStore()
    store._path = blocked / "settings.json"
    told: list[str] = []
    store.failed.connect(told.append)
    for decimals in (0, 2, 0):
        store.update(decimals=decimals)
        store.flush()
    assert len(told) == 1
    assert str(blocked) in told[0]
    assert store.settings.decimals == 0


def test_problems_of_the_file_are_kept_for_the_window(qtbot: QtBot, tmp_path: Path) -> None:
    path = tmp_path / "settings.json"
    path.write_text('{"settings": {"decimals": 99}}', encoding="utf-8")
    store = SettingsStore(path)
    assert len(store.problems) == 1
    assert "decimals" in store.problems[0]
