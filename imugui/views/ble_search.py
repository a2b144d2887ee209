"""BleSearch: looks for Bluetooth boards while somebody wants to see them, and tells what changed."""

from __future__ import annotations

import dataclasses
import time
from functools import cached_property
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QTimer, Signal, Slot

from imugui.workers.session import Session

if TYPE_CHECKING:
    from imugui.workers.session import Scan, Sighting

LOOK_MS = 200
BURST_S = 3.0  # of one scan: between two of them a connection gets its turn
PAUSE_MS = 2000  # after a scan that failed: Bluetooth may be switched on meanwhile
FORGET_S = 12.0  # a board that is heard no more is listed so long


class BleSearch(QObject):
    """Never blocks: the scan runs in the Bluetooth thread, a timer looks at what it has found."""

    changed = Signal()  # boards, problem or running

    def __init__(self, session: Session, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.used = False  # somebody has asked for Bluetooth, which some systems make the user allow
        self.problem = ""  # why nothing can be seen, and what to do
        self._session = session
        self._seen: dict[str, Sighting] = {}  # by address, in the order of first sight
        self._waited = 0  # ms since a scan failed
        self._timer = QTimer(self)
        self._timer.setInterval(LOOK_MS)
        self._timer.timeout.connect(self._look)

    @cached_property
    def _scan(self) -> Scan:
        """Made when it is first wanted: start-up time."""
        return self._session.bluetooth.scan()

    @property
    def running(self) -> bool:
        """Whether it looks."""
        return self._timer.isActive()

    @property
    def boards(self) -> list[Sighting]:
        """What was seen lately, in the order of first sight."""
        return list(self._seen.values())

    @Slot()
    def start(self) -> None:
        """Look until ``stop``."""
        self.used = True
        if not self.running:
            self._timer.start()
            self._begin()
            self.changed.emit()

    @Slot()
    def stop(self) -> None:
        """Look no further; what was seen stays."""
        if self.running:
            self._timer.stop()
            self._scan.stop()

    @Slot()
    def _look(self) -> None:
        before = list(self._seen.values()), self.problem
        now = time.perf_counter()
        for board in self._scan.boards:
            self._meet(board)
        self._seen = {key: board for key, board in self._seen.items() if now - board.t < FORGET_S}
        if not self._scan.running:
            self._next()
        elif self._scan.boards:
            self.problem = ""
        if before != (list(self._seen.values()), self.problem):
            self.changed.emit()

    def _meet(self, board: Sighting) -> None:
        """An advertisement may lack what another one told."""
        old = self._seen.get(board.address, board)
        name, services = board.name or old.name, board.services or old.services
        self._seen[board.address] = dataclasses.replace(board, name=name, services=services)

    def _next(self) -> None:
        """A scan is over: say why if it failed, and begin another, after a pause where it did."""
        found = self._scan.problem
        self.problem = found.sentence if found else ""
        self._waited += LOOK_MS
        if found is None or self._waited >= PAUSE_MS:
            self._waited = 0
            self._begin()

    def _begin(self) -> None:
        try:
            self._scan.start(BURST_S)
        except RuntimeError:  # the program ends
            self._timer.stop()
