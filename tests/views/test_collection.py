"""Timed collection, with a real session and short times."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from PySide6.QtCore import Qt
from pytestqt.qtbot import QtBot

from imugui import paths
from imugui.recording import read_recording
from imugui.views.collection import COUNTDOWN, IDLE, RECORDING, Collection, Plan
from imugui.views.record_view import RecordView
from imugui.views.settings_store import SettingsStore
from imugui.workers.session import Session, Source, State

SHORT = Plan(duration_s=0.5, countdown_s=0.0, repeats=2, pause_s=0.1, label="slow turn", note="a test")


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Where recordings go; the trash is there too."""
    monkeypatch.setattr(paths, "documents_folder", lambda: tmp_path / "recordings")
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "data"))
    (tmp_path / "data").mkdir()
    return tmp_path / "recordings"


@pytest.fixture
def streaming(session: Session, folder: Path, qtbot: QtBot) -> Session:
    session.connect_to(Source("simulator", "aiming"))
    qtbot.waitUntil(lambda: session.status().state is State.STREAMING)
    return session


def told(collection: Collection) -> list[tuple[str, str]]:
    """What it says from now on."""
    said: list[tuple[str, str]] = []
    collection.ended.connect(lambda tone, words: said.append((tone, words)))
    return said


def test_nothing_is_collected_without_a_board(session: Session, folder: Path) -> None:
    collection = Collection(session)
    said = told(collection)
    assert not collection.start(SHORT)
    assert said[0][0] == "warn"
    assert "Connect a board first" in said[0][1]
    assert not folder.exists()


def test_every_recording_is_as_long_as_asked(streaming: Session, folder: Path, qtbot: QtBot) -> None:
    collection = Collection(streaming)
    said = told(collection)
    assert collection.start(SHORT)
    qtbot.waitUntil(lambda: not collection.running)
    assert said == [("info", "Done. 2 of 2 recordings are complete and kept.")]
    assert len(collection.made) == 2
    for path in collection.made:
        assert path.name.endswith(("_slow-turn.imugui", "_slow-turn-2.imugui"))
        recording = read_recording(path)
        assert (recording.about["label"], recording.about["note"]) == ("slow turn", "a test")
        times = recording.samples["t"]
        assert times[-1] - times[0] >= SHORT.duration_s - 0.05


def test_progress_goes_from_nothing_to_all(streaming: Session, qtbot: QtBot) -> None:
    collection = Collection(streaming)
    collection.start(Plan(duration_s=1.0, countdown_s=1.0, repeats=1))
    first = collection.stage()
    assert (first.phase, first.run) == (COUNTDOWN, 1)
    assert first.share < 0.2
    looks = [first]

    def near_the_end() -> bool:
        looks.append(collection.stage())
        return looks[-1].phase == RECORDING and looks[-1].share > 0.8

    qtbot.waitUntil(near_the_end)
    assert 0.0 < looks[-1].left_s < 0.5
    qtbot.waitUntil(lambda: collection.stage().phase == IDLE)


def test_cancel_keeps_what_is_complete(streaming: Session, folder: Path, qtbot: QtBot) -> None:
    collection = Collection(streaming)
    said = told(collection)
    collection.start(replace(SHORT, duration_s=1.5))
    qtbot.waitUntil(lambda: len(collection.made) == 1 and streaming.recording is not None)
    cut = streaming.recording.path
    collection.cancel()
    assert not collection.running
    assert streaming.recording is None
    tone, words = said[0]
    assert tone == "warn"
    assert words.startswith("Cancelled. 1 of 2 recordings are complete and kept. The one that ran, ")
    assert "moved to the trash" in words or cut.name in words
    assert cut.exists() is (cut.name in words)
    assert collection.made[0].is_dir()


def test_a_recording_ended_by_hand_ends_the_collection(streaming: Session, qtbot: QtBot) -> None:
    collection = Collection(streaming)
    said = told(collection)
    collection.start(SHORT)
    qtbot.waitUntil(lambda: streaming.recording is not None and streaming.recording.rows > 0)
    streaming.stop_recording()
    qtbot.waitUntil(lambda: not collection.running)
    assert "recording was ended" in said[0][1]
    assert "kept as" in said[0][1]


def test_losing_the_board_between_two_ends_it(streaming: Session, qtbot: QtBot) -> None:
    collection = Collection(streaming)
    said = told(collection)
    collection.start(replace(SHORT, duration_s=1.5))
    qtbot.waitUntil(lambda: len(collection.made) == 1)
    streaming.disconnect_source()
    qtbot.waitUntil(lambda: not collection.running)
    assert said[0][0] in ("warn", "error")
    assert "1 of 2" in said[0][1]


def test_the_page_collects_and_lists(
    streaming: Session, settings_store: SettingsStore, folder: Path, shown: Callable[[Any], Any], qtbot: QtBot
) -> None:
    page = shown(RecordView(streaming, settings_store))
    page.collect.form.set_value(SHORT)
    qtbot.mouseClick(page.collect.start_button, Qt.MouseButton.LeftButton)
    page.refresh()
    assert page.collect.cancel_button.isVisible()
    qtbot.waitUntil(lambda: page.collection.running and page.collection.stage().phase == RECORDING)
    page.refresh()
    assert page.collect.left.text().endswith(" s")
    assert page.collect.run.text() == "1 of 2"
    qtbot.waitUntil(lambda: not page.collection.running)
    page.slow_refresh()
    made = page.collection.made[-1]
    qtbot.waitUntil(lambda: page.recordings.selected() == made)
    assert page.collect.start_button.isVisible()
    page.stop()
