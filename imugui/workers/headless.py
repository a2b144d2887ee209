"""A session without a window: run it for a while, then report."""

from __future__ import annotations

import math
import signal
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from PySide6.QtCore import QCoreApplication, QEventLoop, QTimer

from imugui import __version__
from imugui.workers.session import Session, Source, State, Status

FINAL = (State.ENDED, State.FAILED)
LOOK_MS = 50
GIVE_UP_S = 10.0  # a port that never gave a sample


@dataclass(frozen=True)
class Result:
    report: dict[str, Any]
    sentence: str


def run_session(
    source: Source, fusion: dict[str, Any], spike_mask: bool, seconds: float, recording: Path | None = None
) -> Result:
    """Read the source for ``seconds`` of host time, or until a file ends, or until Ctrl-C; record it if asked.

    ``fusion``: filter_name, params and use_mag, as the session takes them.
    """
    app = QCoreApplication.instance() or QCoreApplication([])
    session = Session(**fusion)
    session.set_spike_mask(spike_mask)
    interrupted: list[int] = []
    before = signal.signal(signal.SIGINT, lambda number, _: interrupted.append(number))
    session.message.connect(lambda _, text: print(text, file=sys.stderr))  # noqa: T201
    session.connect_to(source)
    if recording is not None:
        session.record(recording)
    started = time.perf_counter()

    def over(status: Status) -> bool:
        passed = time.perf_counter() - started
        hopeless = math.isinf(seconds) and status.samples == 0 and passed > GIVE_UP_S
        return bool(interrupted) or passed >= seconds or hopeless or status.state in FINAL

    try:
        status = spin(session, over)
        result = Result(report(session, status), status.sentence)
    finally:
        signal.signal(signal.SIGINT, before)
        session.close()
        app.processEvents()
    return result


def spin(session: Session, over: Callable[[Status], bool]) -> Status:
    """Let events run until ``over`` says so of the status, or raises; returns the last status."""
    loop = QEventLoop()
    raised: list[Exception] = []

    def look() -> None:
        try:
            done = over(session.status())
        except Exception as error:  # in a slot it would only be printed, and the loop would go on for ever
            raised.append(error)
            done = True
        if done:
            loop.quit()

    timer = QTimer()
    timer.setInterval(LOOK_MS)
    timer.timeout.connect(look)
    timer.start()
    loop.exec()
    timer.stop()
    if raised:
        raise raised[0]
    return session.status()


def report(session: Session, status: Status) -> dict[str, Any]:
    """The figures of a run under the names that DESIGN.md gives them."""
    return {
        "messages": status.messages,
        "bad_messages": status.bad_messages,
        "samples": status.samples,
        "gaps": status.gaps,
        "gap_s": round(status.gap_s, 3),
        "missed_rows": status.missed_rows,
        "rate_hz": round(session.rate_hz, 2),
        "jitter_ms": _number(status.jitter_ms),
        "format": status.format,
        "seen": status.seen,
        "baud": status.baud,
        "age_ms": session.age_quantiles(),
        "filter": status.filter,
        "filter_note": status.filter_note,
        "mag_updates": session.mag_updates,
        "mag_trust": status.mag_trust,
        "state": status.state.name.lower(),
        "version": __version__,
    }


def _number(value: float) -> float | None:
    return round(value, 3) if math.isfinite(value) else None
