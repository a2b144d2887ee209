"""Age of samples at publish with the window painting, against the same stream without a window.

A child process sends samples over a pseudo-terminal; this one reads, decodes, fuses and (second run) paints the Live
page at 60 Hz. Prints one JSON line a run and the ratio.

    python3 run.py bench live [--seconds 60] [--rate 1000] [--format triplets]
"""

from __future__ import annotations

import argparse
import json
import multiprocessing
import os
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")

from PySide6.QtCore import QEvent, QObject
from PySide6.QtWidgets import QWidget

from imugui import app as composition
from imugui.formats import FORMATS
from imugui.settings import FILE_NAME
from imugui.simulation.board import VirtualBoard
from imugui.simulation.errors import PRESETS
from imugui.simulation.pty_board import PtyBoard
from imugui.simulation.pty_port import PtyPort
from imugui.simulation.wire import Wire
from imugui.views.main_window import MainWindow
from imugui.views.settings_store import SettingsStore
from imugui.workers.headless import report, spin
from imugui.workers.session import Session, Source, Status

SETTLE_S = 3.0


class PaintCount(QObject):
    """Counts the paint events of one widget."""

    def __init__(self, watched: QWidget) -> None:
        super().__init__(watched)
        self.paints = 0
        watched.installEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802
        self.paints += event.type() == QEvent.Type.Paint
        return super().eventFilter(watched, event)


def send(link: str, name: str, rate_hz: float, stop: Any) -> None:
    """The board: runs in a process of its own, so that it does not share the interpreter with what is measured."""
    port = PtyPort(Path(link))
    port.open()
    wire = Wire(VirtualBoard("free", rate_hz, PRESETS["mpu9250-calibrated"], 1), FORMATS[name])
    PtyBoard(wire, port, time.monotonic()).run_until(stop)
    port.close()


def run(link: Path, seconds: float, window: bool) -> dict[str, Any]:
    """One run; ages are counted after the first seconds, in which format and filter are found."""
    application = composition.make_application()
    session = Session()
    shown = MainWindow(session, SettingsStore(link.parent / FILE_NAME)) if window else None
    if shown is not None:
        shown.resize(1280, 800)
        shown.show()
        count = PaintCount(shown.page().scene)
    session.connect_to(Source("serial", str(link)))
    wait(session, SETTLE_S)
    session.reset_ages()
    before, cpu = session.status(), time.process_time()
    painted = count.paints if shown else 0
    status = wait(session, seconds)
    result = report(session, status) | {"window": window, "cpu": round((time.process_time() - cpu) / seconds, 3)}
    result["measured_samples"] = status.samples - before.samples
    if shown is not None:
        result["frames_per_s"] = round((count.paints - painted) / seconds, 1)
        shown.close()
    session.close()
    application.processEvents()
    return result


def wait(session: Session, seconds: float) -> Status:
    until = time.perf_counter() + seconds
    return spin(session, lambda _: time.perf_counter() > until)


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--seconds", type=float, default=20.0)
    arguments.add_argument("--rate", type=float, default=1000.0)
    arguments.add_argument("--format", choices=list(FORMATS), default="triplets")
    chosen = arguments.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        link = Path(folder) / "board"
        context = multiprocessing.get_context("spawn")
        stop = context.Event()
        child = context.Process(target=send, args=(str(link), chosen.format, chosen.rate, stop))
        child.start()
        while not link.exists():
            time.sleep(0.05)
        results = [run(link, chosen.seconds, window) for window in (False, True)]
        stop.set()
        child.join()
    for result in results:
        print(json.dumps({"benchmark": "live", "rate": chosen.rate, **result}))
    ages = [result["age_ms"]["p99"] for result in results]
    print(json.dumps({"benchmark": "live", "age_p99_with_window_to_without": round(ages[1] / ages[0], 2)}))
    return 0


if __name__ == "__main__":
    sys.exit(main())
