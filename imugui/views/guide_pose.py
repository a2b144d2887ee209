"""PoseTaker: waits until the tool is held still, then keeps the attitudes of that hold."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from imugui.fusion.quaternion import Floats
from imugui.guidance.hold import HOLD_S, Hold
from imugui.guidance.stream import Stream
from imugui.samples import Rows


@dataclass(frozen=True, eq=False)
class Pose:
    """A hold: attitudes (n, 4), its last time in s, first and last attitude number."""

    quats: Floats
    t: float
    rows: tuple[int, int]


class PoseTaker:
    """``begin``, then ``feed`` until it gives a pose. Tremor is averaged out; a tool that turns is waited for."""

    def __init__(self, tool_axis: ArrayLike) -> None:
        self.waiting = False
        self._stream = Stream(tool_axis)
        self._hold = Hold()

    def begin(self, tool_axis: ArrayLike) -> None:
        """Wait for the next hold."""
        self.waiting = True
        self._stream, self._hold = Stream(tool_axis), Hold()

    def stop(self) -> None:
        """Wait no longer."""
        self.waiting = False

    @property
    def progress(self) -> float:
        """Share of the hold that is done, 0 to 1."""
        return self._hold.progress if self.waiting else 0.0

    def feed(self, rows: Rows, first_number: int) -> Pose | None:
        """Take the ATTITUDE rows (n,) that are new, the first having this number; the pose once it is held."""
        if not self.waiting or len(rows) == 0:
            return None
        fresh, broken = self._stream.push(rows, first_number)
        if broken:
            self._hold.reset()
        stream = self._stream
        for t, rate in zip(stream.rows["t"][-fresh:] if fresh else (), stream.rates(fresh), strict=True):
            self._hold.step(float(t), inside=True, rate=float(rate), trusted=True)
        if not self._hold.armed:
            return None
        self.waiting = False
        held = stream.recent(HOLD_S)
        last = stream.first + len(stream.rows) - 1
        return Pose(np.asarray(held["quat"]), float(held["t"][-1]), (last - len(held) + 1, last))
