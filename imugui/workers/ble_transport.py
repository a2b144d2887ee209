"""Bluetooth LE boards as a transport: notifications with their own arrival times."""

from __future__ import annotations

import threading
from concurrent.futures import CancelledError, Future
from typing import TYPE_CHECKING

from imugui.workers.ble_errors import problem
from imugui.workers.ble_link import BoardFacts, Link
from imugui.workers.ble_loop import Radio
from imugui.workers.port_errors import LinkError, Problem
from imugui.workers.transport import Arrivals, Source, Transport

if TYPE_CHECKING:
    from bleak.backends.device import BLEDevice

READ_S = 0.1
PAUSES_S = (0.5, 1.0, 2.0, 4.0, 5.0)  # between attempts, while Bluetooth itself does not work
SEARCH_PAUSE_S = 0.25  # between attempts that listen for the board anyway: its return must not be missed
SEARCH_EVERY = 3  # every so many-th attempt searches, in case the system has forgotten the board
LISTENING = ("away", "dropped", "refused", "lost", "silent", "elsewhere")

FINAL = (
    "several",
    "wrong_board",
    "unknown_board",
    "old_service",
    "no_library",
    "thread",
)  # trying again gives the same


class BleTransport(Transport):
    """One board, told by its name or its address. ``radio`` is shared by all boards of a program.

    A board that was connected once is connected again directly: the system then waits for its next advertisement,
    where a search waits for two. Now and then it is searched for all the same.
    """

    baud = 0
    wireless = True

    def __init__(self, source: Source, radio: Radio) -> None:
        self.facts = BoardFacts()
        self.format = ""  # what the board speaks, once connected
        self.retries = True
        self._source = source
        self._radio = radio
        self._link: Link | None = None
        self._device: BLEDevice | None = None  # as it was connected last
        self._tries = 0  # since then
        self._failed = ("", 0)  # how, and how many times again
        self._attempt: Future[None] | None = None
        self._cancelled = threading.Event()

    @property
    def title(self) -> str:
        """What to call the board."""
        return self.facts.name or self._source.address

    @property
    def address(self) -> str:
        """Of the board that was connected last; "" before."""
        return self.facts.address if self.format else ""

    def open(self) -> None:
        """Find, connect and subscribe: some seconds at the most; LinkError in words."""
        self._tries += 1
        device = self._device if self._tries % SEARCH_EVERY else None
        link = Link(self._radio, self._source.address, self.facts, device)
        try:
            if self._cancelled.is_set():
                raise CancelledError
            self._attempt = self._radio.submit(link.open())
            if self._cancelled.is_set():
                self._attempt.cancel()
            self._attempt.result()
        except (CancelledError, RuntimeError):
            self._radio.call(link.leave)  # it may have been made just then
            raise LinkError(problem("stopped", self.title)) from None
        except LinkError as error:
            self.retries = bool(self.format) or error.problem.kind not in FINAL
            raise
        self._link, self._tries, self._failed = link, 0, ("", 0)
        self.format = link.profile.format if link.profile else ""

    def cancel(self) -> None:
        """Give up connecting, for good; from any thread."""
        self._cancelled.set()
        if self._attempt is not None:
            self._attempt.cancel()

    def read(self) -> Arrivals:
        """The notifications since the last call; LinkError, in words, when the link is lost and all were given out."""
        return self._link.mail.take(READ_S) if self._link else []

    def close(self) -> None:
        """Disconnect, without waiting for it."""
        link, self._link = self._link, None
        if link is not None:
            self._device = link.device
            self._radio.call(link.leave)

    def pause_s(self, failed: Problem) -> float:
        """How long to wait after an attempt that failed so, s; longer each time that it is the same."""
        kind, times = self._failed
        self._failed = failed.kind, times + 1 if kind == failed.kind else 0
        if failed.kind in LISTENING:
            return SEARCH_PAUSE_S
        return PAUSES_S[min(self._failed[1], len(PAUSES_S) - 1)]
