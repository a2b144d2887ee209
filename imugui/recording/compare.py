"""Fuse the same samples with two filters, and say how far apart they are."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from imugui.fusion.pipeline import Pipeline
from imugui.fusion.quaternion import angle_between, rotate
from imugui.samples import ATTITUDE, Rows, empty_rows

BLOCK = 2000
UP = np.array([0.0, 0.0, 1.0])


def refuse(rows: Rows, settings: dict[str, Any], progress: Callable[[float], None]) -> Rows:
    """ATTITUDE rows, shape (n,), of SAMPLE rows, shape (n,), by a fresh pipeline with these settings.

    ``progress`` is told the share done, 0 to 1, and may raise to end it. Raises KeyError, TypeError or ValueError when
    the settings are none of a pipeline.
    """
    pipeline = Pipeline.from_settings(settings)
    out = empty_rows(ATTITUDE, len(rows))
    for start in range(0, len(rows), BLOCK):
        out[start : start + BLOCK] = pipeline.step(rows[start : start + BLOCK])
        progress(min(1.0, (start + BLOCK) / len(rows)))
    return out


def angle_difference_deg(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    """The angle of the rotation between quaternions (n, 4) and (n, 4), deg, shape (n,); exactly 0 for equal digits."""
    return np.where((a == b).all(axis=-1), 0.0, np.degrees(angle_between(a, b)))


def tilt_difference_deg(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    """The angle between the two verticals in the sensor's axes, deg, shape (n,): what is left without the heading."""
    up_a, up_b = (rotate(q * np.array([1.0, -1.0, -1.0, -1.0]), UP) for q in (a, b))
    sine = np.linalg.norm(np.cross(up_a, up_b), axis=-1)
    return np.asarray(np.degrees(np.arctan2(sine, (up_a * up_b).sum(axis=-1))))


@dataclass(frozen=True)
class Figures:
    """Of angles in deg; NaN when there are none."""

    mean: float
    rms: float
    largest: float
    largest_at_s: float


def figures(times: NDArray[np.float64], angles_deg: NDArray[np.float64]) -> Figures:
    """Mean, RMS and largest of angles (n,) in deg at times (n,) in s; what is not finite is left out."""
    good = np.isfinite(angles_deg)
    if not good.any():
        return Figures(np.nan, np.nan, np.nan, np.nan)
    angles = angles_deg[good]
    worst = int(np.argmax(angles))
    rms = float(np.sqrt((angles**2).mean()))
    return Figures(float(angles.mean()), rms, float(angles[worst]), float(times[good][worst]))


def thinned(
    times: NDArray[np.float64], values: NDArray[np.float64], columns: int
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Times and values (n,) thinned for a plot: of every column the first, the lowest and the highest, in order."""
    if len(times) <= 3 * columns:
        return times, values
    edges = np.linspace(0, len(times), columns + 1).astype(int)
    kept = np.zeros(len(times), bool)
    for start, end in itertools.pairwise(edges):
        part = values[start:end]
        kept[start] = True
        if np.isfinite(part).any():
            kept[start + int(np.nanargmin(part))] = kept[start + int(np.nanargmax(part))] = True
    return times[kept], values[kept]
