"""BoardDesk: what the window has for each board. Most of it is made when it is first wanted."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal, Slot
from PySide6.QtWidgets import QStackedWidget, QVBoxLayout, QWidget

from imugui.views import VIEWS
from imugui.views.connection_bar import ConnectionBar
from imugui.views.link_log import LinkLogWindow
from imugui.views.record_control import RecordControl
from imugui.views.replay_bar import ReplayBar
from imugui.views.settings_store import SettingsStore
from imugui.views.status_line import StatusLine
from imugui.views.view import View
from imugui.workers.session import Port, Session, Status

if TYPE_CHECKING:
    from imugui.views.compare_window import CompareWindow

OWN_PAGES = ("live", "calibrate", "record", "signals")
"""Pages that each board has; the others are there once, and work with the first board."""


class BoardDesk(QObject):
    """Session, connection bar, recording, replay, status line, link log and pages of one board."""

    said = Signal(str, str)  # tone, sentence
    record_wanted = Signal()

    def __init__(
        self, session: Session, settings_store: SettingsStore, window: QWidget, stack: QStackedWidget, name: str = ""
    ) -> None:
        """``stack`` holds the pages of all boards; ``name`` stands before what a second board says."""
        super().__init__(window)
        self.session, self.name = session, name
        self._settings_store, self._window, self._stack = settings_store, window, stack
        self.pages: dict[str, View] = {}  # those that were opened
        self.opened_compare: CompareWindow | None = None
        self._ports: list[Port] = []
        self.bar = ConnectionBar(session, settings_store, keeps=not name)
        self.recorder = RecordControl(session)
        self.replay = ReplayBar(session)
        self.status_line = StatusLine()
        self.link_log = LinkLogWindow(session, window)
        self.foot = QWidget()
        column = QVBoxLayout(self.foot)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        for part in (self.replay, self.status_line):
            column.addWidget(part)
        for source in (session.message, self.recorder.said):
            source.connect(self._say)
        self.recorder.marked.connect(self.bar.recording.show_marker)

    def page(self, name: str) -> View:
        """A page of this board; most are never opened, and the window does not wait for them."""
        if name not in self.pages:
            page = self.pages[name] = VIEWS[name](self.session, self._settings_store)
            page.wanted.connect(self.bar.connect_to)
            page.said.connect(self._say)
            page.record_wanted.connect(self.record_wanted)
            if self.opened_compare is not None:
                self.opened_compare.ghost.connect(page.show_ghost)
            page.show_ports(self._ports)
            self._stack.addWidget(page)
        return self.pages[name]

    @property
    def compare(self) -> CompareWindow:
        """The comparison of filters, made when it is first wanted."""
        if self.opened_compare is None:
            from imugui.views.compare_window import CompareWindow

            self.opened_compare = CompareWindow(self.session, self._settings_store, self._window)
            self.opened_compare.sought.connect(self.replay.seek)
            for page in self.pages.values():
                self.opened_compare.ghost.connect(page.show_ghost)
        return self.opened_compare

    def show_ports(self, ports: list[Port]) -> None:
        """Take a new list of serial ports."""
        self._ports = ports
        self.bar.show_ports(ports)
        for page in self.pages.values():
            page.show_ports(ports)

    def bring_to_front(self, on: bool) -> None:
        """Show this board's bars, or hide them."""
        for part in (self.bar, self.foot):
            part.setVisible(on)

    def refresh(self) -> None:
        """Paint what moves beside the page."""
        self.replay.refresh()
        if self.opened_compare is not None:
            self.opened_compare.refresh()

    def slow_refresh(self, status: Status) -> None:
        """Bring words and controls up to date."""
        self.recorder.refresh()
        self.bar.refresh(status)
        self.replay.slow_refresh()
        if self.opened_compare is not None:
            self.opened_compare.slow_refresh()
        self.status_line.refresh(status)
        self.link_log.refresh(status)

    def stop(self) -> None:
        """End what runs for this board, and its session."""
        self.link_log.close()
        if self.opened_compare is not None:
            self.opened_compare.close()
            self.opened_compare.stop()
        self.replay.stop()
        for page in self.pages.values():
            page.stop()
        self.session.close()

    def remove(self) -> None:
        """Take the board out of the window."""
        self.stop()
        for page in self.pages.values():
            self._stack.removeWidget(page)
        for widget in (*self.pages.values(), self.bar, self.foot, self.link_log, self.opened_compare):
            if widget is not None:
                widget.deleteLater()
        self.deleteLater()

    @Slot(str, str)
    def _say(self, tone: str, text: str) -> None:
        self.said.emit(tone, f"{self.name}: {text}" if self.name else text)
