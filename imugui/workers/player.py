"""The player: which rows of a recording are due now, with pause, speed, seek and loop."""

from __future__ import annotations

import math
import threading

import numpy as np
from numpy.typing import NDArray

from imugui.recording.events import Event
from imugui.samples import Rows

SPEEDS = (0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0, math.inf)
BLOCK = 512  # rows handed out at once when it goes as fast as it can
OVERVIEW = 1200  # columns of the overview curve


class Player:
    """Plays rows (n,) by their own times. The window's thread commands, the reader's thread asks for rows."""

    def __init__(self, rows: Rows, events: list[Event], speed: float = 1.0) -> None:
        self.rows = rows
        self.events = events
        self.times: NDArray[np.float64] = rows["t"] - rows["t"][0]
        self._lock = threading.Lock()
        self._next = 0
        self._playing = True
        self._speed = speed
        self._loop = False
        self._jumped = False
        self._anchor = (math.nan, 0.0)  # (host time, time in the recording) from which it plays on

    @property
    def duration_s(self) -> float:
        return float(self.times[-1])

    @property
    def position_s(self) -> float:
        """Time in the recording of the newest row handed out, s."""
        return float(self.times[min(max(self._next - 1, 0), len(self.times) - 1)])

    @property
    def playing(self) -> bool:
        return self._playing and not self.ended

    @property
    def ended(self) -> bool:
        return self._next >= len(self.rows) and not self._loop

    @property
    def speed(self) -> float:
        """A member of SPEEDS; infinity is as fast as it goes."""
        return self._speed

    @property
    def loop(self) -> bool:
        return self._loop

    def play(self) -> None:
        """Go on; at the end, from the beginning."""
        with self._lock:
            if self.ended:
                self._go(0)
            self._playing = True
            self._anchor = (math.nan, 0.0)

    def pause(self) -> None:
        """Stand still."""
        with self._lock:
            self._playing = False

    def seek(self, position_s: float) -> None:
        """Go to a time in the recording, s; outside it, to its nearer end."""
        with self._lock:
            self._go(int(np.searchsorted(self.times, position_s)))

    def set_speed(self, speed: float) -> None:
        """Play so many times as fast."""
        if not speed > 0.0:
            raise ValueError(f"a speed is above 0, not {speed}")
        with self._lock:
            self._speed = speed
            self._anchor = (math.nan, 0.0)

    def set_loop(self, on: bool) -> None:
        """At the end begin again, or do not."""
        with self._lock:
            self._loop = on

    def due(self, now: float, room: int) -> tuple[Rows, bool]:
        """(rows due at host time now in s, at most ``room``; whether they do not follow those before)."""
        with self._lock:
            if self._loop and self._next >= len(self.rows):
                self._go(0)
            end = min(self._end(now), self._next + max(room, 0)) if self._playing else self._next
            rows = self.rows[self._next : end].copy()
            self._next = max(self._next, end)
            jumped, self._jumped = self._jumped and len(rows) > 0, self._jumped and len(rows) == 0
            return rows, jumped

    def wait_s(self, now: float) -> float:
        """Time from host time now until the next row is due, s; infinite while paused or at the end."""
        with self._lock:
            if not self._playing or self._next >= len(self.rows):
                return math.inf
            started, position = self._anchor
            if math.isinf(self._speed) or math.isnan(started):
                return 0.0
            return max(0.0, (float(self.times[self._next]) - position) / self._speed - (now - started))

    def overview(self) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """The turning rate over the whole: times (k,) in s, lowest and highest |gyr| (k,) in rad/s of each column."""
        norm = np.linalg.norm(self.rows["gyr"], axis=1)
        starts = np.unique(np.linspace(0, len(norm), min(OVERVIEW, len(norm)), endpoint=False).astype(int))
        return self.times[starts], np.fmin.reduceat(norm, starts), np.fmax.reduceat(norm, starts)

    def _go(self, index: int) -> None:
        self._next = min(index, len(self.rows))
        self._jumped = True
        self._anchor = (math.nan, 0.0)

    def _end(self, now: float) -> int:
        if math.isinf(self._speed):
            return min(self._next + BLOCK, len(self.rows))
        started, position = self._anchor
        if math.isnan(started):
            started, position = now, float(self.times[min(self._next, len(self.times) - 1)])
            self._anchor = (started, position)
        reached = position + (now - started) * self._speed
        return int(np.searchsorted(self.times, reached, side="right"))
