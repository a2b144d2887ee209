"""The few vector and quaternion steps that filters take for every sample, on plain Python floats.

numpy is made for arrays: on three numbers it costs several times more than arithmetic on floats.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, hypot, inf, sin, sqrt

Vector = tuple[float, float, float]
Quat = tuple[float, float, float, float]
Rows3 = tuple[Vector, Vector, Vector]

MAX_DT = 1.0
"""s; a filter never bridges more than this in one step. The pipeline restarts it after longer gaps."""


LARGEST = 1e6
"""No sensor reads more than this in rad/s, m/s2 or uT; a longer vector says nothing."""

FREE_FALL = 1.0
"""m/s2; a shorter specific force has no direction worth following."""

NO_FIELD = 1e-3
"""uT; a shorter field has none."""

HELD = 1.5
"""A field that comes later than so many samples after the one before was held by the board in between."""

NOTHING: Vector = (0.0, 0.0, 0.0)


def sane(v: Sequence[float]) -> Sequence[float]:
    """v itself, or zeros when it is longer than any measurement or not a number."""
    return v if hypot(*v) < LARGEST else NOTHING


def bounded(dt: float) -> float:
    """``dt`` in s within 0 to MAX_DT; a time that goes back integrates nothing."""
    return 0.0 if not dt > 0.0 else dt if dt < MAX_DT else MAX_DT


def direction(v: Sequence[float], shortest: float) -> Vector | None:
    """The unit vector along v, or None when v is not longer than ``shortest`` or no measurement (see ``sane``)."""
    x, y, z = v
    norm = hypot(x, y, z)  # hypot does not overflow where the square would
    if not shortest < norm < LARGEST:
        return None
    return x / norm, y / norm, z / norm


def rotation_rows(q: Quat) -> Rows3:
    """The rows of the matrix sensor -> earth: the earth's east, north and up in sensor axes."""
    w, x, y, z = q
    x2, y2, z2 = x + x, y + y, z + z
    xx, yy, zz = x * x2, y * y2, z * z2
    xy, xz, yz = x * y2, x * z2, y * z2
    wx, wy, wz = w * x2, w * y2, w * z2
    return (
        (1.0 - yy - zz, xy - wz, xz + wy),
        (xy + wz, 1.0 - xx - zz, yz - wx),
        (xz - wy, yz + wx, 1.0 - xx - yy),
    )


def turned_in_sensor(q: Quat, x: float, y: float, z: float) -> Quat:
    """q followed by the rotation vector (rad) in sensor axes, q * exp(v/2); as long as q is."""
    angle = hypot(x, y, z)
    if not 1e-12 < angle < inf:
        return q
    c, s = cos(0.5 * angle), sin(0.5 * angle) / angle
    x, y, z = s * x, s * y, s * z
    w0, x0, y0, z0 = q
    return (
        c * w0 - x * x0 - y * y0 - z * z0,
        c * x0 + x * w0 + z * y0 - y * z0,
        c * y0 + y * w0 + x * z0 - z * x0,
        c * z0 + z * w0 + y * x0 - x * y0,
    )


def turned_in_earth(q: Quat, x: float, y: float, z: float) -> Quat:
    """q after the rotation vector (rad) in earth axes, scaled to unit length.

    The vector v enters as 1 + v/2, which turns by 2 atan(|v|/2): the same within 1 % below 0.35 rad, less above.
    """
    x, y, z = 0.5 * x, 0.5 * y, 0.5 * z
    w0, x0, y0, z0 = q
    w1 = w0 - x * x0 - y * y0 - z * z0
    x1 = x0 + x * w0 + y * z0 - z * y0
    y1 = y0 + y * w0 + z * x0 - x * z0
    z1 = z0 + z * w0 + x * y0 - y * x0
    norm = sqrt(w1 * w1 + x1 * x1 + y1 * y1 + z1 * z1)
    return w1 / norm, x1 / norm, y1 / norm, z1 / norm
