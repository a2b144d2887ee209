"""Scale, cross-axis and bias of an accelerometer from still positions: gravity always has the same length.

Minimises the sum of (|W (a - b)| - g)^2 over the positions by Gauss-Newton, with W upper triangular, i.e. in the axes
of the accelerometer's own x (D. Tedaldi, A. Pretto, E. Menegatti, "A robust and easy to implement method for IMU
calibration without external equipments", ICRA 2014, equations 6 to 10). With 6 parameters W is diagonal.

A weak prior keeps the cross-axis terms small (0.1: ten times what datasheets allow). With well spread positions it
changes nothing; where the positions leave a term open it stops the fit from running away along it, and
``predicted_tilt`` says how much stays open: the residuals cannot.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np

from imugui.calibration.coverage import fibonacci
from imugui.calibration.stillness import Floats
from imugui.samples import GRAVITY

MG = 1e-3 * GRAVITY
"""m/s2 per mg."""
NOISE_FLOOR = 0.2 * MG
"""m/s2; residuals of an exact fit say nothing of its noise: real positions repeat to about this."""
CROSS_AXIS = 0.1
"""1 sigma of the prior on each cross-axis term."""
ITERATIONS = 50
_UPPER = {9: ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)), 6: ((0, 0), (1, 1), (2, 2))}


@dataclass(frozen=True)
class GravityFit:
    """corrected = matrix @ (raw - bias); ``acc`` (n, 3) are the positions it came from, all in m/s2."""

    matrix: Floats
    bias: Floats
    acc: Floats
    parameters: int

    @cached_property
    def residuals(self) -> Floats:
        """Length of the corrected gravity minus g, (n,), m/s2."""
        return norms(self.matrix, self.bias, self.acc) - GRAVITY

    @property
    def residual_mg(self) -> float:
        """RMS over the positions."""
        return rms(self.residuals) / MG

    @cached_property
    def covariance(self) -> Floats:
        """Of the parameters: the parts of W in order of rows, then b, (parameters, parameters)."""
        jacobian = _jacobian(self.matrix, self.bias, self.acc, self.parameters)
        spare = max(1, len(self.acc) - self.parameters)
        sigma = max(NOISE_FLOOR, float(np.sqrt((self.residuals**2).sum() / spare)))
        normal = jacobian.T @ jacobian / sigma**2 + _prior(self.parameters) / NOISE_FLOOR**2
        return np.asarray(np.linalg.pinv(normal, rcond=1e-14, hermitian=True))

    @cached_property
    def predicted_tilt(self) -> float:
        """RMS direction error over all attitudes that the positions leave open, rad; infinite when they are too few."""
        if len(self.acc) < self.parameters:
            return float("inf")
        return float(np.sqrt(np.trace(self.covariance @ _tilt_weight(self.parameters))))

    def gains(self, ways: Floats) -> Floats:
        """By how much, rad2, a further position with each unit vector (n, 3) up would lower predicted_tilt squared."""
        raw = ways * GRAVITY @ np.linalg.inv(self.matrix).T + self.bias
        rows = _jacobian(self.matrix, self.bias, raw, self.parameters)
        spread = rows @ self.covariance
        gain = np.einsum("ij,jk,ik->i", spread, _tilt_weight(self.parameters), spread)
        return np.asarray(gain / (NOISE_FLOOR**2 + np.einsum("ij,ij->i", spread, rows)))


def fit_gravity(acc: Floats, parameters: int, start: GravityFit | None = None) -> GravityFit:
    """Fit 9 or 6 parameters to mean raw accelerations (n, 3), m/s2. It never fails; see ``predicted_tilt``."""
    matrix, bias = (start.matrix, start.bias) if start else _start(acc)
    matrix, bias = matrix.copy(), bias.copy()
    if parameters == 6:
        matrix = np.diag(np.diag(matrix))
    prior = _prior(parameters)
    cost, damping = _cost(matrix, bias, acc, prior), 1e-9
    for _ in range(ITERATIONS):
        jacobian = _jacobian(matrix, bias, acc, parameters)
        slope = jacobian.T @ (norms(matrix, bias, acc) - GRAVITY) + prior @ _packed(matrix, bias, parameters)
        normal = jacobian.T @ jacobian + prior
        step = np.asarray(np.linalg.solve(normal + damping * np.diag(np.diag(normal) + 1e-12), -slope), float)
        tried_matrix, tried_bias = _moved(matrix, bias, step, parameters)
        tried = _cost(tried_matrix, tried_bias, acc, prior)
        if not tried <= cost:
            damping = max(damping, 1e-9) * 10
            continue
        matrix, bias, damping = tried_matrix, tried_bias, damping / 10
        if cost - tried <= 1e-12 * cost + 1e-24:
            break
        cost = tried
    return GravityFit(matrix, bias, acc, parameters)


def leave_one_out(fit: GravityFit) -> Floats:
    """Residual (n,), m/s2, of each position under the fit to all others; NaN where these are too few."""
    errors = np.full(len(fit.acc), np.nan)
    if len(fit.acc) <= fit.parameters:
        return errors
    for k, one in enumerate(fit.acc):
        other = fit_gravity(np.delete(fit.acc, k, axis=0), fit.parameters, fit)
        errors[k] = float(norms(other.matrix, other.bias, one[None])[0]) - GRAVITY
    return errors


def norms(matrix: Floats, bias: Floats, acc: Floats) -> Floats:
    """Lengths (n,) of matrix @ (acc - bias)."""
    return np.asarray(np.linalg.norm((acc - bias) @ matrix.T, axis=1))


def rms(values: Floats) -> float:
    """Root of the mean square; NaN for nothing."""
    return float(np.sqrt(np.mean(values**2))) if len(values) else float("nan")


def _start(acc: Floats) -> tuple[Floats, Floats]:
    """Values from the extremes of each axis, where it saw both of its sides; else nothing to correct."""
    low, high = acc.min(axis=0), acc.max(axis=0)
    seen = high - low > 1.2 * GRAVITY
    scale = np.where(seen, 2 * GRAVITY / np.where(seen, high - low, 1.0), 1.0)
    return np.diag(scale), np.where(seen, (high + low) / 2, 0.0)


def _cost(matrix: Floats, bias: Floats, acc: Floats, prior: Floats) -> float:
    packed = _packed(matrix, bias, len(prior))
    return float(((norms(matrix, bias, acc) - GRAVITY) ** 2).sum() + packed @ prior @ packed)


def _packed(matrix: Floats, bias: Floats, parameters: int) -> Floats:
    return np.array([*(matrix[place] for place in _UPPER[parameters]), *bias])


@cache
def _prior(parameters: int) -> Floats:
    """Weight (parameters, parameters) of the squared cross-axis terms, in (m/s2)^2."""
    crossed = [j != k for j, k in _UPPER[parameters]]
    return np.diag(np.array([*crossed, False, False, False], float) * (NOISE_FLOOR / CROSS_AXIS) ** 2)


def _jacobian(matrix: Floats, bias: Floats, acc: Floats, parameters: int) -> Floats:
    """Derivatives (n, parameters) of the lengths by the parts of W in order of rows, then by b."""
    offset = acc - bias
    corrected = offset @ matrix.T
    unit = corrected / np.linalg.norm(corrected, axis=1, keepdims=True)
    by_matrix = [unit[:, j] * offset[:, k] for j, k in _UPPER[parameters]]
    return np.column_stack((*by_matrix, -unit @ matrix))


def _moved(matrix: Floats, bias: Floats, step: Floats, parameters: int) -> tuple[Floats, Floats]:
    moved = matrix.copy()
    for part, place in zip(step, _UPPER[parameters], strict=False):
        moved[place] += part
    return moved, bias + step[-3:]


@cache
def _tilt_weight(parameters: int) -> Floats:
    """trace(covariance @ weight) is the mean variance, rad2, of the direction of gravity over all attitudes."""
    total = np.zeros((parameters, parameters))
    ways = fibonacci(50)
    for way in ways:
        columns = [np.eye(3)[j] * way[k] * GRAVITY for j, k in _UPPER[parameters]]
        change = np.column_stack((*columns, -np.eye(3)))  # (3, parameters): what each parameter does to the vector
        across = (np.eye(3) - np.outer(way, way)) @ change / GRAVITY
        total += across.T @ across / len(ways)
    return total
