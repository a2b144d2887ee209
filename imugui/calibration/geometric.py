"""The fit that is used: an ellipsoid with Tukey's weights and, where data are thin, a prior that it is nearly round.

Minimised are the distances ``|V (m - b)| - R`` in the sensor's unit over nine numbers: b (3), the shape of V
(SHAPES, 5) and R. Safeguards: V keeps trace 3 and stays well away from singular, every step must lower the cost,
the scale is re-estimated from the median and has a floor, and of two starts the better end is taken.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from imugui.calibration.ellipsoid import (
    FEWEST,
    SHAPES,
    Ellipsoid,
    Floats,
    bisquare,
    li_griffiths,
    robust_sphere,
    spread,
)

SOFT_IRON_PRIOR = 0.10  # standard deviation of each of the five shape numbers
FIELD_PRIOR = 0.05  # relative, of an expected field strength
MODEL_ERROR = 0.01  # of the radius; no room and no sensor is better than this
SCALE_FLOOR = 1e-3  # of the radius, below which no distance counts as an outlier
SHARED = 0.45  # of the noise that a cell seems to average away, this share is believed to stay
FLATTEST = 0.1  # smallest eigenvalue of V that a step may reach
STEPS = 40
SETTLED = 1e-6  # of the radius; a step smaller than this is the end


@dataclass(frozen=True)
class Prior:
    """What is known before: soft iron (standard deviation of the shape), field strength in the sensor's unit.

    ``effective`` is how many of the samples count as independent, against the prior.
    """

    soft_iron: float = SOFT_IRON_PRIOR
    field: float | None = None
    field_share: float = FIELD_PRIOR
    effective: float = 100.0


def tukey(points: ArrayLike, start: Ellipsoid | None = None, weights: Floats | None = None) -> Ellipsoid | None:
    """Tukey-weighted geometric ellipsoid of points (n, 3), from Li-Griffiths or ``start``; None without a start."""
    points = np.asarray(points, float)
    start = start or li_griffiths(points)
    return start and _descend(points, start, None, weights, "full ellipsoid, outliers left out")[0]


def with_prior(points: ArrayLike, prior: Prior, weights: Floats | None = None) -> Ellipsoid:
    """The same with a prior (maximum a posteriori), of points (n, 3) in general position, n >= FEWEST."""
    points = np.asarray(points, float)
    starts = [robust_sphere(points), li_griffiths(points)]
    ends = [_descend(points, start, prior, weights, "ellipsoid with prior") for start in starts if start is not None]
    return min(ends, key=lambda end: end[1])[0]


def _descend(
    points: Floats, start: Ellipsoid, prior: Prior | None, weights: Floats | None, method: str
) -> tuple[Ellipsoid, float]:
    """Damped Gauss-Newton with weights renewed at each step; the end and its cost."""
    fit, damping = start, 1e-3
    known = np.ones(len(points)) if weights is None else weights
    for _ in range(STEPS):
        distances, design = linearise(fit, points)
        scale = max(spread(distances), SCALE_FLOOR * fit.radius)
        noise = max(scale, MODEL_ERROR * fit.radius) if prior else scale
        share = known * bisquare(distances, scale)
        if np.count_nonzero(share) < FEWEST:
            break
        precision = share * (prior.effective / known.sum() if prior else 1.0) / noise**2
        pull, stiffness = _prior_terms(fit, prior)
        normal = (design.T * precision) @ design + stiffness
        gradient = design.T @ (precision * distances) + pull
        fit, damping, step = _step(points, fit, (normal, gradient), damping, (precision, prior))
        if step < SETTLED:
            break
    end = Ellipsoid(fit.bias, fit.matrix, fit.radius, method)
    return end, _robust_cost(points, end, prior, known)


def _step(
    points: Floats,
    fit: Ellipsoid,
    system: tuple[Floats, Floats],
    damping: float,
    terms: tuple[Floats, Prior | None],
) -> tuple[Ellipsoid, float, float]:
    """One step that lowers the cost with these weights: the new fit, damping, and size of the step per radius."""
    normal, gradient = system
    before = _cost(points, fit, *terms)
    for _ in range(8):
        damped = normal + damping * np.diag(np.diag(normal)) + 1e-15 * np.eye(9)
        step = np.asarray(-np.linalg.solve(damped, gradient), float)
        tried = moved(fit, step)
        if tried is not None and _cost(points, tried, *terms) <= before:
            size = float(max(np.abs(step[[0, 1, 2, 8]]).max() / fit.radius, np.abs(step[3:8]).max()))
            return tried, max(damping / 10.0, 1e-9), size
        damping *= 10.0
    return fit, damping, 0.0


def linearise(fit: Ellipsoid, points: Floats) -> tuple[Floats, Floats]:
    """Distances (n,) and their derivatives (n, 9) by bias, shape and radius."""
    centred = points - fit.bias
    corrected = centred @ fit.matrix
    lengths = np.maximum(np.linalg.norm(corrected, axis=1), 1e-12)
    outward = corrected / lengths[:, None]
    design = np.empty((len(points), 9))
    design[:, :3] = -outward @ fit.matrix
    for k, shape in enumerate(SHAPES):
        design[:, 3 + k] = (outward * (centred @ shape)).sum(axis=1)
    design[:, 8] = -1.0
    return lengths - fit.radius, design


def shape_of(fit: Ellipsoid) -> Floats:
    """The five shape numbers of a fit's matrix."""
    return np.asarray(np.einsum("kij,ij->k", SHAPES, fit.matrix))


def moved(fit: Ellipsoid, step: Floats) -> Ellipsoid | None:
    """The fit changed by a step (9,); None where that is no ellipsoid."""
    matrix = fit.matrix + np.einsum("k,kij->ij", step[3:8], SHAPES)
    radius = fit.radius + float(step[8])
    if radius <= 0.0 or np.linalg.eigvalsh(matrix)[0] < FLATTEST:
        return None
    return Ellipsoid(fit.bias + step[:3], matrix, radius, fit.method)


def _prior_terms(fit: Ellipsoid, prior: Prior | None) -> tuple[Floats, Floats]:
    """Gradient (9,) and second derivative (9, 9) of the prior's cost."""
    pull, stiffness = np.zeros(9), np.zeros(9)
    if prior:
        stiffness[3:8] = prior.soft_iron**-2
        pull[3:8] = shape_of(fit) * stiffness[3:8]
        if prior.field:
            stiffness[8] = (prior.field_share * prior.field) ** -2
            pull[8] = (fit.radius - prior.field) * stiffness[8]
    return pull, np.diag(stiffness)


def _cost(points: Floats, fit: Ellipsoid, precision: Floats, prior: Prior | None) -> float:
    return float(precision @ fit.distances(points) ** 2) + _prior_cost(fit, prior)


def _prior_cost(fit: Ellipsoid, prior: Prior | None) -> float:
    if prior is None:
        return 0.0
    field = (fit.radius / prior.field - 1.0) / prior.field_share if prior.field else 0.0
    return float((shape_of(fit) ** 2).sum()) / prior.soft_iron**2 + field**2


def _robust_cost(points: Floats, fit: Ellipsoid, prior: Prior | None, known: Floats) -> float:
    """Cost by which two ends are compared: outliers count, each the same, and the scale is the same for both."""
    scale = MODEL_ERROR * fit.radius * 4.685
    lost = np.minimum((fit.distances(points) / scale) ** 2, 1.0) * 4.685**2
    return float(known @ lost) / float(known.sum()) * (prior.effective if prior else 100.0) + _prior_cost(fit, prior)


def covariance(fit: Ellipsoid, points: Floats, cells: ArrayLike, prior: Prior) -> Floats:
    """Covariance (9, 9) of bias, shape and radius, with at most one effective sample per cell.

    ``points`` (n, 3) are those that were not left out, ``cells`` (n,) the numbers of their direction cells. Samples
    of one cell share the errors of model and room: counted singly they promise five to ten times too much.
    """
    distances, design = linearise(fit, points)
    _, cells, counts = np.unique(np.asarray(cells, int), return_inverse=True, return_counts=True)
    noise = max(MODEL_ERROR * fit.radius, _spread_of_cells(distances, cells, counts))
    normal = (design.T * (1.0 / counts[cells] / noise**2)) @ design + _prior_terms(fit, prior)[1]
    return np.asarray(np.linalg.pinv(normal, hermitian=True))


def _spread_of_cells(distances: Floats, cells: NDArray[np.int64], counts: NDArray[np.int64]) -> float:
    """Standard deviation that one effective sample of a cell has, of cell numbers (n,) from 0 and their counts.

    White noise fades in a cell's mean, an uneven field does not (nine numbers were fitted to those means). It lies
    between the two: taken as all white a fit 8 degrees off was accepted, as all shared too many good ones refused.
    """
    means = np.bincount(cells, distances) / counts
    left = max(len(counts) - 9, 1) / len(counts)
    whole = spread(distances)
    common = min(spread(means) / float(np.sqrt(left)), whole)
    return common + SHARED * (whole - common)


def direction_error_deg(fit: Ellipsoid, spread_of: Floats, directions: Floats) -> float:
    """Expected error of a corrected direction in degrees, rms over unit directions (n, 3), of a covariance (9, 9)."""
    to_raw = np.linalg.inv(fit.matrix)
    moves = np.empty((len(directions), 3, 9))
    moves[:, :, :3] = -fit.matrix / fit.radius
    moves[:, :, 3:8] = np.einsum("kij,jl,nl->nik", SHAPES, to_raw, directions)
    moves[:, :, 8] = 0.0
    along = np.einsum("ni,nik->nk", directions, moves)
    moves -= directions[:, :, None] * along[:, None, :]
    variance = np.einsum("nik,kl,nil->n", moves, spread_of, moves)
    return float(np.degrees(np.sqrt(max(float(variance.mean()), 0.0))))
