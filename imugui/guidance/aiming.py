"""The aiming error: the angle between the tool's axis and the plan, and its picture at the plan.

Pass or fail is decided by the swing alone, so a tool that spins about its own axis changes nothing. The picture is
the log map at the plan: its radius is the true error, so rings are true degrees at any tilt.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from imugui.fusion.quaternion import Floats, conjugate, length, multiply
from imugui.guidance.plan import Plan, screen_sign

BACKWARDS = math.radians(0.01)
"""Nearer than this to exactly backwards no way to turn is shorter than the others."""
SEED001_DEG = 2.0
"""Seed 001 turned green when both Euler differences were smaller than this."""

Basis = tuple[ArrayLike, ArrayLike]


@dataclass(frozen=True)
class Aim:
    """Where the tool points against the plan; rad.

    ``offset``: (towards m', towards c'), where the tool is as seen from the plan, of length ``error``; NaN when
    ``backwards``. ``twist``: turned about its own axis against the plan's attitude, NaN when the plan has none.
    """

    error: float
    offset: tuple[float, float]
    backwards: bool = False
    twist: float = math.nan


def axis_error(d: ArrayLike, p: ArrayLike) -> Floats:
    """The angle in rad, 0 to pi, shape (...), between directions d and p, shapes (..., 3): atan2(|d x p|, d.p)."""
    d, p = np.asarray(d, float), np.asarray(p, float)
    return np.asarray(np.arctan2(length(np.cross(d, p)), (d * p).sum(axis=-1)))


def aim_many(d: ArrayLike, p: ArrayLike, basis: Basis) -> tuple[Floats, Floats]:
    """Errors (n,) and offsets (n, 2), rad, of unit directions d (n, 3) from the plan p (3,) with its basis (m', c').

    The log map of the sphere at p: e = eps (d - cos(eps) p) / |d - cos(eps) p|. Offsets are NaN where d is backwards.
    """
    d = np.asarray(d, float)
    error = axis_error(d, p)
    tangent = d @ np.stack([np.asarray(side, float) for side in basis], axis=-1)
    radius = np.hypot(tangent[..., 0], tangent[..., 1])
    ahead = radius < 1e-300
    offset = np.where(ahead, 0.0, error / np.where(ahead, 1.0, radius))[..., None] * tangent
    return error, np.where((error > math.pi - BACKWARDS)[..., None], np.nan, offset)


def aim(d: ArrayLike, p: ArrayLike, basis: Basis, twist: float = math.nan) -> Aim:
    """The aim of one unit direction d (3,) at the plan p (3,), with the basis of ``plan.target_basis``."""
    errors, offsets = aim_many(np.asarray(d, float)[None], p, basis)
    error = float(errors[0])
    medial, cranial = offsets[0].tolist()
    return Aim(error, (medial, cranial), error > math.pi - BACKWARDS, twist)


def swing_twist(q: ArrayLike, axis: ArrayLike) -> tuple[Floats, Floats]:
    """Split unit quaternions q (..., 4) into swing * twist about the unit axis (3,), the twist done first.

    Twist ~ (w, (v.t) t), swing = q * conj(twist) (Reynolds, "Quaternion axis factor", 2022). Where the swing is a
    half turn no twist is defined: it is the identity then.
    """
    q = np.asarray(q, float)
    w, along, _ = _parts(q, axis)
    size = np.hypot(w, along)
    lost = size < 1e-15
    scale = np.where(lost, 0.0, 1.0 / np.where(lost, 1.0, size))
    twist = np.concatenate(
        (np.where(lost, 1.0, w * scale)[..., None], (along * scale)[..., None] * np.asarray(axis, float)), axis=-1
    )
    return multiply(q, conjugate(twist)), twist


def swing_angle(q: ArrayLike, axis: ArrayLike) -> Floats:
    """The angle in rad, 0 to pi, shape (...), by which q (..., 4) tilts the unit axis (3,).

    eps = 2 atan2(|v - (v.t) t|, sqrt(w^2 + (v.t)^2)), which for t = z is 2 atan2(sqrt(x^2+y^2), sqrt(w^2+z^2)).
    """
    w, along, across = _parts(np.asarray(q, float), axis)
    return np.asarray(2.0 * np.arctan2(length(across), np.hypot(w, along)))


def twist_angle(q_plan: ArrayLike, q_tool: ArrayLike, axis: ArrayLike) -> Floats:
    """How far the tool is turned about its own axis against the plan, rad within +-pi, shape (...).

    ``q_plan`` and ``q_tool``, (..., 4), turn the box's axes into the same frame; ``axis`` (3,) is in the box's axes.
    """
    w, along, _ = _parts(multiply(conjugate(q_plan), q_tool), axis)
    flip = np.where(w < 0.0, -1.0, 1.0)
    return np.asarray(2.0 * np.arctan2(flip * along, flip * w))


def _parts(q: Floats, axis: ArrayLike) -> tuple[Floats, Floats, Floats]:
    """Scalar part (...), vector part along the axis (...), and across it (..., 3)."""
    axis = np.asarray(axis, float)
    along = (q[..., 1:] * axis).sum(axis=-1)
    return q[..., 0], along, q[..., 1:] - along[..., None] * axis


def within(aim: Aim, plan: Plan) -> bool:
    """Whether the error is inside the plan's tolerance; False when it is NaN."""
    return aim.error <= math.radians(plan.tolerance_deg)


def band(aim: Aim, plan: Plan) -> str:
    """ "green" inside the tolerance, "amber" inside the wider one, else "red" (also when the error is NaN)."""
    if within(aim, plan):
        return "green"
    return "amber" if aim.error <= math.radians(plan.amber_deg) else "red"


def words(aim: Aim, side: str, plain: bool = False, digits: int = 0) -> tuple[str, ...]:
    """What to do next, the larger part first: ("tilt 3° more medial", "tilt 1° more caudal").

    Parts that round to nothing are left out. ``plain``: "turn 3° left" instead. Empty when the error is NaN.
    """
    if aim.backwards:
        return ("the tool points backwards: turn it round",)
    if math.isnan(aim.error):
        return ()
    wanted = (-aim.offset[0], -aim.offset[1])
    if plain:
        names, pattern = (("right", "left"), ("up", "down")), "turn {0} {1}"
        wanted = (screen_sign(side) * wanted[0], wanted[1])
    else:
        names, pattern = (("medial", "lateral"), ("cranial", "caudal")), "tilt {0} more {1}"
    said = []
    for value, (positive, negative) in sorted(zip(wanted, names, strict=True), key=lambda part: -abs(part[0])):
        size = f"{abs(math.degrees(value)):.{digits}f}"
        if float(size) > 0.0:
            said.append(pattern.format(f"{size}°", negative if value < 0.0 else positive))
    return tuple(said) or ("on the plan",)


def seed001_accepts(
    yaw_deg: ArrayLike, pitch_deg: ArrayLike, desired_yaw_deg: ArrayLike, desired_pitch_deg: ArrayLike
) -> NDArray[np.bool_]:
    """Seed 001's old rule, kept for comparison: both Euler differences below 2 degrees, subtracted without a wrap."""
    yaw_off = np.abs(np.asarray(desired_yaw_deg, float) - yaw_deg)
    pitch_off = np.abs(np.asarray(desired_pitch_deg, float) - pitch_deg)
    return np.asarray((yaw_off < SEED001_DEG) & (pitch_off < SEED001_DEG))
