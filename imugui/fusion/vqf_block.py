"""Samples that VQF's library can take many at a time, with the same result as one by one."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from imugui.fusion.quaternion import length
from imugui.fusion.scalar import MAX_DT
from imugui.fusion.vqf_spacing import Spacing

MOST = 2000  # samples at once
EVEN = 1e-6  # relative; a spacing no farther off is the library's own but for the rounding of times
FIELD = (1.0, 1e5)  # uT
LARGEST = 1e5  # rad/s and m/s2

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]


def plain(gyr: Floats, acc: Floats, mag: Floats, new: Flags, scales: Floats) -> int:
    """How many samples of the first MOST, (n, 3) each, are as usual: evenly spaced, with values a sensor can give."""
    usual = np.abs(scales[:MOST] - 1.0) < EVEN
    usual &= (np.abs(gyr[:MOST]) < LARGEST).all(axis=1) & (np.abs(acc[:MOST]) < LARGEST).all(axis=1)
    norm = length(np.clip(mag[:MOST], -LARGEST, LARGEST))
    usual &= ~new[:MOST] | ((norm > FIELD[0]) & (norm < FIELD[1]))
    return len(usual) if usual.all() else int(np.argmin(usual))


def follow(
    spacing: Spacing, mag_spacing: Spacing, ts: float, mag_ts: float, mag_age: float, dts: Floats, new: Flags
) -> tuple[dict[str, Any], dict[str, Any], float] | None:
    """States of both spacings and the age of the field, s, after samples (n,); None when one of them departs."""
    after = spacing.walked(dts, ts)
    ages, age = field_ages(dts, new, mag_age)
    after_mag = mag_spacing.walked(np.minimum(ages, MAX_DT), mag_ts)
    return None if after is None or after_mag is None else (after, after_mag, age)


def field_ages(dts: Floats, new: Flags, age: float) -> tuple[Floats, float]:
    """Time in s from each new field back to the one before it, and from the last sample back to the newest one.

    ``age`` is that time before the first sample. Times are added one after the other, as they come.
    """
    fields = np.flatnonzero(new)
    starts = np.concatenate(([0], fields + 1))
    ends = np.concatenate((fields + 1, [len(dts)]))
    ages = np.zeros(len(starts))
    ages[0] = age
    for step in range(int((ends - starts).max())):
        longer = ends - starts > step
        ages[longer] += dts[starts[longer] + step]
    return ages[:-1], float(ages[-1])
