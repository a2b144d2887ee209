"""The virtual board as a transport: finished rows, or the bytes of any format."""

from __future__ import annotations

import threading
import time

from imugui.formats import FORMATS
from imugui.samples import Rows
from imugui.simulation.board import VirtualBoard
from imugui.simulation.errors import PRESETS
from imugui.simulation.hand import HandTurned
from imugui.simulation.pacing import Pacer
from imugui.simulation.wire import Wire, real_board
from imugui.workers.transport import Arrivals, Source, Transport

HAND = "hand"
RATE_HZ = 200.0
SHORTEST_WAIT_S = 0.002
LONGEST_WAIT_S = 0.1


class SimulatorTransport(Transport):
    """A virtual board that is always plugged in. ``address`` is its motion."""

    retries = False
    baud = 0

    def __init__(self, source: Source) -> None:
        self.hand: HandTurned | None = None
        self._source = source
        self._wire: Wire | None = None
        self._wake = threading.Event()

    def open(self) -> None:
        """Make the board; ValueError for an unknown motion, error preset or format."""
        source = self._source
        if source.errors not in PRESETS:
            raise ValueError(f"there are no errors {source.errors!r}; there are {', '.join(PRESETS)}")
        if source.format in FORMATS:
            self._wire = real_board(source.format, source.address, PRESETS[source.errors], source.seed)
            self._board = self._wire.board
        else:
            rate_hz = source.rate_hz or RATE_HZ
            self._board = VirtualBoard(source.address, rate_hz, PRESETS[source.errors], source.seed)
        path = self._board.path
        self.hand = path if isinstance(path, HandTurned) else None
        self._pacer = Pacer(self._board.rate_hz, time.perf_counter())

    def read(self) -> bytes | Arrivals | Rows:
        wait = self._pacer.wait_s(time.perf_counter())
        self._wake.wait(min(max(wait, SHORTEST_WAIT_S), LONGEST_WAIT_S))
        now = time.perf_counter()
        n = self._pacer.due(now)
        if n == 0:
            return b""
        if self._wire is None:
            return self._board.rows(n)
        messages = self._wire.messages(n)
        return [(now, message) for message in messages] if self._wire.form.framed else b"".join(messages)

    def close(self) -> None:
        """Nothing is held."""
