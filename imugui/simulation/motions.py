"""The motions of the virtual board. Each begins with at least a second at rest, so that filters can start.

The hand motions turn about the sensor: they have no linear acceleration. "aiming" and "driving" have,
and it reaches the accelerometer only if ``Errors.linear_acceleration`` says so.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from imugui.fusion import quaternion
from imugui.simulation import MOTION_TITLES
from imugui.simulation.curves import Wander, smooth_step, soft_start
from imugui.simulation.driving import Driving
from imugui.simulation.hand import HandTurned
from imugui.simulation.path import Floats, Motion, Path

DEGREE = np.pi / 180


class Rest(Path):
    """Lies still, tilted a little and turned as the seed says."""

    def __init__(self, seed: int) -> None:
        tilt = np.random.default_rng(seed).uniform(-1, 1, 3) * np.array([5, 5, 180]) * DEGREE
        heading = quaternion.from_rotation_vector(np.array([0, 0, tilt[2]]))
        self._quat = quaternion.multiply(heading, quaternion.from_rotation_vector(tilt * np.array([1, 1, 0])))

    def quats(self, t: Floats) -> Floats:
        """The same attitude (n, 4) at all times t (n,)."""
        return np.tile(self._quat, (len(t), 1))


class Turns(Path):
    """From level and x to the east: to +90, back, to -90 and back about body x, then y, then z, for ever."""

    hold_s, turn_s = 1.5, 3.0
    angles = np.array([0, 90, 0, -90, 0]) * DEGREE

    def quats(self, t: Floats) -> Floats:
        """Attitude (n, 4) at times t (n,) in s."""
        leg_s = self.hold_s + self.turn_s
        leg, within = np.divmod(np.maximum(t, 0.0), leg_s)
        axis, part = np.divmod(leg.astype(int) % 12, 4)
        share = smooth_step((within - self.hold_s) / self.turn_s)
        angle = self.angles[part] + share * (self.angles[part + 1] - self.angles[part])
        return quaternion.from_rotation_vector(np.eye(3)[axis] * angle[:, None])


class Aiming(Path):
    """A tool along body x is brought to one target after another and held there by a hand.

    The tremor is physiological: 8 to 12 Hz, 0.12 deg rms per axis (peaks near 0.4 deg), and the aim sways
    by 0.4 deg rms below 0.5 Hz. The hand turns the tool about a point 0.1 m behind the sensor.
    """

    move_s, hold_s, still_s, count = 2.0, 2.5, 1.5, 40
    lever = np.array([0.1, 0.0, 0.0])
    spread = np.array([10.0, 20.0, 30.0]) * DEGREE  # about body x, y, z

    def __init__(self, seed: int) -> None:
        rng = np.random.default_rng(seed)
        turns = rng.uniform(-1, 1, (self.count, 3)) * self.spread
        self._targets = quaternion.from_rotation_vector(turns)
        following = np.roll(self._targets, -1, axis=0)
        self._steps = quaternion.to_rotation_vector(quaternion.multiply(quaternion.conjugate(self._targets), following))
        self._tremor = Wander(rng, 8.0, 12.0, 0.12 * DEGREE)
        self._sway = Wander(rng, 0.05, 0.5, 0.4 * DEGREE)

    def quats(self, t: Floats) -> Floats:
        """Attitude (n, 4) at times t (n,) in s."""
        leg, within = np.divmod(np.maximum(t - self.still_s, 0.0), self.move_s + self.hold_s)
        index = leg.astype(int) % self.count
        share = smooth_step(within / self.move_s)[:, None]
        aim = quaternion.multiply(self._targets[index], quaternion.from_rotation_vector(share * self._steps[index]))
        alive = smooth_step((t - 1.0) / 1.0)[:, None]
        shake = quaternion.from_rotation_vector(alive * (self._tremor(t) + self._sway(t)))
        return quaternion.multiply(aim, shake)

    def position(self, t: Floats) -> Floats:
        """Position (n, 3) of the sensor in m, the hand being the origin, at times t (n,) in s."""
        return quaternion.rotate(self.quats(t), np.broadcast_to(self.lever, (len(t), 3)))


class Free(Path):
    """Turned over and over, so that within a minute every side has pointed up and every side north.

    The three rates were searched for even coverage (over 90 of 100 cells of the sphere) at less than 230 deg/s,
    which the slowest board's gyroscope (250 deg/s) still follows.
    """

    def __init__(self, seed: int) -> None:
        rng = np.random.default_rng(seed)
        self._spin, self._tumble, self._yaw = np.array([2.3, 0.85, 0.7]) * rng.uniform(0.99, 1.01, 3)
        self._sway = Wander(rng, 0.03, 0.15, 20 * DEGREE)

    def quats(self, t: Floats) -> Floats:
        """Attitude (n, 4) at times t (n,) in s: yaw, then tumble about y, then spin about body z."""
        clock = soft_start(t, 2.0, 2.0)
        zero = np.zeros_like(clock)
        yaw = np.stack([zero, zero, self._yaw * clock], axis=1)
        tumble = np.stack([zero, np.pi / 2 * (1 - np.cos(self._tumble * clock)), zero], axis=1)
        spin = np.stack([zero, zero, self._spin * clock], axis=1)
        outer = quaternion.multiply(quaternion.from_rotation_vector(yaw), quaternion.from_rotation_vector(tumble))
        turned = quaternion.multiply(outer, quaternion.from_rotation_vector(spin))
        sway = smooth_step((t - 2.0) / 2.0)[:, None] * self._sway(t)
        return quaternion.multiply(turned, quaternion.from_rotation_vector(sway))


_MOTIONS: dict[str, tuple[str, Callable[[int], Path]]] = {
    "hand": ("Rests until you drag it with the mouse, then follows your hand.", HandTurned),
    "rest": ("Lies still, as a board on a table.", Rest),
    "turns": ("Turns by 90 degrees to and fro about each of its axes, with holds.", lambda seed: Turns()),
    "aiming": ("A hand brings a tool to one target after another and holds it.", Aiming),
    "driving": ("A small RC car drives laps on a track of 2.4 by 1.6 m.", Driving),
    "free": ("Turned over and over, as for calibrating the magnetometer.", Free),
}
MOTIONS: dict[str, Motion] = {name: Motion(title, *_MOTIONS[name]) for name, title in MOTION_TITLES.items()}
"""Every motion by name, in the order in which they are offered."""
