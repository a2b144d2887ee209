"""What can be looked at over time: quantities with their channels and units, computed from SAMPLE and ATTITUDE rows.

Inside, everything is SI (rad/s, m/s2, uT, rad, s); a Unit says what stands on screen and in exported files.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from imugui.fusion.attitude import CONVENTIONS, display_quat, euler, gravity
from imugui.fusion.quaternion import conjugate, length, multiply
from imugui.samples import GRAVITY, NO_STATUS, Rows
from imugui.signals.history import LONGEST_WINDOW_S

Floats = NDArray[np.float64]

PLAIN = 3
"""Tone of a channel that belongs to no axis: norms, the quaternion's w, temperature, sample interval."""
TURN = 2.0 * math.pi
HALF_CIRCLE = 180.0


@dataclass(frozen=True)
class Unit:
    """``scale`` times SI is shown. An automatic scale spans ``least`` or more, within plus or minus ``limit``."""

    name: str
    ascii: str  # in files
    scale: float
    decimals: int
    least: float
    limit: float = math.inf


@dataclass(frozen=True)
class Channel:
    """One curve. ``tone`` is the axis 0 to 2 whose colour it has, or PLAIN."""

    key: str
    label: str
    tone: int = PLAIN
    period: float = 0.0  # of an angle that starts again at half a turn, rad
    shown: bool = True  # until the user says otherwise


@dataclass(frozen=True)
class Quantity:
    """One plot: channels of one kind and unit."""

    title: str
    kind: str  # key of UNITS
    channels: tuple[Channel, ...]
    tip: str
    raw: bool = False  # exists raw and corrected
    corrected: bool = True  # comes from the attitude rows


UNITS: dict[str, tuple[Unit, ...]] = {
    "acceleration": (Unit("m/s²", "m/s2", 1.0, 3, 0.5), Unit("g", "g", 1.0 / GRAVITY, 4, 0.05)),
    "rate": (Unit("°/s", "deg/s", math.degrees(1.0), 2, 1.0), Unit("rad/s", "rad/s", 1.0, 4, 0.02)),
    "field": (Unit("µT", "uT", 1.0, 2, 2.0),),
    "angle": (Unit("°", "deg", math.degrees(1.0), 2, 0.5, HALF_CIRCLE),),
    "quaternion": (Unit("", "", 1.0, 4, 0.01),),
    "temperature": (Unit("°C", "degC", 1.0, 2, 0.5),),
    "interval": (Unit("ms", "ms", 1e3, 3, 0.2),),
    "number": (Unit("", "", 1.0, 0, 2.0),),
}
"""Units by kind; the first is the one shown until the user chooses another."""


def _axes(stem: str, norm: str = "") -> tuple[Channel, ...]:
    axes = tuple(Channel(f"{stem}.{axis}", axis, tone) for tone, axis in enumerate("xyz"))
    return (*axes, Channel(f"{stem}.norm", norm, shown=False)) if norm else axes


QUANTITIES: dict[str, Quantity] = {
    "acc": Quantity("Accelerometer", "acceleration", _axes("acc", "norm"), "Specific force in the board's axes", True),
    "gyr": Quantity("Gyroscope", "rate", _axes("gyr", "norm"), "Angular rate in the board's axes", True),
    "mag": Quantity("Magnetometer", "field", _axes("mag", "norm"), "Magnetic field in the board's axes", True),
    "gravity": Quantity(
        "Gravity", "acceleration", _axes("gravity"), "What the accelerometer would read at rest, from the attitude"
    ),
    "linear": Quantity(
        "Linear acceleration",
        "acceleration",
        _axes("linear", "norm"),
        "Accelerometer less gravity, in the board's axes; an error of the attitude of 1° shows as 0.17 m/s²",
    ),
    "euler": Quantity(
        "Yaw, pitch, roll",
        "angle",
        (
            Channel("euler.yaw", "yaw", 2, TURN),
            Channel("euler.pitch", "pitch", 1),
            Channel("euler.roll", "roll", 0, TURN),
        ),
        "The attitude as on the Live page: in the display convention, or relative to the origin",
    ),
    "quat": Quantity(
        "Quaternion",
        "quaternion",
        (Channel("quat.w", "w"), *_axes("quat")),
        "Rotation from the board to the earth (east, north, up), or relative to the origin",
    ),
    "temp": Quantity(
        "Temperature", "temperature", (Channel("temp.c", "board"),), "Of the board's sensor", corrected=False
    ),
    "button": Quantity(
        "Button",
        "number",
        (Channel("button.status", "status"), Channel("button.masked", "mask", 0)),
        "The status byte: 0 idle, else what is pressed. Masked is 1 while the spike mask leaves the accelerometer out",
    ),
    "interval": Quantity(
        "Sample interval",
        "interval",
        (Channel("interval.s", "interval"),),
        "Time from one sample to the next, by the sample clock",
        corrected=False,
    ),
}
"""Every plot, in the order of the list and of the stack."""

CHANNELS: dict[str, Channel] = {one.key: one for quantity in QUANTITIES.values() for one in quantity.channels}
SENSORS = ("acc", "gyr", "mag")


def _keys(*names: str) -> tuple[str, ...]:
    return tuple(one.key for name in names for one in QUANTITIES[name].channels)


SAMPLE_KEYS = _keys(*SENSORS, "temp", "interval")
"""Channels computed from SAMPLE rows, in the order of ``sample_values``."""
ATTITUDE_KEYS = _keys(*SENSORS, "gravity", "linear", "euler", "quat", "button")
"""Channels computed from ATTITUDE rows, in the order of ``attitude_values``."""


def fold(value: float, period: float) -> float:
    """The value within plus or minus half a period; unchanged where the period is 0."""
    return value - period * math.floor(value / period + 0.5) if period and math.isfinite(value) else value


def sample_values(rows: Rows, last_t: float) -> Floats:
    """Every channel of SAMPLE_KEYS, shape (keys, n), of n rows; ``last_t`` (s) is the time of the row before them.

    Where time goes back or jumps, as between two connections, there is no interval.
    """
    intervals = np.diff(rows["t"], prepend=last_t)
    intervals[(intervals < 0.0) | (intervals > LONGEST_WINDOW_S)] = np.nan
    return np.concatenate((*(_with_norm(rows[name]) for name in SENSORS), rows["temp_c"][None], intervals[None]))


def attitude_values(rows: Rows, convention: str) -> Floats:
    """Every channel of ATTITUDE_KEYS, shape (keys, n), of n rows; angles in a display convention (a key)."""
    down = gravity(rows["quat"])
    return np.concatenate(
        (
            *(_with_norm(rows[name]) for name in SENSORS),
            down.T,
            _with_norm(rows["acc"] - down),
            euler(_shown(rows, convention)).T,
            rows["local"].T,
            _button(rows),
        )
    )


def _button(rows: Rows) -> Floats:
    """Status and mask, shape (2, n); NaN where the board sends no status."""
    sent = rows["status"] != NO_STATUS
    return np.where(sent, np.stack((rows["status"], rows["masked"])).astype(float), np.nan)


def _with_norm(vectors: Floats) -> Floats:
    """Vectors (n, 3) as (4, n): their parts and their length."""
    return np.concatenate((vectors.T, length(vectors)[None]))


def _shown(rows: Rows, convention: str) -> Floats:
    """The rotations whose angles are shown, (n, 4): relative to the origin only the body's axes follow a convention."""
    local, body = rows["local"], CONVENTIONS[convention].body
    relative = (local != rows["quat"]).any(axis=1)[:, None]
    return np.where(relative, multiply(multiply(body, local), conjugate(body)), display_quat(local, convention))
