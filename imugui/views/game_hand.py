"""The mouse-turned virtual board as a pointer: which turn of it moves the view where a drag goes."""

from __future__ import annotations

import math

import numpy as np

from imugui.fusion.quaternion import Floats, from_matrix, to_matrix
from imugui.fusion.scalar import Quat
from imugui.targeting.settings import POSITION, Control
from imugui.targeting.turning import Steering
from imugui.targeting.view_pose import ZOOM

TILT_PX_PER_DEG = 8.0
"""With the speed mapping an angle is a speed, not a way: a drag of so many px of the field tilts by one degree."""
GROWTH = 2.0
"""A side that follows the pointer makes the square twice as much larger."""


def turn_rad(control: Control, mode: str, right_px: float, up_px: float) -> tuple[float, float]:
    """The turns, rad, that move the view by so much to the right and up; while zooming, up makes it larger."""
    gain = control.zoom_gain if mode == ZOOM else control.gain
    per_px = math.radians(1.0 / (gain if control.mapping == POSITION else TILT_PX_PER_DEG))
    return (0.0, GROWTH * up_px * per_px) if mode == ZOOM else (right_px * per_px, up_px * per_px)


def viewer(control: Control, mode: str, quat: Quat) -> Floats:
    """Rotation (4,), viewer -> earth, of one whose up (y) is the axis for right and whose right (x) that for up.

    To such a viewer ``Session.turn_board(right, up, viewer)`` turns the board so that the view goes right and up.
    """
    steering = Steering(control, mode, quat)
    first, second = np.array([steering.pair(unit) for unit in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))]).T
    up, right = (first, second) if mode == ZOOM else (second, first)
    right = right - up * (up @ right)
    if np.linalg.norm(right) < 0.5:  # one axis steers both, or nothing steers to the right
        right = np.cross(up, (0.0, 0.0, 1.0) if abs(up[2]) < 0.9 else (1.0, 0.0, 0.0))
    right /= np.linalg.norm(right)
    body = np.column_stack((up, right, np.cross(up, right)))
    return np.asarray(from_matrix(to_matrix(np.array(quat)) @ body))
