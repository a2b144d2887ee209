"""CrashReport: a defect is written to the log file and said in one sentence; the program and its recording go on."""

from __future__ import annotations

import logging
import sys
import threading
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from types import TracebackType
from typing import Any

from PySide6.QtCore import (
    QCoreApplication,
    QMessageLogContext,
    QObject,
    QtMsgType,
    Signal,
    Slot,
    qInstallMessageHandler,
)

_LOG = logging.getLogger("imugui")
MOST_LOGGED = 5
"""of one defect in full: one that comes with every frame must not push all others out of the log."""
MOST_PLACES = 1000
LONGEST = 200
"""characters of an error's own words on screen"""
GRAVE = (QtMsgType.QtCriticalMsg, QtMsgType.QtFatalMsg)

Trace = TracebackType | None


class CrashReport(QObject):
    """Takes whatever nobody caught: in the window's thread, in any other, in Qt. ``said`` reaches the window's thread.

    ``say`` is called there with the tone and the sentence, once for each place in the program that fails.
    """

    said = Signal(str, str)  # tone, sentence

    def __init__(self, log: Path | None, say: Callable[[str, str], None]) -> None:
        super().__init__()
        self._log = log
        self._seen: Counter[str] = Counter()
        self._lock = threading.Lock()
        self._before: tuple[Any, ...] = ()
        self._say = say
        self.said.connect(self._tell)  # a slot of its own: it runs in the thread that made this object

    def install(self) -> None:
        """Take over the hooks of Python and Qt; the program must keep this object."""
        before = sys.excepthook, threading.excepthook, sys.unraisablehook
        sys.excepthook = self.take
        threading.excepthook = lambda args: self.take(args.exc_type, args.exc_value, args.exc_traceback)
        sys.unraisablehook = lambda args: self.take(args.exc_type, args.exc_value, args.exc_traceback)
        self._before = (*before, qInstallMessageHandler(self.take_from_qt))

    def remove(self) -> None:
        """Give the hooks back."""
        sys.excepthook, threading.excepthook, sys.unraisablehook, handler = self._before
        qInstallMessageHandler(handler)

    def take(self, kind: type[BaseException], error: BaseException | None, trace: Trace) -> None:
        """An exception that nobody caught, in any thread."""
        if issubclass(kind, KeyboardInterrupt):
            QCoreApplication.quit()
            return
        if issubclass(kind, SystemExit):
            return
        times = self._count(place_of(kind, trace))
        if times <= MOST_LOGGED:
            _LOG.critical("nobody caught this (%d)", times, exc_info=(kind, error or kind(), trace))
            sys.__excepthook__(kind, error or kind(), trace)
        if times == 1:
            self.said.emit("error", self.sentence(f"{kind.__name__}: {error}"))

    def take_from_qt(self, kind: QtMsgType, context: QMessageLogContext, text: str) -> None:
        """What Qt has to say, in any thread: all of it to the log, what is grave to the user too."""
        times = self._count(f"{kind} {text}")
        if times <= MOST_LOGGED:
            _LOG.log(logging.CRITICAL if kind in GRAVE else logging.WARNING, "Qt: %s", text)
            print(text, file=sys.stderr)  # noqa: T201 (as Qt itself does)
        if times == 1 and kind in GRAVE:
            self.said.emit("error", self.sentence(f"Qt: {text}"))

    def sentence(self, what: str) -> str:
        """What to tell the user."""
        words = " ".join(what.split())
        words = words if len(words) <= LONGEST else f"{words[:LONGEST]}..."
        where = f"the details are in {self._log}" if self._log else "it could not be logged"
        return f"A defect in imugui ({words}): {where}; data keep coming in, and a recording goes on."

    @Slot(str, str)
    def _tell(self, tone: str, text: str) -> None:
        self._say(tone, text)

    def _count(self, place: str) -> int:
        with self._lock:
            if len(self._seen) > MOST_PLACES:
                self._seen.clear()
            self._seen[place] += 1
            return self._seen[place]


def place_of(kind: type[BaseException], trace: Trace) -> str:
    """Which defect this is: what was raised, and the line that raised it."""
    while trace is not None and trace.tb_next is not None:
        trace = trace.tb_next
    where = f"{trace.tb_frame.f_code.co_filename}:{trace.tb_lineno}" if trace is not None else ""
    return f"{kind.__name__} {where}"
