"""Free fall: while the board falls the accelerometer feels nothing, so that what it reads is its bias (seed 004)."""

from __future__ import annotations

import numpy as np

from imugui.calibration.accelerometer import NAN, AccelerometerResult, vector
from imugui.calibration.gravity_fit import MG
from imugui.calibration.stillness import DEGREE, GAP_S, Floats, Gathered, Span, rate_of, runs
from imugui.samples import GRAVITY, Rows

WEIGHTLESS = 0.35 * GRAVITY
"""m/s2; a falling board reads less than this, biases included."""
SHORTEST_S = 0.12  # a fall of 7 cm
WANTED = 3
LARGEST_SPIN = 180.0 * DEGREE
"""rad/s; a sensor 2 cm from the centre feels 20 mg then."""
TILT_DEG = 2.5
"""Scale and cross-axis errors stay: datasheets allow 3 % and 2 %."""


class FreeFallFlow:
    """The bias alone, from three short falls onto something soft; poorer than positions, and it says so."""

    title = "Free fall"
    accuracy = f"Bias only, a few mg; scale stays unknown: about {TILT_DEG:g} deg. Positions are better."

    def __init__(self) -> None:
        self._gathered = Gathered()
        self.falls: Floats = np.zeros((0, 3))  # what was read in each fall, m/s2
        self.spinning = 0  # falls not used, because the board turned
        self._samples = 0

    def feed(self, rows: Rows) -> None:
        """Take raw SAMPLE rows, shape (n,)."""
        self._gathered.feed(rows)
        kept = self._gathered.rows
        found = falls_of(kept)
        calm = [span for span in found if _spin(kept[span.rows]) <= LARGEST_SPIN]
        self.spinning = len(found) - len(calm)
        self.falls = np.array([kept["acc"][span.rows].mean(axis=0) for span in calm]).reshape(-1, 3)
        self._samples = sum(span.stop - span.start for span in calm)

    @property
    def progress(self) -> float:
        """Share of the falls wanted."""
        return min(1.0, len(self.falls) / WANTED)

    @property
    def missing(self) -> tuple[str, ...]:
        """Falls still to come."""
        left = WANTED - len(self.falls)
        return (f"{left} more {'fall' if left == 1 else 'falls'}",) if left > 0 else ()

    @property
    def sentence(self) -> str:
        """What to do now."""
        if self.done:
            return "Done: enough falls."
        if self.spinning:
            return "Let it drop without a turn: a spinning board feels its own spin."
        return "Let the board drop by a hand's breadth onto something soft."

    @property
    def done(self) -> bool:
        """Whether there are enough falls."""
        return len(self.falls) >= WANTED

    def result(self) -> AccelerometerResult:
        """The bias, or why there is none."""
        if not self.done:
            spun = f" {self.spinning} not used: the board was spinning." if self.spinning else ""
            return AccelerometerResult(False, f"{len(self.falls)} of {WANTED} falls seen.{spun}", "free fall")
        bias = np.median(self.falls, axis=0)
        spread_mg = float(np.abs(self.falls - bias).max()) / MG
        if spread_mg > 100.0:
            return AccelerometerResult(False, f"The falls disagree by {spread_mg:.0f} mg: try again.", "free fall")
        text = f"Bias from {len(self.falls)} falls that agree within {spread_mg:.0f} mg. Scale and cross-axis terms"
        text += f" stay unknown: about {TILT_DEG:g} deg of tilt. Still positions are better."
        known = self._gathered.rows["temp_c"][np.isfinite(self._gathered.rows["temp_c"])]
        return AccelerometerResult(
            True,
            text,
            "free fall",
            vector(bias),
            residual_mg=spread_mg,
            tilt_deg=TILT_DEG,
            samples=self._samples,
            temp_c=float(known.mean()) if len(known) else NAN,
        )


def falls_of(rows: Rows) -> list[Span]:
    """The inner part of every fall in usable raw SAMPLE rows, shape (n,): letting go and landing are left out."""
    rate = rate_of(rows)
    light = np.linalg.norm(rows["acc"], axis=1) < WEIGHTLESS
    light[1:] &= np.diff(rows["t"]) < GAP_S
    spans = []
    for span in runs(light):
        count = span.stop - span.start
        if count >= max(4, SHORTEST_S * rate):
            edge = max(1, count // 5)
            spans.append(Span(span.start + edge, span.stop - edge))
    return spans


def _spin(rows: Rows) -> float:
    """Mean rate of turn, rad/s; 0 without a gyroscope."""
    rates = np.linalg.norm(rows["gyr"], axis=1)
    return float(rates.mean()) if np.isfinite(rates).all() else 0.0
