"""A block of samples of the self-calibrating filter: buffered as they come, summed at its end.

A sample is a dozen numbers and not worth numpy; a block of 50 ms is summed in a few array steps.
"""

from __future__ import annotations

from array import array
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from imugui.fusion.quaternion import Floats
from imugui.fusion.scalar import Quat

WIDTH = 13  # numbers of a buffered sample: gyr, acc, 1, quat, dt, time since the block began
FIELD_WIDTH = 4  # time and mag
REMEMBERED = 0.1  # s, for which rotations are kept: the longest delay of a magnetometer
FAST = 3.4  # rad/s (200 deg/s), a gyroscope that is clipped reads at least this
TINY = 1e-9  # s, two samples at the same time
STRONG = 15.0  # m/s2, the same for an accelerometer


def _quadratic() -> Floats:
    """K of shape (16, 9) with R = (q outer q) K, both flattened row by row."""
    k = np.zeros((4, 4, 3, 3))
    for row, column, terms in (
        (0, 0, "+ww +xx -yy -zz"), (0, 1, "+xy +xy -wz -wz"), (0, 2, "+xz +xz +wy +wy"),
        (1, 0, "+xy +xy +wz +wz"), (1, 1, "+ww -xx +yy -zz"), (1, 2, "+yz +yz -wx -wx"),
        (2, 0, "+xz +xz -wy -wy"), (2, 1, "+yz +yz +wx +wx"), (2, 2, "+ww -xx -yy +zz"),
    ):  # fmt: skip
        for term in terms.split():
            k["wxyz".index(term[1]), "wxyz".index(term[2]), row, column] += 1.0 if term[0] == "+" else -1.0
    return k.reshape(16, 9)


TO_ROTATION = _quadratic()
FROM_QUATS = np.ascontiguousarray(TO_ROTATION.T)


@dataclass
class Field:
    """The mean field of a block, in earth axes as the attitude had it when it was measured."""

    mean: Floats  # (3,), uT
    speed: Floats  # (3,), uT/s: how fast the mean would turn were the delay longer
    norm: float  # uT


@dataclass
class Sums:
    """What a block amounts to; sensor quantities are summed over time in earth axes."""

    time: float  # T, s
    force: Floats  # (3,), sum R a dt, m/s
    rotation: Floats  # (3, 3), sum R dt, s
    by_matrix: Floats  # (3, 9), sum R_ij w_k dt: the turn of the attitude for each element of the gyroscope matrix
    mean_rate: Floats  # (3,), mean w, rad/s
    turning: float  # sum |w|^2 dt, rad2/s
    clipped: bool  # a sensor has reached the end of its range
    field: Field | None  # None when no field was measured


class Block:
    """Buffers samples, and remembers past rotations because the magnetometer's values come late."""

    def __init__(self, delay: float = 0.0) -> None:
        self.delay = delay  # s, of the magnetometer
        self.time = 0.0  # s, so far
        self._samples = array("d")
        self._fields = array("d")
        self._past_times: Floats = np.zeros(0)  # s, at most 0: before this block
        self._past: Floats = np.zeros((0, 9))  # the rotations then, row by row
        self._top_gyr, self._top_acc = FAST, STRONG  # largest readings so far

    def add(self, gyr: Sequence[float], acc: Sequence[float], quat: Quat, dt: float) -> None:
        """Take one sample (rad/s, m/s2) with the attitude at its end, ``dt`` s after the sample before."""
        self.time = time = self.time + dt
        self._samples.extend((*gyr, *acc, 1.0, *quat, dt, time))

    def add_field(self, mag: Sequence[float]) -> None:
        """Take the field (uT, sensor axes) that came with the last sample."""
        self._fields.extend((self.time, *mag))

    def sums(self, full_scale: float = 0.0) -> Sums:
        """The sums so far; call once, then ``clear``. ``full_scale`` of the gyroscope in rad/s, 0 when unknown."""
        samples = np.frombuffer(self._samples).reshape(-1, WIDTH)
        quats, dt, gyr = samples[:, 7:11], samples[:, 11], samples[:, :3]
        products = (quats[:, :, None] * quats[:, None, :]).reshape(-1, 16)
        summed = (FROM_QUATS @ ((products * dt[:, None]).T @ samples[:, :7])).reshape(3, 3, 7)
        return Sums(
            time=self.time,
            force=summed[:, :, 3:6].trace(axis1=1, axis2=2),
            rotation=summed[:, :, 6],
            by_matrix=summed[:, :, :3].reshape(3, 9),
            mean_rate=gyr.sum(axis=0) / len(gyr),
            turning=float(((gyr * gyr) * dt[:, None]).sum()),
            clipped=self._clipped(gyr, samples[:, 3:6], full_scale),
            field=self._field(samples[:, 12], products @ TO_ROTATION),
        )

    def _clipped(self, gyr: Floats, acc: Floats, full_scale: float) -> bool:
        """Does a sensor read its full scale, or twice in a row exactly the largest value it ever gave?"""
        fast, strong = float(np.abs(gyr).max()), float(np.abs(acc).max())
        known = 0.0 < 0.99 * full_scale <= fast
        repeats = (fast >= self._top_gyr and _repeats(gyr, fast)) or (strong >= self._top_acc and _repeats(acc, strong))
        self._top_gyr, self._top_acc = max(fast, self._top_gyr), max(strong, self._top_acc)
        return known or repeats

    def _field(self, times: Floats, rotations: Floats) -> Field | None:
        """The mean field in earth axes, each turned with the attitude ``delay`` seconds before it came."""
        times = np.concatenate((self._past_times, times))
        rotations = np.concatenate((self._past, rotations))
        first = int(times.searchsorted(self.time - REMEMBERED))
        self._past_times, self._past = times[first:] - self.time, rotations[first:]
        if not self._fields:
            return None
        fields = np.frombuffer(self._fields).reshape(-1, FIELD_WIDTH)
        mags = fields[:, 1:]
        turned, turning = _at(fields[:, 0] - self.delay, times, rotations)
        norm = float(np.sqrt((mags * mags).sum(axis=1)).mean())
        return Field(_mean_product(turned, mags), _mean_product(turning, mags), norm)

    def clear(self, turn: Floats | None = None) -> None:
        """Begin the next block; remembered rotations are turned by the matrix ``turn``, or forgotten without one."""
        self.time = 0.0
        del self._samples[:], self._fields[:]
        if turn is None:
            self._past_times, self._past = self._past_times[:0], self._past[:0]
        else:
            self._past = (turn @ self._past.reshape(-1, 3, 3)).reshape(-1, 9)

    def state(self) -> dict[str, Any]:
        """Everything that the next sums depend on, as plain numbers and lists."""
        return {
            "delay": self.delay,
            "time": self.time,
            "samples": self._samples.tolist(),
            "fields": self._fields.tolist(),
            "past_times": self._past_times.tolist(),
            "past": self._past.tolist(),
            "tops": [self._top_gyr, self._top_acc],
        }

    def restore(self, state: dict[str, Any]) -> None:
        """Continue from ``state``."""
        self.delay, self.time = state["delay"], state["time"]
        self._samples, self._fields = array("d", state["samples"]), array("d", state["fields"])
        self._past_times = np.array(state["past_times"], float)
        self._past = np.array(state["past"], float).reshape(-1, 9)
        self._top_gyr, self._top_acc = state["tops"]


def _repeats(values: Floats, largest: float) -> bool:
    """Is the largest value (n, 3) there twice in a row?"""
    at_end = (np.abs(values[1:]) == largest) & (values[1:] == values[:-1])
    return bool(at_end.any())


def _at(wanted: Floats, times: Floats, rotations: Floats) -> tuple[Floats, Floats]:
    """Rotations (n, 9) at the wanted times and their change per s, from those (m, 9) at rising times (m,)."""
    if len(times) < 2:
        return np.repeat(rotations, len(wanted), axis=0), np.zeros((len(wanted), 9))
    after = np.minimum(np.maximum(times.searchsorted(wanted), 1), len(times) - 1)
    before = after - 1
    start, first = times[before], rotations[before]
    span = np.maximum(times[after] - start, TINY)
    turning = (rotations[after] - first) / span[:, None]
    share = np.minimum(np.maximum(wanted - start, 0.0), span)
    return first + share[:, None] * turning, turning


def _mean_product(matrices: Floats, vectors: Floats) -> Floats:
    """The mean (3,) of matrices (n, 9), row by row, times vectors (n, 3)."""
    # not einsum: the order of its sums, and so the last digit, may depend on where the arrays lie in memory
    products = matrices * np.concatenate((vectors, vectors, vectors), axis=1)
    return np.asarray((products.sum(axis=0) / len(vectors)).reshape(3, 3).sum(axis=1))
