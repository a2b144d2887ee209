"""Sensor families: how the magnetometer sits, what a raw count is worth, how late a low-pass makes the values."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

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
    gyr_delay_ms: Mapping[float, float] = field(default_factory=dict)  # by the bandwidth of its low-pass, Hz
    mag_delay_ms: float = 0.0  # from the field to its value, 0 where it is not known
    low_pass_hz: float = 0.0  # the usual setting, 0 where there is none


# The delays of the gyroscope are the tables of the register maps, CONFIG, DLPF_CFG: InvenSense RM-MPU-6000A, 4.3, and
# RM-MPU-9250A, 4.5. 41 Hz is what the usual libraries for the MPU-9250 set (FaBo's, and the sketches of Kris Winer);
# of the MPU-6050 no setting is usual. The AK8963 measures for 7.2 ms (its datasheet, single measurement): its value
# belongs to the middle, 3.6 ms earlier, and waits half a sample of 140 Hz, another 3.6 ms, until the board asks.
FAMILIES: dict[str, Family] = {
    "mpu9250": Family(
        "MPU-9250: magnetometer axes turned",
        ((1, 1.0), (0, 1.0), (2, -1.0)),
        16384,
        16.4,
        333.87,
        21.0,
        {250.0: 0.97, 184.0: 2.9, 92.0: 3.9, 41.0: 5.9, 20.0: 9.9, 10.0: 17.85, 5.0: 33.48},
        7.2,
        41.0,
    ),
    "mpu6050": Family(
        "MPU-6050: no magnetometer",
        gyr_delay_ms={256.0: 0.98, 188.0: 1.9, 98.0: 2.8, 42.0: 4.8, 20.0: 8.3, 10.0: 13.4, 5.0: 18.6},
    ),
    "aligned": Family("all axes aligned"),
}

FIRMWARES: dict[str, tuple[str, float]] = {
    "accel-lines": ("mpu9250", 41.0),  # the FaBo library, DLPF_CFG 3
    "triplets": ("mpu9250", 5.0),  # the tracker's sketch, DLPF_CFG 6
    "colon-line": ("mpu6050", 0.0),  # the card's report does not say
    "motion-card": ("mpu6050", 0.0),
}
"""The boards behind the formats: family, and the bandwidth in Hz that their own firmware sets (0: not known)."""


@dataclass(frozen=True)
class Delays:
    """How late a board's values are, ms: the gyroscope's, and the magnetometer's beyond it; and from what."""

    gyr_ms: float = 0.0
    mag_ms: float = 0.0
    source: str = ""


def known_delays(board_format: str, name: str = "") -> Delays | None:
    """What the table says of a board by its format and what its user says of its family; None where it says nothing.

    In steps of 0.1 and 1 ms: more is not known. A magnetometer that is quicker than the gyroscope counts as no later.
    """
    own, low_pass_hz = FIRMWARES.get(board_format, ("", 0.0))
    key = name or own
    if key not in FAMILIES:
        return None
    chosen = FAMILIES[key]
    hz = low_pass_hz if key == own else chosen.low_pass_hz
    if hz not in chosen.gyr_delay_ms:
        return None
    gyr_ms = chosen.gyr_delay_ms[hz]
    source = f"{chosen.title.partition(':')[0]}, low-pass of {hz:g} Hz"
    return Delays(round(gyr_ms, 1), round(max(0.0, chosen.mag_delay_ms - gyr_ms), 0), source)


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
