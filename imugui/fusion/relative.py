"""The attitude of one board in the frame of another: a tool against a bone, a clamp or the other hand.

    q_rel(t) = q_ref(t)^-1 h q_tool(t)

Each sample of the tool gives one row. The reference's attitude at that moment lies between two of its samples, and is
taken from the shortest turn between them. Nothing is extrapolated: a tool's sample waits until the reference has one
after it, so a reference that stands still gives a result that stands still. Reference samples more than BRIDGE_S apart
are not bridged; the tool's samples between them are left out and counted.

h turns about the vertical. Without a magnetometer each filter has a heading of its own; then h is what the user
measured by holding the two boards the same way round (``align``). With a magnetometer on both it is the identity.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from imugui.fusion.quaternion import IDENTITY, Floats, conjugate, multiply, rotate, slerp
from imugui.fusion.scalar import Quat
from imugui.fusion.timing import LineFit
from imugui.samples import ATTITUDE, Rows, empty_rows

BRIDGE_S = 0.1
"""Between reference samples farther apart than this its attitude is not known."""
KEEP_S = 2.0
"""A tool's sample waits so long for the reference, and so much of the reference is kept."""
EARLY_S, LATE_S = 0.25, 2.0
"""An arrival that much before or after its time: the sample times began anew."""


@dataclass(frozen=True)
class Alignment:
    """What was found when the two boards were held the same way round.

    ``heading``: h. ``zero``: the relative attitude that was left then, and is shown as zero. ``residual``: the angle
    of that, rad: how differently the boards were held, or are mounted, apart from the heading.
    """

    heading: Quat = IDENTITY
    zero: Quat = IDENTITY
    residual: float = 0.0


UNALIGNED = Alignment()


class HostTime:
    """A board's sample times on the host's clock, by a line through when what arrived: a device's clock runs freely."""

    def __init__(self) -> None:
        self._fit = LineFit()
        self._t = math.nan  # of the newest row, by its own clock

    def convert(self, rows: Rows) -> Floats:
        """Host time in s, (n,), of SAMPLE or ATTITUDE rows (n,) in order, those of one arrival not torn apart."""
        times = np.empty(len(rows))
        ends = np.flatnonzero(np.diff(rows["t_arrival"], append=np.nan) != 0.0) + 1
        start = 0
        for end in ends.tolist():
            times[start:end] = self._arrived(rows["t"][start:end], float(rows["t_arrival"][end - 1]))
            start = end
        return times

    def _arrived(self, t: Floats, arrival: float) -> Floats:
        newest = float(t[-1])
        late = arrival - self._fit.at(newest) if self._fit.settled else 0.0
        if not (newest > self._t and -EARLY_S < late < LATE_S):
            self._fit = LineFit()
        self._t = newest
        self._fit.add(newest, arrival)
        if not self._fit.settled:
            return arrival + (t - newest)
        return self._fit.at(newest) + self._fit.period * (t - newest)


class Track:
    """Rows of one board in the order of their host times."""

    def __init__(self) -> None:
        self.rows: Rows = empty_rows(ATTITUDE, 0)
        self.times: Floats = np.zeros(0)
        self.newest = -math.inf  # host time of all that ever came
        self._host = HostTime()

    def push(self, rows: Rows) -> None:
        """Take new ATTITUDE rows (n,); those without a time or an attitude are left out."""
        rows = rows[np.isfinite(rows["t"]) & np.isfinite(rows["t_arrival"]) & np.isfinite(rows["quat"]).all(axis=1)]
        if len(rows) == 0:
            return
        # the line moves a little while it is fitted; what came later is not earlier for that
        times = np.maximum.accumulate(np.maximum(self._host.convert(rows), self.newest))
        self.rows, self.times = np.concatenate((self.rows, rows)), np.concatenate((self.times, times))
        self.newest = float(times[-1])

    def take(self, until: float) -> tuple[Rows, Floats]:
        """Rows and host times before this time, s; they are given out once."""
        n = int(np.searchsorted(self.times, until))
        taken = self.rows[:n], self.times[:n]
        self.rows, self.times = self.rows[n:], self.times[n:]
        return taken


class Relative:
    """Takes the ATTITUDE rows of both boards as they come.

    The result does not depend on how the rows are cut into blocks, as long as neither board is late by KEEP_S.
    """

    def __init__(self) -> None:
        self.alignment = UNALIGNED
        self.dropped = 0  # rows of the tool for which the reference's attitude was not known
        self.newest: tuple[Floats, Floats] | None = None  # attitudes (4,) of reference and tool at one moment
        self._tool, self._reference = Track(), Track()

    def step(self, tool: Rows, reference: Rows) -> Rows:
        """The relative ATTITUDE rows (n,) that are complete with these rows: see ``against``."""
        self._tool.push(tool)
        self._reference.push(reference)
        rows, times = self._tool.take(max(self._reference.newest, self._tool.newest - KEEP_S))
        after, share, known = bracket(self._reference.times, times)
        self.dropped += len(rows) - int(known.sum())
        rows, after, share = rows[known], after[known], share[known]
        out = empty_rows(ATTITUDE, 0)
        if len(rows):
            before, behind = self._reference.rows[after - 1], self._reference.rows[after]
            q_ref = slerp(before["quat"], behind["quat"], share)
            out = against(rows, q_ref, before, behind, share, self.alignment)
            self.newest = q_ref[-1], rows["quat"][-1]
        self._reference.take(self._reference.newest - KEEP_S)
        return out


def bracket(track: Floats, times: Floats) -> tuple[NDArray[np.intp], Floats, NDArray[np.bool_]]:
    """Where ``times`` (n,) lie in rising ``track`` (m,), s: (row after, share of the way, is it known), (n,) each.

    Known is what lies between two times no farther apart than BRIDGE_S.
    """
    if len(track) < 2:
        return np.zeros(len(times), np.intp), np.zeros(len(times)), np.zeros(len(times), np.bool_)
    after = np.clip(np.searchsorted(track, times), 1, len(track) - 1)
    start, end = track[after - 1], track[after]
    span = end - start
    known = (times >= start) & (times <= end) & (span <= BRIDGE_S + 1e-9)
    share = np.where(known, (times - start) / np.where(span > 0.0, span, 1.0), 0.0)
    return after, share, known


def against(tool: Rows, q_ref: Floats, before: Rows, behind: Rows, share: Floats, alignment: Alignment) -> Rows:
    """ATTITUDE rows (n,) of a tool in the frame of a reference, whose attitudes (n, 4) lie between two of its rows.

    ``quat`` and ``local`` are tool -> reference, ``local`` from the alignment's zero; ``gyr`` is the rate against the
    reference, in the tool's axes. ``acc``, ``mag``, ``bias``, ``t`` and ``status`` are the tool's own. At rest means
    both, disturbed means either; sigmas are of both together (NaN where one is not known); the arrival is the older.
    """
    out = tool.copy()
    out["quat"] = relative_quat(tool["quat"], q_ref, alignment.heading)
    out["local"] = multiply(conjugate(alignment.zero), out["quat"])
    turning = before["gyr"] + share[:, None] * (behind["gyr"] - before["gyr"])
    out["gyr"] = tool["gyr"] - rotate(conjugate(out["quat"]), turning)
    out["rest"] &= before["rest"] & behind["rest"]
    out["disturbed"] |= before["disturbed"] | behind["disturbed"]
    for name in ("sigma_tilt", "sigma_heading"):
        out[name] = np.hypot(tool[name], behind[name])
    out["t_arrival"] = np.minimum(tool["t_arrival"], behind["t_arrival"])
    return out


def relative_quat(tool: ArrayLike, reference: ArrayLike, heading: ArrayLike = IDENTITY) -> Floats:
    """Attitudes tool -> reference, (..., 4), of two boards' attitudes to the earth; ``heading``: h."""
    return multiply(conjugate(reference), multiply(heading, tool))


def align(tool: ArrayLike, reference: ArrayLike, same_north: bool) -> Alignment:
    """The alignment of two boards held the same way round now; attitudes (4,) to the earth. ``same_north``: h is known.

    h is the turn about the vertical that brings the tool nearest to the reference. The angle of q_ref^-1 h q_tool is
    that of h a with a = q_tool q_ref^-1, whose cosine, cos(psi/2) a_w - sin(psi/2) a_z, is largest at
    psi = 2 atan2(-a_z, a_w).
    """
    apart = multiply(tool, conjugate(reference))
    half = 0.0 if same_north else math.atan2(-apart[3], apart[0])
    heading = (math.cos(half), 0.0, 0.0, math.sin(half))
    left = relative_quat(tool, reference, heading)
    w, x, y, z = left.tolist()
    return Alignment(heading, (w, x, y, z), 2.0 * math.atan2(math.hypot(x, y, z), abs(w)))
