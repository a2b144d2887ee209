"""Sample time: a smooth clock from bursty arrivals, and the board's own clock where it sends one.

No board of ours sends time. Bytes arrive in bursts (USB, the system's scheduler, a busy window), so arrival
differences are useless as ``dt``; their long-run mean is good. ``ArrivalClock`` fits a straight line, sample number
against arrival time, with forgetting, and lets the published time glide along that line. ``DeviceClock`` unwraps a
board's own time and ties it to the host's.

Both take one block per arrival: all rows that one chunk of bytes completed, with that chunk's arrival time.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from imugui.samples import Rows

MEMORY_S = 15.0  # arrivals older than this fade from the line fit
SETTLE_S = 0.5  # span of arrivals after which the fitted line is used
SETTLE_ARRIVALS = 6
SLEW = 0.02  # the published dt departs from the fitted period by at most this share
GAP_AT_ONCE_S = 0.5  # later than this: a gap, without waiting to see whether a backlog follows
GAP_WATCH_S = 0.25  # lateness that lasts this long, over this many arrivals, is a gap too
GAP_WATCH_ARRIVALS = 4
RATE_CHANGE_S = 1.5  # three gaps within this time: the rate itself changed
GAP_SAMPLES = 3  # fewer missing samples are not called a gap
GAP_MIN_S = 0.02


class LineFit:
    """Straight line through (sample number, arrival time), weighted least squares with exponential forgetting."""

    def __init__(self) -> None:
        self.weight = 0.0
        self.span_s = 0.0
        self.arrivals = 0
        self._n = self._t = self._nn = self._nt = 0.0
        self._last_t = math.nan

    def add(self, n: float, t: float) -> None:
        """Add the arrival at host time t (s) of sample number n."""
        passed = 0.0 if self.arrivals == 0 else max(0.0, t - self._last_t)
        # a long silence teaches nothing: without this limit it would wipe out the slope
        fade = math.exp(-min(passed / MEMORY_S, 1.0))
        self._last_t = t
        self.span_s += passed
        self.arrivals += 1
        self.weight = fade * self.weight + 1.0
        step_n = n - self._n
        self._n += step_n / self.weight
        step_t = t - self._t
        self._t += step_t / self.weight
        self._nn = fade * self._nn + step_n * (n - self._n)
        self._nt = fade * self._nt + step_n * (t - self._t)

    def state(self) -> list[float]:
        """Everything, as plain numbers."""
        return [self.weight, self.span_s, self.arrivals, self._n, self._t, self._nn, self._nt, self._last_t]

    def restore(self, state: list[float]) -> None:
        """Continue from a ``state``."""
        self.weight, self.span_s, arrivals, self._n, self._t, self._nn, self._nt, self._last_t = state
        self.arrivals = int(arrivals)

    @property
    def settled(self) -> bool:
        return self.span_s >= SETTLE_S and self.arrivals >= SETTLE_ARRIVALS and self.period > 0.0

    @property
    def period(self) -> float:
        """Seconds per sample; NaN before two samples arrived apart."""
        return self._nt / self._nn if self._nn > 0.0 and self._nt > 0.0 else math.nan

    def at(self, n: float) -> float:
        """Host time (s) on the line at sample number n."""
        return self._t + self.period * (n - self._n)


class ArrivalClock:
    """Sample times for boards without a clock; counts what a gap cost."""

    def __init__(self) -> None:
        self.gaps = 0
        self.gap_s = 0.0
        self.jitter_s = 0.0
        self._fit = LineFit()
        self._n = 0.0  # sample number of the newest row; gaps advance it
        self._t = math.nan  # published time of the newest row
        self._late_since = math.nan
        self._late_least = math.inf
        self._late_count = 0
        self._shifts: list[float] = []  # when samples were found missing, over the last seconds

    @property
    def period(self) -> float:
        """Seconds per sample; NaN until known."""
        return self._fit.period

    def state(self) -> dict[str, Any]:
        """Everything that the next stamp depends on, as plain values."""
        late = [self._late_since, self._late_least, self._late_count]
        return {"fit": self._fit.state(), "n": self._n, "t": self._t, "jitter": self.jitter_s} | {
            "late": late,
            "shifts": list(self._shifts),
        }

    def restore(self, state: dict[str, Any]) -> None:
        """Continue from a ``state``, bit for bit."""
        self._fit.restore(state["fit"])
        self._n, self._t, self.jitter_s = state["n"], state["t"], state["jitter"]
        self._late_since, self._late_least, count = state["late"]
        self._late_count, self._shifts = int(count), list(state["shifts"])

    def stamp(self, rows: Rows) -> None:
        """Write ``rows["t"]`` for one arrival's rows, shape (n,), from their common ``t_arrival``; in place."""
        if len(rows) == 0:
            return
        arrival = float(rows["t_arrival"][-1])
        if self._fit.settled:
            self._watch(arrival, len(rows))
        if self._fit.settled:
            rows["t"] = self._glide(len(rows))
        else:
            rows["t"] = self._spread(arrival, len(rows))
        self._n += len(rows)
        self._t = float(rows["t"][-1])
        self._learn(arrival)

    def _spread(self, arrival: float, n: int) -> NDArray[np.float64]:
        """Before the rate is known: an arrival's samples lie evenly between the arrival before and this one."""
        if math.isnan(self._t):
            return np.asarray(arrival - 1e-6 * np.arange(n - 1, -1, -1), float)  # no two at one time
        end = max(arrival, self._t + 1e-6 * n)
        return self._t + (end - self._t) * np.arange(1, n + 1) / n

    def _glide(self, n: int) -> NDArray[np.float64]:
        """One fitted period a sample, leaning towards the line by at most SLEW."""
        period = self._fit.period
        line = self._fit.at(self._n)
        times = np.empty(n)
        t = self._t
        for i in range(n):
            line += period
            lean = (line - t - period) * 0.05
            t += period + min(max(lean, -SLEW * period), SLEW * period)
            times[i] = t
        return times

    def _learn(self, arrival: float) -> None:
        if not math.isnan(self._late_since):
            return  # under watch: a line bent towards late arrivals would hide the gap
        if self._fit.settled:
            late = arrival - self._fit.at(self._n)
            self.jitter_s += 0.02 * (abs(late) - self.jitter_s)
            bound = max(4.0 * self.jitter_s, 1e-3)
            arrival -= late - min(max(late, -bound), bound)
        self._fit.add(self._n, arrival)

    def _watch(self, arrival: float, n: int) -> None:
        """Tell lost samples (all later ones are late, for good) from a stalled host (a backlog catches up)."""
        period = self._fit.period
        late = arrival - self._fit.at(self._n + n)
        if late < -max(0.05, 5.0 * period):
            self._restart()
        elif late > max(GAP_AT_ONCE_S, 10.0 * period):
            self._shift(late, arrival)
        elif late > max(0.6 * period, 4.0 * self.jitter_s, 2e-3):
            self._late_least = min(self._late_least, late)
            self._late_count += 1
            if math.isnan(self._late_since):
                self._late_since = arrival
            elif self._late_count >= GAP_WATCH_ARRIVALS and arrival - self._late_since >= GAP_WATCH_S:
                self._shift(self._late_least, arrival)
        else:
            self._on_time()

    def _on_time(self) -> None:
        self._late_since = math.nan
        self._late_least = math.inf
        self._late_count = 0

    def _shift(self, missing_s: float, arrival: float) -> None:
        """Samples were lost: move on in time by what is missing. Again and again: the rate itself changed."""
        self._shifts = [t for t in self._shifts if arrival - t < RATE_CHANGE_S] + [arrival]
        if len(self._shifts) >= 3 and missing_s < GAP_AT_ONCE_S:
            self._restart()
            return
        period = self._fit.period
        self._n += missing_s / period
        self._t += missing_s
        self._on_time()
        if missing_s >= max((GAP_SAMPLES - 0.5) * period, GAP_MIN_S):
            self.gaps += 1
            self.gap_s += missing_s

    def _restart(self) -> None:
        self._fit = LineFit()
        self._shifts = []
        self._on_time()


WRAPS_S = (2**16 * 1e-3, 2**24 * 1e-6, 2**32 * 1e-6, 2**32 * 1e-3)
"""Where counters of microseconds or milliseconds start again, s."""


class DeviceClock:
    """The board's own time, unwrapped and shifted so that its first sample lies at its arrival."""

    def __init__(self, anchored: bool = True) -> None:
        """Not ``anchored``: a recording's times are kept as they are, digit for digit."""
        self.gaps = 0
        self.gap_s = 0.0
        self.jitter_s = 0.0
        self.period = math.nan
        self._raw = math.nan
        self._t = math.nan
        self._offset = 0.0
        self._anchored = anchored

    def state(self) -> dict[str, Any]:
        """Everything that the next stamp depends on, as plain values."""
        return {"raw": self._raw, "t": self._t, "offset": self._offset, "period": self.period}

    def restore(self, state: dict[str, Any]) -> None:
        """Continue from a ``state``, bit for bit."""
        self._raw, self._t, self._offset, self.period = (state[key] for key in ("raw", "t", "offset", "period"))

    def stamp(self, rows: Rows) -> None:
        """Turn ``rows["t"]`` from the board's time into continuous host-based time, s; in place."""
        for i in range(len(rows)):
            rows["t"][i] = self._next(float(rows["t"][i]), float(rows["t_arrival"][i]))

    def _next(self, raw: float, arrival: float) -> float:
        if math.isnan(raw):
            raw = self._raw + self.period
        if math.isnan(self._raw):
            self._offset = arrival - raw if self._anchored and not math.isnan(arrival) else 0.0
        else:
            self._follow(raw, arrival)
        t = raw + self._offset
        self._count(t - self._t)
        self._raw, self._t = raw, t
        return t

    def _follow(self, raw: float, arrival: float) -> None:
        """A step back is a counter that started again near its end, or a board that was reset."""
        if raw >= self._raw:
            return
        for wrap in WRAPS_S:
            if 0.0 <= wrap - self._raw < 2.0 and raw < 2.0:
                self._offset += wrap
                return
        resumed = self._t + 1e-6 if math.isnan(arrival) else max(arrival, self._t + 1e-6)
        self._offset = resumed - raw

    def _count(self, dt: float) -> None:
        if math.isnan(dt):
            return
        if math.isnan(self.period):
            self.period = dt
        if dt > max((GAP_SAMPLES + 0.5) * self.period, GAP_MIN_S) and self.period > 0.0:
            self.gaps += 1
            self.gap_s += dt - self.period
        else:
            self.jitter_s += 0.02 * (abs(dt - self.period) - self.jitter_s)
            self.period += 0.02 * (dt - self.period)
