"""Turns between still positions, integrated from the gyroscope: many at once, with many trial matrices."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from imugui.calibration.positions import Stop, angle
from imugui.calibration.stillness import DEGREE, GAP_S, Floats
from imugui.fusion.quaternion import conjugate, from_rotation_vector, multiply, rotate, to_rotation_vector
from imugui.samples import Rows

SHORTEST = 20.0 * DEGREE
"""Smaller turns say little about the scale."""
INSIDE = 30
"""Rows of a still span that belong to a turn."""


@dataclass(frozen=True)
class Turn:
    """What the gyroscope read from one stop to the next, its bias at the two taken out.

    ``steps`` (n, 3) are raw rotation vectors per sample, rad; ``before`` and ``after`` the raw acceleration (3,), m/s2.
    """

    steps: Floats
    before: Floats
    after: Floats
    seconds: float

    @property
    def total(self) -> Floats:
        """The steps added up (3,), rad: the angle and axis of a turn about one axis."""
        return np.asarray(self.steps.sum(axis=0))


def turns_of(rows: Rows, stops: Sequence[Stop]) -> list[Turn]:
    """The turns between successive stops of usable rows, shape (n,); none over a gap, none smaller than 20 deg."""
    found = []
    for first, second in pairwise(stops):
        # from inside one still span to inside the next, but no farther in than needed: noise adds up there too
        reach = slice(
            max(first.span.start, first.span.stop - INSIDE), min(second.span.stop, second.span.start + INSIDE)
        )
        t, gyr = rows["t"][reach], rows["gyr"][reach]
        steps = np.diff(t)
        if len(steps) < 2 or (steps < 0).any() or (steps > GAP_S).any() or not np.isfinite(gyr).all():
            continue
        share = ((t - t[0]) / (t[-1] - t[0]))[:, None]
        rates = gyr - (first.gyr * (1 - share) + second.gyr * share)
        turn = Turn(0.5 * (rates[1:] + rates[:-1]) * steps[:, None], first.acc, second.acc, float(t[-1] - t[0]))
        if max(angle(first.acc, second.acc), float(np.linalg.norm(turn.total))) >= SHORTEST:
            found.append(turn)
    return found


def padded(turns: Sequence[Turn]) -> Floats:
    """The steps of all turns as one array (m, n, 3), the short ones filled up with no rotation."""
    longest = max(len(turn.steps) for turn in turns)
    array = np.zeros((len(turns), 1 << (longest - 1).bit_length(), 3))
    for k, turn in enumerate(turns):
        array[k, : len(turn.steps)] = turn.steps
    return array


def rotations(steps: Floats, matrix: Floats) -> Floats:
    """Attitude at the end of each turn in axes of its start, (m, 4), for steps (m, n, 3), n a power of two.

    ``matrix`` is (3, 3), or (m, 3, 3) with one for each turn.
    """
    quats = from_rotation_vector(steps @ np.swapaxes(matrix, -1, -2))
    while quats.shape[1] > 1:  # neighbours first: log2(n) products of whole arrays
        quats = multiply(quats[:, 0::2], quats[:, 1::2])
    return np.asarray(quats[:, 0])


def gravity_errors(steps: Floats, matrix: Floats, before: Floats, after: Floats) -> Floats:
    """Predicted minus seen direction of gravity after each turn, (m, 3); ``before``, ``after`` unit vectors (m, 3)."""
    return np.asarray(rotate(conjugate(rotations(steps, matrix)), before) - after)


def turned_angles(turns: Sequence[Turn], matrix: Floats) -> Floats:
    """How far each turn went as a single rotation, (m,), rad, 0 to pi."""
    return np.asarray(np.linalg.norm(to_rotation_vector(rotations(padded(turns), matrix)), axis=1))
