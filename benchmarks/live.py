"""Age of samples at publish and at paint, with each page at work, against an empty window on the same stream.

A child process sends samples over a pseudo-terminal at 100, 200, 400 and 1000 Hz; this one reads, decodes, fuses and
paints. Prints one JSON line for each rate and page: ages in ms, rows missed, processor share, frames a second; the
ratio is that of the 99th percentiles at publish. The highest rate comes again with one more filter.

    python3 run.py bench live [--seconds 3] [--rates 100 200 400 1000] [--filter imugui] [--format triplets]
"""

from __future__ import annotations

import argparse
import math
import multiprocessing
import os
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")

import numpy as np
from _at_work import put_to_work
from _measure import line
from PySide6.QtCore import QEvent, QObject
from PySide6.QtWidgets import QMainWindow, QWidget

from imugui import app as composition
from imugui.formats import FORMATS
from imugui.fusion import DEFAULT_FILTER, FILTERS
from imugui.settings import FILE_NAME
from imugui.simulation.board import VirtualBoard
from imugui.simulation.errors import PRESETS
from imugui.simulation.pty_board import PtyBoard
from imugui.simulation.pty_port import PtyPort
from imugui.simulation.wire import Wire
from imugui.views import VIEWS
from imugui.views.main_window import MainWindow
from imugui.views.settings_store import SettingsStore
from imugui.workers.headless import spin
from imugui.workers.session import Session, Source, Status

SETTLE_S = 3.0
PAGE_SETTLE_S = 0.5
RATES_HZ = (100.0, 200.0, 400.0, 1000.0)
LIMIT = {(1000.0, "live", DEFAULT_FILTER): 5.0, (1000.0, "live", "imugui"): 15.0}
"""Age at publish, 99th percentile, ms, at most, by rate, page and filter."""
EMPTY = "empty window"


class Frames(QObject):
    """Notes, whenever a frame paints a widget or one of its parts, how old the newest attitude is.

    A frame is what the window paints in one go; the parts in it count once, however long they take.
    """

    def __init__(self, watched: QWidget, session: Session) -> None:
        super().__init__()
        self.ages_ms: list[float] = []
        self._session = session
        self._counted = True
        self._window, self._parts = watched.window(), {watched, *watched.findChildren(QWidget)}
        for widget in {self._window, *self._parts}:
            widget.installEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802
        if event.type() == QEvent.Type.UpdateRequest and watched is self._window:
            self._counted = False
        elif event.type() == QEvent.Type.Paint and not self._counted and watched in self._parts:
            self._counted = True
            newest = self._session.attitude.last(1)
            if len(newest):
                self.ages_ms.append(1e3 * (time.perf_counter() - float(newest["t_arrival"][0])))
        return super().eventFilter(watched, event)


def send(link: str, name: str, rate_hz: float, stop: Any) -> None:
    """The board: runs in a process of its own, so that it does not share the interpreter with what is measured."""
    port = PtyPort(Path(link))
    port.open()
    wire = Wire(VirtualBoard("free", rate_hz, PRESETS["mpu9250-calibrated"], 1), FORMATS[name])
    PtyBoard(wire, port, time.monotonic()).run_until(stop)
    port.close()


@contextmanager
def board(link: Path, name: str, rate_hz: float) -> Iterator[None]:
    """A board that sends as long as the block lasts."""
    context = multiprocessing.get_context("spawn")
    stop = context.Event()
    child = context.Process(target=send, args=(str(link), name, rate_hz, stop))
    child.start()
    until = time.perf_counter() + 30.0
    while not link.exists() and time.perf_counter() < until:
        time.sleep(0.05)
    try:
        yield
    finally:
        stop.set()
        child.join()


def wait(session: Session, seconds: float) -> Status:
    until = time.perf_counter() + seconds
    return spin(session, lambda _: time.perf_counter() > until)


def measured(session: Session, watched: QWidget, seconds: float) -> dict[str, Any]:
    """What happens in the next seconds."""
    session.reset_ages()
    frames, cpu, before = Frames(watched, session), time.process_time(), session.status()
    status = wait(session, seconds)
    shares = np.percentile(frames.ages_ms, (50, 95, 99)).round(1).tolist() if frames.ages_ms else []
    return {
        "age_ms": session.age_quantiles(),
        "paint_age_ms": dict(zip(("p50", "p95", "p99"), shares, strict=False)),
        "missed_rows": status.missed_rows - before.missed_rows,
        "samples": status.samples - before.samples,
        "cpu": round((time.process_time() - cpu) / seconds, 3),
        "frames_per_s": round(len(frames.ages_ms) / seconds, 1),
    }


def p99_ms(figures: dict[str, Any]) -> float:
    """99th percentile of the age at publish; NaN where a busy machine fused nothing, which is never as wanted."""
    return float(figures["age_ms"].get("p99", math.nan))


def one_rate(link: Path, rate_hz: float, seconds: float, pages: Sequence[str], filter_name: str) -> None:
    """Print the figures of one rate: the empty window first, then pages of the real one."""
    found: dict[str, dict[str, Any]] = {}
    session, bare = Session(filter_name), QMainWindow()
    bare.resize(1280, 800)
    bare.show()
    session.connect_to(Source("serial", str(link)))
    wait(session, SETTLE_S)
    found[EMPTY] = measured(session, bare, seconds)
    session.disconnect_source()
    bare.close()
    window = MainWindow(session, SettingsStore(link.parent / FILE_NAME))
    window.resize(1280, 800)
    window.show()
    session.connect_to(Source("serial", str(link)))
    wait(session, SETTLE_S)
    for name in pages:
        put_to_work(window, session, name)
        wait(session, PAGE_SETTLE_S)
        found[name] = measured(session, window.page(), seconds)
    window.close()
    session.close()
    base = p99_ms(found[EMPTY])
    for name, figures in found.items():
        limit = LIMIT.get((rate_hz, name, filter_name))
        p99 = p99_ms(figures)
        ok = figures["missed_rows"] == 0 and p99 <= (math.inf if limit is None else limit)
        case = ", ".join((f"{rate_hz:g} Hz", name, *([] if filter_name == DEFAULT_FILTER else [filter_name])))
        line("live", case, p99 / base, None, False, ok=ok, limit_ms=limit, **figures)


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--seconds", type=float, default=3.0)
    arguments.add_argument("--rates", type=float, nargs="+", default=RATES_HZ)
    arguments.add_argument("--pages", nargs="+", choices=list(VIEWS), default=list(VIEWS))
    arguments.add_argument("--filter", choices=list(FILTERS), default="imugui", help="at the highest rate, too")
    arguments.add_argument("--format", choices=list(FORMATS), default="triplets")
    chosen = arguments.parse_args()
    application = composition.make_application()
    runs = [(rate_hz, chosen.pages, DEFAULT_FILTER) for rate_hz in chosen.rates]
    if chosen.filter != DEFAULT_FILTER:
        runs.append((max(chosen.rates), ["live"], chosen.filter))
    for rate_hz, pages, filter_name in runs:
        with tempfile.TemporaryDirectory() as folder:
            link = Path(folder) / "board"
            with board(link, chosen.format, rate_hz):
                one_rate(link, rate_hz, chosen.seconds, pages, filter_name)
            application.processEvents()
    return 0


if __name__ == "__main__":
    sys.exit(main())
