"""The hand of the simulated user with the board in it, and the motion card's button under its thumb."""

from __future__ import annotations

import random
from math import exp, hypot, radians, sqrt

from imugui.fusion.scalar import NOTHING, Quat, Vector, turned_in_sensor
from imugui.targeting.activation import SHORT_S
from imugui.targeting.person import Person
from imugui.targeting.turning import turn_deg

STEADY_S, WANDER_S = 3.0, 0.5
"""Correlation times of the hand's noise: of its movements, and of holding still."""


class Hand:
    """Turns towards ``wanted`` (rotation vector from the neutral attitude, deg, board axes) as an arm does."""

    def __init__(self, person: Person, dt: float, neutral: Quat, draw: random.Random) -> None:
        self.wanted: Vector = NOTHING
        self.angles = [0.0, 0.0, 0.0]  # deg, where it is but for its noise
        self.quat = self._neutral = neutral
        self.gyr: Vector = NOTHING  # rad/s
        self._person, self._dt, self._gauss = person, dt, draw.gauss
        self._rates = [0.0, 0.0, 0.0]  # deg/s
        self._noise = [0.0, 0.0, 0.0]  # deg
        self._wander = [0.0, 0.0, 0.0]  # deg
        self._steady, self._slow = exp(-dt / STEADY_S), exp(-dt / WANDER_S)
        self._drift = person.wander_deg * sqrt(1.0 - self._slow**2)

    @property
    def back(self) -> bool:
        """At rest near its neutral attitude."""
        near = self._person.neutral_deg
        return hypot(*self.angles) < near and hypot(*self._rates) < 10.0 * near

    def jolt(self) -> None:
        """The thumb presses the button."""
        for n in range(3):
            self._noise[n] += self._gauss(0.0, self._person.jolt_deg)

    def step(self) -> None:
        """Go on by dt: a critically damped follower, with noise that grows with its speed."""
        dt, k, gauss = self._dt, self._person.arm, self._gauss
        pushed = self._person.motor * hypot(*self._rates) * sqrt(dt)
        turn = []
        for n, wanted in enumerate(self.wanted):
            self._rates[n] += dt * k * (k * (wanted - self.angles[n]) - 2.0 * self._rates[n])
            self.angles[n] += dt * self._rates[n]
            self._noise[n] = self._steady * self._noise[n] + gauss(0.0, pushed)
            self._wander[n] = self._slow * self._wander[n] + gauss(0.0, self._drift)
            turn.append(radians(self.angles[n] + self._noise[n] + self._wander[n]))
        before, self.quat = self.quat, turned_in_sensor(self._neutral, *turn)
        x, y, z = turn_deg(before, self.quat)
        self.gyr = radians(x) / dt, radians(y) / dt, radians(z) / dt


class Card:
    """The button of the motion card: a short press pans, a long one zooms, a short one stops (seed 004, 4.3)."""

    def __init__(self) -> None:
        self.status = 0
        self._held_s = 0.0

    def hold(self, dt: float) -> None:
        """The button is down for dt s more."""
        self._held_s += dt
        if self.status == 0 and self._held_s >= SHORT_S:
            self.status = 2

    def release(self) -> None:
        """The button comes up."""
        if self._held_s < SHORT_S:
            self.status = 0 if self.status else 1
        self._held_s = 0.0
