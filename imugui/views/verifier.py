"""Verifier: computes a recording again in a process of its own, so that nothing here waits or stutters."""

from __future__ import annotations

import os
import sys
import time
from pathlib import Path

from PySide6.QtCore import QObject, QProcess, QProcessEnvironment, Signal, Slot

import imugui

EQUAL = "largest difference 0 deg"
KILL_WAIT_MS = 2000


class Verifier(QObject):
    """Runs ``imugui verify`` on one recording at a time."""

    said = Signal(str, str)  # tone "good", "warn" or "bad", sentence

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.path: Path | None = None  # what is being verified
        self._started = 0.0
        self._process = QProcess(self)
        self._process.finished.connect(self._finished)
        self._process.errorOccurred.connect(self._not_started)

    @property
    def running_s(self) -> float:
        """How long it has been running, s."""
        return time.perf_counter() - self._started

    def start(self, path: Path) -> None:
        """Verify this recording; what was being verified is given up."""
        self.cancel()
        self.path, self._started = path, time.perf_counter()
        environment = QProcessEnvironment.systemEnvironment()
        home = str(Path(imugui.__file__).parent.parent)
        kept = environment.value("PYTHONPATH")
        environment.insert("PYTHONPATH", os.pathsep.join(filter(None, (home, kept))))
        self._process.setProcessEnvironment(environment)
        self._process.start(sys.executable, ["-m", "imugui", "verify", str(path)])

    @Slot()
    def cancel(self) -> None:
        """Give up, quietly."""
        self.path = None
        if self._process.state() is not QProcess.ProcessState.NotRunning:
            self._process.kill()
            self._process.waitForFinished(KILL_WAIT_MS)

    @Slot(int, QProcess.ExitStatus)
    def _finished(self, code: int, _: QProcess.ExitStatus) -> None:
        path, self.path = self.path, None
        if path is None:
            return
        said = bytes(self._process.readAllStandardOutput().data()).decode(errors="replace").strip()
        wrong = bytes(self._process.readAllStandardError().data()).decode(errors="replace").strip()
        if code:
            self.said.emit("bad", wrong.splitlines()[-1] if wrong else f"{path.name} could not be verified.")
        else:
            self.said.emit("good" if EQUAL in said else "warn", f"{path.name}: {said}")

    @Slot(QProcess.ProcessError)
    def _not_started(self, error: QProcess.ProcessError) -> None:
        if self.path is not None and error is QProcess.ProcessError.FailedToStart:
            self.path = None
            self.said.emit("bad", f"Python could not be started: {self._process.errorString()}.")
