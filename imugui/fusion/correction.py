"""Correction: what calibration has found wrong with the three sensors, taken out of every sample."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from imugui.fusion.quaternion import to_matrix
from imugui.samples import Rows

Vector = tuple[float, float, float]
Matrix = tuple[Vector, Vector, Vector]

_ZERO: Vector = (0.0, 0.0, 0.0)
_UNIT: Matrix = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


@dataclass(frozen=True)
class Correction:
    """For each sensor ``corrected = mounting * matrix * (raw - bias)``; it changes nothing by default.

    Biases (3,) are in the sensor's unit (rad/s, m/s2, uT), matrices (3, 3) have none. ``mounting`` (w, x, y, z) turns
    the board's axes into those of the tool or vehicle it is fixed to. Arrays are taken too and kept as tuples;
    ValueError for other shapes and for values that are not finite.
    """

    gyr_bias: Vector = _ZERO
    gyr_matrix: Matrix = _UNIT
    acc_bias: Vector = _ZERO
    acc_matrix: Matrix = _UNIT
    mag_bias: Vector = _ZERO
    mag_matrix: Matrix = _UNIT
    mounting: tuple[float, float, float, float] = (1.0, 0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        for item in dataclasses.fields(self):
            value, shape = np.asarray(getattr(self, item.name), float), np.asarray(item.default).shape
            if value.shape != shape or not np.isfinite(value).all():
                raise ValueError(f"{item.name}: expected finite numbers of shape {shape}")
            object.__setattr__(self, item.name, _tuples(value.tolist()))

    def apply(self, rows: Rows) -> Rows:
        """A corrected copy of a block of SAMPLE rows, shape (n,)."""
        corrected = rows.copy()
        for name, (bias, matrix) in self._steps.items():
            corrected[name] = _transform(rows[name] - bias, matrix)
        return corrected

    @property
    def has_mag(self) -> bool:
        """Whether a magnetometer calibration is in it."""
        return any(self.mag_bias) or self.mag_matrix != _UNIT

    @cached_property
    def _steps(self) -> dict[str, tuple[Vector, NDArray[np.float64]]]:
        """Bias and whole matrix of each sensor that needs any."""
        mounting = to_matrix(self.mounting)
        steps = {}
        for name in ("gyr", "acc", "mag"):
            bias, matrix = getattr(self, f"{name}_bias"), mounting @ np.array(getattr(self, f"{name}_matrix"), float)
            if any(bias) or not np.array_equal(matrix, _UNIT):
                steps[name] = (bias, matrix)
        return steps


def _tuples(values: Any) -> Any:
    return tuple(_tuples(value) for value in values) if isinstance(values, list) else values


def _transform(vectors: NDArray[np.float64], matrix: NDArray[np.float64]) -> NDArray[np.float64]:
    """Matrix times each vector (n, 3), written out: a library product may round one row and many rows differently."""
    x, y, z = vectors[:, 0:1], vectors[:, 1:2], vectors[:, 2:3]
    return np.asarray(x * matrix[:, 0] + y * matrix[:, 1] + z * matrix[:, 2])
