"""A board for long runs, in a process of its own, that loses nothing and counts what it sends."""

from __future__ import annotations

import multiprocessing
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from imugui.formats import FORMATS
from imugui.simulation.board import VirtualBoard
from imugui.simulation.errors import PRESETS
from imugui.simulation.pacing import Pacer
from imugui.simulation.pty_board import SHORTEST_WAIT_S
from imugui.simulation.pty_port import PtyPort
from imugui.simulation.wire import Wire

OPEN_S = 30.0


class Sender:
    """The parent's hold on the board."""

    def __init__(self) -> None:
        context = multiprocessing.get_context("spawn")
        self.sent: Any = context.Value("q", 0)  # samples whose bytes are in the pseudo-terminal
        self.hold, self.holding, self.stop = context.Event(), context.Event(), context.Event()
        self.spawn = context.Process

    def pause(self) -> int:
        """Have the board fall silent between two samples; how many it has sent."""
        self.holding.clear()
        self.hold.set()
        if not self.holding.wait(OPEN_S):
            raise TimeoutError("the board does not fall silent")
        return int(self.sent.value)

    def go_on(self) -> None:
        self.hold.clear()


def send(link: str, name: str, rate_hz: float, sender: tuple[Any, ...]) -> None:
    """Speak at the rate; what the terminal has no room for is not dropped: it waits, and the next samples with it."""
    sent, hold, holding, stop = sender
    port = PtyPort(Path(link))
    port.open()
    wire = Wire(VirtualBoard("free", rate_hz, PRESETS["mpu9250-calibrated"], 1), FORMATS[name])
    pacer, waiting, made = Pacer(rate_hz, time.monotonic()), b"", 0
    while not stop.is_set():
        due = pacer.due(time.monotonic())
        if not waiting and not hold.is_set() and port.has_reader():
            waiting, made = wire.take(due), made + due
        lost = port.write(waiting)  # whole lines at the end: they are sent again
        waiting = waiting[len(waiting) - lost :]
        if not waiting:
            sent.value = made
            if hold.is_set():
                holding.set()
        stop.wait(SHORTEST_WAIT_S)
    port.close()


@contextmanager
def steady_board(link: Path, name: str, rate_hz: float) -> Iterator[Sender]:
    """A board that speaks FORMATS[name] at rate_hz under ``link`` as long as the block lasts."""
    sender = Sender()
    shared = sender.sent, sender.hold, sender.holding, sender.stop
    child = sender.spawn(target=send, args=(str(link), name, rate_hz, shared))
    child.start()
    until = time.monotonic() + OPEN_S
    while not link.exists() and child.is_alive() and time.monotonic() < until:
        time.sleep(0.05)
    try:
        yield sender
    finally:
        sender.stop.set()
        child.join()
