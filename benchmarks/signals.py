"""Frames a second of the Signals page: ten channels over 120 s at 1,000 Hz, 1280 x 800, offscreen, rows still coming.

The yardsticks are plain pyqtgraph plots of the same rows in the same layout: as they come, and with pyqtgraph's own
reduction to peaks. Prints a JSON line of each, then one of the memory over an hour of simulated time.

    python3 run.py bench signals [--seconds 5]
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import sys
import time
from collections.abc import Callable

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")

import numpy as np
import pyqtgraph
from PySide6.QtCore import QEvent, QObject
from PySide6.QtWidgets import QApplication, QWidget

from imugui.ring import Ring
from imugui.samples import ATTITUDE, SAMPLE, Rows, empty_rows
from imugui.signals.feed import Feed
from imugui.views import theme
from imugui.views.settings_store import SettingsStore
from imugui.views.signals_view import SignalsView
from imugui.workers.session import Session

RATE_HZ = 1000
WINDOW_S = 120
SIZE = (1280, 800)
PER_FRAME = 17  # rows between two frames at 60 Hz
CHANNELS = {"acc": "xyz", "gyr": "xyz", "mag": ("x", "y", "z", "norm")}
WANTED_HZ = 30.0
HOUR_S = 3600
PIECE = 10_000


class PaintCount(QObject):
    """Counts the paint events of one widget."""

    def __init__(self, watched: QWidget) -> None:
        super().__init__(watched)
        self.paints = 0
        watched.installEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802
        self.paints += event.type() == QEvent.Type.Paint
        return super().eventFilter(watched, event)


def make_rows(first: int, n: int, random: np.random.Generator) -> tuple[Rows, Rows]:
    """Noise on slow swings: n sample and attitude rows from number ``first``."""
    t = (first + np.arange(n)) / RATE_HZ
    samples, attitude = empty_rows(SAMPLE, n), empty_rows(ATTITUDE, n)
    samples["t"] = attitude["t"] = samples["t_arrival"] = t
    for k, name in enumerate(("acc", "gyr", "mag")):
        swing = np.sin(t[:, None] * (0.3, 0.7, 1.1) + k)
        samples[name] = attitude[name] = 10.0 * swing + random.normal(0.0, 1.0, (n, 3))
    half = 0.1 * t
    attitude["quat"] = attitude["local"] = np.column_stack((np.cos(half), 0.0 * t, 0.0 * t, np.sin(half)))
    return samples, attitude


def frames_per_s(frame: Callable[[int], None], seconds: float) -> float:
    """How often ``frame(number)`` can be drawn in a second, after a warm-up."""
    for number in range(3):
        frame(number)
    start, count = time.perf_counter(), 0
    while time.perf_counter() - start < seconds:
        frame(3 + count)
        count += 1
    return count / (time.perf_counter() - start)


def signals_page(application: QApplication, seconds: float, spectrum: bool) -> dict[str, float]:
    """The page with rows pushed before each frame, as they come from the board."""
    session, random = Session(), np.random.default_rng(1)
    view = SignalsView(session, SettingsStore())
    view.resize(*SIZE)
    view.scope.viewport.window_s = float(WINDOW_S)
    view.scope.choice.channels = {f"{stem}.{axis}" for stem, axes in CHANNELS.items() for axis in axes}
    rows = make_rows(0, WINDOW_S * RATE_HZ, random)
    session.samples.push(rows[0])
    session.attitude.push(rows[1])
    view.show()
    view.slow_refresh()
    while view.scope.feed.behind or len(view.scope.feed.raw) == 0:
        view.refresh()
    if spectrum:
        view.toggle_spectrum()
    painted = PaintCount(view.plots)

    def frame(number: int) -> None:
        new = make_rows(WINDOW_S * RATE_HZ + number * PER_FRAME, PER_FRAME, random)
        session.samples.push(new[0])
        session.attitude.push(new[1])
        view.refresh()
        application.processEvents()
        if painted.paints <= number:
            raise RuntimeError("a frame was not painted")

    result = {"frames_per_s": round(frames_per_s(frame, seconds), 1), "history_mb": view.scope.feed.nbytes / 1e6}
    start = time.perf_counter()
    view.slow_refresh()
    result["slow_refresh_ms"] = round(1e3 * (time.perf_counter() - start), 1)
    view.close()
    session.close()
    return result


def plain_plots(application: QApplication, seconds: float, peaks: bool) -> float:
    """The same curves in three pyqtgraph plots, every row handed over anew for each frame."""
    widget = pyqtgraph.GraphicsLayoutWidget()
    widget.resize(*SIZE)
    samples, _ = make_rows(0, WINDOW_S * RATE_HZ, np.random.default_rng(1))
    curves = []
    samples = np.concatenate((samples, samples))
    rows = WINDOW_S * RATE_HZ
    for row, name in enumerate(CHANNELS):
        plot = widget.addPlot(row=row, col=0)
        plot.setXRange(-WINDOW_S, 0, padding=0)
        plot.setYRange(-20, 20)
        columns = [samples[name][:, axis].copy() for axis in range(3)]
        columns += [np.linalg.norm(samples[name], axis=1)] * ("norm" in CHANNELS[name])
        for column in columns:
            curve = plot.plot(pen="w", skipFiniteCheck=True)
            if peaks:
                curve.setDownsampling(auto=True, method="peak")
                curve.setClipToView(True)
            curves.append((curve, column))
    x = samples["t"][:rows] - WINDOW_S
    painted = PaintCount(widget.viewport())
    widget.show()

    def frame(number: int) -> None:
        for curve, column in curves:
            start = PER_FRAME * number % rows
            curve.setData(x, column[start : start + rows])
        application.processEvents()
        if painted.paints <= number:
            raise RuntimeError("a frame was not painted")

    result = frames_per_s(frame, seconds)
    widget.close()
    return result


def memory_over_an_hour() -> dict[str, float]:
    """Bytes held and the process's largest size, after two minutes and after an hour of rows at full rate."""
    samples, attitude, random = Ring(SAMPLE, PIECE), Ring(ATTITUDE, PIECE), np.random.default_rng(1)
    feed = Feed(samples, attitude, "ENU")
    held, peak = [], []
    for first in range(0, HOUR_S * RATE_HZ, PIECE):
        rows = make_rows(first, PIECE, random)
        samples.push(rows[0])
        attitude.push(rows[1])
        feed.refresh()
        if first in ((WINDOW_S * 2) * RATE_HZ, HOUR_S * RATE_HZ - PIECE):
            held.append(feed.nbytes)
            peak.append(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)
    return {"held_mb": held[-1] / 1e6, "held_growth_bytes": held[-1] - held[0], "peak_growth_kb": peak[-1] - peak[0]}


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--seconds", type=float, default=5.0)
    seconds = arguments.parse_args().seconds
    application = QApplication([])
    theme.apply(application, "dark")
    page = signals_page(application, seconds, spectrum=False)
    spectra = signals_page(application, seconds, spectrum=True)
    plain, peaks = (plain_plots(application, seconds, choice) for choice in (False, True))
    result = {"benchmark": "signals", "channels": 10, "rate_hz": RATE_HZ, "window_s": WINDOW_S, **page}
    result |= {"spectrum_frames_per_s": spectra["frames_per_s"]}
    result |= {"pyqtgraph_frames_per_s": round(plain, 1), "pyqtgraph_peaks_frames_per_s": round(peaks, 1)}
    result |= {"ratio": round(page["frames_per_s"] / plain, 1), "ratio_peaks": round(page["frames_per_s"] / peaks, 1)}
    print(json.dumps(result | {"ok": page["frames_per_s"] >= WANTED_HZ}))
    print(json.dumps({"benchmark": "signals_memory", "hours": 1, "rate_hz": RATE_HZ, **memory_over_an_hour()}))
    return 0


if __name__ == "__main__":
    sys.exit(main())
