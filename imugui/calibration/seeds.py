"""How the seed systems calibrate a magnetometer, for comparison on the same data. None of these is used.

000 halves the sum of two poses 180 degrees apart, 001 and 002 take minimum and maximum. Seed 001's progress bar is
here too: it measures the length of the present sample, which says nothing about directions not seen.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from imugui.calibration.ellipsoid import Ellipsoid, Floats, min_max, scaled
from imugui.fusion.quaternion import conjugate, multiply, rotate, to_rotation_vector

BAR_TICKS = 50  # display ticks that the bar averages
HALF_TURN_DEG = 10.0  # how exactly a half turn about an axis must be one
POSES = 400  # attitudes among which half turns are looked for


@dataclass(frozen=True)
class SeedMethod:
    """What a seed does: the label to show and the sentence that says how."""

    title: str
    how: str


SEED_METHODS: dict[str, SeedMethod] = {
    "half turns": SeedMethod("180° turns (seed 000)", "Offset only, from two opposite poses for each axis."),
    "min/max": SeedMethod("Minimum and maximum (seed 001)", "Offset and scale of each axis, outliers and all."),
    "min/max offset": SeedMethod("Offset of minimum and maximum (seed 002)", "Its fusion scripts leave the scale out."),
}


def min_max_scaled(points: ArrayLike) -> Ellipsoid:
    """Seed 001: scale = 2 / (max - min), offset = (min + max) / 2, raw points (n, 3)."""
    fit = min_max(points)
    return Ellipsoid(fit.bias, fit.matrix, fit.radius, SEED_METHODS["min/max"].title)


def min_max_offset(points: ArrayLike) -> Ellipsoid:
    """Seed 002 as its fusion scripts use it: the offset alone, raw points (n, 3)."""
    fit = min_max(points)
    radius = float(np.linalg.norm(np.asarray(points, float) - fit.bias, axis=1).mean())
    return Ellipsoid(fit.bias, np.eye(3), radius, SEED_METHODS["min/max offset"].title)


def half_turn_offset(first: ArrayLike, second: ArrayLike, axis: int) -> Floats:
    """Seed 000: the hard iron (3,) from two raw fields (3,) half a turn about a body axis apart; NaN along it."""
    offset: Floats = (np.asarray(first, float) + np.asarray(second, float)) / 2.0
    offset[axis] = np.nan
    return offset


def half_turns(points: ArrayLike, quats: ArrayLike) -> Ellipsoid | None:
    """The same on any motion: raw fields (n, 3) with attitudes (n, 4), from gyroscope and accelerometer alone.

    The pair of poses nearest to half a turn is taken for each axis; None when two axes have no such pair.
    """
    points, quats = np.asarray(points, float), np.asarray(quats, float)
    chosen = np.linspace(0, len(points) - 1, min(len(points), POSES)).astype(int)
    found = [half_turn_offset(*pair) for pair in _half_turn_pairs(points[chosen], quats[chosen])]
    if len(found) < 2:
        return None
    bias = np.nanmean(found, axis=0)
    radius = float(np.linalg.norm(points - bias, axis=1).mean())
    return scaled(bias, np.eye(3), radius, SEED_METHODS["half turns"].title)


def _half_turn_pairs(points: Floats, quats: Floats) -> list[tuple[Floats, Floats, int]]:
    """For each axis that has one: two fields half a turn about it apart, and the axis."""
    turns = to_rotation_vector(multiply(conjugate(quats[:, None]), quats[None, :]))
    limit = np.radians(HALF_TURN_DEG)
    pairs = []
    for axis in range(3):
        # the rotation vector ends near (+-pi, 0, 0); both signs are the same half turn
        off = np.linalg.norm(np.abs(turns) - np.pi * np.eye(3)[axis], axis=2)
        i, j = np.unravel_index(int(off.argmin()), off.shape)
        if off[i, j] < limit:
            pairs.append((points[i], points[j], axis))
    return pairs


def bar_value(norm: float) -> float:
    """Seed 001's figure for one corrected sample of length ``norm``: trunc(100 (1 - |1 - norm|)), at least 0."""
    return float(max(np.trunc(100.0 * (1.0 - abs(1.0 - norm))), 0.0)) if np.isfinite(norm) else 0.0


class ProgressBar:
    """Seed 001's progress bar: the mean of its last 50 figures, rounded up; it begins with zeros."""

    def __init__(self) -> None:
        self._values: deque[float] = deque([0.0] * BAR_TICKS, BAR_TICKS)

    def push(self, norm: float) -> int:
        """Take the length of the present corrected sample (1 is perfect); returns per cent."""
        self._values.append(bar_value(norm))
        return int(np.ceil(np.mean(self._values)))


def final_bar(points: ArrayLike) -> int:
    """What seed 001's bar says in the mean over raw points (n, 3) with its own final calibration, per cent."""
    norms = np.linalg.norm(min_max_scaled(points).apply(points), axis=1) / min_max_scaled(points).radius
    return int(np.ceil(np.mean([bar_value(norm) for norm in norms])))


def level_heading_spread_deg(fit: Ellipsoid, points: ArrayLike, quats: ArrayLike) -> float:
    """How far the heading of a fit strays (standard deviation, degrees) over raw fields (n, 3) and attitudes (n, 4)."""
    field = rotate(quats, fit.apply(points))
    heading = np.arctan2(field[:, 0], field[:, 1])
    mean = np.arctan2(np.sin(heading).mean(), np.cos(heading).mean())
    return float(np.degrees(np.sqrt((np.angle(np.exp(1j * (heading - mean))) ** 2).mean())))
