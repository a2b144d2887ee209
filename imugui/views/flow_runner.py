"""FlowRunner: drives one guided calibration in a thread of its own, so that no fit ever holds up the window."""

from __future__ import annotations

import logging
import queue
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from PySide6.QtCore import QThread, Signal

from imugui.calibration.flow import Flow, Result
from imugui.samples import SAMPLE, Rows, empty_rows

_LOG = logging.getLogger(__name__)
_STOP = None
MOST_ROWS = 20_000  # of the newest, for plot and comparison
Look = Callable[[Any, Rows], Any]


@dataclass(frozen=True, eq=False)
class Step:
    """What a flow says after a block of rows; ``result`` only once there is enough for a verdict."""

    progress: float
    sentence: str
    missing: tuple[str, ...]
    done: bool
    result: Result | None
    picture: Any  # what Guide.look made of the flow


class FlowRunner(QThread):
    """Takes blocks of raw rows, feeds the flow and tells each step. The flow is touched by this thread alone."""

    stepped = Signal(object)  # Step
    failed = Signal(str)

    def __init__(self, flow: Flow, look: Look, pace_s: float = 0.0, ends: bool = False) -> None:
        """``pace_s``: least time between two verdicts, s; ``ends``: rows are left alone once the flow is done."""
        super().__init__()
        self._pace_s, self._ends = pace_s, ends
        self._judged_t = -np.inf
        self._result: Result | None = None
        self._flow = flow
        self._look = look
        self._inbox: queue.SimpleQueue[Rows | str | None] = queue.SimpleQueue()

    def feed(self, rows: Rows) -> None:
        """Hand over a block of raw SAMPLE rows."""
        if len(rows):
            self._inbox.put(rows)

    def ask(self, method: str) -> None:
        """Call a method of the flow, in its thread."""
        self._inbox.put(method)

    def stop(self) -> None:
        """End, and wait until the thread is gone."""
        self._inbox.put(_STOP)
        self.wait()

    def run(self) -> None:
        try:
            recent = empty_rows(SAMPLE, 0)
            self.stepped.emit(self._look_at(recent))
            while (rows := self._pending()) is not None:
                if self._ends and self._flow.done:
                    continue
                self._flow.feed(rows)
                recent = np.concatenate((recent, rows))[-MOST_ROWS:]
                self.stepped.emit(self._look_at(recent))
        except Exception as error:
            _LOG.exception("calibration flow")
            self.failed.emit(f"A defect in imugui: {type(error).__name__}: {error}. Nothing was changed.")

    def _pending(self) -> Rows | None:
        """All rows that wait, as one block; None when it is time to end. Methods that were asked for are called."""
        items = [self._inbox.get()]
        while not self._inbox.empty():
            items.append(self._inbox.get())
        if _STOP in [item for item in items if not isinstance(item, np.ndarray)]:
            return None
        for method in (item for item in items if isinstance(item, str)):
            getattr(self._flow, method)()
        blocks = [item for item in items if isinstance(item, np.ndarray)]
        return np.concatenate(blocks) if blocks else empty_rows(SAMPLE, 0)

    def _look_at(self, recent: Rows) -> Step:
        """A snapshot of the flow, and of the newest rows it got."""
        flow, now = self._flow, time.monotonic()
        done = flow.done
        if done and now - self._judged_t >= self._pace_s:
            self._judged_t, self._result = now, flow.result()
        result = self._result if done else None
        return Step(flow.progress, flow.sentence, flow.missing, done, result, self._look(flow, recent))
