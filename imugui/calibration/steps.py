"""Short turns of a board: what the gyroscope says of them, and a vector fixed in the earth before and after."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from imugui.calibration.ellipsoid import Floats
from imugui.fusion.quaternion import from_rotation_vector, multiply, normalise, to_matrix, to_rotation_vector

STEP_S = 0.2
SMOOTH_S = 0.1  # what is seen is averaged over so long: a hand shakes
LEAST_TURN = np.radians(2.0)  # per step, below which a step tells nothing


@dataclass(frozen=True, eq=False)
class Steps:
    """Short turns: rotation vectors of the gyroscope (n, 3), unit vectors seen before and after (n, 3)."""

    turn: Floats
    before: Floats
    after: Floats

    def misfit(self, gyr: Floats, mag: Floats | None = None) -> Floats:
        """Predicted minus seen vector (n, 3) with these maps of rates and of what is seen."""
        before, after = (self.before, self.after) if mag is None else (self.before @ mag.T, self.after @ mag.T)
        # a mirrored map turns the other way round: the rotation vector is mapped, not the rotation
        back = to_matrix(from_rotation_vector(-(self.turn @ gyr.T)))
        return np.asarray(np.einsum("nij,nj->ni", back, before) - after)

    def score_deg(self, gyr: Floats) -> float:
        """Misfit in degrees, rms, with this map of the rates."""
        return float(np.degrees(np.sqrt((self.misfit(gyr) ** 2).sum(axis=1).mean())))


def cut(t: ArrayLike, gyr: ArrayLike, t_seen: ArrayLike, seen: ArrayLike) -> Steps:
    """Cut a recording into steps of 0.2 s that turn the board."""
    times, rates = _finite(t, gyr)
    times_seen, vectors_seen = _finite(t_seen, seen)
    if len(times) < 2 or len(times_seen) < 2:
        return Steps(np.zeros((0, 3)), np.zeros((0, 3)), np.zeros((0, 3)))
    edges = np.arange(max(times[0], times_seen[0]), min(times[-1], times_seen[-1]), STEP_S)
    after, before = (_integral(times_seen, vectors_seen, edges + shift) for shift in (SMOOTH_S / 2, -SMOOTH_S / 2))
    vectors = after - before
    vectors /= np.maximum(np.linalg.norm(vectors, axis=1, keepdims=True), 1e-12)
    turn = _turns(times, rates, edges)
    chosen = np.linalg.norm(turn, axis=1) > LEAST_TURN
    return Steps(turn[chosen], vectors[:-1][chosen], vectors[1:][chosen])


def _finite(t: ArrayLike, vectors: ArrayLike) -> tuple[Floats, Floats]:
    """The instants (n,) at which the vectors (n, 3) are numbers."""
    times, values = np.asarray(t, float), np.asarray(vectors, float)
    good = np.isfinite(times) & np.isfinite(values).all(axis=1)
    return times[good], values[good]


def _integral(t: Floats, vectors: Floats, until: Floats) -> Floats:
    """The integral (..., 3) of vectors (n, 3) over time up to the instants (...)."""
    middle = (vectors[1:] + vectors[:-1]) / 2.0
    total = np.concatenate((np.zeros((1, 3)), np.cumsum(middle * np.diff(t)[:, None], axis=0)))
    return np.stack([np.interp(until, t, column) for column in total.T], axis=-1)


def _turns(t: Floats, gyr: Floats, edges: Floats) -> Floats:
    """Rotation vectors (n, 3) from edge to edge: quarter steps of integrated rates, chained as rotations."""
    parts = np.diff(_integral(t, gyr, np.linspace(edges[:-1], edges[1:], 5).T), axis=1)
    quat = from_rotation_vector(parts[:, 0])
    for k in range(1, parts.shape[1]):
        quat = multiply(quat, from_rotation_vector(parts[:, k]))
    return to_rotation_vector(normalise(quat))
