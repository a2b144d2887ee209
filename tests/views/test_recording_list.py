"""The list of recordings: read in a thread, opened, verified, shown, deleted."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QMessageBox
from pytestqt.qtbot import QtBot

from imugui.recording.folder import ABOUT, FolderWriter
from imugui.recording.summary import Summary
from imugui.samples import SAMPLE, empty_rows
from imugui.views.recording_list import RecordingList
from imugui.views.recording_model import SUMMARY, facts_of, title_of
from imugui.workers.session import Session, Source


def write(folder: Path, name: str, n: int = 500) -> Path:
    rows = empty_rows(SAMPLE, n)
    rows["t"] = np.arange(n) / 100.0
    rows["acc"], rows["gyr"] = (0.0, 0.0, 9.81), 0.1
    writer = FolderWriter(folder / f"{name}.imugui", {"label": name})
    writer.samples(rows)
    writer.close({"rows": n, "missed_rows": 0})
    return writer.folder


@pytest.fixture
def listed(shown: Callable[[Any], Any]) -> Iterator[RecordingList]:
    one = shown(RecordingList())
    one.resize(700, 500)
    one.activateWindow()
    yield one
    one.stop()


def read(listed: RecordingList, folder: Path, qtbot: QtBot, running: Path | None = None) -> list[Summary]:
    """Read the folder, and wait until every summary is there."""

    def summaries() -> list[Any]:
        return [listed.model.index(row).data(SUMMARY) for row in range(listed.model.rowCount())]

    with qtbot.waitSignal(listed.model.counted):
        listed.refresh(folder, running)
    qtbot.waitUntil(lambda: all(summaries()))
    return summaries()


def test_an_empty_folder_says_how_to_fill_it(listed: RecordingList, tmp_path: Path, qtbot: QtBot) -> None:
    read(listed, tmp_path / "missing", qtbot)
    assert listed.nothing.isVisible()
    assert "Press Record" in listed.nothing.text()
    assert not any(button.isEnabled() for button in listed.buttons())


def test_recordings_are_listed_newest_first_with_their_numbers(
    listed: RecordingList, tmp_path: Path, qtbot: QtBot
) -> None:
    for name in ("2026-01-01_a", "2026-01-02_b"):
        write(tmp_path, name)
    running = write(tmp_path, "2026-01-03_c")
    found = read(listed, tmp_path, qtbot, running)
    assert [one.label for one in found] == ["2026-01-02_b", "2026-01-01_a"]
    assert facts_of(found[0]).startswith("5.0 s · 100.0 Hz · no gaps · ")
    assert title_of(found[0].path, found[0]) == "2026-01-02_b"
    assert listed.selected() == found[0].path
    assert all(button.isEnabled() for button in listed.buttons())
    assert not listed.grab().isNull()


def test_a_new_recording_appears_by_itself(listed: RecordingList, tmp_path: Path, qtbot: QtBot) -> None:
    write(tmp_path, "a")
    assert len(read(listed, tmp_path, qtbot)) == 1
    write(tmp_path, "b")
    assert len(read(listed, tmp_path, qtbot)) == 2


def test_damage_is_told_in_the_list(listed: RecordingList, tmp_path: Path, qtbot: QtBot) -> None:
    (write(tmp_path, "a") / ABOUT).write_text("{")
    assert "cannot be read" in facts_of(read(listed, tmp_path, qtbot)[0])
    assert facts_of(None) == "reading…"


def test_enter_opens(listed: RecordingList, tmp_path: Path, qtbot: QtBot) -> None:
    path = write(tmp_path, "a")
    read(listed, tmp_path, qtbot)
    listed.list.setFocus()
    with qtbot.waitSignal(listed.opened) as opened:
        qtbot.keyClick(listed.list, Qt.Key.Key_Return)
    assert opened.args == [str(path)]
    with qtbot.waitSignal(listed.opened):
        qtbot.mouseClick(listed.open_button, Qt.MouseButton.LeftButton)


def test_verify_says_zero_for_a_recording_of_this_version(
    listed: RecordingList, session: Session, tmp_path: Path, qtbot: QtBot
) -> None:
    session.connect_to(Source("simulator", "aiming"))
    qtbot.waitUntil(lambda: session.attitude.count > 5)
    session.record(tmp_path / "real.imugui")
    qtbot.waitUntil(lambda: session.recording is not None and session.recording.rows > 50)
    session.disconnect_source()
    read(listed, tmp_path, qtbot)
    qtbot.mouseClick(listed.verify_button, Qt.MouseButton.LeftButton)
    assert listed.verify_button.text() == "Cancel"
    with qtbot.waitSignal(listed.verifier.said, timeout=30_000):
        pass
    assert listed.tone.tone == "good"
    assert "largest difference 0 deg" in listed.result.text()
    assert listed.verify_button.text() == "Verify"


def test_what_cannot_be_verified_is_explained(listed: RecordingList, tmp_path: Path, qtbot: QtBot) -> None:
    write(tmp_path, "a")
    read(listed, tmp_path, qtbot)
    with qtbot.waitSignal(listed.verifier.said, timeout=30_000):
        listed.verify()
    assert listed.tone.tone == "bad"
    assert "a.imugui" in listed.result.text()


def test_verifying_can_be_cancelled(listed: RecordingList, tmp_path: Path, qtbot: QtBot) -> None:
    write(tmp_path, "a")
    read(listed, tmp_path, qtbot)
    listed.verify()
    listed.verify()
    assert listed.verifier.path is None
    assert "cancelled" in listed.result.text()


def test_delete_asks_first(
    listed: RecordingList, tmp_path: Path, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "data"))
    (tmp_path / "data").mkdir()
    path = write(tmp_path / "files", "a")
    read(listed, tmp_path / "files", qtbot)
    asked: list[str] = []

    def no(*words: Any) -> QMessageBox.StandardButton:
        asked.append(words[-1])
        return QMessageBox.StandardButton.No

    monkeypatch.setattr(QMessageBox, "question", no)
    listed.list.setFocus()
    qtbot.keyClick(listed.list, Qt.Key.Key_Delete)
    assert asked == ["Move a.imugui to the trash?"]
    assert path.is_dir()
    monkeypatch.setattr(QMessageBox, "question", lambda *_: QMessageBox.StandardButton.Yes)
    qtbot.mouseClick(listed.delete_button, Qt.MouseButton.LeftButton)
    moved = not path.exists()
    assert ("was moved to the trash" if moved else "cannot be moved") in listed.result.text()
    assert len(read(listed, tmp_path / "files", qtbot)) == (0 if moved else 1)
