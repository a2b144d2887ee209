"""The virtual board on a pseudo-terminal: the loop that speaks at the board's own pace."""

from __future__ import annotations

import threading
import time

from imugui.simulation.pacing import Pacer
from imugui.simulation.pty_port import PtyPort
from imugui.simulation.wire import Wire

SHORTEST_WAIT_S = 0.004
"""Above 250 Hz samples go out in small groups: waking more often would cost more than it shows."""

BOOT_S = 0.2
"""As on an Arduino, opening the port resets the board; it then starts with its preamble after this time.
(A reader empties its buffer while it opens a port: what comes at once would be lost.)"""


class PtyBoard:
    """Feeds a port from a wire. Everything happens in ``step``, which is told the time and never waits."""

    def __init__(self, wire: Wire, port: PtyPort, start_t: float, boot_s: float = BOOT_S) -> None:
        self.wire, self.port, self.boot_s = wire, port, boot_s
        self.pacer = Pacer(wire.board.rate_hz, start_t)
        self.unheard = 0  # samples made while nobody had the port open or the board was starting
        self._heard = False
        self._speaks_at = start_t

    def step(self, t: float) -> int:
        """Send what is due at host time t in s; returns how many samples were sent."""
        heard = self.port.has_reader()
        if heard and not self._heard:
            self.wire.restart()
            self._speaks_at = t + self.boot_s
        elif self._heard and not heard:
            self.port.forget()
        self._heard = heard
        n = self.pacer.due(t)
        if not heard or t < self._speaks_at:
            self.wire.skip(n)
            self.unheard += n
            return 0
        if n:
            self.port.write(self.wire.take(n))
        return n

    def run_until(self, stop: threading.Event) -> None:
        """Step on the host's monotonic clock until the event is set."""
        while not stop.is_set():
            self.step(time.monotonic())
            stop.wait(max(SHORTEST_WAIT_S, self.pacer.wait_s(time.monotonic())))

    def unplug(self) -> None:
        """Pull the plug; the board goes on moving unheard."""
        self.port.close()

    def replug(self) -> None:
        """Plug in again, under the same link."""
        self.port.open()
