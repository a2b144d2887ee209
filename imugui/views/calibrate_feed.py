"""Feed: hands the raw rows of a session on to a flow, and says in words why none come."""

from __future__ import annotations

import numpy as np

from imugui.samples import SAMPLE, Rows, empty_rows
from imugui.workers.session import Session, State

GAP_S = 0.5
"""A step in time that is told."""
_FLOWING = (State.STREAMING, State.IMPOSSIBLE)


class Feed:
    """Rows since the last call, while it is not paused; ``trouble`` is a sentence, or empty."""

    def __init__(self, session: Session) -> None:
        self._session = session
        self._count = session.samples.count
        self._last_t = float("nan")
        self._paused = False
        self.trouble = ""
        self.gaps = 0

    def pause(self) -> None:
        """Let rows pass by until ``resume``."""
        self._paused = True

    def resume(self) -> None:
        """Go on with the rows that come from now on."""
        if self._paused:
            self._paused = False
            self._count = self._session.samples.count
            self._last_t = float("nan")

    def pull(self) -> Rows:
        """The new raw SAMPLE rows, shape (n,)."""
        if self._paused:
            return empty_rows(SAMPLE, 0)
        rows, self._count, missed = self._session.samples.since(self._count)
        state = self._session.status().state
        self.trouble = "" if state in _FLOWING else f"{state.word}: the calibration waits, nothing is lost."
        if len(rows):
            self._note_gap(rows, missed)
        return rows

    def _note_gap(self, rows: Rows, missed: int) -> None:
        times = np.concatenate(([self._last_t], rows["t"]))
        steps = np.diff(times[np.isfinite(times)])
        gap = missed > 0 or bool((steps > GAP_S).any()) or bool((steps < 0.0).any())
        self.gaps += gap
        self._last_t = float(rows["t"][-1])
