"""What an attitude means to a person: angles, heading, gravity, display conventions.

Inside, a quaternion turns the sensor frame into the earth frame ENU (x east, y magnetic north, z up).
Angles are one self-consistent ZYX Tait-Bryan set: ``q = Rz(yaw) * Ry(pitch) * Rx(roll)``, so yaw counts
counter-clockwise seen from above and a positive pitch turns the x axis down.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from imugui.fusion.quaternion import (
    Floats,
    conjugate,
    from_matrix,
    from_rotation_vector,
    length,
    multiply,
    rotate,
    to_matrix,
)
from imugui.samples import GRAVITY

UNRELIABLE_BELOW = np.radians(5.0)
"""Nearer than this to +-90 degrees of pitch, yaw and roll are not told apart well."""

_LOCKED = 1e-8  # cos(pitch) below which the noise of rounding would decide yaw and roll


def euler(quat: ArrayLike) -> Floats:
    """Yaw, pitch, roll in rad, shape (..., 3), of unit quaternions (..., 4).

    Yaw and roll are within +-pi, pitch within +-pi/2. Where x is vertical only yaw -+ roll is defined: roll is 0.
    """
    m = to_matrix(quat)
    level = np.hypot(m[..., 0, 0], m[..., 1, 0])
    locked = level < _LOCKED
    yaw = np.where(
        locked, np.arctan2(-m[..., 0, 1], m[..., 1, 1]), np.arctan2(m[..., 1, 0], np.where(locked, 1.0, m[..., 0, 0]))
    )
    roll = np.where(locked, 0.0, np.arctan2(m[..., 2, 1], m[..., 2, 2]))
    # atan2 rather than asin, which loses half its digits near +-90 degrees
    return np.stack((yaw, np.arctan2(-m[..., 2, 0], level), roll), axis=-1)


def from_euler(yaw: ArrayLike, pitch: ArrayLike, roll: ArrayLike) -> Floats:
    """Unit quaternions (..., 4) of yaw, pitch and roll in rad; the inverse of ``euler``."""
    turns = [np.asarray(angle, float)[..., None] for angle in (yaw, pitch, roll)]
    about_z, about_y, about_x = (
        from_rotation_vector(angle * axis)
        for angle, axis in zip(turns, np.array(((0.0, 0, 1), (0, 1, 0), (1, 0, 0))), strict=True)
    )
    return multiply(multiply(about_z, about_y), about_x)


def euler_reliable(quat: ArrayLike) -> NDArray[np.bool_]:
    """False where pitch is within 5 degrees of +-90 and yaw and roll run into each other; shape (...)."""
    pitch = euler(quat)[..., 1]
    return np.asarray(np.abs(pitch) < np.pi / 2 - UNRELIABLE_BELOW)


def heading_deg(quat: ArrayLike) -> Floats:
    """Heading in degrees, 0 to 360, clockwise from magnetic north; shape (...).

    It is the direction in which the sensor's x axis points. Within 5 degrees of the vertical that direction is lost:
    then -z (x up) or z (x down) is looked at, the axis that took x's place when the nose was pitched up or down.
    """
    m = to_matrix(quat)
    forward = _forward(m[..., :, 0], m[..., :, 2])
    return np.asarray(np.degrees(np.arctan2(forward[..., 0], forward[..., 1])) % 360.0)


def _forward(x: Floats, z: Floats) -> Floats:
    """The direction whose horizontal part is 'ahead', from the sensor's x and z axes in earth axes, (..., 3)."""
    up = x[..., 2:3]
    steep = np.hypot(x[..., 0:1], x[..., 1:2]) < np.sin(UNRELIABLE_BELOW)
    return np.where(steep, np.where(up > 0.0, -z, z), x)


def gravity(quat: ArrayLike) -> Floats:
    """What an ideal accelerometer at rest reads in this attitude, m/s2 in sensor axes, shape (..., 3)."""
    return rotate(conjugate(quat), (0.0, 0.0, GRAVITY))


def dip_and_norm(quat: ArrayLike, mag: ArrayLike) -> tuple[Floats, Floats]:
    """How far the field points below the horizon (rad) and how strong it is (uT), each of shape (...).

    ``mag`` is in uT and sensor axes, (..., 3). The dip of a zero field is 0.
    """
    field = rotate(quat, mag)
    level = np.hypot(field[..., 0], field[..., 1])
    return np.asarray(np.arctan2(-field[..., 2], level)), length(mag)


def from_acc_mag(acc: ArrayLike, mag: ArrayLike | None = None) -> Floats:
    """The attitude of a sensor at rest: acc gives the vertical, mag (any unit) the north. Shapes (..., 3) -> (..., 4).

    Without a field, or where it is parallel to the vertical, the yaw is 0 (TRIAD: H. D. Black, AIAA Journal 2, 1964).
    A zero or non-finite ``acc`` counts as level.
    """
    up = _unit(acc, fallback=(0.0, 0.0, 1.0))
    # ahead in sensor axes: x, or -z (z) when x points up (down); the same rule as heading_deg
    steep = np.hypot(up[..., 1:2], up[..., 2:3]) < np.sin(UNRELIABLE_BELOW)
    ahead = np.where(steep, np.where(up[..., :1] > 0.0, (0.0, 0, -1), (0.0, 0, 1)), (1.0, 0, 0))
    east = _unit(np.cross(np.cross(up, ahead), up), fallback=(1.0, 0.0, 0.0))
    if mag is not None:
        east = _unit(np.cross(_unit(mag, fallback=(0.0, 0.0, 0.0)), up), fallback=east)
    return from_matrix(np.stack((east, np.cross(up, east), up), axis=-2))


def _unit(v: ArrayLike, fallback: ArrayLike) -> Floats:
    v = np.asarray(v, float)
    biggest = np.abs(v).max(axis=-1, keepdims=True)
    usable = (biggest > 1e-9) & (biggest < np.inf)
    scaled = np.where(usable, v, 1.0) / np.where(usable, biggest, 1.0)
    return np.where(usable, scaled / length(scaled)[..., None], fallback)


@dataclass(frozen=True)
class Convention:
    """How attitudes are shown: names of the earth axes, and the turns of the earth and of the body frame."""

    title: str
    tip: str
    earth: tuple[float, float, float, float]
    body: tuple[float, float, float, float]


_HALF = float(np.sqrt(0.5))

CONVENTIONS: dict[str, Convention] = {
    "ENU": Convention(
        "East, north, up",
        "Yaw 0 is east and counts counter-clockwise seen from above.",
        earth=(1.0, 0.0, 0.0, 0.0),
        body=(1.0, 0.0, 0.0, 0.0),
    ),
    "NWU": Convention(
        "North, west, up",
        "Yaw 0 is north and counts counter-clockwise seen from above.",
        earth=(_HALF, 0.0, 0.0, -_HALF),
        body=(1.0, 0.0, 0.0, 0.0),
    ),
    "NED": Convention(
        "North, east, down",
        "Yaw 0 is north and counts clockwise seen from above; a positive pitch is nose up. "
        "The body is shown as forward, right, down.",
        earth=(0.0, _HALF, _HALF, 0.0),
        body=(0.0, 1.0, 0.0, 0.0),
    ),
}


def display_quat(quat: ArrayLike, convention: str) -> Floats:
    """Turn attitudes (..., 4) sensor -> ENU into those of a display convention, whose ``euler`` is then shown.

    NED flips both frames: the earth to north, east, down, and the body from x forward, y left, z up to x forward,
    y right, z down. So a level board reads pitch 0 and roll 0 in every convention.
    """
    shown = CONVENTIONS[convention]
    return multiply(multiply(shown.earth, quat), conjugate(shown.body))
