"""Quaternion arithmetic on numpy arrays, (w, x, y, z), vectorised over leading axes.

All rotations turn sensor vectors into the earth frame: ``v_earth = q * v_sensor * conj(q)``.
The formulas are written out component by component, because a matrix product may round
differently for one row than for many, and a stream must give the same numbers however it is cut.
Filters work on plain floats instead: see ``scalar.py``.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]

IDENTITY = (1.0, 0.0, 0.0, 0.0)


def multiply(p: ArrayLike, q: ArrayLike) -> Floats:
    """Hamilton product p * q: first q, then p. Shapes (..., 4) that broadcast."""
    pw, px, py, pz = _parts(p)
    qw, qx, qy, qz = _parts(q)
    return np.stack(
        (
            pw * qw - px * qx - py * qy - pz * qz,
            pw * qx + px * qw + py * qz - pz * qy,
            pw * qy - px * qz + py * qw + pz * qx,
            pw * qz + px * qy - py * qx + pz * qw,
        ),
        axis=-1,
    )


def conjugate(q: ArrayLike) -> Floats:
    """The inverse of unit quaternions, shape (..., 4)."""
    return np.asarray(q, float) * (1.0, -1.0, -1.0, -1.0)


def normalise(q: ArrayLike) -> Floats:
    """Scale to length 1, shape (..., 4); a zero or non-finite quaternion becomes the identity."""
    q = np.asarray(q, float)
    biggest = np.abs(q).max(axis=-1, keepdims=True)
    usable = (biggest > 0.0) & (biggest < np.inf)
    # scaled by the biggest part first, so that squares neither overflow nor vanish
    scaled = np.where(usable, q, IDENTITY) / np.where(usable, biggest, 1.0)
    return np.asarray(scaled / length(scaled)[..., None])


def length(v: ArrayLike) -> Floats:
    """Euclidean length along the last axis, which must hold 3 or 4 parts."""
    first, *others = (part * part for part in _parts(v))
    return np.sqrt(sum(others, start=first))


def rotate(q: ArrayLike, v: ArrayLike) -> Floats:
    """Turn sensor vectors v, shape (..., 3), into the earth frame with unit q, shape (..., 4)."""
    w, x, y, z = _parts(q)
    vx, vy, vz = _parts(v)
    # v + 2w (r x v) + 2 r x (r x v), with r the vector part
    tx, ty, tz = 2.0 * (y * vz - z * vy), 2.0 * (z * vx - x * vz), 2.0 * (x * vy - y * vx)
    return np.stack(
        (vx + w * tx + y * tz - z * ty, vy + w * ty + z * tx - x * tz, vz + w * tz + x * ty - y * tx), axis=-1
    )


def from_rotation_vector(r: ArrayLike) -> Floats:
    """Quaternions of rotation vectors, shape (..., 3), rad: the direction is the axis, the length the angle."""
    r = np.asarray(r, float)
    half = 0.5 * length(r)
    # np.sinc(x) is sin(pi x)/(pi x), finite at zero
    return np.concatenate((np.cos(half)[..., None], 0.5 * np.sinc(half / np.pi)[..., None] * r), axis=-1)


def to_rotation_vector(q: ArrayLike) -> Floats:
    """Rotation vectors, shape (..., 3), rad, of unit quaternions; the short way round, at most pi long."""
    q = np.asarray(q, float)
    q = np.where(q[..., :1] < 0.0, -q, q)
    sine = length(q[..., 1:])
    angle = 2.0 * np.arctan2(sine, q[..., 0])
    tiny = sine < 1e-12
    scale = np.where(tiny, 2.0, angle / np.where(tiny, 1.0, sine))
    return np.asarray(scale[..., None] * q[..., 1:])


def to_matrix(q: ArrayLike) -> Floats:
    """Rotation matrices sensor -> earth, shape (..., 3, 3), of unit quaternions."""
    w, x, y, z = _parts(q)
    rows = (
        (1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
        (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
        (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
    )
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def from_matrix(matrix: ArrayLike) -> Floats:
    """Unit quaternions with w >= 0 of rotation matrices, shape (..., 3, 3).

    Each row below is the quaternion times four times one of its parts; the longest is taken
    (S. W. Shepperd, Journal of Guidance and Control 1(3), 1978).
    """
    m = np.asarray(matrix, float)
    a, b, c = m[..., 0, 0], m[..., 1, 1], m[..., 2, 2]
    wx, wy, wz = m[..., 2, 1] - m[..., 1, 2], m[..., 0, 2] - m[..., 2, 0], m[..., 1, 0] - m[..., 0, 1]
    yz, xz, xy = m[..., 2, 1] + m[..., 1, 2], m[..., 0, 2] + m[..., 2, 0], m[..., 1, 0] + m[..., 0, 1]
    rows = (
        (1 + a + b + c, wx, wy, wz),
        (wx, 1 + a - b - c, xy, xz),
        (wy, xy, 1 - a + b - c, yz),
        (wz, xz, yz, 1 - a - b + c),
    )
    candidates = np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)
    largest = np.stack([row[i] for i, row in enumerate(rows)], axis=-1).argmax(axis=-1)
    q = np.take_along_axis(candidates, largest[..., None, None], axis=-2)[..., 0, :]
    return normalise(np.where(q[..., :1] < 0.0, -q, q))


def angle_between(p: ArrayLike, q: ArrayLike) -> Floats:
    """The angle in rad, 0 to pi, of the rotation from p to q, unit quaternions (..., 4)."""
    error = multiply(conjugate(p), q)
    # atan2 keeps its accuracy near 0 and near pi, where acos of w does not
    return np.asarray(2.0 * np.arctan2(length(error[..., 1:]), np.abs(error[..., 0])))


def slerp(p: ArrayLike, q: ArrayLike, share: ArrayLike) -> Floats:
    """The attitude that part of the shortest way from p to q, unit quaternions (..., 4); share (...): 0 is p, 1 is q.

    K. Shoemake, Animating rotation with quaternion curves, SIGGRAPH 1985, as p (p^-1 q)^share.
    """
    step = to_rotation_vector(multiply(conjugate(p), q))
    return multiply(p, from_rotation_vector(np.asarray(share, float)[..., None] * step))


def _parts(values: ArrayLike) -> tuple[Floats, ...]:
    array = np.asarray(values, float)
    return tuple(array[..., i] for i in range(array.shape[-1]))
