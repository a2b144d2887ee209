"""The fine rotation between magnetometer and gyroscope, which no ellipsoid can tell.

It is not fitted to the spread of the dip, which trades rotation against the dip and goes 4 to 15 degrees astray;
that spread is only the acceptance number, which must not grow.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from imugui.calibration.axes import dip_spread_deg
from imugui.calibration.ellipsoid import Floats, spread
from imugui.calibration.flow import Result
from imugui.calibration.steps import Steps, cut
from imugui.fusion.quaternion import from_matrix, from_rotation_vector, to_matrix, to_rotation_vector

STEPS_FEWEST = 40
SPAN = 0.05  # smallest over largest scatter of rotation axes that span space
FARTHEST_DEG = 20.0  # of the fine rotation; more is another map
GROWTH = 1.1  # of the spread of the dip, at most


@dataclass(frozen=True, eq=False)
class FineResult(Result):
    """A rotation (3, 3) that brings the field into the gyroscope's axes, its angle and the misfit per step.

    ``dip_spread_deg``: spread of the dip (before, after); NaN without accelerations.
    """

    matrix: Floats
    angle_deg: float
    misfit_deg: float
    dip_spread_deg: tuple[float, float] = (np.nan, np.nan)


def fine_rotation(
    t: ArrayLike,
    gyr: ArrayLike,
    t_mag: ArrayLike,
    mag: ArrayLike,
    start: ArrayLike | None = None,
    acc: ArrayLike | None = None,
) -> FineResult:
    """The rotation Q of the field into the gyroscope's axes: R(w dt)' Q h(t) = Q h(t + dt) over 0.2 s steps.

    ``t`` (n,) s, calibrated ``gyr`` (n, 3) rad/s, ``t_mag`` (m,) s, calibrated ``mag`` (m, 3); ``start``: the map
    (3, 3) found before; ``acc`` (m, 3) m/s2 at the times of the field, for the acceptance number.
    """
    first = np.eye(3) if start is None else np.asarray(start, float)
    steps = cut(t, gyr, t_mag, mag)
    if len(steps.turn) < STEPS_FEWEST:
        return FineResult(False, "Not enough turning to find the fine rotation.", first, 0.0, np.nan)
    axes = np.linalg.eigvalsh(steps.turn.T @ steps.turn)
    if axes[0] < SPAN * axes[-1]:
        reason = "The board was not turned about all three axes: the fine rotation cannot be told."
        return FineResult(False, reason, first, 0.0, np.nan)
    matrix = _descend(steps, first)
    angle_deg = float(np.degrees(np.linalg.norm(to_rotation_vector(from_matrix(matrix @ first.T)))))
    misfit_deg = float(np.degrees(spread(np.linalg.norm(steps.misfit(np.eye(3), matrix), axis=1))))
    field, dips = np.asarray(mag, float), (np.nan, np.nan)
    if acc is not None:
        dips = (dip_spread_deg(acc, field @ first.T), dip_spread_deg(acc, field @ matrix.T))
    problem = _problem(angle_deg, dips)
    said = f"The magnetometer is turned by {angle_deg:.1f}° against the gyroscope{problem}."
    return FineResult(not problem, said, first if problem else matrix, angle_deg, misfit_deg, dips)


def _problem(angle_deg: float, dips: tuple[float, float]) -> str:
    """Why the rotation is not taken; empty when it is."""
    if angle_deg > FARTHEST_DEG:
        return ", too much for a fine rotation: look for another axis map first"
    if dips[1] > GROWTH * dips[0]:
        return f", but the dip would then spread more ({dips[1]:.1f}° instead of {dips[0]:.1f}°), so it is not taken"
    return ""


def _descend(steps: Steps, matrix: Floats) -> Floats:
    """Robust Gauss-Newton from a first rotation (3, 3)."""
    for _ in range(20):
        step = _fine_step(steps, matrix)
        matrix = to_matrix(from_rotation_vector(step)) @ matrix
        if np.linalg.norm(step) < 1e-7:
            break
    return matrix


def _fine_step(steps: Steps, matrix: Floats) -> Floats:
    """One Gauss-Newton step (3,) of a small rotation from the left, Huber-weighted."""
    misfit = steps.misfit(np.eye(3), matrix)
    size = np.linalg.norm(misfit, axis=1)
    limit = 1.5 * max(spread(size), 1e-9)
    weights = np.minimum(1.0, limit / np.maximum(size, 1e-12))
    back = to_matrix(from_rotation_vector(-steps.turn))
    # d(exp([e]x) v)/de = -[v]x
    design = -back @ _cross(steps.before @ matrix.T) + _cross(steps.after @ matrix.T)
    normal = np.einsum("n,nki,nkj->ij", weights, design, design)
    gradient = np.einsum("n,nki,nk->i", weights, design, misfit)
    return np.asarray(-np.linalg.solve(normal + 1e-9 * np.trace(normal) * np.eye(3), gradient))


def _cross(v: Floats) -> Floats:
    """Matrices (n, 3, 3) of the cross product with v (n, 3)."""
    zero = np.zeros(len(v))
    x, y, z = v.T
    return np.stack((zero, -z, y, z, zero, -x, -y, x, zero), axis=-1).reshape(-1, 3, 3)
