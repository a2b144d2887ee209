"""A file as a board: sample CSV or raw capture, at the speed it was made (times a factor)."""

from __future__ import annotations

import threading
import time
from pathlib import Path

import numpy as np

from imugui.recording import UnreadableError, read_samples
from imugui.samples import Rows
from imugui.workers.transport import Source

SHORTEST_WAIT_S = 0.004
LONGEST_WAIT_S = 0.1


class ReplayTransport:
    """Plays the rows of one file once. ``address`` is its path."""

    retries = False
    baud = 0

    def __init__(self, source: Source) -> None:
        self._source = source
        self._next = 0
        self._wake = threading.Event()

    def open(self) -> None:
        """Read the file; OSError when it cannot be read, ValueError in words when it holds no samples."""
        source = self._source
        try:
            self.capture = read_samples(Path(source.address), source.format, source.options, source.rate_hz)
        except UnreadableError as error:
            raise ValueError(str(error)) from error
        self._rows = self.capture.rows
        self._elapsed = (self._rows["t"] - self._rows["t"][0]) / source.speed
        self._start = time.perf_counter()

    def read(self) -> bytes | Rows:
        if self._next >= len(self._rows):
            raise EOFError
        now = time.perf_counter() - self._start
        wait = float(self._elapsed[self._next]) - now
        self._wake.wait(min(max(wait, SHORTEST_WAIT_S), LONGEST_WAIT_S))
        end = int(np.searchsorted(self._elapsed, time.perf_counter() - self._start, side="right"))
        rows, self._next = self._rows[self._next : end], max(self._next, end)
        return rows.copy() if len(rows) else b""

    def close(self) -> None:
        """The rows were read at opening; nothing is held."""
