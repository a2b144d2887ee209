"""What a motion is: a true course of the board through the world, and where that is on the globe."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

STEP = 1e-3
"""s, half width of the central differences: error below 1e-5 m/s2 for everything a hand or a car does."""

ORIGIN_LAT, ORIGIN_LON, ORIGIN_ALT = 50.8162, 12.9294, 372.0
"""Where the virtual world's origin lies: the car park of the RC car (degrees north, degrees east, m)."""

M_PER_DEGREE = 111_320.0


class Path(ABC):
    """The true course of one board. It begins at rest at t = 0, and its rates are continuous.

    ``live``: follows a person, so the board asks for few rows ahead. ``travels``: has a place on the globe.
    """

    live = False
    travels = False

    @abstractmethod
    def quats(self, t: Floats) -> Floats:
        """True attitude (n, 4), sensor -> earth, at times t (n,) in s."""

    def position(self, t: Floats) -> Floats:
        """True position (n, 3) of the sensor, m east, north, up, at times t (n,) in s."""
        return np.zeros((len(t), 3))

    def velocity(self, t: Floats) -> Floats:
        """Velocity (n, 3), m/s in the earth frame, at times t (n,) in s."""
        velocity: Floats = (self.position(t + STEP) - self.position(t - STEP)) / (2 * STEP)
        return velocity

    def acceleration(self, t: Floats) -> Floats:
        """Linear acceleration (n, 3) without gravity, m/s2 in the earth frame, at times t (n,) in s."""
        around = self.position(t + STEP) - 2 * self.position(t) + self.position(t - STEP)
        acceleration: Floats = around / STEP**2
        return acceleration


@dataclass(frozen=True)
class Motion:
    """An entry of MOTIONS: ``start(seed)`` gives a fresh Path, equal for equal seeds."""

    title: str
    sentence: str
    start: Callable[[int], Path]


class Place(NamedTuple):
    """What a GNSS receiver says, each (n,): degrees north, degrees east, m, m/s over ground."""

    lat: Floats
    lon: Floats
    alt: Floats
    speed: Floats


def place(path: Path, t: Floats) -> Place:
    """Position and speed of a travelling path at times t (n,) in s, on a plane that touches the globe at the origin."""
    east, north, up = path.position(t).T
    velocity = path.velocity(t)
    lon = ORIGIN_LON + east / (M_PER_DEGREE * math.cos(math.radians(ORIGIN_LAT)))
    return Place(ORIGIN_LAT + north / M_PER_DEGREE, lon, ORIGIN_ALT + up, np.hypot(velocity[:, 0], velocity[:, 1]))
