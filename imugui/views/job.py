"""Job: one piece of long work in a thread of its own, with progress, and a Cancel that works."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable
from typing import Any

from PySide6.QtCore import QObject, QThread, Signal, Slot

from imugui.recording import UnreadableError

_LOG = logging.getLogger(__name__)


class CancelledError(Exception):
    """Raised in the thread, once nobody wants the result any more."""


class Job(QThread):
    """Runs ``work(job)`` once; the work calls ``job.progress`` and so learns that it was cancelled."""

    progressed = Signal(float)  # share done, 0 to 1
    succeeded = Signal(object)  # the result
    failed = Signal(str)  # why there is none, in one line

    def __init__(self, work: Callable[[Job], Any], parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._work = work
        self._cancelled = threading.Event()

    def cancel(self) -> None:
        """Want the result no more: nothing is told from now on."""
        self._cancelled.set()

    def stop(self) -> None:
        """Cancel, and wait until the thread is gone."""
        self.cancel()
        self.wait()

    def progress(self, share: float) -> None:
        """Called by the work: a share from 0 to 1 is done; raises CancelledError."""
        if self._cancelled.is_set():
            raise CancelledError
        self.progressed.emit(share)

    def run(self) -> None:
        try:
            result = self._work(self)
        except CancelledError:
            return
        except (UnreadableError, OSError, MemoryError) as error:
            self._tell(self.failed, str(error) or type(error).__name__)
        except Exception as error:
            _LOG.exception("job")
            self._tell(self.failed, f"A defect in imugui: {type(error).__name__}: {error}")
        else:
            self._tell(self.succeeded, result)

    def _tell(self, signal: Any, what: object) -> None:
        if not self._cancelled.is_set():
            signal.emit(what)


class Jobs(QObject):
    """The jobs of one widget: keeps those that run, and lets go of those that have finished."""

    def __init__(self, parent: QObject) -> None:
        super().__init__(parent)
        self._running: list[Job] = []

    def start(self, work: Callable[[Job], Any], done: Callable[[Any], object], failed: Callable[[str], object]) -> Job:
        """Start work; ``done`` gets its result and ``failed`` its problem.

        Both are bound methods of QObjects, so that they are called in the thread of these.
        """
        job = Job(work)
        job.succeeded.connect(done)
        job.failed.connect(failed)
        job.finished.connect(self._tidy)
        self._running.append(job)
        job.start()
        return job

    def stop(self) -> None:
        """Cancel all, and wait until their threads are gone."""
        for job in self._running:
            job.cancel()
        for job in self._running:
            job.wait()
        self._running.clear()

    @Slot()
    def _tidy(self) -> None:
        self._running = [job for job in self._running if not job.isFinished()]
