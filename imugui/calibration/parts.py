"""The parts of a profile: one frozen dataclass for each thing that was calibrated, all plain values.

Every part checks itself when it is made, from a flow or from a file: shapes, limits and plausibility (ValueError).
"""

# ruff: noqa: RUF009  (limited() is a dataclasses.field with the limits in it, and makes nothing that could be shared)
from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Any

import numpy as np

from imugui.fusion.correction import Matrix, Vector

NAN = float("nan")
ZERO: Vector = (0.0, 0.0, 0.0)
UNIT: Matrix = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
NANS: Vector = (NAN, NAN, NAN)
QUALITIES = ("good", "usable", "poor")
LONGEST_TEXT = 400
MOST_SAMPLES = 10**12
FIRST_YEAR, LAST_YEAR = 1970, 2199  # nobody has calibrated outside of these, and calendars end


def limited(default: Any, limit: float, *, low: float | None = None, most: int = 0) -> Any:
    """A field of numbers within +-``limit`` (or ``low`` to ``limit``) of the default's shape.

    NaN in the default: a value may be unknown. ``most``: a list of up to so many items, each shaped like ``default``.
    """
    metadata = {"low": -limit if low is None else low, "high": limit, "most": most, "example": default}
    return dataclasses.field(default=() if most else default, metadata=metadata)


@dataclass(frozen=True)
class Part:
    """What every part tells: how, when (UTC, ISO 8601), how warm, from how many samples, how good and in which words.

    Lists are taken too and kept as tuples.
    """

    method: str = ""
    date: str = ""
    temp_c: float = limited(NAN, 200.0)
    samples: int = limited(0, MOST_SAMPLES, low=0)
    quality: str = "usable"
    verdict: str = ""

    def __post_init__(self) -> None:
        for item in dataclasses.fields(self):
            object.__setattr__(self, item.name, checked(item, getattr(self, item.name)))
        if self.quality not in QUALITIES:
            raise ValueError(f"quality: {self.quality[:20]!r} is none of {', '.join(QUALITIES)}")
        self.when()
        self.check()

    def check(self) -> None:
        """Raise ValueError when the values cannot be true together."""

    def when(self) -> datetime:
        """The date, with its time zone; ValueError when it is none."""
        return date_of(self.date, "date")


@dataclass(frozen=True)
class GyroscopePart(Part):
    """corrected = matrix @ (raw - bias); bias and its 1 sigma in rad/s; error in deg for a turn (matrix only).

    ``matrix_sigma``: 1 sigma of the worst known element; ``matrix_date`` is empty where the matrix came with the bias.
    """

    bias: Vector = limited(ZERO, 0.6)
    sigma: Vector = limited(ZERO, 0.6, low=0.0)
    matrix: Matrix = limited(UNIT, 1.5)
    matrix_method: str = ""
    turn_error_deg: float = limited(NAN, 180.0, low=0.0)
    matrix_sigma: float = limited(NAN, 1.0, low=0.0)
    matrix_date: str = ""
    matrix_temp_c: float = limited(NAN, 200.0)

    def check(self) -> None:
        """A gyroscope's matrix is near the unit matrix, and its date is one."""
        near_unit(self.matrix)
        self.matrix_when()

    @property
    def scale(self) -> dict[str, Any]:
        """All that is known of scale and cross-axis terms, by field: for a part with another bias."""
        names = ("matrix", "matrix_method", "turn_error_deg", "matrix_sigma", "matrix_date", "matrix_temp_c")
        kept = {name: getattr(self, name) for name in names}
        if self.matrix_method and not self.matrix_date:
            kept |= {"matrix_date": self.date, "matrix_temp_c": self.temp_c}
        return kept

    def matrix_when(self) -> datetime:
        """The date of scale and cross-axis terms, with its time zone; ValueError when it is none."""
        return date_of(self.matrix_date, "matrix_date") if self.matrix_date else self.when()


@dataclass(frozen=True)
class AccelerometerPart(Part):
    """corrected = matrix @ (raw - bias), m/s2; what it leaves; unit vectors of the positions held."""

    bias: Vector = limited(ZERO, 5.0)
    matrix: Matrix = limited(UNIT, 1.5)
    residual_mg: float = limited(NAN, 1000.0, low=0.0)
    loo_mg: float = limited(NAN, 1000.0, low=0.0)
    tilt_deg: float = limited(NAN, 90.0, low=0.0)
    positions: tuple[Vector, ...] = limited(ZERO, 1.001, most=500)

    def check(self) -> None:
        """An accelerometer's matrix is near the unit matrix."""
        near_unit(self.matrix)


@dataclass(frozen=True)
class MagnetometerPart(Part):
    """corrected = soft_iron @ (raw - hard_iron), uT, in the accelerometer's axes; how good that is, in degrees."""

    hard_iron: Vector = limited(ZERO, 1e4)
    soft_iron: Matrix = limited(UNIT, 10.0)
    field_ut: float = limited(NAN, 1e3, low=1.0)
    dip_deg: float = limited(NAN, 90.0)
    predicted_deg: float = limited(NAN, 180.0, low=0.0)
    residual_percent: float = limited(NAN, 1000.0, low=0.0)
    coverage: float = limited(NAN, 1.0, low=0.0)
    gap_deg: float = limited(NAN, 180.0, low=0.0)
    axes: str = ""  # which axes of the magnetometer are those of the accelerometer, in words
    cells: tuple[int, ...] = limited(0, 99, low=0, most=100)  # cells of calibration.coverage that were seen

    def check(self) -> None:
        """Soft iron stretches; it neither mirrors nor flattens."""
        values = np.linalg.svd(np.array(self.soft_iron), compute_uv=False)
        if np.linalg.det(np.array(self.soft_iron)) <= 0.0 or values[0] > 10.0 * values[-1]:
            raise ValueError("soft_iron: no plausible soft iron")


@dataclass(frozen=True)
class MountingPart(Part):
    """Rotation (w, x, y, z) from the sensor's axes to the box's or tool's; how well its x axis is known."""

    quat: tuple[float, float, float, float] = limited((1.0, 0.0, 0.0, 0.0), 1.001)
    error_deg: float = limited(NAN, 180.0, low=0.0)

    def check(self) -> None:
        """A rotation has length 1."""
        if abs(math.hypot(*self.quat) - 1.0) > 1e-3:
            raise ValueError("quat: not a rotation")


@dataclass(frozen=True)
class TemperaturePart(Part):
    """Gyroscope bias against temperature: see calibration.temperature.TemperatureModel (rad/s, /K, /K2)."""

    coefficients: tuple[Vector, ...] = limited(ZERO, 1.0, most=3)
    reference_c: float = limited(25.0, 200.0)
    low_c: float = limited(25.0, 200.0)
    high_c: float = limited(25.0, 200.0)
    error_dps: float = limited(NAN, 1000.0, low=0.0)

    def check(self) -> None:
        """There is a curve over a range."""
        if not self.coefficients or not self.low_c <= self.reference_c <= self.high_c:
            raise ValueError("coefficients: no curve over a range of temperatures")


@dataclass(frozen=True)
class NoisePart(Part):
    """White noise N (deg/s or mg per root hertz) and bias instability (deg/s, mg) of each axis."""

    rate_hz: float = limited(NAN, 1e5, low=0.0)
    gyr_white: Vector = limited(NANS, 1e4, low=0.0)
    gyr_instability: Vector = limited(NANS, 1e4, low=0.0)
    acc_white: Vector = limited(NANS, 1e4, low=0.0)
    acc_instability: Vector = limited(NANS, 1e4, low=0.0)


PARTS: dict[str, type[Part]] = {
    "gyroscope": GyroscopePart,
    "accelerometer": AccelerometerPart,
    "magnetometer": MagnetometerPart,
    "mounting": MountingPart,
    "temperature": TemperaturePart,
    "noise": NoisePart,
}
"""Every part by its name in a profile."""


def checked(item: dataclasses.Field[Any], value: Any) -> Any:
    """``value`` in the type of the field; ValueError says what is wrong with it."""
    meta = item.metadata
    if not meta:
        if not isinstance(value, str) or len(value) > LONGEST_TEXT:
            raise ValueError(f"{item.name}: expected a text of up to {LONGEST_TEXT} characters")
        return value
    inside = _number(meta["low"], meta["high"])
    if not meta["most"]:
        return _shaped(item.name, value, meta["example"], inside)
    if not isinstance(value, list | tuple) or len(value) > meta["most"]:
        raise ValueError(f"{item.name}: expected a list of up to {meta['most']}")
    return tuple(_shaped(item.name, one, meta["example"], inside) for one in value)


def date_of(text: str, name: str) -> datetime:
    """An ISO 8601 date with its time zone, else UTC; ValueError, with the field's name, when it is none."""
    try:
        when = datetime.fromisoformat(text)
        if not FIRST_YEAR <= when.year <= LAST_YEAR:
            raise ValueError(text)
    except ValueError:
        raise ValueError(f"{name}: {text[:40]!r} is no ISO 8601 date") from None
    return when if when.tzinfo else when.replace(tzinfo=UTC)


def near_unit(matrix: Matrix) -> None:
    """Raise ValueError for a matrix that no sensor's scale and cross-axis errors can make."""
    if np.abs(np.array(matrix) - np.eye(3)).max() > 0.5:
        raise ValueError("matrix: too far from the unit matrix for a sensor")


def _number(low: float, high: float) -> Callable[[Any, Any], Any]:
    def inside(value: Any, example: Any) -> Any:
        """The number, or None for a wrong one."""
        if value is None or (isinstance(value, float) and value != value):
            return NAN if isinstance(example, float) and example != example else None
        if isinstance(value, bool) or not isinstance(value, int | float) or not low <= value <= high:
            return None
        if isinstance(example, int):
            return int(value) if value == int(value) else None
        return float(value)

    return inside


def _shaped(name: str, value: Any, example: Any, inside: Callable[[Any, Any], Any]) -> Any:
    """A number, or nested tuples of them shaped like ``example``."""
    if isinstance(example, tuple):
        if not isinstance(value, list | tuple) or len(value) != len(example):
            raise ValueError(f"{name}: expected {len(example)} values")
        return tuple(_shaped(name, one, other, inside) for one, other in zip(value, example, strict=True))
    number = inside(value, example)
    if number is None:
        raise ValueError(f"{name}: not a number within its limits")
    return number
