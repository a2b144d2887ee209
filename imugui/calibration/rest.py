"""At rest: the bias of the gyroscope, from a board that really lies still."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from imugui.calibration.flow import Result
from imugui.calibration.stillness import (
    AT_REST,
    DEGREE,
    Floats,
    Gathered,
    Span,
    rate_of,
    resolution,
    still_spans,
    wander,
)
from imugui.fusion.correction import Vector
from imugui.samples import Rows

LARGEST_BIAS = 25.0 * DEGREE
"""rad/s; datasheets of the cheapest sensors allow 20 deg/s."""
ENOUGH = 0.02 * DEGREE
"""rad/s; the guided flow waits until two sigmas are below, but no longer than PATIENCE_S."""
PATIENCE_S = 10.0
LARGEST_TILT = 0.3 * DEGREE
"""rad by which gravity may turn within a still span."""

NO_BIAS: Vector = (0.0, 0.0, 0.0)
LAY_IT_DOWN = "Lay the board on something solid and let go of it."


@dataclass(frozen=True)
class RestResult(Result):
    """The bias of the gyroscope in rad/s, its 1 sigma, and the still rows it came from."""

    bias: Vector = NO_BIAS
    sigma: Vector = NO_BIAS
    seconds: float = 0.0
    samples: int = 0
    temp_c: float = float("nan")

    @property
    def sigma_dps(self) -> float:
        """The worst axis' 1 sigma, deg/s."""
        return max(self.sigma) / DEGREE


class RestFlow:
    """At rest: takes the gyroscope's bias from the longest still span; a timer alone never ends it."""

    title = "At rest"

    def __init__(self) -> None:
        self._gathered = Gathered()
        self._result = rest_bias(self._gathered.rows)

    def feed(self, rows: Rows) -> None:
        """Take raw SAMPLE rows, shape (n,)."""
        self._gathered.feed(rows)
        self._result = rest_bias(self._gathered.rows)

    def result(self) -> RestResult:
        """The bias, or why there is none."""
        return self._result

    @property
    def progress(self) -> float:
        """Share of the stillness that is needed."""
        if self.done:
            return 1.0
        found = self._result
        if not found.accepted:
            return min(0.9, 0.5 * found.seconds / AT_REST.shortest_s)
        return min(0.95, max(0.5, found.seconds / PATIENCE_S, (ENOUGH / (2 * max(found.sigma))) ** 2))

    @property
    def sentence(self) -> str:
        """What to do now."""
        if self.done:
            return "Done: the bias is known."
        return "Leave it lying: the average is getting better." if self._result.accepted else LAY_IT_DOWN

    @property
    def missing(self) -> tuple[str, ...]:
        """What still stands in the way."""
        if self.done:
            return ()
        if not self._result.accepted:
            return (self._result.reason,)
        return (f"uncertainty {2 * self._result.sigma_dps:.3f} deg/s, wanted {ENOUGH / DEGREE:.2f}",)

    @property
    def done(self) -> bool:
        """Whether the bias is known well enough."""
        found = self._result
        return found.accepted and (2 * max(found.sigma) <= ENOUGH or found.seconds >= PATIENCE_S)


def auto_bias(rows: Rows) -> RestResult:
    """The bias at start-up, from the rows so far, if the board lies still by itself; raw SAMPLE rows, shape (n,)."""
    gathered = Gathered()
    gathered.feed(rows)
    return rest_bias(gathered.rows)


def rest_bias(rows: Rows) -> RestResult:
    """The gyroscope's bias from the longest still span of usable raw SAMPLE rows, shape (n,)."""
    rows = rows[np.isfinite(rows["gyr"]).all(axis=1)]
    if len(rows) == 0:
        return RestResult(False, "No gyroscope values came yet.")
    step = resolution(rows["gyr"])
    if len(rows) > 20 and step == 0.0:
        return RestResult(False, _frozen(rows))
    spans = still_spans(rows, AT_REST)
    if not spans:
        return _not_still(rows)
    return _measured(rows, max(spans, key=lambda span: span.stop - span.start), step)


def span_sigma(gyr: Floats, rate_hz: float, step: float) -> Floats:
    """1 sigma (3,) of the mean of still rates (n, 3): the worst of white noise, slow change and resolution ``step``.

    Where the noise is smaller than the step it does not average out: the step's own spread, step / sqrt(12), remains.
    """
    spread = gyr.std(axis=0)
    per_block = max(1, round(0.5 * rate_hz))
    count = len(gyr) // per_block
    blocks = gyr[: count * per_block].reshape(count, per_block, 3).mean(axis=1) if count else gyr
    slow = blocks.std(axis=0) / np.sqrt(len(blocks))
    hidden = np.where(spread < 0.3 * step, step / np.sqrt(12), 0.0)
    return np.asarray(np.maximum(np.maximum(spread / np.sqrt(len(gyr)), slow), hidden))


def _measured(rows: Rows, span: Span, step: float) -> RestResult:
    still, rate = rows[span.rows], rate_of(rows)
    gyr = still["gyr"]
    bias, sigma = gyr.mean(axis=0), span_sigma(gyr, rate, step)
    seconds = float(still["t"][-1] - still["t"][0]) + 1 / rate
    refusal = _still_turning(still, sigma) or _implausible(bias)
    if refusal:
        return RestResult(False, refusal)
    text = f"Bias ({_dps(bias)}) deg/s, known to {2 * sigma.max() / DEGREE:.3f} deg/s (2 sigma), {seconds:.1f} s still."
    if (gyr.std(axis=0) < 0.3 * step).any():
        text += f" The board's steps of {step / DEGREE:.3f} deg/s hide its noise: averaging longer does not help."
    known = still["temp_c"][np.isfinite(still["temp_c"])]
    temp_c = float(known.mean()) if len(known) else float("nan")
    return RestResult(True, text, _vector(bias), _vector(sigma), seconds, len(still), temp_c)


def _still_turning(still: Rows, sigma: Floats) -> str:
    """A slow even turn has no variance: it shows as a change from the first third to the last."""
    third = max(1, len(still) // 3)
    first, last = (part["acc"].mean(axis=0) for part in (still[:third], still[-third:]))
    cosine = float(first @ last / max(1e-9, float(np.linalg.norm(first) * np.linalg.norm(last))))
    tilt = float(np.arccos(min(1.0, cosine)))
    drift = np.abs(still["gyr"][:third].mean(axis=0) - still["gyr"][-third:].mean(axis=0))
    if tilt > LARGEST_TILT or (drift > 0.2 * DEGREE + 6 * sigma).any():
        return f"The board is still turning slowly (gravity moved by {tilt / DEGREE:.1f} deg). {LAY_IT_DOWN}"
    return ""


def _implausible(bias: Floats) -> str:
    if np.abs(bias).max() <= LARGEST_BIAS:
        return ""
    return f"A rate of ({_dps(bias)}) deg/s is no bias: the board turns evenly, or the gyroscope's unit is wrong."


def _frozen(rows: Rows) -> str:
    if resolution(rows["acc"]) == 0.0:
        return "No value ever changes: the board is frozen, or sends the same sample again and again."
    return "The gyroscope never changes, so its resolution is not known. Turn the board a little, then lay it down."


def _not_still(rows: Rows) -> RestResult:
    """Refused: handled, or simply too short so far."""
    rate = rate_of(rows)
    seconds = (len(rows) - 1) / rate if rate > 0.0 else 0.0  # what was seen: a gap does not count
    if rate == 0.0 or seconds < 0.5 + 2 / rate:
        return RestResult(False, f"Only {seconds:.1f} s came so far; {AT_REST.shortest_s:g} s still are needed.")
    gyr, acc = wander(rows["gyr"], rate), wander(rows["acc"], rate)
    limit = max(AT_REST.gyr, resolution(rows["gyr"])), max(AT_REST.acc, resolution(rows["acc"]))
    recent = max(1, round(AT_REST.shortest_s * rate))
    worst_gyr, worst_acc = float(gyr[-recent:].max()), float(acc[-recent:].max())
    if worst_gyr <= limit[0] and worst_acc <= limit[1]:
        short = f"Still, but only for {min(seconds, AT_REST.shortest_s):.1f} s; {AT_REST.shortest_s:g} s are needed."
        return RestResult(False, short, seconds=min(seconds, AT_REST.shortest_s))
    moved = f"it turns to and fro by {worst_gyr / DEGREE:.1f} deg/s and shakes by {worst_acc:.2f} m/s2"
    allowed = f"{AT_REST.gyr / DEGREE:g} deg/s and {AT_REST.acc:g} m/s2 are the limits"
    return RestResult(False, f"The board is being handled: {moved} ({allowed}). {LAY_IT_DOWN}")


def _dps(rates: Floats) -> str:
    return ", ".join(f"{rate / DEGREE:+.3f}" for rate in rates)


def _vector(values: Floats) -> Vector:
    x, y, z = values.tolist()
    return x, y, z
