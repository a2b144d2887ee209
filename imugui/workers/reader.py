"""The reader thread: keeps one link open, stamps what arrives, decodes it, pushes it."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass

from PySide6.QtCore import Signal

from imugui.ring import Ring
from imugui.samples import Rows
from imugui.workers.intake import Intake
from imugui.workers.port_errors import PORT_ERRORS, Problem, explain, explain_file
from imugui.workers.transport import Source, Transport
from imugui.workers.worker import Worker

RETRY_S = 0.25
DENIED_GRACE_S = 1.0  # udev sets the rights a moment after a port appears


@dataclass
class Link:
    """Facts about the link; written by the reader's thread, read by anyone, one attribute at a time."""

    phase: str = "opening"  # a key of verdict's phases
    problem: Problem | None = None
    opened: float = math.nan
    byte_t: float = math.nan
    sample_t: float = math.nan
    breaks: int = 0
    missing_s: float = 0.0


class Reader(Worker):
    """Reads one transport until stopped; a port that fails is tried again by itself."""

    changed = Signal()  # the link's phase or format changed

    def __init__(self, source: Source, transport: Transport, ring: Ring) -> None:
        super().__init__()
        self.source = source
        self.link = Link()
        self.intake = Intake(source)
        self._transport = transport
        self._ring = ring
        self._open = False
        self._tried = math.nan

    def step(self) -> None:
        if self.link.phase in ("ended", "failed"):
            self.stopping.wait(0.1)
        elif not self._open:
            self._try_open()
        else:
            self._read()

    def finish(self) -> None:
        self._transport.close()

    def _try_open(self) -> None:
        try:
            self._transport.open()
        except PORT_ERRORS as error:
            self._not_opened(self._explain(error, opening=True))
            return
        self._open = True
        self.link.opened = time.perf_counter()
        self.link.problem = None
        self.intake.opened(self._transport, self.link.opened)
        self._enter("open")

    def _not_opened(self, problem: Problem) -> None:
        now = time.perf_counter()
        if math.isnan(self._tried):
            self._tried = now
        if not self._transport.retries:
            self.link.problem = problem
            self._enter("failed")
            return
        waits = problem.kind == "denied" and now - self._tried < DENIED_GRACE_S
        if self.link.phase == "opening" and not waits:
            self.link.problem = problem
            self._enter("lost")
        self.stopping.wait(RETRY_S)

    def _read(self) -> None:
        try:
            data = self._transport.read()
        except EOFError:
            self._transport.close()
            self._enter("ended")
            return
        except PORT_ERRORS as error:
            self._lost(self._explain(error, opening=False))
            return
        now = time.perf_counter()
        if len(data):
            self._take(data, now)
        self.intake.tick(self._transport, now)

    def _take(self, data: bytes | Rows, now: float) -> None:
        self.link.byte_t = now
        known = self.intake.format
        rows = self.intake.feed(data, now)
        if len(rows):
            self._count_break(now)
            self.link.sample_t = now
            self._ring.push(rows)
        if self.intake.format != known:
            self.changed.emit()

    def _count_break(self, now: float) -> None:
        """After a break of the link, what is missing is the time between the samples around it."""
        if self.link.breaks and self.link.opened > self.link.sample_t:
            self.link.missing_s += now - self.link.sample_t

    def _lost(self, problem: Problem) -> None:
        self._open = False
        self._transport.close()
        self._tried = math.nan
        self.link.problem = problem
        self.link.breaks += 1
        self._enter("lost")
        self.stopping.wait(RETRY_S)

    def _explain(self, error: BaseException, *, opening: bool) -> Problem:
        if self._transport.retries:
            return explain(error, self.source.address, opening=opening)
        return explain_file(error, self.source.address)

    def _enter(self, phase: str) -> None:
        if phase != self.link.phase:
            self.link.phase = phase
            self.changed.emit()
