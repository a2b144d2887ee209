"""What every benchmark shares: interleaved rounds, medians, one JSON line a figure."""

from __future__ import annotations

import json
import math
import os
import platform
import resource
import statistics
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

Clock = Callable[[], float]

BROAD = Path(__file__).resolve().parents[2] / "shared" / "data" / "broad"
"""BROAD's trials as .npz, beside the checkout; they are not part of the repository."""


def interleaved(
    jobs: Mapping[str, Callable[[], object]], rounds: int, clock: Clock = time.process_time
) -> dict[str, float]:
    """Median seconds of each job, all run in turn ``rounds`` times, so that a busy machine slows them alike."""
    taken: dict[str, list[float]] = {name: [] for name in jobs}
    for _ in range(rounds):
        for name, job in jobs.items():
            start = clock()
            job()
            taken[name].append(clock() - start)
    return {name: statistics.median(times) for name, times in taken.items()}


def children_s() -> float:
    """Processor time in s of all ended child processes; less disturbed by other programs than the clock on the wall."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def line(benchmark: str, case: str, ratio: float, wanted: float | None, at_least: bool, **more: Any) -> None:
    """Print one figure: a ratio, what it must reach (None: nothing), whether it does, and what it was made of.

    A ratio that is not known (NaN) is printed as null.
    """
    ok = wanted is None or (ratio >= wanted if at_least else ratio <= wanted)
    known = round(ratio, 3) if math.isfinite(ratio) else None
    figure = {"benchmark": benchmark, "case": case, "ratio": known, "wanted": wanted}
    print(json.dumps(figure | {"at_least": at_least, "ok": ok} | more), flush=True)


def machine() -> dict[str, Any]:
    """Where the figures were made."""
    load = os.getloadavg()[0] if hasattr(os, "getloadavg") else float("nan")
    return {
        "system": f"{platform.system()} {platform.machine()}",
        "python": platform.python_version(),
        "cores": os.cpu_count(),
        "load": round(load, 1),
    }


def note(benchmark: str, text: str) -> None:
    """Print what a reader of the figures must know beside them."""
    print(json.dumps({"benchmark": benchmark, "note": text}), flush=True)
