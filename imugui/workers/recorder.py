"""The recorder thread: drains the rings, the raw bytes and the events to disk, beside the data path."""

from __future__ import annotations

import errno
import threading
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from PySide6.QtCore import Signal

from imugui import recording
from imugui.recording.events import Event
from imugui.recording.raw import Chunk
from imugui.ring import Ring
from imugui.workers.worker import Worker

PERIOD_S = 0.1
FLUSH_S = 1.0
FUSION_GRACE_S = 0.5  # how long the end waits for the fusion thread
LOW_DISK = 500_000_000  # bytes left at which a warning is due
CATCH_UP = 1 << 14  # rows a step: a long stall is written off piece by piece, so that stopping stays quick


class Tap:
    """Where the recording's other sources leave what they have; filled by the reader and fusion threads."""

    def __init__(self) -> None:
        self.raw: deque[Chunk] = deque()
        self.events: deque[Event] = deque()
        self.first_sample = -1  # number in the samples ring at which the recording begins; -1 until known
        self.first_attitude = -1  # the same in the attitude ring
        self.ready = threading.Event()  # both are known


@dataclass(frozen=True)
class RecordingStatus:
    """What the record button shows."""

    path: Path
    elapsed_s: float
    size_bytes: int
    free_bytes: int
    rows: int
    missed_rows: int
    problem: str = ""


class Recorder(Worker):
    """Writes one recording, until stopped or until the disk says no."""

    stopped_by_disk = Signal(str)

    def __init__(self, folder: Path, about: dict[str, Any], samples: Ring, attitude: Ring, tap: Tap) -> None:
        """Make the folder at once; raises OSError."""
        super().__init__()
        self._writer = recording.FolderWriter(folder, about)
        self._rings: tuple[tuple[Ring, Callable[[Any], None], str], ...] = (
            (samples, self._writer.samples, "first_sample"),
            (attitude, self._writer.attitude, "first_attitude"),
        )
        self._tap = tap
        self._counts = [-1, -1]
        self._length: int | None = None  # how many rows the recording has, once it ends
        self._started = time.perf_counter()
        self._flushed = self._started
        self.rows = 0
        self.missed_rows = 0
        self.problem = ""
        self._size = self._free = 0
        self._look_at_disk()

    def status(self) -> RecordingStatus:
        """A snapshot, from any thread."""
        elapsed = time.perf_counter() - self._started
        return RecordingStatus(
            self._writer.folder, elapsed, self._size, self._free, self.rows, self.missed_rows, self.problem
        )

    def step(self) -> None:
        self.stopping.wait(PERIOD_S)
        if not self.problem:
            self._guarded(self._drain)

    def finish(self) -> None:
        """Write the rest and close in order."""
        if not self.problem:
            self._guarded(self._drain_all)
        self._guarded(lambda: self._writer.close({"rows": self.rows, "missed_rows": self.missed_rows}))

    def _guarded(self, act: Callable[[], None]) -> None:
        """A disk that fails ends the recording in words; what was written stays."""
        try:
            act()
        except OSError as error:
            if not self.problem:
                self.problem = disk_words(error, self._writer.folder)
                self.stopped_by_disk.emit(self.problem)

    def _drain(self) -> None:
        if self._tap.ready.is_set():
            for index, (ring, write, first) in enumerate(self._rings):
                self._drain_ring(index, ring, write, first)
        self._write_queue(self._tap.raw, self._writer.raw)
        self._write_queue(self._tap.events, self._writer.events)
        now = time.perf_counter()
        if now - self._flushed >= FLUSH_S:
            self._flushed = now
            self._writer.flush()
            self._look_at_disk()

    def _drain_ring(self, index: int, ring: Ring, write: Callable[[Any], None], first: str) -> None:
        begin = getattr(self._tap, first)
        if self._counts[index] < 0:
            self._counts[index] = begin
        rows, count, missed = ring.since(self._counts[index])
        if self._length is not None:
            rows = rows[: max(0, begin + self._length - (count - len(rows)))]
        self._counts[index] = count
        self.missed_rows += missed
        for start in range(0, len(rows), CATCH_UP):
            write(rows[start : start + CATCH_UP])
        if index == 0:
            self.rows += len(rows)

    def _drain_all(self) -> None:
        """The last samples, and the attitudes that belong to them as soon as they are fused."""
        samples, attitude = (ring for ring, _, _ in self._rings)
        if self._tap.ready.is_set():
            self._length = samples.count - self._tap.first_sample
            until = time.perf_counter() + FUSION_GRACE_S
            while attitude.count - self._tap.first_attitude < self._length and time.perf_counter() < until:
                time.sleep(0.002)
        self._drain()
        self._writer.flush()

    @staticmethod
    def _write_queue(queue: deque[Any], write: Callable[[list[Any]], None]) -> None:
        taken = [queue.popleft() for _ in range(len(queue))]
        if taken:
            write(taken)

    def _look_at_disk(self) -> None:
        self._size, self._free = self._writer.size(), self._writer.free()


def disk_words(error: OSError, folder: Path) -> str:
    """Why a recording ended, and what to do."""
    if error.errno == errno.ENOSPC:
        return f"The disk of {folder} is full: the recording ended. What was written is kept; free some space."
    return f"The recording ended: {folder} cannot be written ({error.strerror or error}). What was written is kept."
