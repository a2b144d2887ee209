"""Throughput in bits/s as MacKenzie's own tools compute it, and the nominal difficulties of rings and of the game.

Effective width and throughput: ISO 9241-411:2012 annex B; R. W. Soukoreff, I. S. MacKenzie, IJHCS 61 (2004) 751.
The unit is one sequence: trials in a row of one participant, one amplitude and width, one block. Raw trials are never
pooled over sequences; the mean of their throughputs is. Lengths are in px of the field, or in any one unit.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from statistics import NormalDist

import numpy as np
from numpy.typing import ArrayLike, NDArray

from imugui.fusion.quaternion import Floats

Flags = NDArray[np.bool_]

WIDTH_PER_SD = math.sqrt(2.0 * math.pi * math.e)
"""Effective width per standard deviation: the entropy of a normal distribution; rounded to 4.133 by many."""
HALF_WIDTH_Z = 2.066
"""Half of the rounded 4.133, as MacKenzie's formula for error rates has it."""
LEAST_ERROR_PERCENT = 0.0049
MIN_TRIALS = 3
SAME = 1e-9
"""A spread below this share of the amplitude is rounding: endpoints that do not differ have no effective width."""


@dataclass(frozen=True)
class Throughput:
    """One sequence in figures; NaN where there is none, and ``word`` says why."""

    n: int = 0
    rejected: int = 0  # trials that cannot be used: no way to go, no time taken, or no number
    amplitude: float = math.nan  # mean effective amplitude Ae
    sd: float = math.nan  # of the endpoints along the task axis
    width: float = math.nan  # effective width We
    difficulty: float = math.nan  # effective index of difficulty IDe, bits
    movement_time_s: float = math.nan
    bits_per_s: float = math.nan
    error_percent: float = math.nan
    word: str = ""


def axis_errors(from_xy: ArrayLike, to_xy: ArrayLike, sel_xy: ArrayLike) -> tuple[Floats, Floats]:
    """Amplitude and signed error along the task axis (+ is too far) of n trials, shapes (n, 2); NaN without a way."""
    start, goal, end = (np.asarray(xy, float) for xy in (from_xy, to_xy, sel_xy))
    way = goal - start
    amplitude = np.hypot(way[:, 0], way[:, 1])
    length = np.where(amplitude > 0.0, amplitude, np.nan)
    miss = end - goal
    return amplitude, (miss[:, 0] * way[:, 0] + miss[:, 1] * way[:, 1]) / length


def outliers(from_xy: ArrayLike, to_xy: ArrayLike, sel_xy: ArrayLike, width: ArrayLike) -> Flags:
    """Trials, shapes (n, 2), that moved less than half of the way or ended more than two widths from the centre."""
    start, goal, end = (np.asarray(xy, float) for xy in (from_xy, to_xy, sel_xy))
    amplitude, moved, missed = _lengths(goal - start), _lengths(end - start), _lengths(end - goal)
    return np.asarray((moved < 0.5 * amplitude) | (missed > 2.0 * np.asarray(width, float)))


def throughput(
    from_xy: ArrayLike,
    to_xy: ArrayLike,
    sel_xy: ArrayLike,
    movement_time_s: ArrayLike,
    width: ArrayLike,
    serial: bool = True,
    keep: ArrayLike = True,
) -> Throughput:
    """Effective throughput of one sequence: centres and selections (n, 2), times (n,) in s, target width(s).

    ``serial``: each movement starts where the one before ended, on the same axis, so its overshoot makes the way
    longer. ``keep``: flags (n,) of the trials that count; one left out still is where the next one started.
    """
    amplitude, error = axis_errors(from_xy, to_xy, sel_xy)
    times = np.asarray(movement_time_s, float)
    good = np.isfinite(error) & np.isfinite(times) & (times > 0.0)
    used = good & np.asarray(keep, bool)
    n, rejected = int(used.sum()), int((~good).sum())
    if n < MIN_TRIALS:
        return Throughput(n, rejected, word=f"n/a: fewer than {MIN_TRIALS} trials")
    effective = amplitude + error
    if serial:
        effective[1:] += np.nan_to_num(error[:-1])
    missed = _lengths(np.asarray(sel_xy, float) - np.asarray(to_xy, float)) > 0.5 * np.asarray(width, float)
    return _sequence(effective[used], error[used], times[used], missed[used], rejected)


def _sequence(effective: Floats, error: Floats, times: Floats, missed: Flags, rejected: int) -> Throughput:
    n, mean, sd = len(error), float(effective.mean()), float(error.std(ddof=1))
    time, errors = float(times.mean()), 100.0 * float(missed.mean())
    if sd <= SAME * abs(mean):
        word = "n/a: the endpoints do not spread"
        return Throughput(n, rejected, mean, sd, movement_time_s=time, error_percent=errors, word=word)
    width = WIDTH_PER_SD * sd
    if mean <= 0.0:
        word = "n/a: the movements did not go to the targets"
        return Throughput(n, rejected, mean, sd, width, movement_time_s=time, error_percent=errors, word=word)
    difficulty = math.log2(mean / width + 1.0)
    return Throughput(n, rejected, mean, sd, width, difficulty, time, difficulty / time, errors)


def index_of_difficulty(amplitude: float, width: float) -> float:
    """Nominal index of difficulty log2(A/W + 1) in bits (Shannon form, MacKenzie 1992); NaN without a width."""
    return math.log2(amplitude / width + 1.0) if amplitude >= 0.0 and width > 0.0 else math.nan


def pan_difficulty(distance: float, tolerance: float) -> float:
    """Bits of a pan over ``distance``; ``tolerance`` is half the width of what is accepted."""
    return index_of_difficulty(distance, 2.0 * tolerance)


def zoom_difficulty(from_size: float, to_size: float, tolerance: float) -> float:
    """Bits of a zoom, with distances on the logarithm of the size.

    The way of a zoom is a ratio (Y. Guiard, M. Beaudouin-Lafon, IJHCS 61 (2004) 875). NaN for a size that is not
    larger than the tolerance.
    """
    if not (from_size > 0.0 and to_size > tolerance > 0.0):
        return math.nan
    return index_of_difficulty(
        abs(math.log(to_size / from_size)), math.log((to_size + tolerance) / (to_size - tolerance))
    )


def zoom_difficulty_linear(from_size: float, to_size: float, tolerance: float) -> float:
    """Bits of a zoom, with distances as differences of the size: right when the hand adds pixels."""
    return index_of_difficulty(abs(to_size - from_size), 2.0 * tolerance)


def width_from_errors(width: float, error_percent: float) -> float:
    """Effective width when only the error rate is known: W 2.066 / z(1 - err/2) (MacKenzie 1992)."""
    share = max(error_percent, LEAST_ERROR_PERCENT) / 100.0
    if not 0.0 < share < 1.0:
        return math.nan
    return width * HALF_WIDTH_Z / NormalDist().inv_cdf(1.0 - 0.5 * share)


def ring(n: int, diameter: float) -> Floats:
    """Centres (n + 1, 2) of a ring of n targets in the order of visit: the start, n jumps across, back at the start.

    Every jump has the length ``chord(n, diameter)``. Raises ValueError for an even n, whose jumps would differ.
    """
    if n < 3 or n % 2 == 0:
        raise ValueError(f"a ring needs an odd number of targets, 3 or more, not {n}")
    angles = 2.0 * np.pi * ((np.arange(n + 1) * ((n + 1) // 2)) % n) / n
    return 0.5 * diameter * np.column_stack((np.sin(angles), np.cos(angles)))


def chord(n: int, diameter: float) -> float:
    """The way from target to target of a ring of odd n: D cos(pi / 2n)."""
    return diameter * math.cos(0.5 * math.pi / n)


def _lengths(xy: Floats) -> Floats:
    return np.asarray(np.hypot(xy[:, 0], xy[:, 1]))
