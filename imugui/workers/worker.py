"""Worker: a thread that repeats one plain step until it is stopped."""

from __future__ import annotations

import logging
import math
import threading
from logging.handlers import RotatingFileHandler

from PySide6.QtCore import QThread, Signal

_LOG = logging.getLogger(__name__)


def log_file() -> str:
    """Where the program writes its log; "" when it writes none."""
    handlers = logging.getLogger().handlers
    return next((handler.baseFilename for handler in handlers if isinstance(handler, RotatingFileHandler)), "")


class Worker(QThread):
    """Calls ``step`` until ``stop``; tests call ``step`` themselves, without a thread.

    ``step`` must return within about 0.1 s. It runs in the worker's thread; nothing else of a subclass does.
    """

    failed = Signal(str)  # a defect of the program: what happened; the loop goes on

    def __init__(self) -> None:
        super().__init__()
        self.stopping = threading.Event()

    def step(self) -> None:
        """Do one round of work."""
        raise TypeError("a worker defines its step")

    def finish(self) -> None:
        """Give back what the worker holds; called once in its thread after the last step."""

    def run(self) -> None:
        reported = False
        while not self.stopping.is_set():
            try:
                self.step()
            except Exception as error:
                _LOG.exception("worker %s", type(self).__name__)
                if not reported:
                    reported = True
                    self.failed.emit(f"{type(self).__name__}: {type(error).__name__}: {error}")
                self.stopping.wait(0.1)
        self.finish()

    def stop(self, patience_s: float = math.inf) -> bool:
        """End the loop and wait until the thread is gone, for so long at the most; whether it is."""
        self.stopping.set()
        return self.wait() if math.isinf(patience_s) else self.wait(round(1e3 * patience_s))
