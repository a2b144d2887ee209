"""The hand's turn since engaging, and the part of it that steers: plain floats, one row at a time."""

from __future__ import annotations

from math import atan2, degrees, hypot

from imugui.fusion.scalar import NOTHING, Quat, Vector, rotation_rows
from imugui.targeting.settings import Control
from imugui.targeting.view_pose import ZOOM, Pair

NEAR_VERTICAL = 0.17
"""Sine of 10 degrees: a board that points closer than this to straight up or down has no roll to correct."""

LETTERS = "xyz"


def turn_deg(origin: Quat, quat: Quat) -> Vector:
    """The rotation vector, deg, of conj(origin) * quat in the axes of the board at ``origin``; the short way round.

    No Euler angles: nothing wraps and nothing locks (E.2, T9). Neither quaternion need be of unit length exactly.
    """
    a, b, c, d = origin
    w, x, y, z = quat
    real = a * w + b * x + c * y + d * z
    # paired so that equal quaternions give exactly 0
    i = (a * x - b * w) + (d * y - c * z)
    j = (a * y - c * w) + (b * z - d * x)
    k = (a * z - d * w) + (c * x - b * y)
    sine = hypot(i, j, k)
    if sine == 0.0:
        return NOTHING
    angle = 2.0 * atan2(sine, abs(real))
    scale = degrees(angle) / (sine if real >= 0.0 else -sine)
    return scale * i, scale * j, scale * k


class Steering:
    """What part of a turn steers: the axes of ``control``, turned into view axes for the attitude at engaging.

    Roll correction (E.2, T8): the axis that neither right nor up uses is where the board points. About it the
    steering axes are turned until the one for right is upright. Only gravity is needed for that, no heading.
    """

    def __init__(self, control: Control, mode: str, origin: Quat) -> None:
        names = (control.zoom_axis,) if mode == ZOOM else (control.x_axis, control.y_axis)
        plane = LETTERS.index(control.x_axis[1]), LETTERS.index(control.y_axis[1])
        roll = roll_of(origin, plane) if control.roll_corrected else (1.0, 0.0)
        axes = [_turned(name, plane, roll) for name in names]
        self._first = axes[0]
        self._second = axes[1] if len(axes) > 1 else NOTHING

    def pair(self, turn: Vector) -> Pair:
        """The steering parts of a turn, deg: right and up, or larger and 0."""
        x, y, z = turn
        (a, b, c), (d, e, f) = self._first, self._second
        return a * x + b * y + c * z, d * x + e * y + f * z


def roll_of(origin: Quat, plane: tuple[int, int]) -> Pair:
    """Cosine and sine of the angle in the board's ``plane`` from its first axis to upright.

    (1, 0), no correction, when the plane is nearly level: then the board points up or down.
    """
    if plane[0] == plane[1]:
        return 1.0, 0.0
    up = rotation_rows(origin)[2]
    a, b = up[plane[0]], up[plane[1]]
    length = hypot(a, b)
    return (a / length, b / length) if length > NEAR_VERTICAL else (1.0, 0.0)


def _turned(name: str, plane: tuple[int, int], roll: Pair) -> Vector:
    """The body axis ``name``, like "-z", turned in ``plane`` by the angle with this cosine and sine."""
    axis = [0.0, 0.0, 0.0]
    axis[LETTERS.index(name[1])] = -1.0 if name[0] == "-" else 1.0
    (i, j), (cosine, sine) = plane, roll
    if i != j:
        axis[i], axis[j] = cosine * axis[i] - sine * axis[j], sine * axis[i] + cosine * axis[j]
    return axis[0], axis[1], axis[2]
