"""Driving: the RC car on its circuit."""

from __future__ import annotations

import numpy as np

from imugui.fusion import quaternion
from imugui.simulation.curves import Wander, smooth_step, soft_start
from imugui.simulation.path import Floats, Path

DEGREE = np.pi / 180


class Driving(Path):
    """Laps counter-clockwise on an oval; x points forward, y left, z up.

    The track is an ellipse with the given half axes in m (east, north), driven at ``rate`` rad/s of its parameter:
    the defaults give 1.2 to 1.8 m/s and 0.18 to 0.28 g, the pace of the seed system's RC car. On a track whose
    bends last longer than a filter's accelerometer time constant (3 s for VQF) every filter takes the
    centrifugal force for tilt: on one of 40 m at 3 to 6 m/s VQF is off by 9 deg.
    """

    travels = True
    roll_gain, pitch_gain = 0.6 * DEGREE, 0.4 * DEGREE  # rad of body roll and pitch per m/s2

    def __init__(self, seed: int, half_x: float = 1.2, half_y: float = 0.8, rate: float = 1.5) -> None:
        self._half_x, self._half_y, self._rate = half_x, half_y, rate
        self._rough = Wander(np.random.default_rng(seed), 1.0, 4.0, 0.15 * DEGREE)

    def _parameter(self, t: Floats) -> Floats:
        return self._rate * soft_start(t, 2.0, 2.0)

    def position(self, t: Floats) -> Floats:
        """Position (n, 3) in m at times t (n,) in s."""
        p = self._parameter(t)
        return np.stack([self._half_x * np.cos(p), self._half_y * np.sin(p), np.zeros_like(p)], axis=1)

    def _yaw(self, t: Floats) -> Floats:
        """Direction of travel (n,), rad counter-clockwise from east, without jumps: a circle's plus a correction."""
        p = self._parameter(t)
        sin, cos = np.sin(p), np.cos(p)
        across = (self._half_x - self._half_y) * sin * cos
        along = self._half_x * sin**2 + self._half_y * cos**2
        yaw: Floats = p + np.pi / 2 + np.arctan2(across, along)
        return yaw

    def quats(self, t: Floats) -> Floats:
        """Attitude (n, 4) at times t (n,) in s: heading along the track, leaning out of bends, nose down in braking."""
        yaw, (east, north, _) = self._yaw(t), self.acceleration(t).T
        forward = np.cos(yaw) * east + np.sin(yaw) * north
        left = np.cos(yaw) * north - np.sin(yaw) * east
        lean = np.stack([self.roll_gain * left, -self.pitch_gain * forward, np.zeros_like(yaw)], axis=1)
        rough = smooth_step((t - 2.0) / 2.0)[:, None] * self._rough(t)
        heading = np.stack([np.zeros_like(yaw), np.zeros_like(yaw), yaw], axis=1)
        turned = quaternion.from_rotation_vector(heading)
        return quaternion.multiply(turned, quaternion.from_rotation_vector(lean + rough))
