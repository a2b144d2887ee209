"""Ring: the data bus between threads. One writer pushes, every reader keeps its own count."""

from __future__ import annotations

import mmap
import threading
from typing import Any

import numpy as np

from imugui.samples import Rows


class Ring:
    """The last ``capacity`` rows of one type, mirrored so that any recent window is one slice.

    ``count`` is the number of rows ever pushed; row k of all time is numbered k, from 0.
    """

    def __init__(self, dtype: np.dtype[Any], capacity: int) -> None:
        if capacity < 1:
            raise ValueError("a ring needs room for at least one row")
        self.capacity = capacity
        self.count = 0
        self._rows = np.zeros(2 * capacity, dtype)
        self._lock = threading.Lock()
        self._reserved = False

    def reserve(self) -> None:
        """Have the system give all of the ring's memory now, if nothing was pushed yet; at the most once.

        Otherwise it comes page by page while the ring fills for the first time, which takes 11 minutes at 200 Hz: a
        long recording could find in its eleventh minute that there is no memory left.
        """
        if not self._reserved and self.count == 0:
            self._reserved = True
            self._rows.view(np.uint8)[:: mmap.PAGESIZE] = 0  # written, as a page that is only read is not given

    def push(self, rows: Rows) -> None:
        """Append a block of rows, shape (n,); of more than ``capacity`` rows only the newest are kept."""
        n = len(rows)
        if n == 0:
            return
        kept = rows[-self.capacity :]
        with self._lock:
            start = (self.count + n - len(kept)) % self.capacity
            head = min(len(kept), self.capacity - start)
            for offset in (0, self.capacity):
                self._rows[offset + start : offset + start + head] = kept[:head]
                self._rows[offset : offset + len(kept) - head] = kept[head:]
            self.count += n

    def last(self, n: int) -> Rows:
        """A copy of the newest n rows, oldest first; fewer when fewer were pushed."""
        with self._lock:
            return self._copy(min(n, self.count, self.capacity))

    def since(self, count: int) -> tuple[Rows, int, int]:
        """Rows pushed after ``count``: (copy, new count to ask from next time, rows missed in between)."""
        with self._lock:
            wanted = max(0, self.count - count)
            kept = min(wanted, self.capacity)
            return self._copy(kept), self.count, wanted - kept

    def _copy(self, n: int) -> Rows:
        end = self.capacity + self.count % self.capacity
        return self._rows[end - n : end].copy()
