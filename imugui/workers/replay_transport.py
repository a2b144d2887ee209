"""A file as a board: a recording, a sample CSV or a raw capture, played by its own times."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from pathlib import Path

from imugui.recording import Capture, Recording, UnreadableError, is_recording, read_recording, read_samples
from imugui.samples import Rows
from imugui.workers.player import BLOCK, Player
from imugui.workers.transport import Source, Transport

SHORTEST_WAIT_S = 0.004
LONGEST_WAIT_S = 0.1


class ReplayTransport(Transport):
    """Plays one file. ``address`` is its path; ``player`` is there once it is open."""

    retries = False
    baud = 0

    def __init__(self, source: Source) -> None:
        self.player: Player | None = None
        self.recording: Recording | None = None
        self.capture: Capture | None = None
        self.jumped = False  # the rows read last do not follow those before; whoever takes note resets it
        self.room: Callable[[], int] = lambda: BLOCK  # how many rows the receiver can take without losing any
        self._source = source
        self.progress = 0.0  # share of the file that was read
        self._cancelled = threading.Event()
        self._wake = threading.Event()

    def open(self) -> None:
        """Read the file; OSError when it cannot be read, ValueError in words when it holds no samples."""
        source = self._source
        path = Path(source.address)
        try:
            if is_recording(path):
                self.recording = read_recording(path, self._watch)
                rows, events = self.recording.samples, self.recording.events
            else:
                self.capture = read_samples(path, source.format, source.options, source.rate_hz, self._watch)
                rows, events = self.capture.rows, []
        except UnreadableError as error:
            raise ValueError(str(error)) from error
        self.player = Player(rows, events, source.speed)

    def cancel(self) -> None:
        """Give up reading the file; from any thread."""
        self._cancelled.set()

    def _watch(self, share: float) -> None:
        self.progress = share
        if self._cancelled.is_set():
            raise UnreadableError("reading was cancelled")

    def read(self) -> bytes | Rows:
        player = self.player
        if player is None or player.ended:
            raise EOFError
        wait = player.wait_s(time.perf_counter())
        self._wake.wait(min(max(wait, SHORTEST_WAIT_S), LONGEST_WAIT_S))
        rows, jumped = player.due(time.perf_counter(), self.room())
        self.jumped = self.jumped or jumped
        return rows if len(rows) else b""

    @property
    def paused(self) -> bool:
        """Whether the user lets it stand still."""
        return self.player is not None and not self.player.playing and not self.player.ended

    @property
    def ended(self) -> bool:
        """Whether everything was played; seeking back or playing again changes that."""
        return self.player is None or self.player.ended

    def close(self) -> None:
        """The file was read at opening; nothing is held."""
