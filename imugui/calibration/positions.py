"""The still positions of a session: found by themselves, named by the side that points up."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np

from imugui.calibration.stillness import DEGREE, IN_POSITION, Floats, Span, rate_of, still_spans
from imugui.samples import Rows

EDGE_S = 0.1  # s left out at both ends of a still span, where the hand lets go and takes hold
SAME = 5.0 * DEGREE
"""Positions nearer than this are one (reference: 16 positions from 38 still intervals)."""
FACE = 25.0 * DEGREE
"""A face is up when its axis is at most this far from the vertical; hand-held faces were 3 to 16 deg off."""

FACES: dict[str, tuple[int, int]] = {
    "x up": (0, 1),
    "x down": (0, -1),
    "y up": (1, 1),
    "y down": (1, -1),
    "z up": (2, 1),
    "z down": (2, -1),
}
"""Every face: its axis and the sign of that axis' reading."""


@dataclass(frozen=True)
class Stop:
    """One still span: mean raw acceleration (3,) m/s2 and rate (3,) rad/s (NaN without gyroscope)."""

    span: Span
    acc: Floats
    gyr: Floats
    seconds: float


@dataclass(frozen=True)
class Position:
    """One attitude, from all its stops: mean raw acceleration (3,) m/s2, time still and number of samples."""

    acc: Floats
    seconds: float
    samples: int

    @property
    def direction(self) -> Floats:
        """Unit vector (3,), sensor axes, that points up."""
        return np.asarray(self.acc / max(1e-9, float(np.linalg.norm(self.acc))))

    @property
    def face(self) -> str:
        """The key of FACES that is up, or nothing."""
        return face_of(self.acc)


def stops_of(rows: Rows) -> list[Stop]:
    """Every still span of usable raw SAMPLE rows, shape (n,), in order."""
    rate = rate_of(rows)
    return [_stop(rows, span, round(EDGE_S * rate)) for span in still_spans(rows, IN_POSITION)]


def positions_of(stops: Sequence[Stop]) -> list[Position]:
    """The different attitudes among the stops; those nearer than 5 deg to a mean are averaged into it, by time."""
    found: list[Position] = []
    for stop in stops:
        near = [k for k, old in enumerate(found) if angle(old.acc, stop.acc) < SAME]
        samples = stop.span.stop - stop.span.start
        if not near:
            found.append(Position(stop.acc, stop.seconds, samples))
            continue
        old = found[near[0]]
        seconds = old.seconds + stop.seconds
        acc = (old.acc * old.seconds + stop.acc * stop.seconds) / seconds
        found[near[0]] = Position(acc, seconds, old.samples + samples)
    return found


def angle(a: Floats, b: Floats) -> float:
    """The angle between two vectors (3,), rad."""
    ax, ay, az = a.tolist()
    bx, by, bz = b.tolist()  # plain numbers: numpy's own cross product takes a hundred times longer for one pair
    across = math.hypot(ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx)
    return math.atan2(across, ax * bx + ay * by + az * bz)


def face_of(acc: Floats) -> str:
    """The face that is up for a raw acceleration (3,), m/s2; nothing in between faces."""
    axis = int(np.abs(acc).argmax())
    if abs(acc[axis]) < np.cos(FACE) * max(1e-9, float(np.linalg.norm(acc))):
        return ""
    return next(name for name, (k, sign) in FACES.items() if k == axis and sign == np.sign(acc[axis]))


def missing_faces(positions: Sequence[Position]) -> list[str]:
    """The faces that were not up yet."""
    held = {position.face for position in positions}
    return [name for name in FACES if name not in held]


def between_faces() -> tuple[Floats, list[str]]:
    """The 12 edges and 8 corners: unit vectors (20, 3) that point up, and their names."""
    ways = [np.array(signs, float) for signs in product((1, 0, -1), repeat=3) if np.count_nonzero(signs) >= 2]
    return np.array([way / np.linalg.norm(way) for way in ways]), [_between_words(way) for way in ways]


def farthest_between(positions: Sequence[Position], count: int) -> list[str]:
    """The ``count`` edges and corners that lie farthest from all positions held, in words."""
    ways, names = between_faces()
    taken = [position.direction for position in positions] + [np.eye(3)[k] * sign for k, sign in FACES.values()]
    words = []
    for _ in range(min(count, len(ways))):
        best = max(range(len(ways)), key=lambda k: min(angle(ways[k], old) for old in taken))
        taken.append(ways[best])
        words.append(names[best])
    return words


def _stop(rows: Rows, span: Span, edge: int) -> Stop:
    edge = min(edge, (span.stop - span.start) // 4)
    inner = rows[span.start + edge : span.stop - edge]
    seconds = float(inner["t"][-1] - inner["t"][0])
    return Stop(span, inner["acc"].mean(axis=0), inner["gyr"].mean(axis=0), seconds)


def _between_words(way: Floats) -> str:
    sides = [f"{'+' if part > 0 else '-'}{axis}" for axis, part in zip("xyz", way, strict=True) if part]
    kind = "the edge between" if len(sides) == 2 else "the corner of"
    return f"{kind} {', '.join(sides[:-1])} and {sides[-1]} up"
