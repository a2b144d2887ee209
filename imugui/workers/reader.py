"""The reader thread: keeps one link open, stamps what arrives, decodes it, pushes it."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import Signal

from imugui.recording.events import Event
from imugui.ring import Ring
from imugui.samples import Rows
from imugui.workers.fusion_worker import FusionWorker
from imugui.workers.intake import Intake
from imugui.workers.port_errors import PORT_ERRORS, Problem, explain, explain_file
from imugui.workers.recorder import Tap
from imugui.workers.status import board_facts
from imugui.workers.transport import Arrivals, Source, Transport
from imugui.workers.verdict import Facts
from imugui.workers.worker import Worker

if TYPE_CHECKING:
    from imugui.recording import Recording

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
    told = Signal(str, str)  # tone, sentence

    def __init__(self, source: Source, transport: Transport, ring: Ring, fusion: FusionWorker) -> None:
        super().__init__()
        self.source = source
        self.link = Link()
        self.intake = Intake(source)
        self._transport = transport
        self._ring = ring
        self._fusion = fusion
        self._tap: Tap | None = None
        self._new_tap: Tap | None = None
        self._open = False
        self._tried = math.nan

    def record(self, tap: Tap | None) -> None:
        """From the next arrival on leave bytes and events in this tap; None: no more."""
        self._new_tap = tap

    @property
    def where(self) -> str:
        """What to call the place the samples come from."""
        return getattr(self._transport, "title", self.source.address)

    @property
    def found(self) -> Source:
        """The source, with the address of the board that was found where it was called by its name."""
        address = getattr(self._transport, "address", "")
        return replace(self.source, address=address) if address else self.source

    @property
    def board_facts(self) -> dict[str, Any]:
        """What a wireless board tells of itself, under the names of Status."""
        return board_facts(self._transport)

    def facts(self, now: float, odd: str) -> Facts:
        """What is known of the link at host time now (s); ``odd`` says what makes its values impossible."""
        link, intake = self.link, self.intake
        return Facts(
            now=now,
            phase=link.phase,
            where=self.where,
            wireless=getattr(self._transport, "wireless", False),
            problem=link.problem.sentence if link.problem else "",
            progress=getattr(self._transport, "progress", 0.0),
            paused=getattr(self._transport, "paused", False),
            problem_kind=link.problem.kind if link.problem else "",
            opened=link.opened,
            byte_t=link.byte_t,
            sample_t=link.sample_t,
            period_s=intake.clock.period,
            format=intake.format,
            baud=intake.baud,
            findings=intake.seen,
            odd=odd,
            missing_s=link.missing_s,
            breaks=link.breaks,
        )

    def step(self) -> None:
        if self.link.phase in ("ended", "failed"):
            self._rest()
        elif not self._open:
            self._try_open()
        else:
            self._read()

    def finish(self) -> None:
        self._transport.close()

    def _try_open(self) -> None:
        for ring in (self._ring, self._fusion.attitude):  # here, so that neither start nor window waits for it
            ring.reserve()
        try:
            self._transport.open()
        except PORT_ERRORS as error:
            self._not_opened(self._explain(error, opening=True))
            return
        self._open = True
        self.link.opened = time.perf_counter()
        self.link.problem = None
        self._follow(getattr(self._transport, "recording", None))
        self.intake.opened(self._transport, self.link.opened)
        self.intake.note(self.link.opened, f"{self.where} is open")
        if self._tap is not None:
            self._tap.raw.append((self.link.opened, b""))
        self._note("connect", self.where)
        self._enter("open")
        if self.link.breaks:
            self.told.emit("info", f"{self.where} is back.")

    def _not_opened(self, problem: Problem) -> None:
        now = time.perf_counter()
        if math.isnan(self._tried):
            self._tried = now
        if not self._transport.retries:
            self._say(problem, "failed")
            return
        waits = problem.kind == "denied" and now - self._tried < DENIED_GRACE_S
        if (self.link.phase == "opening" and not waits) or self._explains(problem):
            self._say(problem, "lost")
        self._pause(problem)

    def _say(self, problem: Problem, phase: str) -> None:
        self.link.problem = problem
        self.intake.note(time.perf_counter(), problem.sentence)
        self._enter(phase)
        self.told.emit("error", problem.sentence)

    def _explains(self, problem: Problem) -> bool:
        """Whether this tells more of why there is no link than what was said."""
        said = self.link.problem
        return said is not None and problem.kind != said.kind and (problem.cause or said.cause)

    def _pause(self, problem: Problem) -> None:
        """Between two attempts."""
        pause_s = getattr(self._transport, "pause_s", None)
        self.stopping.wait(pause_s(problem) if pause_s else RETRY_S)

    def _read(self) -> None:
        try:
            data = self._transport.read()
        except EOFError:
            self._enter("ended")
            return
        except PORT_ERRORS as error:
            self._lost(self._explain(error, opening=False))
            return
        now = time.perf_counter()
        if len(data):
            self._take(data, now)
        self.intake.tick(self._transport, now)

    def _rest(self) -> None:
        """Nothing to read, for good or until the player goes back in its file."""
        self.stopping.wait(0.05)
        if self.link.phase == "ended" and not getattr(self._transport, "ended", True):
            self._enter("open")

    def _take(self, data: bytes | Arrivals | Rows, now: float) -> None:
        self.link.byte_t = now
        known = self.intake.format
        if self._new_tap is not self._tap and (self._new_tap is None or known):
            self._begin_tap()
        if self._tap is not None:
            self._keep(self._tap, data, now)
        if getattr(self._transport, "jumped", False):
            self._jump()
        rows = self.intake.feed(data, now)
        if len(rows):
            self._count_break(now)
            self.link.sample_t = now
            self._ring.push(rows)
            self._fusion.wake()
        if self.intake.format != known:
            self.changed.emit()

    @staticmethod
    def _keep(tap: Tap, data: bytes | Arrivals | Rows, now: float) -> None:
        """What can be decoded again is recorded as it came."""
        if isinstance(data, bytes):
            tap.raw.append((now, data))
        elif isinstance(data, list):
            tap.raw.extend(data)

    def _follow(self, recording: Recording | None) -> None:
        """A recording is replayed as it was fused, unless its filter cannot be set up here."""
        if recording is None or not self.source.follow:
            return
        try:
            self._fusion.follow(recording.events, self._ring.count)
        except (KeyError, TypeError, ValueError) as error:
            self.told.emit("warn", f"The recorded filter cannot be set up here ({error}); the chosen one is used.")

    def _begin_tap(self) -> None:
        """A recording begins with the next sample: say what is known so far, so that it can be computed again."""
        self._tap = self._new_tap
        if self._tap is not None:
            if self.intake.head:
                self._tap.raw.append((math.nan, self.intake.head))
            found = {"format": self.intake.format, "clock": self.intake.clock.state()}
            self._fusion.begin_tap(self._tap, self._ring.count, found)

    def _jump(self) -> None:
        """The player went elsewhere in its file: clock and filter begin again there."""
        self._transport.jumped = False  # type: ignore[attr-defined]
        self.intake.restart_clock()
        self._fusion.restart(self._ring.count)

    def _note(self, kind: str, text: str) -> None:
        if self._tap is not None and self._tap.ready.is_set():
            number = self._ring.count - self._tap.first_sample
            self._tap.events.append(Event(kind, math.nan, number, text))

    def _count_break(self, now: float) -> None:
        """After a break of the link, what is missing is the time between the samples around it."""
        if self.link.breaks and self.link.opened > self.link.sample_t:
            self.link.missing_s += now - self.link.sample_t

    def _lost(self, problem: Problem) -> None:
        self._open = False
        self._transport.close()
        self._tried = math.nan
        self.link.breaks += 1
        self._note("lost", problem.sentence)
        self._say(problem, "lost")
        self._pause(problem)

    def _explain(self, error: BaseException, *, opening: bool) -> Problem:
        if self._transport.retries:
            return explain(error, self.source.address, opening=opening)
        return explain_file(error, self.source.address)

    def _enter(self, phase: str) -> None:
        if phase != self.link.phase:
            self.link.phase = phase
            self.changed.emit()
