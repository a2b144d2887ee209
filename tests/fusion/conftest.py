"""Ideal rows for fusion tests: what perfect sensors read along a known motion."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from imugui.fusion.attitude import from_euler, gravity
from imugui.fusion.quaternion import Floats, conjugate, multiply, rotate, to_rotation_vector
from imugui.samples import SAMPLE, Rows, empty_rows

FIELD = (0.0, 20.0, -43.0)  # uT, earth axes: 47.4 uT, dip 65 degrees

IdealRows = Callable[..., tuple[Rows, Floats]]


def sensed(t: Floats, quats: Floats, mag_every: int = 1) -> Rows:
    """Rows (n,) of perfect sensors with the attitudes (n, 4) at the times t (n,); the field held for some rows."""
    rows = empty_rows(SAMPLE, len(t))
    rows["t"] = t
    turns = to_rotation_vector(multiply(conjugate(quats[:-1]), quats[1:]))
    rows["gyr"] = np.concatenate((np.zeros((1, 3)), turns / np.maximum(np.diff(t), 1e-12)[:, None]))
    rows["acc"] = gravity(quats)
    measured = np.arange(len(t)) // mag_every * mag_every
    rows["mag"] = rotate(conjugate(quats), FIELD)[measured]
    return rows


def tumbling(t: Floats) -> Floats:
    """A smooth motion through all directions, upside down too; it starts at yaw 40, pitch 11, roll -23 degrees."""
    yaw = 0.7 + 1.5 * np.sin(0.4 * t) + 0.3 * t
    return from_euler(yaw, 0.2 + 0.9 * np.sin(0.7 * t), -0.4 + 2.0 * np.sin(0.31 * t))


@pytest.fixture
def ideal_rows() -> IdealRows:
    """``ideal_rows(t, mag_every=1, motion=tumbling)`` -> (rows, true attitudes)."""

    def make(t: Floats, mag_every: int = 1, motion: Callable[[Floats], Floats] = tumbling) -> tuple[Rows, Floats]:
        quats = motion(t)
        return sensed(t, quats, mag_every), quats

    return make
