"""The long runs, only on request: twelve hours of samples through the whole live path, twenty minutes with the window.

The twelve hours come 40 times as fast: a child process sends 8,000 samples a second over a pseudo-terminal; they are
decoded, fused and recorded. The recording needs about 3 GB. Watched: memory after the first tenth against the end,
rows missed by fusion and recorder, and whether the recording holds every row in order.

    python3 run.py bench endurance [--hours 12] [--speed 40] [--minutes 20] [--folder DIR]
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import sys
import tempfile
from pathlib import Path
from typing import Any

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")

from _measure import line
from live import board, wait
from PySide6.QtWidgets import QApplication

from imugui import app as composition
from imugui.settings import FILE_NAME
from imugui.views import VIEWS
from imugui.views.main_window import MainWindow
from imugui.views.settings_store import SettingsStore
from imugui.workers.session import Session, Source, Status

RATE_HZ = 200.0
FORMAT = "triplets"
LOOKS = 200
PAGE_SIZE = os.sysconf("SC_PAGE_SIZE") if hasattr(os, "sysconf") else 4096
GROWTH = {"accelerated": 0.02, "window": 0.01}  # of memory, at most


def memory_mb() -> float:
    """What this process holds in memory; 0 where the system does not tell."""
    statm = Path("/proc/self/statm")
    return int(statm.read_text().split()[1]) * PAGE_SIZE / 1e6 if statm.exists() else 0.0


def watched(session: Session, seconds: float, window: MainWindow | None) -> tuple[list[float], Status]:
    """Memory in MB, looked at LOOKS times; the window's pages are opened one after the other."""
    pages, held = list(VIEWS), []
    for look in range(LOOKS):
        if window is not None:
            window.show_page(pages[look % len(pages)])
        status = wait(session, seconds / LOOKS)
        held.append(memory_mb())
    return held, status


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
    return facts


def run(case: str, folder: Path, seconds: float, rate_hz: float, with_window: bool) -> bool:
    """One long run with a recording; prints its figure."""
    application = composition.make_application()
    session = Session()
    window = MainWindow(session, SettingsStore(folder / FILE_NAME)) if with_window else None
    if window is not None:
        window.show()
    recording = folder / f"{case}.imugui"
    with board(folder / "board", FORMAT, rate_hz):
        session.connect_to(Source("serial", str(folder / "board"), FORMAT))
        wait(session, 3.0)
        session.record(recording)
        held, status = watched(session, seconds, window)
        session.stop_recording()
        session.disconnect_source()
    close(session, window, application)
    facts, early = kept(recording), max(held[LOOKS // 10], 1e-9)
    growth = max(held[LOOKS // 10 :]) / early - 1.0
    whole = facts["rises"] and facts["samples"] == facts["attitude"] == facts["ended"].get("rows")
    ok = growth < GROWTH[case] and status.missed_rows == 0 and whole and not facts["ended"].get("missed_rows")
    more = {"memory_mb": [round(early), round(held[-1])], "growth": round(growth, 4), "missed_rows": status.missed_rows}
    more |= {"samples": facts["samples"], "hours": round(facts["samples"] / RATE_HZ / 3600.0, 2), "whole": whole}
    line("endurance", case, 1.0 + growth, 1.0 + GROWTH[case], False, ok=ok, bad_messages=status.bad_messages, **more)
    shutil.rmtree(recording)
    return ok


def close(session: Session, window: MainWindow | None, application: QApplication) -> None:
    """End in order."""
    if window is not None:
        window.close()
    session.close()
    application.processEvents()


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--hours", type=float, default=12.0, help="of samples at 200 Hz, accelerated; 0: none")
    arguments.add_argument("--speed", type=float, default=40.0)
    arguments.add_argument("--minutes", type=float, default=20.0, help="in real time with the window; 0: none")
    arguments.add_argument("--folder", type=Path, help="where there is room for the recording")
    chosen = arguments.parse_args()
    with tempfile.TemporaryDirectory(dir=chosen.folder) as name:
        folder, ok = Path(name), True
        if chosen.minutes > 0.0:
            ok &= run("window", folder, 60.0 * chosen.minutes, RATE_HZ, with_window=True)
        if chosen.hours > 0.0:
            seconds = 3600.0 * chosen.hours / chosen.speed
            ok &= run("accelerated", folder, seconds, RATE_HZ * chosen.speed, with_window=False)
    return 0 if ok else 1


if __name__ == "__main__":
    sys.exit(main())
