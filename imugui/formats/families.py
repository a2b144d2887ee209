"""Sensor families: how the magnetometer sits beside the accelerometer, and what a raw count is worth."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Axes = tuple[tuple[int, float], tuple[int, float], tuple[int, float]]
"""For each accelerometer axis: (index on the wire, factor)."""

ALIGNED: Axes = ((0, 1.0), (1, 1.0), (2, 1.0))


@dataclass(frozen=True)
class Family:
    """What all boards with one kind of sensor have in common."""

    title: str
    mag_axes: Axes = ALIGNED
    acc_per_g: float = 16384.0  # raw counts, range 2 g
    gyr_per_dps: float = 16.4  # raw counts, range 2000 deg/s
    temp_per_c: float = 340.0  # raw counts
    temp_zero_c: float = 36.53  # degrees Celsius at raw 0


FAMILIES: dict[str, Family] = {
    "mpu9250": Family("MPU-9250: magnetometer axes turned", ((1, 1.0), (0, 1.0), (2, -1.0)), 16384, 16.4, 333.87, 21.0),
    "mpu6050": Family("MPU-6050: no magnetometer"),
    "aligned": Family("all axes aligned"),
}


def family(name: str, default: str) -> Family:
    """The family called ``name``, or the default one when the name is empty; ValueError when there is none."""
    key = name or default
    if key not in FAMILIES:
        raise ValueError(f"no sensor family called {key!r}; there are {', '.join(FAMILIES)}")
    return FAMILIES[key]


def on_wire(axes: Axes, factor: float = 1.0, first: int = 0) -> Axes:
    """The same axes for a message whose field begins at value number ``first``, with ``factor`` as unit."""
    x, y, z = ((index + first, sign * factor) for index, sign in axes)
    return x, y, z


def to_body(values: Sequence[float], axes: Axes) -> tuple[float, float, float]:
    """The field among a message's values, in the accelerometer's axes."""
    (i, x), (j, y), (k, z) = axes
    return values[i] * x, values[j] * y, values[k] * z


def to_wire(mag: NDArray[np.float64], axes: Axes) -> NDArray[np.float64]:
    """Inverse of to_body for a block, shape (n, 3), with factors of +1 or -1."""
    wire = np.empty_like(mag)
    for body_axis, (index, sign) in enumerate(axes):
        wire[:, index] = mag[:, body_axis] * sign
    return wire
