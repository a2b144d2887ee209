"""Stream: the newest attitudes, and what they say about steadiness, disturbance and the age of the heading."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from imugui.fusion.quaternion import Floats, angle_between, length, rotate
from imugui.guidance.facts import Facts
from imugui.guidance.hold import GAP_S, HOLD_S
from imugui.guidance.turning import Turning
from imugui.samples import ATTITUDE, GRAVITY, Rows, empty_rows

KEEP_S = 2.0
LOST_S = 0.25
"""s without a sample after which nobody knows how far the tool was turned meanwhile."""
HALF_S = 0.25
"""The rate is that of the mean direction from one such span to the next: a tremor of 8 to 12 Hz averages out."""
SHAKEN = 0.7
"""m/s2 of acceleration, mean over HOLD_S: 4 degrees in the direction of gravity, of which a filter with a time
constant of 3 s takes up some tenths of a degree."""
HELD = math.radians(3.0)
"""A tool that was turned no farther since was held."""
NOT_UNIT = 0.01
UNSTATED = (0.0, 0.0)
"""rad, 1 sigma of tilt and heading of a filter that has said nothing since the registration."""
UNRESTED_DRIFT = math.radians(0.1)
"""rad/s; before it has seen the board at rest a filter knows the gyroscope's bias this well (VQF's own figure)."""
WARM_DRIFT = math.radians(0.02) / math.sqrt(3.0)
"""rad/s per K, 1 sigma: the bias moves by up to 0.02 deg/s per K (MPU-9250) from where it was at rest."""
WARM_UP_K, WARM_UP_S = 4.0, 120.0
"""Without a thermometer the board is taken for one that was just switched on: so much warmer, in this time constant."""


class Stream:
    """Takes attitudes as they come. What is kept is unbroken: a bad row, a gap or a missed row begins it anew.

    ``lost``: why the heading no longer follows from that at ``mark``, one sentence, or empty.
    """

    def __init__(self, tool_axis: ArrayLike) -> None:
        self.tool_axis = np.asarray(tool_axis, float)
        self.rows: Rows = empty_rows(ATTITUDE, 0)
        self.directions: Floats = np.zeros((0, 3))  # of the tool, in the earth frame
        self.first = 0  # attitude number of rows[0]
        self.lost = ""
        self._turning = Turning()
        self._next = 0  # number of the attitude to come
        self._torn = False  # the newest row was not usable
        self._stated = UNSTATED
        self._held_tilt = math.nan  # rad, the least sigma_tilt
        self._growth = 0.0  # rad/s, of sigma_heading when the tool was held last
        self._t = math.nan
        self._arrival = math.nan
        self._rest_t = math.nan  # s, when the filter last saw the board at rest
        self._rest_temp_c = math.nan

    @property
    def way(self) -> Floats:
        """Where the tool points now, (3,) in the earth frame."""
        return np.asarray(self.directions[-1])

    def set_tool_axis(self, axis: ArrayLike) -> None:
        """Follow another axis (3,) of the box."""
        self.tool_axis = np.asarray(axis, float)
        self.directions = rotate(self.rows["quat"], self.tool_axis)

    def push(self, rows: Rows, first_number: int) -> tuple[int, bool]:
        """Take ATTITUDE rows (n,), the first having this number: (how many of the kept ones are new, was it broken)."""
        if len(rows) == 0:
            return 0, False
        good = _usable(rows)
        self._note_loss(rows["t"][good], first_number)
        self._turning.step(rows["quat"][good])
        rests = rows["t"][good & rows["rest"]]
        self._rest_t = float(rests[-1]) if len(rests) else self._rest_t
        arrivals = rows["t_arrival"][good]
        if len(arrivals) and np.isfinite(arrivals[-1]):
            self._arrival = float(arrivals[-1])
        begin = _unbroken(rows, good)
        joins = begin == 0 and first_number == self._next and len(self.rows) > 0 and not self._torn
        joins = joins and 0.0 <= rows["t"][0] - self.rows["t"][-1] <= GAP_S
        self._next, self._torn = first_number + len(rows), begin == len(rows)
        if self._torn:
            return 0, True  # what was good last stays to be seen while it ages
        self._keep(rows[begin:], first_number + begin, joins)
        return min(len(rows) - begin, len(self.rows)), not joins

    def _keep(self, rows: Rows, number: int, joins: bool) -> None:
        ways = rotate(rows["quat"], self.tool_axis)
        if joins:
            rows, ways, number = np.concatenate((self.rows, rows)), np.concatenate((self.directions, ways)), self.first
        old = int(np.searchsorted(rows["t"], rows["t"][-1] - KEEP_S))
        self.rows, self.directions, self.first = rows[old:], ways[old:], number + old

    def _note_loss(self, t: Floats, number: int) -> None:
        """Look for time that nobody saw: between the rows, and since the block before."""
        if len(t) == 0:
            return
        missed = max(0, number - self._next)  # rows that were there but not handed over
        steps = np.diff(t, prepend=self._t)
        steps[0] /= missed + 1
        gap = float(np.max(np.nan_to_num(steps)))
        if gap > LOST_S:
            self.lost = f"Samples of {gap:.1f} s are missing since the registration. Register again."
        elif np.any(steps < -LOST_S) or number < self._next:
            self.lost = "The stream has begun anew since the registration. Register again."
        self._t = float(t[-1])

    def mark(self) -> None:
        """The heading is registered now: errors of it count from here."""
        self.lost, self._stated = "", UNSTATED
        self._held_tilt, self._growth = math.nan, 0.0
        self._turning.reset()

    def fill(self, facts: Facts) -> Facts:
        """The facts with what the attitudes say."""
        if len(self.rows) and self.rows["rest"][-1]:
            self._rest_temp_c = facts.temp_c
        recent = self.recent(HOLD_S)
        tilt, heading = self._state()
        return replace(
            facts,
            arrival=facts.arrival if math.isnan(self._arrival) else self._arrival,
            epoch_words=facts.epoch_words or self.lost,
            drift=self._drift(facts),
            turning=facts.turning if facts.relative else self._turning.size,
            mag_disturbed=facts.mag_disturbed or bool(recent["disturbed"].any()),
            shaken=facts.shaken or (not facts.relative and pushed(recent)),
            sigma_tilt=tilt,
            sigma_heading=heading,
            heading_before=self._stated[1],
            heading_growth=max(facts.drift, self._growth),
            held_tilt=self._held_tilt,
        )

    def _state(self) -> tuple[float, float]:
        """1 sigma of tilt and heading as the filter says them, rad, NaN: it does not.

        A filter that has fallen silent since the registration is as little sure of the tilt as it was.
        """
        if len(self.rows) == 0:
            return math.nan, math.nan
        tilt, heading = self.rows[["sigma_tilt", "sigma_heading"]][-1].tolist()
        if not math.isnan(tilt + heading):
            self._stated = (tilt, heading)
            self._held_tilt = min(tilt, self._held_tilt)  # the first is less than NaN
            self._growth = growth(self.rows, self._growth)
        elif self._stated is not UNSTATED:
            tilt = self._stated[0]
        return tilt, heading

    def _drift(self, facts: Facts) -> float:
        """1 sigma in rad/s of the heading's drift now, from that soon after a rest; of two boards, of both."""
        boards = math.sqrt(2.0) if facts.relative else 1.0
        if math.isnan(self._rest_t):
            return max(facts.drift, boards * UNRESTED_DRIFT)
        warmer = abs(facts.temp_c - self._rest_temp_c)
        if math.isnan(warmer):
            warmer = WARM_UP_K * -math.expm1((self._rest_t - self._t) / WARM_UP_S)
        return math.hypot(facts.drift, boards * WARM_DRIFT * warmer)

    def recent(self, seconds: float) -> Rows:
        """The rows of the last so many seconds, as far as they are unbroken; at most KEEP_S."""
        return self.rows[self._from(len(self.rows) - 1, seconds) :] if len(self.rows) else self.rows

    def rates(self, n: int) -> Floats:
        """How fast the tool's axis moved at each of the last n rows, (n,), rad/s; NaN where that is not known yet."""
        sums = np.concatenate((np.zeros((1, 3)), np.cumsum(self.directions, axis=0)))
        t, found = self.rows["t"], np.full(n, np.nan)
        for place, end in enumerate(range(len(t) - n, len(t))):
            middle, start = self._from(end, HALF_S), self._from(end, 2 * HALF_S)
            if t[end] - t[0] < 2 * HALF_S or middle == start:
                continue
            newer = (sums[end + 1] - sums[middle]) / (end + 1 - middle)
            older = (sums[middle] - sums[start]) / (middle - start)
            found[place] = np.linalg.norm(newer - older) / HALF_S
        return found

    def _from(self, end: int, seconds: float) -> int:
        """The first row not earlier than so many seconds before row ``end``."""
        return int(np.searchsorted(self.rows["t"], self.rows["t"][end] - seconds - 1e-9))


def _usable(rows: Rows) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """Rows with a time, a unit quaternion and a sample that was really there."""
    finite = np.isfinite(rows["t"]) & np.isfinite(rows["acc"]).all(axis=1) & np.isfinite(rows["gyr"]).all(axis=1)
    return np.asarray(finite & (np.abs(length(rows["quat"]) - 1.0) < NOT_UNIT))


def _unbroken(rows: Rows, good: np.ndarray[tuple[int], np.dtype[np.bool_]]) -> int:
    """The number of rows up to the last break in a block: a bad row, or a gap before a row."""
    steps = np.diff(rows["t"], prepend=rows["t"][0])
    after_bad = np.flatnonzero(~good)
    after_gap = np.flatnonzero(good & ~((steps >= 0.0) & (steps <= GAP_S)))
    return int(max(after_bad[-1] + 1 if len(after_bad) else 0, after_gap[-1] if len(after_gap) else 0))


def growth(rows: Rows, before: float) -> float:
    """By how much sigma_heading, which is known now, grew in ATTITUDE rows (n,) since it was least, rad/s.

    ``before``: what holds where the tool was turned in them, which makes it grow and shrink, or where they are few.
    """
    sigmas = rows["sigma_heading"]
    least = int(np.nanargmin(sigmas))
    seconds = float(rows["t"][-1] - rows["t"][least])
    if seconds < 2 * HALF_S or float(angle_between(rows["quat"][least], rows["quat"][-1])) > HELD:
        return before
    return float(sigmas[-1] - sigmas[least]) / seconds


def pushed(rows: Rows) -> bool:
    """Whether the mean specific force of a board's own ATTITUDE rows (n,), earth axes, is not gravity's alone."""
    if len(rows) == 0 or rows["t"][-1] - rows["t"][0] < HALF_S:
        return False
    force = rotate(rows["quat"], rows["acc"]).mean(axis=0) - (0.0, 0.0, GRAVITY)
    return bool(np.linalg.norm(force) > SHAKEN)
