"""HandTurned: the board in the hand of a person who has a mouse."""

from __future__ import annotations

import threading

import numpy as np

from imugui.fusion import quaternion
from imugui.simulation.path import Floats, Path

STIFFNESS = 16.0
"""rad/s of the critically damped follower: the board trails the mouse by 2/16 s."""

LEAD = 0.5
"""rad: the follower is pulled by at most this much, so it turns at STIFFNESS * LEAD / 2 = 4 rad/s (229 deg/s) at
the most, inside the 250 deg/s of the slowest board's gyroscope."""

FARTHEST = 2.5
"""rad: how far the wanted attitude may be ahead; what the mouse asks beyond is lost, or the short way would flip."""

FROM_SOUTH = quaternion.from_rotation_vector(np.array([np.pi / 2, 0.0, 0.0]))
"""A viewer who looks north: right is east, up is up (rotation viewer -> earth; viewer x right, y up, z to the eye)."""


class HandTurned(Path):
    """Rests level, x to the east, until turned. One thread may turn it while another asks for its attitudes."""

    live = True

    def __init__(self, seed: int = 0) -> None:
        self.viewer: Floats = FROM_SOUTH  # rotation viewer -> earth; a camera that orbits assigns it
        self._lock = threading.Lock()
        self._t = 0.0
        self._quat: Floats = np.array([1.0, 0.0, 0.0, 0.0])
        self._wanted: Floats = self._quat
        self._rate: Floats = np.zeros(3)  # rad/s, earth frame

    @property
    def wanted(self) -> Floats:
        """The attitude (4,), sensor -> earth, that the board turns to."""
        return self._wanted.copy()

    def turn(self, dx_rad: float, dy_rad: float, roll_rad: float = 0.0) -> None:
        """Turn the wanted attitude as a mouse drags it: right by dx, down by dy, counter-clockwise by roll."""
        axis = quaternion.rotate(self.viewer, np.array([dy_rad, dx_rad, roll_rad]))
        turn = quaternion.from_rotation_vector(axis)
        with self._lock:
            self._want(quaternion.multiply(turn, self._wanted))

    def turn_to(self, quat: Floats) -> None:
        """Turn to an attitude (4,), sensor -> earth, the short way."""
        with self._lock:
            self._want(quaternion.normalise(np.asarray(quat, float)))

    def quats(self, t: Floats) -> Floats:
        """Attitude (n, 4) at times t (n,) in s, which must go on where the last call ended.

        The exact solution of a critically damped follower, per block: with the offset x from the wanted attitude,
        x(t) = (x0 + (v0 + k x0) t) exp(-k t).
        """
        if len(t) == 0:
            return np.zeros((0, 4))
        with self._lock:
            after = (np.asarray(t) - self._t)[:, None]
            offset = -self._lead(LEAD)
            pull = self._rate + STIFFNESS * offset
            fade = np.exp(-STIFFNESS * after)
            turned = (offset + pull * after) * fade - offset
            quats = quaternion.multiply(quaternion.from_rotation_vector(turned), self._quat)
            rate = (pull - STIFFNESS * (offset + pull * after[-1])) * fade[-1]
            # rate of the rotation vector -> angular rate, to first order: a block turns by less than 0.2 rad
            self._rate = rate + np.cross(turned[-1], rate) / 2
            self._t, self._quat = float(t[-1]), quaternion.normalise(quats[-1])
            return quats

    def _lead(self, most: float) -> Floats:
        """Rotation vector (3,) in rad, earth frame, from the attitude to the wanted one, shortened to ``most``."""
        lead = quaternion.to_rotation_vector(quaternion.multiply(self._wanted, quaternion.conjugate(self._quat)))
        return lead * min(1.0, most / max(float(np.linalg.norm(lead)), 1e-12))

    def _want(self, quat: Floats) -> None:
        self._wanted = quat
        self._wanted = quaternion.multiply(quaternion.from_rotation_vector(self._lead(FARTHEST)), self._quat)
