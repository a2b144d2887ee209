"""The window closed in the middle of things, and a program that was put to sleep: what was received is kept."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import serial
from PySide6.QtCore import QTimer

from imugui.recording import read_recording
from imugui.recording.folder import SAMPLES
from imugui.views.main_window import MainWindow
from imugui.views.settings_store import SettingsStore
from imugui.workers.session import Session, Source, State
from imugui.workers.verify import verify


@pytest.fixture
def window(session: Session, qtbot: Any) -> Iterator[MainWindow]:
    one = MainWindow(session, SettingsStore())
    one.show()
    qtbot.waitExposed(one)
    yield one
    one.close()
    one.deleteLater()


def stream(session: Session, qtbot: Any) -> None:
    session.connect_to(Source("simulator", "free"))
    qtbot.waitUntil(lambda: session.attitude.count > 20)


def test_closed_while_recording_the_recording_is_whole(
    window: MainWindow, session: Session, qtbot: Any, tmp_path: Path
) -> None:
    stream(session, qtbot)
    folder = tmp_path / "closed.imugui"
    assert session.record(folder)
    qtbot.waitUntil(lambda: session.recording.rows > 50)
    window.close()
    kept = read_recording(folder)
    assert kept.warnings == ()
    assert kept.about["ended"]["rows"] == len(kept.samples) == len(kept.attitude) > 50
    assert kept.about["ended"]["missed_rows"] == 0
    assert verify(folder).attitude_difference_deg == 0.0


def test_closed_while_calibrating_nothing_is_changed(window: MainWindow, session: Session, qtbot: Any) -> None:
    threads = threading.active_count()
    stream(session, qtbot)
    window.show_page("calibrate")
    page: Any = window.pages["calibrate"]
    page.calibrate("mag")
    qtbot.waitUntil(lambda: page.flow.picture.isVisible() and session.attitude.count > 200)
    before = session.profiles.entries()
    window.close()
    assert session.source is None
    assert before == session.profiles.entries() == []
    assert threading.active_count() == threads


def test_closed_while_a_port_opens_the_window_goes_at_once(
    window: MainWindow, session: Session, monkeypatch: pytest.MonkeyPatch
) -> None:
    inside, may_go_on = threading.Event(), threading.Event()
    seen: list[bool] = []

    def slow(*_: Any, **__: Any) -> Any:
        inside.set()
        may_go_on.wait(60)
        raise serial.SerialException("no board answers")

    monkeypatch.setattr(serial, "serial_for_url", slow)
    session.connect_to(Source("serial", "/dev/rfcomm0"))
    assert inside.wait(30)
    assert session.status().state is State.OPENING
    real = session.close

    def close() -> None:
        seen.append(window.isVisible())
        may_go_on.set()
        real()

    monkeypatch.setattr(session, "close", close)
    QTimer.singleShot(0, window.close)
    window.close()
    assert seen[0] is False
    assert session.source is None


@pytest.mark.skipif(os.name == "nt", reason="needs SIGSTOP")
def test_a_program_that_was_put_to_sleep_goes_on_and_says_what_is_missing(tmp_path: Path, qtbot: Any) -> None:
    link, folder, report = tmp_path / "board", tmp_path / "slept.imugui", tmp_path / "report.json"
    start = [sys.executable, "-m", "imugui"]
    board = subprocess.Popen([*start, "simulate", "--format", "accel-lines", "--port-link", str(link)], stdout=-3)
    live = [*start, "live", "--port", str(link), "--seconds", "3", "--record", str(folder), "--report", str(report)]
    program = subprocess.Popen(live, stdout=subprocess.DEVNULL)
    table = folder / SAMPLES
    try:
        qtbot.waitUntil(lambda: table.exists() and table.read_bytes().count(b"\n") > 60)
        program.send_signal(signal.SIGSTOP)
        qtbot.wait(800)  # asleep: there is nothing to wait for
        program.send_signal(signal.SIGCONT)
        assert program.wait(60) == 0
    finally:
        program.kill()
        board.terminate()
        board.wait()
    kept = read_recording(folder)
    assert kept.warnings == ()
    assert np.diff(kept.samples["t"]).min() > 0.0
    said = json.loads(report.read_text())
    assert said["bad_messages"] <= 1  # the line in which the buffer of the port was full
    assert len(kept.samples) > 100
    assert verify(folder).attitude_difference_deg == 0.0
