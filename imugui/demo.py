"""The demo: the virtual board through a port, the fusion and every page, with a report and pictures."""

from __future__ import annotations

import os
import threading
import time
from pathlib import Path

from PySide6.QtWidgets import QApplication

from imugui import settings
from imugui.app import make_application
from imugui.cli import fail, write_report
from imugui.simulation.pty_board import PtyBoard
from imugui.simulation.pty_port import PtyPort
from imugui.simulation.wire import real_board
from imugui.views import VIEWS
from imugui.views.main_window import MainWindow
from imugui.views.settings_store import SettingsStore
from imugui.workers.headless import report, spin
from imugui.workers.session import Session, Source, State

DEMO_FORMAT, DEMO_MOTION = "accel-lines", "aiming"


def run_demo(out: Path, seconds: float) -> int:
    """Virtual board -> pseudo-terminal -> serial reader -> fusion -> pages; report.json and a screenshot of each."""
    if "QT_QPA_PLATFORM" not in os.environ:
        os.environ["QT_QPA_PLATFORM"] = "offscreen"
    try:
        out.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        return fail(f"{out}: {error.strerror}")
    app = make_application()
    session = Session()
    window = MainWindow(session, SettingsStore(out / settings.FILE_NAME))
    window.show()
    stop, port = threading.Event(), PtyPort()
    source = demo_source(port, stop)
    session.connect_to(source)
    try:
        until = time.perf_counter() + seconds
        status = spin(session, lambda status: time.perf_counter() > until or status.state is State.FAILED)
        written = take_screenshots(window, app, out)
        write_report(out / "report.json", report(session, status))
    except OSError as error:
        return fail(f"{error.filename or out}: {error.strerror}")
    finally:
        stop.set()
        window.close()
        session.close()
        port.close()
    for path in (*written, out / "report.json"):
        print(path)  # noqa: T201
    return 0 if status.samples else fail(status.sentence)


def demo_source(port: PtyPort, stop: threading.Event) -> Source:
    """A virtual board on a pseudo-terminal, fed by a thread of its own; without one where there are none."""
    try:
        port.open()
    except OSError:
        return Source("simulator", DEMO_MOTION, DEMO_FORMAT)
    board = PtyBoard(real_board(DEMO_FORMAT, DEMO_MOTION, seed=1), port, time.monotonic())
    threading.Thread(target=board.run_until, args=(stop,), daemon=True).start()
    return Source("serial", port.path)


def take_screenshots(window: MainWindow, app: QApplication, out: Path) -> list[Path]:
    """One PNG of the window for each page; raises OSError when a picture cannot be written."""
    written = []
    for name in VIEWS:
        window.show_page(name)
        app.processEvents()
        path = out / f"{name}.png"
        if not window.grab().save(str(path)):
            raise OSError(0, "the picture could not be written", str(path))
        written.append(path)
    return written
