"""A defect: in the log, in one sentence with the log's name, and the recording goes on."""

from __future__ import annotations

import logging
import logging.handlers
import sys
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from PySide6.QtCore import QTimer, QtMsgType, qCritical

from imugui.app import start_log
from imugui.crash import LONGEST, MOST_LOGGED, CrashReport
from imugui.recording import read_recording
from imugui.views.main_window import MainWindow
from imugui.views.settings_store import SettingsStore
from imugui.workers.session import Session, Source


@pytest.fixture
def log(tmp_path: Path) -> Iterator[Path]:
    path = start_log(tmp_path / "user")
    assert path is not None
    yield path
    for handler in logging.getLogger().handlers[:]:
        if isinstance(handler, logging.handlers.RotatingFileHandler) and handler.baseFilename == str(path):
            logging.getLogger().removeHandler(handler)
            handler.close()


@pytest.fixture
def said() -> list[str]:
    return []


@pytest.fixture
def crash(qapp: object, log: Path, said: list[str]) -> Iterator[CrashReport]:
    one = CrashReport(log, lambda _, text: said.append(text))
    one.install()
    yield one
    one.remove()


def fail(text: str = "a planted defect") -> None:
    raise RuntimeError(text)


def take(crash: CrashReport, text: str = "a planted defect") -> None:
    try:
        fail(text)
    except RuntimeError as error:
        crash.take(type(error), error, error.__traceback__)


def test_a_defect_in_the_window_names_the_log_and_the_recording_goes_on(
    session: Session, log: Path, qtbot: Any, tmp_path: Path
) -> None:
    window = MainWindow(session, SettingsStore())
    report = CrashReport(log, window.show_message)
    window.show()
    session.connect_to(Source("simulator", "free"))
    qtbot.waitUntil(lambda: session.attitude.count > 20)
    assert session.record(tmp_path / "on.imugui")
    with qtbot.captureExceptions() as caught:
        QTimer.singleShot(0, fail)
        qtbot.waitUntil(lambda: bool(caught))
    report.take(*caught[0])
    assert str(log) in window.banner.text()
    assert "a planted defect" in window.banner.text()
    assert "in fail" in log.read_text()
    rows = session.recording.rows
    qtbot.waitUntil(lambda: session.recording.rows > rows + 50)
    window.close()
    window.deleteLater()
    assert read_recording(tmp_path / "on.imugui").warnings == ()


def test_a_defect_in_any_thread_reaches_the_window(crash: CrashReport, said: list[str], log: Path, qtbot: Any) -> None:
    threads: list[int] = []
    crash.said.connect(lambda *_: threads.append(threading.get_ident()))
    thread = threading.Thread(target=fail)
    thread.start()
    thread.join()
    qtbot.waitUntil(lambda: bool(said))
    assert "RuntimeError: a planted defect" in said[0]
    assert str(log) in said[0]
    assert "Traceback" in log.read_text()


def test_a_defect_of_a_worker_is_said_with_the_log(
    session: Session, log: Path, qtbot: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    told: list[str] = []
    session.message.connect(lambda _, text: told.append(text))
    session.connect_to(Source("simulator", "free"))
    qtbot.waitUntil(lambda: session.attitude.count > 20)
    pipeline = session._fusion._running
    monkeypatch.setattr(pipeline, "_fuse", lambda *_: fail())
    qtbot.waitUntil(lambda: bool(told))
    assert "a planted defect" in told[0]
    assert str(log) in told[0]
    monkeypatch.undo()
    count = session.attitude.count
    qtbot.waitUntil(lambda: session.attitude.count > count + 50)


def test_what_comes_with_every_frame_neither_fills_the_log_nor_the_banner(
    crash: CrashReport, said: list[str], log: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for _ in range(200):
        take(crash)
    assert log.read_text().count("Traceback") == MOST_LOGGED
    assert len(said) == 1
    assert capsys.readouterr().err.count("a planted defect") == MOST_LOGGED


def test_what_qt_says_is_logged_and_what_is_grave_is_said(crash: CrashReport, said: list[str], log: Path) -> None:
    crash.take_from_qt(QtMsgType.QtWarningMsg, None, "a small matter")
    assert said == []
    qCritical("a grave matter")
    assert "a grave matter" in said[0]
    assert "a small matter" in log.read_text()
    assert "a grave matter" in log.read_text()


def test_a_long_text_of_many_lines_becomes_one_sentence(crash: CrashReport, said: list[str]) -> None:
    take(crash, "a\nb\n" * 5000)
    assert "\n" not in said[0]
    assert len(said[0]) < LONGEST + 400


def test_without_a_log_that_is_said_and_hooks_are_given_back(qapp: object) -> None:
    before = sys.excepthook, threading.excepthook, sys.unraisablehook
    told: list[str] = []
    one = CrashReport(None, lambda _, text: told.append(text))
    one.install()
    take(one)
    assert "could not be logged" in told[0]
    one.remove()
    assert (sys.excepthook, threading.excepthook, sys.unraisablehook) == before
