"""Running a filter over many samples: one by one, or several at once where it can do that with the same result."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from imugui.fusion.filter import Filter
from imugui.fusion.scalar import MAX_DT, Quat, Vector

FEWEST = 16  # samples from which on it pays to try several at once
SHORTEST, LONGEST = 32, 4096  # samples that go one by one before it is tried again
SAID = ("quat", "bias", "rest", "disturbed", "sigma_tilt", "sigma_heading")

Floats = NDArray[np.float64]
Said = tuple[NDArray[Any], ...]
"""What a filter said after each sample, one array for each of SAID."""
Restart = Callable[[list[float], float], float]


def said_now(filter_: Filter) -> Said:
    """What the filter says now, as one row; NaN for what it does not know."""
    return tuple(np.array([getattr(filter_, name, np.nan)]) for name in SAID)


def run(
    filter_: Filter, gyr: Floats, acc: Floats, mag: Floats, new: NDArray[np.bool_], dts: Floats, restart: Restart
) -> Said:
    """Feed samples, (n, 3) each and dts (n,) in s, in order; what was said before and after each, n + 1 rows.

    ``new`` tells where mag is a new measurement; ``restart`` gets (acc, dt) at gaps, and says what dt to feed.
    A filter with ``update_block`` is offered all samples that are left, and takes as many of the first ones as it can.
    """
    update_block = getattr(filter_, "update_block", None) if len(dts) >= FEWEST else None
    said, at, alone = [said_now(filter_)], 0, SHORTEST
    while at < len(dts):
        taken = update_block(gyr[at:], acc[at:], mag[at:], new[at:], dts[at:]) if update_block else ()
        if taken:
            alone = SHORTEST
        else:
            part = slice(at, at + alone if update_block else None)
            taken = _one_by_one(filter_, (gyr[part], acc[part], mag[part], new[part], dts[part]), restart)
            alone = min(2 * alone, LONGEST)
        said.append(taken)
        at += len(taken[0])
    return tuple(map(np.concatenate, zip(*said, strict=True)))


def _one_by_one(filter_: Filter, samples: tuple[NDArray[Any], ...], restart: Restart) -> Said:
    update = filter_.update
    quats, biases, rests, disturbances = list[Quat](), list[Vector](), list[bool](), list[bool]()
    knowing: Any = filter_ if hasattr(filter_, "sigma_tilt") else None
    sigmas: list[tuple[float, float]] = []
    for gyr, acc, mag, new, dt in zip(*(values.tolist() for values in samples), strict=True):
        if not -MAX_DT <= dt <= MAX_DT:  # a gap, or NaN before the very first
            dt = restart(acc, dt)
        update(gyr, acc, mag if new else None, dt)
        quats.append(filter_.quat)
        biases.append(filter_.bias)
        rests.append(filter_.rest)
        disturbances.append(filter_.disturbed)
        if knowing is not None:
            sigmas.append((knowing.sigma_tilt, knowing.sigma_heading))
    tilt, heading = np.array(sigmas).T if sigmas else np.full((2, len(quats)), np.nan)
    return np.array(quats), np.array(biases), np.array(rests), np.array(disturbances), tilt, heading
