"""Feed: pulls both rings into histories of channels, at the pace of whoever looks."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from imugui.ring import Ring
from imugui.samples import Rows
from imugui.signals.channels import ATTITUDE_KEYS, CHANNELS, SAMPLE_KEYS, attitude_values, sample_values
from imugui.signals.history import Floats, History

ROWS = 1 << 17  # two minutes at 1 kHz
PIECE = 1 << 14  # rows taken by one refresh: after a long absence the window stays responsive
PERIODS = {key: channel.period for key, channel in CHANNELS.items() if channel.period}


class Pull:
    """Takes the rows of one ring over into one history, at the most PIECE at once."""

    def __init__(self, ring: Ring, history: History, values: Callable[[Rows, float], Floats]) -> None:
        self.history = history
        self._ring = ring
        self._values = values
        self._count = 0
        self._waiting: Rows = np.empty(0)
        self._last_t = math.nan  # of the row before the waiting ones

    def restart(self) -> None:
        """Begin anew with what the ring holds."""
        self.history.clear()
        self._count, self._waiting, self._last_t = 0, np.empty(0), math.nan

    @property
    def behind(self) -> bool:
        """True while rows wait to be taken."""
        return len(self._waiting) > 0

    def step(self) -> bool:
        """Take what is new; True when there was any."""
        if not self.behind:
            self._waiting, self._count, missed = self._ring.since(self._count)
            self._last_t = math.nan if missed else self._last_t
        piece, self._waiting = self._waiting[:PIECE], self._waiting[PIECE:]
        if len(piece) == 0:
            return False
        self.history.push(piece["t"], self._values(piece, self._last_t))
        self._last_t = float(piece["t"][-1])
        return True


class Feed:
    """``raw`` holds the channels of the SAMPLE rows, ``corrected`` those of the ATTITUDE rows.

    After a pause ``refresh`` takes what the rings still hold; what they have lost meanwhile is a gap in time.
    """

    def __init__(self, samples: Ring, attitude: Ring, convention: str, capacity: int = ROWS) -> None:
        self.convention = convention
        self.raw = History(SAMPLE_KEYS, capacity)
        self.corrected = History(ATTITUDE_KEYS, capacity, PERIODS)
        self._pulls = (
            Pull(samples, self.raw, sample_values),
            Pull(attitude, self.corrected, lambda rows, _: attitude_values(rows, self.convention)),
        )

    def restart(self, convention: str) -> None:
        """Begin anew with what the rings hold, the angles in this display convention."""
        self.convention = convention
        for pull in self._pulls:
            pull.restart()

    def refresh(self) -> bool:
        """Pull what is new; True when there was any."""
        new = [pull.step() for pull in self._pulls]
        return any(new)

    @property
    def behind(self) -> bool:
        """True while more than one refresh is needed to catch up."""
        return any(pull.behind for pull in self._pulls)

    @property
    def nbytes(self) -> int:
        """Memory of the histories, bytes."""
        return self.raw.nbytes + self.corrected.nbytes
