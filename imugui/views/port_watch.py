"""PortWatch: looks for serial ports once a second, in its own thread, because some systems take long to answer."""

from __future__ import annotations

import threading

from PySide6.QtCore import QThread, Signal

from imugui.workers.session import Port, Session

PERIOD_S = 1.0


class PortWatch(QThread):
    """``found`` tells every change. While ``paused`` is set nothing is asked: no port is disturbed in opening."""

    found = Signal(list)  # of Port

    def __init__(self, session: Session) -> None:
        super().__init__()
        self.paused = threading.Event()
        self._stopping = threading.Event()
        self._session = session
        self._known: list[Port] | None = None

    def look(self) -> None:
        """Ask once, and tell when the answer is new."""
        try:
            ports = self._session.serial_ports()
        except OSError:  # a device vanished while it was being read; the next look tells
            return
        if ports != self._known:
            self._known = ports
            self.found.emit(ports)

    def run(self) -> None:
        while not self._stopping.is_set():
            if not self.paused.is_set():
                self.look()
            self._stopping.wait(PERIOD_S)

    def stop(self) -> None:
        """End the thread and wait until it is gone."""
        self._stopping.set()
        self.wait()
