"""One verdict in words about a link: what is so, why it probably is, what to do next.

Pure: facts in, verdict out. The connection bar, the status line and ``imugui live`` all show this one.
"""

from __future__ import annotations

import enum
import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from imugui.samples import GRAVITY, Rows

BOOT_S = 3.0  # an Arduino is silent for about 2 s after its port was opened
STALLED_S = 1.0
SLOW_PERIODS = 5.0  # a board slower than 5 Hz is stalled only after this many of its periods
DETECT_S = 6.0


class State(enum.Enum):
    """(word on screen, tone of it)."""

    IDLE = ("Not connected", "neutral")
    OPENING = ("Opening", "neutral")
    WAITING = ("Waiting for the board", "neutral")
    SEARCHING = ("Finding the format", "neutral")
    SILENT = ("Silent", "warn")
    NO_MESSAGES = ("No message found", "bad")
    IMPOSSIBLE = ("Impossible values", "bad")
    STREAMING = ("Streaming", "good")
    PAUSED = ("Paused", "neutral")
    STALLED = ("Stalled", "warn")
    MISSING = ("No port", "bad")
    BUSY = ("Port busy", "bad")
    DENIED = ("No permission", "bad")
    AWAY = ("Board not found", "bad")
    TAKEN = ("Board in use", "bad")
    NO_BLUETOOTH = ("No Bluetooth", "bad")
    LOST = ("Connection lost", "bad")
    ENDED = ("Recording ended", "neutral")
    FAILED = ("Cannot open", "bad")

    @property
    def word(self) -> str:
        return self.value[0]

    @property
    def tone(self) -> str:
        """ "neutral", "good", "warn" or "bad"."""
        return self.value[1]


@dataclass(frozen=True)
class Verdict:
    state: State
    sentence: str


@dataclass(frozen=True)
class Facts:
    """What is known of a link at host time ``now``; times in s, NaN for never."""

    now: float
    phase: str  # "idle", "opening", "open", "lost", "ended", "failed"
    where: str = ""
    problem: str = ""
    progress: float = 0.0  # share of a file that was read
    paused: bool = False  # a replay that stands still because the user wants it
    problem_kind: str = ""  # a key of port_errors.SENTENCES
    opened: float = math.nan
    byte_t: float = math.nan  # newest byte
    sample_t: float = math.nan  # newest sample
    period_s: float = math.nan
    format: str = ""
    baud: int = 0
    findings: str = ""  # what the detector or decoder saw
    odd: str = ""  # what makes the values impossible
    missing_s: float = 0.0  # time lost by earlier breaks of the connection
    breaks: int = 0
    wireless: bool = False


def judge(facts: Facts) -> Verdict:
    """The one verdict."""
    return _PHASES[facts.phase](facts)


def _idle(_: Facts) -> Verdict:
    return Verdict(State.IDLE, "Choose a source and press Connect.")


def _opening(facts: Facts) -> Verdict:
    share = f" {100.0 * facts.progress:.0f} % read." if facts.progress > 0.0 else ""
    return Verdict(State.OPENING, f"Opening {facts.where}.{share}")


def _failed(facts: Facts) -> Verdict:
    return Verdict(State.FAILED, facts.problem)


def _lost(facts: Facts) -> Verdict:
    never_open = math.isnan(facts.opened)
    state = _NOT_OPENED.get(facts.problem_kind, State.FAILED) if never_open else State.LOST
    return Verdict(state, facts.problem)


_NOT_OPENED = {
    "missing": State.MISSING,
    "busy": State.BUSY,
    "denied": State.DENIED,
    **dict.fromkeys(("away", "dropped", "refused", "lost", "silent"), State.AWAY),
    **dict.fromkeys(("elsewhere", "ours"), State.TAKEN),
    **dict.fromkeys(("off", "no_adapter", "classic", "no_bus", "no_service", "stuck"), State.NO_BLUETOOTH),
}


def _ended(facts: Facts) -> Verdict:
    return Verdict(State.ENDED, f"The end of {facts.where} was reached. Connect plays it again.")


def _open(facts: Facts) -> Verdict:
    if not math.isnan(facts.sample_t):
        return _after_samples(facts)
    waited = facts.now - facts.opened
    if math.isnan(facts.byte_t):
        return _no_bytes(facts, waited)
    if waited < DETECT_S:
        return Verdict(State.SEARCHING, f"Bytes arrive; finding out which format they are. {facts.findings}".strip())
    return Verdict(
        State.NO_MESSAGES,
        f"Bytes arrive, but no message is found in them: {facts.findings or 'wrong baud rate or another format'}. "
        "Check the baud rate and the sketch on the board, or choose the format; the link log shows what came.",
    )


def _no_bytes(facts: Facts, waited: float) -> Verdict:
    if facts.wireless:
        return _no_notification(facts, waited)
    if waited < BOOT_S:
        return Verdict(
            State.WAITING, f"{facts.where} is open; waiting for the first byte (boards that restart need 2 s)."
        )
    return Verdict(
        State.SILENT,
        f"{facts.where} is open, but the board sends nothing. Press its reset button; check that its sketch is running "
        "and that this is the right port.",
    )


def _no_notification(facts: Facts, waited: float) -> Verdict:
    if waited < BOOT_S:
        return Verdict(State.WAITING, f"{facts.where} is connected; waiting for its first message.")
    return Verdict(
        State.SILENT,
        f"{facts.where} is connected, but sends nothing. Press its button, or switch it off and on.",
    )


def _after_samples(facts: Facts) -> Verdict:
    if facts.paused:
        return Verdict(State.PAUSED, f"{facts.where} stands still. Space plays it on.")
    quiet = facts.now - facts.sample_t
    patience = max(STALLED_S, SLOW_PERIODS * facts.period_s if facts.period_s == facts.period_s else 0.0)
    if quiet > patience:
        return _stalled(facts, quiet)
    if facts.odd:
        return Verdict(State.IMPOSSIBLE, facts.odd)
    rate = f" at {facts.baud} baud" if facts.baud else ""
    found = f": {facts.findings}" if facts.findings else ""
    said = f"{facts.format[:1].upper()}{facts.format[1:]}{rate}{found}."
    if facts.breaks:
        said += f" The connection broke {facts.breaks} x; {facts.missing_s:.1f} s of data are missing."
    return Verdict(State.STREAMING, said)


def _stalled(facts: Facts, quiet: float) -> Verdict:
    if facts.now - facts.byte_t < STALLED_S:
        text = (
            f"Bytes arrive, but no message for {quiet:.0f} s: {facts.findings}. Was the board's sketch or rate changed?"
        )
    else:
        advice = "Bring it closer" if facts.wireless else "Press the board's reset button or check the cable"
        text = f"{facts.where} has sent nothing for {quiet:.0f} s. {advice}."
    return Verdict(State.STALLED, text)


_PHASES: dict[str, Callable[[Facts], Verdict]] = {
    "idle": _idle,
    "opening": _opening,
    "open": _open,
    "lost": _lost,
    "ended": _ended,
    "failed": _failed,
}


def oddity(rows: Rows) -> str:
    """What makes the newest rows, shape (n,), impossible for a working board, in words; "" when nothing does."""
    if len(rows) < 20:
        return ""
    acc = rows["acc"][np.isfinite(rows["acc"]).all(axis=1)]
    if len(acc) == 0:
        return "The accelerometer sends no numbers. Check the sensor's wiring."
    norm = float(np.median(np.linalg.norm(acc, axis=1)))
    if norm < 0.05 * GRAVITY:
        return "The accelerometer reads zero. The sensor is asleep or not wired; press the board's reset button."
    if not 0.4 * GRAVITY < norm < 2.5 * GRAVITY:
        return (
            f"The accelerometer reads {norm:.1f} m/s2 where gravity should give 9.8: "
            "wrong units or range. Name the columns and units of this board."
        )
    turning = float(np.nanmax(np.abs(rows["gyr"]), initial=0.0))
    frozen = not np.ptp(acc, axis=0).any() and not np.ptp(rows["gyr"], axis=0).any()
    if frozen and turning > 0.2:
        return "Every value stands still although the gyroscope says the board turns. Press the board's reset button."
    return _saturation(rows)


RANGE_ENDS = {
    "gyr": ("gyroscope", "turn it more slowly", np.radians([250.0, 500.0, 1000.0, 2000.0])),
    "acc": ("accelerometer", "do not knock it", GRAVITY * np.array([4.0, 8.0, 16.0])),
}
"""Where a sensor's range may end, in SI, and what to do about it; 2 g is left out, hands reach it."""
SATURATED_ROWS = 5


def _saturation(rows: Rows) -> str:
    """Which sensor is at the end of its range, in words: an axis that often reads exactly the same largest value."""
    for name, (sensor, advice, ends) in RANGE_ENDS.items():
        for values in np.abs(rows[name]).T:
            top = float(np.nanmax(values, initial=0.0))
            at_an_end = bool((np.abs(top / ends - 1.0) < 0.005).any())
            if at_an_end and int((values == top).sum()) >= SATURATED_ROWS:
                return f"The {sensor} is at the end of its range: what is faster or stronger is lost, so {advice}."
    return ""
