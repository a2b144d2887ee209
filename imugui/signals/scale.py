"""Scales: steps a person can read (1, 2, 5), their words, and a range that follows the data without fidgeting."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Range = tuple[float, float]

MARGIN = 0.06  # share of the data's span left free above and below
NEAR = 0.02  # of the data's span: nearer than this to an end the range is widened
SHRINK = 0.5  # a range is given up when the data would fit into one of this share
ANGLE_STEPS = (15.0, 30.0, 45.0, 90.0, 180.0)
LARGEST = 1e12  # beyond this nothing on a board is a measurement


def nice_step(rough: float) -> float:
    """The least of 1, 2, 5 times a power of ten that is not below ``rough`` (> 0)."""
    power = 10.0 ** math.floor(math.log10(rough))
    return next((nice * power for nice in (1.0, 2.0, 5.0) if nice * power >= rough * (1.0 - 1e-9)), 10.0 * power)


def ticks(low: float, high: float, most: int, angles: bool = False) -> tuple[NDArray[np.float64], float]:
    """At the most ``most`` + 1 round values from low to high, and their step; angles are in degrees."""
    step = nice_step((high - low) / max(most, 1))
    if angles and step > 10.0:
        step = next((one for one in ANGLE_STEPS if one * most >= high - low), ANGLE_STEPS[-1])
    first, last = math.ceil(low / step - 1e-6), math.floor(high / step + 1e-6)
    return np.asarray(step * np.arange(first, last + 1, dtype=float)), step


def tick_words(value: float, step: float) -> str:
    """A tick with the decimals its step needs and a real minus sign."""
    decimals = max(0, -math.floor(math.log10(step) + 1e-9))
    return f"{round(value, decimals) + 0.0:.{decimals}f}".replace("-", "−")


def round_range(low: float, high: float, least: float) -> Range:
    """A range with round ends that holds low to high with a margin, and spans ``least`` at the least."""
    low, high = max(low, -LARGEST), min(high, LARGEST)
    spare = max(0.5 * (least - (high - low)), MARGIN * (high - low))
    step = nice_step((high - low + 2.0 * spare) / 16.0)
    return step * math.floor((low - spare) / step), step * math.ceil((high + spare) / step)


class AutoScale:
    """Widens at once when data come near the edge; narrows only when less than half of it would do."""

    def __init__(self) -> None:
        self.range: Range | None = None

    def follow(self, low: float, high: float, least: float) -> Range:
        """The range for data from low to high; NaN keeps the last one. All in the unit shown."""
        if not (math.isfinite(low) and math.isfinite(high)):
            return self.range or (-0.5 * least, 0.5 * least)
        wanted = round_range(low, high, least)
        near = NEAR * (high - low)
        if self.range is None or wanted[1] - wanted[0] < SHRINK * (self.range[1] - self.range[0]):
            self.range = wanted
        elif low < self.range[0] + near or high > self.range[1] - near:
            self.range = min(wanted[0], self.range[0]), max(wanted[1], self.range[1])
        return self.range
