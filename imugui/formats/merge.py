"""Several tables with clocks of their own become one: everything on the gyroscope's times."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from imugui.formats.columns import POSITION
from imugui.samples import SAMPLE, Rows, empty_rows

Numbers = NDArray[np.float64]

BASES = ("gyr", "acc", "mag", "lat")
"""What sets the times: the first of these that there is."""
HELD = ("mag", "temp_c", *POSITION)
NEAR = 1.5  # periods of the accelerometer within which its nearest value is taken
SHARED = 0.5  # share of rows with everything from which on a row without it is damaged


@dataclass(frozen=True)
class Part:
    """The rows of one table, shape (n,); what it does not hold is NaN. ``force`` as in columns.Table."""

    rows: Rows
    force: str


def merge(parts: Sequence[Part]) -> Rows:
    """One row for each time of the gyroscope, or of the slowest substitute where there is none.

    The acceleration is the nearest in time; a row without one near is left out. The magnetometer and slower values
    are held from the last one before, so that they repeat bit for bit until a new one comes.
    """
    if len(parts) == 1 and is_complete(parts[0].rows):
        return parts[0].rows
    base = next((name for name in BASES if _count(parts, name)), "")
    if not base:
        return np.empty(0, SAMPLE)
    t, values = _series(parts, base)
    rows = empty_rows(SAMPLE, len(t))
    rows["t"], rows[base] = t, values
    if base != "acc":
        rows["acc"] = _acceleration(parts, t)
    for name in HELD:
        if name != base and _count(parts, name):
            rows[name] = hold(t, *_series(parts, name))
    _hold_status(parts, rows)
    return rows[np.isfinite(rows["acc"]).all(axis=1)] if base == "gyr" and _count(parts, "acc") else rows


def is_complete(rows: Rows) -> bool:
    """Whether most rows hold all that any row of the table holds, so that nothing needs to be brought together."""
    there = [_there(rows, name) for name in ("gyr", "acc")]
    both, either = there[0] & there[1], there[0] | there[1]
    return not (there[0].any() and there[1].any()) or bool(both.sum() >= SHARED * either.sum())


def hold(t: Numbers, times: Numbers, values: Numbers) -> Numbers:
    """For each of ``t`` the newest of ``values`` that is not later; NaN before the first. Times ascend."""
    place = np.searchsorted(times, t, side="right") - 1
    held = np.array(values[np.maximum(place, 0)])
    held[place < 0] = np.nan
    return held


def nearest(t: Numbers, times: Numbers, values: Numbers) -> Numbers:
    """For each of ``t`` the value, shape (n, 3), nearest in time; NaN where none is within NEAR periods."""
    place = np.clip(np.searchsorted(times, t), 1, len(times) - 1)
    place = np.where(t - times[place - 1] <= times[place] - t, place - 1, place)
    found = np.array(values[place])
    period = float(np.median(np.diff(times))) if len(times) > 1 else np.inf
    found[np.abs(times[place] - t) > NEAR * period] = np.nan
    return found


def _acceleration(parts: Sequence[Part], t: Numbers) -> Numbers:
    """The acceleration at t; the sum of its parts where it was not recorded whole."""
    by_force = {part.force: part for part in parts if _there(part.rows, "acc").any()}
    if "total" in by_force:
        return nearest(t, *_series([by_force["total"]], "acc"))
    if {"linear", "gravity"} <= by_force.keys():
        sums = [nearest(t, *_series([by_force[force]], "acc")) for force in ("linear", "gravity")]
        return np.asarray(sums[0] + sums[1])
    return np.full((len(t), 3), np.nan)


def _series(parts: Sequence[Part], name: str) -> tuple[Numbers, Numbers]:
    """Ascending times and values of one field, from the table that has most of it."""
    rows = max((part.rows for part in parts), key=lambda rows: int(_there(rows, name).sum()))
    rows = rows[_there(rows, name)]
    order = np.argsort(rows["t"], kind="stable")
    return rows["t"][order], rows[name][order]


def _hold_status(parts: Sequence[Part], rows: Rows) -> None:
    part = max(parts, key=lambda part: int((part.rows["status"] >= 0).sum()))
    known = part.rows[(part.rows["status"] >= 0) & np.isfinite(part.rows["t"])]
    if len(known):
        held = hold(rows["t"], known["t"], known["status"].astype(float))
        rows["status"] = np.where(np.isfinite(held), held, rows["status"])


def _count(parts: Sequence[Part], name: str) -> int:
    return max(int(_there(part.rows, name).sum()) for part in parts)


def _there(rows: Rows, name: str) -> NDArray[np.bool_]:
    """Which rows hold a field."""
    there = np.isfinite(rows[name])
    return np.asarray(there.all(axis=1) if there.ndim > 1 else there)
