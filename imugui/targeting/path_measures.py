"""How a path went to its target: detours, turns and smoothness, by our own definitions.

The seven names are those of I. S. MacKenzie, T. Kauppinen, M. Silfverberg, CHI 2001. Paths are resampled to a fixed
rate, and a change counts only when it is larger than a band, because a sensor's jitter changes sign all the time.
Along the task axis u goes from the start (0) to the target's centre (the amplitude); v is across, to the left.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from imugui.fusion.quaternion import Floats

RATE_HZ = 100.0
BAND = 1.0
"""px; the least change that counts. Give the noise's sigma where it is larger."""
SMOOTH_HZ, SMOOTH_LEAST, SMOOTH_PADDING = 10.0, 0.05, 4
MAX_POINTS = 1_000_000


@dataclass(frozen=True)
class PathMeasures:
    """One path in figures, lengths in px; NaN where the path is too short for one."""

    reentries: int = 0  # TRE: times the target was entered again after the first time
    axis_crossings: int = 0  # TAC: sign changes of v
    direction_changes: int = 0  # MDC: turns of v
    orthogonal_changes: int = 0  # ODC: turns of u
    overshoots: int = 0  # times u went past the target's far edge
    variability: float = math.nan  # MV: standard deviation of v
    error: float = math.nan  # ME: mean of |v|
    offset: float = math.nan  # MO: mean of v
    length: float = math.nan
    efficiency: float = math.nan  # straight way from first to last point / length
    smoothness: float = math.nan  # spectral arc length, 0 at best and below


def path_measures(
    t: ArrayLike,
    xy: ArrayLike,
    from_xy: ArrayLike,
    to_xy: ArrayLike,
    width: float,
    band: float = BAND,
    rate_hz: float = RATE_HZ,
) -> PathMeasures:
    """Measure a path: times (n,) in s, places (n, 2), the two ends of the task axis and the target's width.

    Rows that are no numbers or do not go forward in time are left out.
    """
    places, rate_hz = resample(t, xy, rate_hz)
    if len(places) < 2:
        return PathMeasures()
    amplitude = float(np.hypot(*(np.asarray(to_xy, float) - np.asarray(from_xy, float))))
    length = path_length(places)
    straight = float(np.hypot(*(places[-1] - places[0])))
    common: dict[str, Any] = {"length": length, "efficiency": straight / length if length > 0.0 else math.nan}
    smoothness = spectral_arc_length(np.hypot(*np.diff(places, axis=0).T) * rate_hz, rate_hz)
    if amplitude == 0.0:
        return PathMeasures(**common, smoothness=smoothness)
    u, v = task_axes(places, from_xy, to_xy)
    half = 0.5 * width
    return PathMeasures(
        reentries=max(0, entries(np.hypot(u - amplitude, v), half, band) - 1),
        axis_crossings=crossings(v, band),
        direction_changes=turns(v, band),
        orthogonal_changes=turns(u, band),
        overshoots=entries(-u, -(amplitude + half + band), band),
        variability=float(v.std(ddof=1)),
        error=float(np.abs(v).mean()),
        offset=float(v.mean()),
        smoothness=smoothness,
        **common,
    )


def resample(t: ArrayLike, xy: ArrayLike, rate_hz: float = RATE_HZ) -> tuple[Floats, float]:
    """The path (n, 2) at even times from its first to its last, and the rate in Hz that makes them fit.

    Linear in between; empty with fewer than two rows.
    """
    times, places = np.asarray(t, float), np.asarray(xy, float).reshape(-1, 2)
    good = np.isfinite(times) & np.isfinite(places).all(axis=1)
    times, places = times[good], places[good]
    before = np.maximum.accumulate(np.concatenate(([-np.inf], times)))[:-1]
    times, places = times[times > before], places[times > before]
    if len(times) < 2:
        return np.empty((0, 2)), rate_hz
    n = min(max(2, round((times[-1] - times[0]) * rate_hz) + 1), MAX_POINTS)
    even = np.linspace(times[0], times[-1], n)
    path = np.column_stack([np.interp(even, times, places[:, axis]) for axis in (0, 1)])
    return path, (n - 1) / float(times[-1] - times[0])


def task_axes(xy: Floats, from_xy: ArrayLike, to_xy: ArrayLike) -> tuple[Floats, Floats]:
    """Places (n, 2) as (u along the way from start to target, v across it to the left); the two must differ."""
    start = np.asarray(from_xy, float)
    way = np.asarray(to_xy, float) - start
    ex, ey = way / np.hypot(*way)
    x, y = (xy - start).T
    return x * ex + y * ey, y * ex - x * ey


def path_length(xy: Floats) -> float:
    """The length of the path (n, 2)."""
    return float(np.hypot(*np.diff(xy, axis=0).T).sum())


def entries(distance: Floats, limit: float, band: float) -> int:
    """How often the distance (n,) came down to ``limit``; it has left when it is above limit + band."""
    marks = np.where(distance <= limit, 1, np.where(distance > limit + band, -1, 0))
    marks = marks[marks != 0]
    return int((np.diff(marks, prepend=-1) > 0).sum())


def crossings(values: Floats, band: float) -> int:
    """How often values (n,) changed from above +band to below -band or back."""
    marks = np.where(values > band, 1, np.where(values < -band, -1, 0))
    return int(np.count_nonzero(np.diff(marks[marks != 0])))


def turns(values: Floats, band: float) -> int:
    """How often values (n,) turned round, by more than ``band`` from where they turned."""
    count, way = 0, 0
    low = high = float(values[0])
    for value in values.tolist():
        low, high = min(low, value), max(high, value)
        if way <= 0 and value > low + band:
            count, way, high = count + (way < 0), 1, value
        elif way >= 0 and value < high - band:
            count, way, low = count + (way > 0), -1, value
    return count


def spectral_arc_length(speed: Floats, rate_hz: float) -> float:
    """Smoothness of a speed profile (n,): the length of its spectrum's arc below 10 Hz, negative.

    S. Balasubramanian et al., J. NeuroEng. Rehabil. 12 (2015) 112, equation 5, with their adaptive cut-off at 5 %.
    """
    if len(speed) < 4 or not (speed > 0.0).any():
        return math.nan
    n = 2 ** (math.ceil(math.log2(len(speed))) + SMOOTH_PADDING)
    spectrum = np.abs(np.fft.rfft(speed, n))
    frequency = np.fft.rfftfreq(n, 1.0 / rate_hz)
    spectrum = spectrum[frequency <= SMOOTH_HZ] / spectrum.max()
    last = int(np.flatnonzero(spectrum >= SMOOTH_LEAST)[-1])
    if last == 0:
        return math.nan
    return -float(np.hypot(1.0 / last, np.diff(spectrum[: last + 1])).sum())
