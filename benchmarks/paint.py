"""Milliseconds a frame of every page at work, at 1280 x 800 with a board that turns, and of the cube at 600 x 600.

A frame is what the display timer asks of the main thread: refresh the page, then let it be painted; offscreen, where
Qt's raster engine paints as on any screen. Counted is the main thread's own processor time, so that other programs and
the reader and fusion threads do not count. The yardstick of the ratios: 30 plain polygons painted in the same run.

    python3 run.py bench paint [--frames 120]
"""

from __future__ import annotations

import argparse
import os
import statistics
import sys
import tempfile
import time
from pathlib import Path

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")

from _at_work import put_to_work
from _measure import line
from paint_scene import plain_polygons, scene_ms
from PySide6.QtWidgets import QApplication

from imugui import app as composition
from imugui.settings import FILE_NAME
from imugui.views import VIEWS, theme
from imugui.views.main_window import MainWindow
from imugui.views.settings_store import SettingsStore
from imugui.workers.headless import spin
from imugui.workers.session import Session, Source, State

PAGE_MS, CUBE_MS = 12.0, 4.0
FRAME_S = 1.0 / 60.0
WARM_S = 3.0


def frame_times_ms(window: MainWindow, application: QApplication, frames: int) -> list[float]:
    """Time of each frame of the page in front, at 60 frames a second."""
    times = []
    for _ in range(frames + 10):
        time.sleep(FRAME_S)
        begin = time.thread_time()
        window.refresh()
        application.processEvents()
        times.append(1e3 * (time.thread_time() - begin))
    return times[10:]


def pages(application: QApplication, frames: int, yardstick_ms: float) -> None:
    """Print a figure for each page."""
    with tempfile.TemporaryDirectory() as folder:
        session = Session()
        window = MainWindow(session, SettingsStore(Path(folder) / FILE_NAME))
        window.resize(1280, 800)
        window.show()
        session.connect_to(Source("simulator", "free", rate_hz=200.0))
        until = time.perf_counter() + WARM_S
        spin(session, lambda status: status.state is State.STREAMING and time.perf_counter() > until)
        for name in VIEWS:
            put_to_work(window, session, name)
            application.processEvents()
            window.frames.stop()  # frames are asked for here; words come at their own pace
            times = frame_times_ms(window, application, frames)
            print_figure(f"page {name}", times, yardstick_ms, PAGE_MS)
        window.close()
        session.close()


def print_figure(case: str, times_ms: list[float], yardstick_ms: float, limit_ms: float) -> None:
    """One line: the median frame against the yardstick and against its limit."""
    ms = statistics.median(times_ms)
    p95 = sorted(times_ms)[int(0.95 * len(times_ms))]
    more = {"ms": round(ms, 2), "p95_ms": round(p95, 2), "limit_ms": limit_ms, "polygons_ms": round(yardstick_ms, 3)}
    line("paint", case, ms / yardstick_ms, None, False, ok=ms <= limit_ms, **more)


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--frames", type=int, default=120)
    frames = arguments.parse_args().frames
    application = composition.make_application()
    theme.apply(application, "dark")
    yardstick_ms = plain_polygons()
    print_figure("cube, 600 x 600", [scene_ms(turning=True)], yardstick_ms, CUBE_MS)
    pages(application, frames, yardstick_ms)
    return 0


if __name__ == "__main__":
    sys.exit(main())
