"""The long runs, only on request: twelve hours of samples through the whole live path, twenty minutes with the window.

The twelve hours come 40 times as fast: a child process sends 8,000 samples a second over a pseudo-terminal; they are
decoded, fused and recorded. On a machine that cannot keep up the terminal is full and the board waits, so that the run
takes longer and loses nothing. The recording needs 3 GB.

With the window its pages take turns in front. Each is opened once before anything is measured, since what is imported
and drawn for the first time stays in memory.

Watched: memory after the first tenth against the most that is held later; rows missed by fusion and recorder; samples
sent against samples recorded, which the board counts; whether the recording holds every row in order.

    python3 run.py bench endurance [--hours 12] [--speed 40] [--minutes 20] [--folder DIR]
"""

from __future__ import annotations

import argparse
import json
import multiprocessing
import os
import shutil
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")

from _board import Sender, steady_board
from _measure import line
from live import wait
from PySide6.QtWidgets import QApplication

from imugui import app as composition
from imugui.settings import FILE_NAME
from imugui.views import VIEWS
from imugui.views.main_window import MainWindow
from imugui.views.settings_store import SettingsStore
from imugui.workers.headless import spin
from imugui.workers.session import Session, Source, Status

RATE_HZ = 200.0
FASTEST_HZ = 8000.0  # of the virtual board
FORMAT = "triplets"
LOOKS = 200
CURVE = 50  # of these go into the plot
SETTLE_S, PAGE_S, QUIET_S = 3.0, 2.0, 0.5
PATIENCE = 5.0  # times as long as planned
PAGE_SIZE = os.sysconf("SC_PAGE_SIZE") if hasattr(os, "sysconf") else 4096
GROWTH = {"accelerated": 0.02, "window": 0.01}  # of memory, at most


@dataclass(frozen=True)
class Run:
    """One long run: its name, how many samples, how many a second, and whether the window is open."""

    case: str
    samples: int
    rate_hz: float
    with_window: bool


def memory_mb() -> float:
    """What this process holds in memory; 0 where the system does not tell."""
    statm = Path("/proc/self/statm")
    return int(statm.read_text().split()[1]) * PAGE_SIZE / 1e6 if statm.exists() else 0.0


def watched(run: Run, session: Session, window: MainWindow | None) -> tuple[list[float], Status]:
    """Memory in MB, looked at LOOKS times while the samples come; the window's pages take turns in front."""
    pages, held, status = list(VIEWS), [], session.status()
    begin = status.samples
    until = time.perf_counter() + PATIENCE * run.samples / run.rate_hz
    for look in range(1, LOOKS + 1):
        if window is not None:
            window.show_page(pages[look % len(pages)])
        wanted = begin + run.samples * look // LOOKS

        def over(status: Status, wanted: int = wanted) -> bool:
            return status.samples >= wanted or time.perf_counter() > until

        status = spin(session, over)
        held.append(memory_mb())
    return held, status


def prepare(session: Session, window: MainWindow | None) -> None:
    """Wait until the stream is steady, and open each page once."""
    wait(session, SETTLE_S)
    if window is not None:
        for name in VIEWS:
            window.show_page(name)
            wait(session, PAGE_S)


def silence(session: Session, sender: Sender) -> int:
    """Let the board fall silent and the session take what it has said; how many samples it has sent."""
    sent, seen = sender.pause(), -1
    while (now := wait(session, QUIET_S).samples) != seen:
        seen = now
    return sent


def kept(folder: Path) -> dict[str, Any]:
    """What the recording's tables hold: rows of both, and whether their times rise."""
    facts: dict[str, Any] = {"rises": True}
    for name in ("samples", "attitude"):
        rows, newest = 0, float("-inf")
        with (folder / f"{name}.csv").open("rb") as table:
            for text in table:
                if text[:1] not in b"#t":
                    t = float(text[: text.index(b",")])
                    facts["rises"] &= t > newest
                    newest, rows = t, rows + 1
        facts[name] = rows
    about = json.loads((folder / "about.json").read_text(encoding="utf-8"))
    facts["ended"] = about.get("ended", {})
    facts["mb"] = round(sum(file.stat().st_size for file in folder.iterdir()) / 1e6)
    return facts


def recorded(
    run: Run, session: Session, window: MainWindow | None, sender: Sender, recording: Path
) -> tuple[list[float], Status, int]:
    """Record the run: memory at each look, the last status, and how many samples the board sent meanwhile.

    The recording begins and ends while the board is silent, so that both count the same samples.
    """
    before = silence(session, sender)
    session.record(recording)
    sender.go_on()
    held, status = watched(run, session, window)
    sent = silence(session, sender) - before
    session.stop_recording()
    return held, status, sent


def apart(run: Run, folder: Path) -> int:
    """One long run in a process of its own, so that its memory is its own; 0 when it is as wanted."""
    child = multiprocessing.get_context("spawn").Process(target=run_one, args=(run, folder))
    child.start()
    child.join()
    return child.exitcode or 0


def run_one(run: Run, folder: Path) -> None:
    """One long run; prints its figure and ends with 1 when that is not as wanted."""
    application = composition.make_application()
    session = Session()
    window = MainWindow(session, SettingsStore(folder / FILE_NAME)) if run.with_window else None
    if window is not None:
        window.show()
    recording = folder / f"{run.case}.imugui"
    begin = time.perf_counter()
    with steady_board(folder / "board", FORMAT, run.rate_hz) as sender:
        session.connect_to(Source("serial", str(folder / "board"), FORMAT))
        prepare(session, window)
        held, status, sent = recorded(run, session, window, sender, recording)
        session.disconnect_source()
    took_s = time.perf_counter() - begin
    close(session, window, application)
    ok = show(run, held, status, sent, kept(recording), took_s)
    shutil.rmtree(recording)
    if not ok:
        sys.exit(1)


def show(run: Run, held: list[float], status: Status, sent: int, facts: dict[str, Any], took_s: float) -> bool:
    """Print the figure of a run; whether it is as wanted."""
    early = max(held[LOOKS // 10], 1e-9)
    growth = max(held[LOOKS // 10 :]) / early - 1.0
    missed = status.missed_rows + facts["ended"].get("missed_rows", 0)
    lost = sent - facts["samples"]
    whole = facts["rises"] and facts["samples"] == facts["attitude"] == facts["ended"].get("rows") >= run.samples
    ok = growth < GROWTH[run.case] and whole and missed == lost == status.bad_messages == 0
    more: dict[str, Any] = {"memory_mb": [round(early), round(max(held[LOOKS // 10 :]))], "growth": round(growth, 4)}
    more |= {"missed_rows": missed, "lost_samples": lost, "bad_messages": status.bad_messages, "whole": whole}
    more |= {"samples": facts["samples"], "hours": round(facts["samples"] / RATE_HZ / 3600.0, 2)}
    more |= {"rate_hz": run.rate_hz, "took_s": round(took_s), "recording_mb": facts["mb"]}
    more |= {"held_mb": [round(mb, 1) for mb in held[:: LOOKS // CURVE]]}
    line("endurance", run.case, 1.0 + growth, 1.0 + GROWTH[run.case], False, ok=ok, **more)
    return ok


def close(session: Session, window: MainWindow | None, application: QApplication) -> None:
    """End in order."""
    if window is not None:
        window.close()
    session.close()
    application.processEvents()


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--hours", type=float, default=12.0, help="of samples at 200 Hz, accelerated; 0: none")
    arguments.add_argument("--speed", type=float, default=40.0, help="how many times as fast, at the most 40")
    arguments.add_argument("--minutes", type=float, default=20.0, help="in real time with the window; 0: none")
    arguments.add_argument("--folder", type=Path, help="where there is room for the recording, 3 GB for 12 hours")
    chosen = arguments.parse_args()
    if not RATE_HZ <= RATE_HZ * chosen.speed <= FASTEST_HZ:
        arguments.error("the speed is 1 to 40 times")
    runs = (
        Run("window", round(60.0 * chosen.minutes * RATE_HZ), RATE_HZ, True),
        Run("accelerated", round(3600.0 * chosen.hours * RATE_HZ), RATE_HZ * chosen.speed, False),
    )
    with tempfile.TemporaryDirectory(dir=chosen.folder) as name:
        codes = [apart(run, Path(name)) for run in runs if run.samples >= LOOKS]
    return 1 if any(codes) else 0


if __name__ == "__main__":
    sys.exit(main())
