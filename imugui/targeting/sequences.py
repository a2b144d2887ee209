"""Throughput of the trials of a run: effective where a person confirmed each target, nominal everywhere.

Difficulties of pan and zoom: Y. Guiard, M. Beaudouin-Lafon, IJHCS 61 (2004) 875. The two are done one after the other,
so their bits add up and their times too.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from imugui.fusion.quaternion import Floats
from imugui.targeting.throughput import (
    Flags,
    Throughput,
    index_of_difficulty,
    outliers,
    pan_difficulty,
    throughput,
    zoom_difficulty,
)
from imugui.targeting.trials import Trial

NOMINAL = "nominal: the game selects by itself, so endpoints say nothing about precision"
AMPLITUDE_DIGITS = 6  # px; amplitudes that differ by rounding belong to one sequence


@dataclass(frozen=True)
class RunThroughput:
    """Throughputs of one run in bits/s; NaN where there is none."""

    effective: float = math.nan  # mean of the sequences, outliers left out
    with_outliers: float = math.nan  # the same with them
    nominal: float = math.nan
    word: str = ""  # why a sequence has no effective one
    sequences: int = 0
    outliers: tuple[int, ...] = ()  # ``index`` of the trials


def run_throughput(trials: Sequence[Trial]) -> RunThroughput:
    """The throughputs of a run (one trial at least): a mean of means over its sequences."""
    nominal = nominal_throughput(trials)
    if any(trial.automatic for trial in trials):
        return RunThroughput(nominal=nominal, word=NOMINAL)
    flags = outlier_flags(trials)
    places: dict[tuple[object, ...], list[int]] = {}
    for place, trial in enumerate(trials):
        places.setdefault(_sequence_key(trial), []).append(place)
    without, every = (
        [effective([trials[k] for k in at], keep[at]) for at in places.values()]
        for keep in (~flags, np.ones_like(flags))
    )
    return RunThroughput(
        mean_known([one.bits_per_s for one in without]),
        mean_known([one.bits_per_s for one in every]),
        nominal,
        "; ".join(dict.fromkeys(one.word for one in without if one.word)),
        sum(not one.word for one in without),
        tuple(trials[k].index for k in np.flatnonzero(flags).tolist()),
    )


def nominal_bits(trial: Trial) -> float:
    """Nominal difficulty of a target: of a ring log2(A/W + 1), of the game that of its pan and of its zoom."""
    if trial.task == "ring":
        return index_of_difficulty(trial.amplitude_px, trial.width_px)
    distance = math.hypot(trial.to_x - trial.from_x, trial.to_y - trial.from_y)
    zoom = zoom_difficulty(trial.from_size, trial.to_size, trial.tolerance_px)
    return pan_difficulty(distance, trial.tolerance_px) + zoom


def nominal_throughput(trials: Sequence[Trial]) -> float:
    """Sum of the nominal bits / sum of the movement times, over trials that have both; NaN without."""
    bits, times = np.array([nominal_bits(trial) for trial in trials]), column(trials, "movement_time_s")
    good = np.isfinite(bits) & (times > 0.0)
    return float(bits[good].sum() / times[good].sum()) if good.any() else math.nan


def outlier_flags(trials: Sequence[Trial]) -> Flags:
    """Flags (n,) of trials whose selection cannot have been meant: see ``throughput.outliers``, in place and in size.

    A trial that was selected by the game itself is none.
    """
    width = np.array([trial.target_width_px for trial in trials])
    flags = outliers(*_ways(trials, centres), width)
    flags |= _zoomed(trials) & outliers(*_ways(trials, _zooms), _zoom_widths(trials))
    return np.asarray(flags & np.array([not trial.automatic for trial in trials], bool))


def effective(trials: Sequence[Trial], keep: Flags) -> Throughput:
    """Effective throughput of one sequence of a ring, or of a run of the game that was confirmed by hand.

    The game's targets lie in all directions, so the overshoot of the one before does not lie on the axis of the next,
    and its amplitudes are mixed. Lengths are those of the pan.
    """
    times, width = column(trials, "movement_time_s"), np.array([trial.target_width_px for trial in trials])
    serial = trials[0].task == "ring"
    pan = throughput(*_ways(trials, centres), times, width, serial, keep)
    if not _zoomed(trials).any():
        return pan
    zoom = throughput(*_ways(trials, _zooms), times, _zoom_widths(trials), False, keep)
    panned = (centres(trials, "from") != centres(trials, "to")).any()
    parts = [pan, zoom] if panned else [zoom]
    word = next((part.word for part in parts if part.word), "")
    if word:
        return dataclasses.replace(pan, bits_per_s=math.nan, word=word)
    used = times[(times > 0.0) & keep]
    bits, time = sum(part.difficulty * part.n for part in parts), float(used.sum())
    n = len(used)
    return dataclasses.replace(pan, n=n, difficulty=bits / n, movement_time_s=time / n, bits_per_s=bits / time, word="")


def _sequence_key(trial: Trial) -> tuple[object, ...]:
    if trial.task != "ring":
        return (trial.task,)
    return (trial.task, round(trial.amplitude_px, AMPLITUDE_DIGITS), round(trial.width_px, AMPLITUDE_DIGITS))


def _ways(trials: Sequence[Trial], place: Callable[[Sequence[Trial], str], Floats]) -> tuple[Floats, Floats, Floats]:
    return place(trials, "from"), place(trials, "to"), place(trials, "sel")


def _zoomed(trials: Sequence[Trial]) -> Flags:
    return np.array([trial.task == "fov" and trial.from_size != trial.to_size for trial in trials], bool)


def _zooms(trials: Sequence[Trial], end: str) -> Floats:
    """Sizes as places on one axis: their logarithms."""
    logs = log_sizes(trials, end)
    return np.column_stack((logs, np.zeros_like(logs)))


def _zoom_widths(trials: Sequence[Trial]) -> Floats:
    """What is accepted of a size, on the logarithm."""
    size, tolerance = column(trials, "to_size"), column(trials, "tolerance_px")
    rest = np.where(size > tolerance, size - tolerance, np.nan)
    return np.asarray(np.log((size + tolerance) / rest))


def column(trials: Sequence[Trial], name: str) -> Floats:
    """A field of n trials as an array (n,)."""
    return np.array([getattr(trial, name) for trial in trials], float)


def centres(trials: Sequence[Trial], end: str) -> Floats:
    """Centres (n, 2) of an end of the way: "from", "to" or "sel", px."""
    return np.column_stack((column(trials, f"{end}_x"), column(trials, f"{end}_y")))


def log_sizes(trials: Sequence[Trial], end: str) -> Floats:
    """Logarithms (n,) of the sizes at an end of the way; NaN for no size."""
    sizes = column(trials, f"{end}_size")
    return np.asarray(np.log(np.where(sizes > 0.0, sizes, np.nan)))


def known(values: Sequence[float] | Floats) -> Floats:
    """The finite ones of values (n,)."""
    array = np.asarray(values, float)
    return np.asarray(array[np.isfinite(array)])


def mean_known(values: Sequence[float] | Floats) -> float:
    """Mean of the finite values; NaN without one."""
    finite = known(values)
    return float(finite.mean()) if len(finite) else math.nan
