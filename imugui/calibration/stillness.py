"""Where in a stream of rows was the board still?

Two measures, over windows of 0.5 s. The variance of the raw accelerometer against the quietest that this very data
has (36 times its 5 % quantile: D. Tedaldi, A. Pretto, E. Menegatti, ICRA 2014, section IV), which needs no knowledge
of the sensor. And the spread of 0.1 s means against fixed limits, so that a board which was never quiet is not called
so by comparison with itself: noise averages out of the means, a hand's tremor does not.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from imugui.samples import SAMPLE, Rows, empty_rows

Floats = NDArray[np.float64]
DEGREE = np.pi / 180

WINDOW_S, MEAN_S = 0.5, 0.1
QUIET_QUANTILE, QUIET_FACTOR = 0.05, 6.0
GAP_S = 0.5
"""A step of time longer than this, or back, ends a still span."""
MAX_ROWS = 200_000
"""Rows kept of one session: 16 minutes at 200 Hz."""


@dataclass(frozen=True)
class Limits:
    """What counts as still: spread of 0.1 s means of gyroscope (rad/s) and accelerometer (m/s2), and for how long."""

    gyr: float
    acc: float
    shortest_s: float


AT_REST = Limits(0.5 * DEGREE, 0.06, 2.0)
"""Lying on something solid. Real boards at rest: below 0.25 deg/s; the quietest board in a hand: above 2 deg/s."""
IN_POSITION = Limits(2.0 * DEGREE, 0.12, 1.0)
"""Good enough for gravity's direction; leaned or held against something."""


@dataclass(frozen=True)
class Span:
    """Rows ``start`` to ``stop`` (not included) were still."""

    start: int
    stop: int

    @property
    def rows(self) -> slice:
        """The span as an index."""
        return slice(self.start, self.stop)


@dataclass
class Gathered:
    """The usable rows of a session, oldest dropped beyond MAX_ROWS; ``seen`` counts all that came."""

    rows: Rows = field(default_factory=lambda: empty_rows(SAMPLE, 0))
    seen: int = 0

    def feed(self, rows: Rows) -> None:
        """Keep the rows that have a time and an acceleration; another file's times are put behind these."""
        self.seen += len(rows)
        good = rows[np.isfinite(rows["t"]) & np.isfinite(rows["acc"]).all(axis=1)].copy()
        if len(good) and len(self.rows) and good["t"][0] < self.rows["t"][-1] - GAP_S:
            good["t"] += self.rows["t"][-1] - good["t"][0] + 2 * GAP_S
        self.rows = np.concatenate((self.rows, good))[-MAX_ROWS:]

    @property
    def seconds(self) -> float:
        """How long the rows last, s."""
        return float(self.rows["t"][-1] - self.rows["t"][0]) if len(self.rows) else 0.0


def rate_of(rows: Rows) -> float:
    """Mean samples per second of rows, shape (n,), gaps left out; 0 when there is none."""
    steps = np.diff(rows["t"])
    steps = steps[(steps >= 0.0) & (steps < GAP_S)]
    total = float(steps.sum())
    return len(steps) / total if total > 0.0 else 0.0


def resolution(values: Floats) -> float:
    """The smallest step between different values of (n, 3) in their unit; 0 when no axis ever changes."""
    steps = []
    for axis in values.T:
        known = np.unique(axis[np.isfinite(axis)][-5_000:])
        change = np.diff(known)
        # decimals turned into SI units differ in the last digits: these are no steps
        change = change[change > 1e-9 * max(1e-6, float(np.abs(known).max(initial=0.0)))]
        steps += [float(change.min())] if len(change) else []
    return min(steps, default=0.0)


def still_spans(rows: Rows, limits: Limits = IN_POSITION) -> list[Span]:
    """The still spans of usable rows, shape (n,), at least ``limits.shortest_s`` long, in order."""
    rate = rate_of(rows)
    window = max(4, round(WINDOW_S * rate))
    if rate == 0.0 or len(rows) < window:
        return []
    quiet = _acc_quiet(rows["acc"], window)
    for name, limit in (("gyr", limits.gyr), ("acc", limits.acc)):
        values = rows[name]
        if np.isfinite(values).all():
            quiet &= wander(values, rate) <= max(limit, resolution(values))
    still = np.zeros(len(rows), bool)
    still[window // 2 : window // 2 + len(quiet)] = quiet
    steps = np.diff(rows["t"])
    spans = [part for span in runs(still) for part in _split(span, (steps < 0.0) | (steps > GAP_S))]
    return [span for span in spans if rows["t"][span.stop - 1] - rows["t"][span.start] >= limits.shortest_s - 1 / rate]


def wander(values: Floats, rate_hz: float) -> Floats:
    """Root of the summed variance of 0.1 s means in each 0.5 s window of (n, 3), in the values' unit."""
    window, short = max(4, round(WINDOW_S * rate_hz)), max(1, round(MEAN_S * rate_hz))
    spread = np.sqrt(_variance(_means(values, short), max(2, window - short + 1)))
    return np.asarray(spread)


def runs(flags: NDArray[np.bool_]) -> list[Span]:
    """The unbroken stretches where ``flags``, shape (n,), is True."""
    edges = np.flatnonzero(np.diff(np.concatenate(([0], flags.astype(int), [0]))))
    return [Span(int(a), int(b)) for a, b in zip(edges[::2], edges[1::2], strict=True)]


def _acc_quiet(acc: Floats, window: int) -> NDArray[np.bool_]:
    """Which windows are hardly louder than the quietest ones; coarse steps hide noise of about their own size."""
    variance = _variance(acc, window)
    level = max(float(np.quantile(variance, QUIET_QUANTILE)), resolution(acc) ** 2 / 4)
    return np.asarray(variance <= QUIET_FACTOR**2 * level)


def _means(values: Floats, n: int) -> Floats:
    sums = np.cumsum(np.vstack((np.zeros((1, 3)), values)), axis=0)
    return np.asarray((sums[n:] - sums[:-n]) / n)


def _variance(values: Floats, n: int) -> Floats:
    """Summed over the axes, for every window of n rows."""
    centred = values - values.mean(axis=0)  # so that the difference of large sums keeps its digits
    return np.asarray(np.maximum(_means(centred**2, n) - _means(centred, n) ** 2, 0.0).sum(axis=1))


def _split(span: Span, broken: NDArray[np.bool_]) -> list[Span]:
    """The parts of a span between gaps; ``broken[i]``: no way from row i to row i + 1."""
    cuts = (np.flatnonzero(broken[span.start : span.stop - 1]) + span.start + 1).tolist()
    edges = [span.start, *cuts, span.stop]
    return [Span(a, b) for a, b in pairwise(edges)]
