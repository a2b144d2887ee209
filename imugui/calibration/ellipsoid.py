"""Fits of a magnetometer's cloud: the sensor sees a sphere shifted by hard iron and bent by soft iron.

A fit says ``corrected = matrix @ (raw - bias)``, of length ``radius``. ``matrix`` is symmetric (a cloud cannot tell
a rotation) with trace 3, so that corrected values keep the sensor's unit.

The geometric fits minimise ``|V (m - b)| - R`` in the sensor's unit. The form ``|W (m - b)| - 1`` shrinks W on thin
data and runs to infinity, where its residual is best.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]

FEWEST = 12
"""Points below which nothing is fitted; nine numbers are looked for."""

_AXIS = 1.0 / np.sqrt(2.0)
SHAPES: Floats = np.array(
    [
        np.diag([_AXIS, -_AXIS, 0.0]),
        np.diag([1.0, 1.0, -2.0]) / np.sqrt(6.0),
        [[0.0, _AXIS, 0.0], [_AXIS, 0.0, 0.0], [0.0, 0.0, 0.0]],
        [[0.0, 0.0, _AXIS], [0.0, 0.0, 0.0], [_AXIS, 0.0, 0.0]],
        [[0.0, 0.0, 0.0], [0.0, 0.0, _AXIS], [0.0, _AXIS, 0.0]],
    ]
)
"""The five ways to bend a sphere without changing the trace: V = 1 + sum of shape_k * SHAPES[k]; orthonormal."""


@dataclass(frozen=True, eq=False)
class Ellipsoid:
    """A fit: bias (3,) and radius in the sensor's unit, matrix (3, 3) without one; ``method`` names it."""

    bias: Floats
    matrix: Floats
    radius: float
    method: str

    def apply(self, points: ArrayLike) -> Floats:
        """Corrected points (n, 3) of raw ones, in the sensor's unit."""
        return np.asarray((np.asarray(points, float) - self.bias) @ self.matrix.T, float)

    def distances(self, points: ArrayLike) -> Floats:
        """How far corrected points lie outside the sphere (n,), in the sensor's unit."""
        return np.asarray(np.linalg.norm(self.apply(points), axis=1) - self.radius)

    def residual(self, points: ArrayLike) -> float:
        """Standard deviation of the corrected length over its mean; raw points (n, 3)."""
        lengths = np.linalg.norm(self.apply(points), axis=1)
        return float(lengths.std() / lengths.mean())

    @property
    def axis_ratio(self) -> float:
        """Longest over shortest semi-axis of the cloud."""
        gains = np.linalg.svd(self.matrix, compute_uv=False)
        return float(gains[0] / max(gains[-1], 1e-12))


def scaled(bias: Floats, matrix: Floats, radius: float, method: str) -> Ellipsoid:
    """The fit with its matrix brought to trace 3, the radius along with it."""
    factor = 3.0 / float(np.trace(matrix))
    return Ellipsoid(bias, matrix * factor, radius * factor, method)


def min_max(points: ArrayLike) -> Ellipsoid:
    """Middle and half width of each axis, points (n, 3); what seeds 001 and 002 do."""
    points = np.asarray(points, float)
    low, high = points.min(axis=0), points.max(axis=0)
    half = np.maximum((high - low) / 2.0, 1e-9)
    return scaled((low + high) / 2.0, np.diag(1.0 / half), 1.0, "minimum and maximum")


def sphere(points: ArrayLike, weights: Floats | None = None) -> Ellipsoid:
    """Sphere by linear least squares of |m|^2 = 2 b.m + (R^2 - b^2); points (n, 3), weights (n,)."""
    points = np.asarray(points, float)
    middle = points.mean(axis=0)  # near the origin the squares keep their digits
    centred = points - middle
    root = np.ones(len(points)) if weights is None else np.sqrt(weights)
    design = np.column_stack((2.0 * centred, np.ones(len(points)))) * root[:, None]
    found = np.linalg.lstsq(design, (centred**2).sum(axis=1) * root, rcond=None)[0]
    radius = float(np.sqrt(max(found[3] + found[:3] @ found[:3], 1e-18)))
    return Ellipsoid(middle + found[:3], np.eye(3), radius, "sphere")


def robust_sphere(points: ArrayLike) -> Ellipsoid:
    """Sphere that leaves out what lies far off it; points (n, 3)."""
    points = np.asarray(points, float)
    fit = sphere(points)
    for _ in range(15):
        distances = fit.distances(points)
        weights = bisquare(distances, spread(distances))
        if np.count_nonzero(weights) < FEWEST:
            break
        fit = sphere(points, weights)
    return Ellipsoid(fit.bias, fit.matrix, fit.radius, "sphere, outliers left out")


def axis_aligned(points: ArrayLike) -> Ellipsoid | None:
    """Ellipsoid along the axes by linear least squares, points (n, 3); None when the points do not form one."""
    points = np.asarray(points, float)
    middle, scale = _frame(points)
    x, y, z = ((points - middle) / scale).T
    # trace of the quadric fixed: a x^2 + b y^2 + (3 - a - b) z^2 + 2 l.m + d = 0
    design = np.column_stack((x * x - z * z, y * y - z * z, 2 * x, 2 * y, 2 * z, np.ones(len(x))))
    a, b, *rest = np.linalg.lstsq(design, -3.0 * z * z, rcond=None)[0]
    fit = _from_quadric(np.diag([a, b, 3.0 - a - b]), np.array(rest[:3]), float(rest[3]), "ellipsoid along the axes")
    return _unframed(fit, middle, scale)


def li_griffiths(points: ArrayLike) -> Ellipsoid | None:
    """Full ellipsoid by constrained least squares, points (n, 3); None when the points do not form one.

    Q. Li and J. G. Griffiths, Least squares ellipsoid specific fitting, GMP 2004, eq. 11 to 16 with k = 4.
    """
    points = np.asarray(points, float)
    middle, scale = _frame(points)
    x, y, z = ((points - middle) / scale).T
    design = np.column_stack((x * x, y * y, z * z, 2 * y * z, 2 * x * z, 2 * x * y, 2 * x, 2 * y, 2 * z, 0 * x + 1))
    scatter = design.T @ design
    s11, s12, s22 = scatter[:6, :6], scatter[:6, 6:], scatter[6:, 6:]
    tail = np.linalg.lstsq(s22, s12.T, rcond=None)[0]
    values, vectors = np.linalg.eig(_CONSTRAINT_INVERSE @ (s11 - s12 @ tail))
    head = vectors[:, np.argmax(values.real)].real
    a, b, c, f, g, h = head
    linear = -tail @ head
    quadric: Floats = np.array([[a, h, g], [h, b, f], [g, f, c]])
    sign = 1.0 if np.trace(quadric) > 0.0 else -1.0
    fit = _from_quadric(sign * quadric, sign * linear[:3], sign * float(linear[3]), "full ellipsoid (Li-Griffiths)")
    return _unframed(fit, middle, scale)


def _constraint() -> Floats:
    """Li and Griffiths' constraint 4J - I^2 > 0 on the six second-order terms."""
    matrix = np.zeros((6, 6))
    matrix[:3, :3] = np.ones((3, 3)) - 2.0 * np.eye(3)
    matrix[3:, 3:] = -4.0 * np.eye(3)
    return matrix


_CONSTRAINT_INVERSE: Floats = np.asarray(np.linalg.inv(_constraint()), float)


def _frame(points: Floats) -> tuple[Floats, float]:
    """Middle and size of a cloud, to fit it near the origin and near one."""
    middle = np.asarray(points.mean(axis=0))
    return middle, max(float(np.sqrt(((points - middle) ** 2).sum(axis=1).mean())), 1e-12)


def _unframed(fit: Ellipsoid | None, middle: Floats, scale: float) -> Ellipsoid | None:
    return fit and Ellipsoid(middle + scale * fit.bias, fit.matrix, scale * fit.radius, fit.method)


def _from_quadric(quadric: Floats, linear: Floats, constant: float, method: str) -> Ellipsoid | None:
    """The ellipsoid m'Am + 2 l.m + d = 0; None when it is none."""
    values, axes = np.linalg.eigh(quadric)
    if values[0] <= 1e-6 * abs(values[-1]):
        return None
    bias = np.asarray(-np.linalg.solve(quadric, linear), float)
    level = float(bias @ quadric @ bias - constant)
    if level <= 0.0:
        return None
    root = np.asarray((axes * np.sqrt(values)) @ axes.T, float)
    return scaled(bias, root, float(np.sqrt(level)), method)


def spread(distances: Floats) -> float:
    """Robust standard deviation: 1.4826 times the median size."""
    return max(1.4826 * float(np.median(np.abs(distances))), 1e-9)


def bisquare(distances: Floats, scale: float) -> Floats:
    """Tukey's weights (n,): 1 at the fit, 0 from 4.685 standard deviations on."""
    share = distances / (4.685 * scale)
    weights: Floats = np.maximum(1.0 - share * share, 0.0) ** 2
    return weights


Fitter = Callable[[Floats], Ellipsoid | None]

METHODS: dict[str, Fitter] = {
    "min/max": min_max,
    "sphere": sphere,
    "robust sphere": robust_sphere,
    "axis ellipsoid": axis_aligned,
    "full ellipsoid": li_griffiths,
}
"""The closed fits by name; the weighted one is in ``geometric``."""
