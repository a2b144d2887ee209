"""ToolHand: a hand that brings a tool where it is told, twirls it, and trembles."""

from __future__ import annotations

import numpy as np

from imugui.fusion import quaternion
from imugui.simulation.curves import Wander, smooth_step
from imugui.simulation.hand import HandTurned
from imugui.simulation.path import Floats

DEGREE = np.pi / 180
TREMOR_HZ, TREMOR = (8.0, 12.0), 0.12 * DEGREE
SWAY_HZ, SWAY = (0.05, 0.5), 0.2 * DEGREE
TWIRL_HZ = (0.05, 0.25)
LEVER_M = 0.1
"""How far along the tool the sensor is from the wrist."""


class ToolHand(HandTurned):
    """Follows ``turn_to`` as HandTurned does; the tool is ``axis`` in body axes, about which it is twirled.

    Tremor (8 to 12 Hz, 0.12 deg rms per axis) and sway (below 0.5 Hz, 0.2 deg rms) begin after ``still_s``, and so
    does the twirl, of ``twirl`` rad rms to and fro. The wrist is the centre, so the sensor feels the tremor's
    acceleration. Nothing of this is known to ``wanted``.
    """

    still_s = 4.0

    def __init__(self, seed: int = 0, axis: tuple[float, float, float] = (1.0, 0.0, 0.0), twirl: float = 1.0) -> None:
        super().__init__(seed)
        rng = np.random.default_rng(seed)
        self.axis: Floats = np.array(axis)
        self._tremor = Wander(rng, *TREMOR_HZ, TREMOR)
        self._sway = Wander(rng, *SWAY_HZ, SWAY)
        self._twirl = Wander(rng, *TWIRL_HZ, twirl)
        self._spun = 0.0  # rad, by what was asked before
        self._spinning = (0.0, 0.0, 1.0)  # rad, from s, for s
        self._places: Floats = np.zeros((0, 3))  # of the two rows before, m
        self._made: Floats = np.zeros((0, 4))
        self._before = -1.0  # s, time of the row before

    def spin(self, angle: float, seconds: float) -> None:
        """Turn the tool about its own axis by so many rad, from now on and evenly but for soft ends."""
        self._spun += self._spinning[0]
        self._spinning = (angle, self._t, seconds)

    def _spin_angle(self, t: Floats) -> Floats:
        angle, begin, seconds = self._spinning
        return np.asarray(self._spun + angle * smooth_step((np.asarray(t) - begin) / seconds))

    def quats(self, t: Floats) -> Floats:
        """Attitude (n, 4) at times t (n,) in s, which must go on where the last call ended."""
        alive = smooth_step((np.asarray(t) - self.still_s) / 2.0)[:, None]
        twirled = (alive * self._twirl(t)[:, :1] + self._spin_angle(t)[:, None]) * self.axis
        shaken = alive * (self._tremor(t) + self._sway(t))
        steady = quaternion.multiply(super().quats(t), quaternion.from_rotation_vector(twirled))
        self._made = quaternion.multiply(steady, quaternion.from_rotation_vector(shaken))
        return self._made

    def acceleration(self, t: Floats) -> Floats:
        """Linear acceleration (n, 3), m/s2 in the earth frame, of the rows made last; one row late."""
        places = quaternion.rotate(self._made, LEVER_M * self.axis)
        if len(self._places) == 0:
            self._places = places[[0, 0]]
        course = np.concatenate([self._places, places])
        self._places = course[-2:]
        spacing, self._before = (float(t[-1]) - self._before) / len(t), float(t[-1])
        acceleration: Floats = (course[2:] - 2 * course[1:-1] + course[:-2]) / spacing**2
        return acceleration
