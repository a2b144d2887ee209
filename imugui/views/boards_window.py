"""BoardsWindow: the part of the window that knows of one board or two, and which page of which is in front."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import Slot
from PySide6.QtWidgets import QApplication, QMainWindow, QStackedWidget, QVBoxLayout

from imugui.views import PAGES, theme
from imugui.views.banner import Banner
from imugui.views.board_desk import OWN_PAGES, BoardDesk
from imugui.views.board_strip import BoardStrip
from imugui.views.connection_bar import ConnectionBar
from imugui.views.link_log import LinkLogWindow
from imugui.views.navigation import Navigation
from imugui.views.port_watch import PortWatch
from imugui.views.record_control import RecordControl
from imugui.views.replay_bar import ReplayBar
from imugui.views.settings_store import SettingsStore
from imugui.views.status_line import StatusLine
from imugui.views.view import View
from imugui.workers.session import Port, Session, State

if TYPE_CHECKING:
    from imugui.views.compare_window import CompareWindow

FIRST_PAGE = "live"
RELATIVE_PAGES = ("live", "guide")
"""Pages that show one board against the other."""
SECOND = "Board 2"


class BoardsWindow(QMainWindow):
    """Pages, keys and messages are of the board in front: ``desk``."""

    def __init__(self, session: Session, settings_store: SettingsStore) -> None:
        super().__init__()
        self.settings_store = settings_store
        self._theme = ""
        self._take_settings()
        self.navigation = Navigation(PAGES)
        self.banner = Banner()
        self.stack = QStackedWidget()
        self.strip = BoardStrip()
        self.bars, self.feet = QVBoxLayout(), QVBoxLayout()
        self.ports = PortWatch(session)
        self._ports: list[Port] = []
        self._page = FIRST_PAGE
        self.desks: list[BoardDesk] = []
        self.desk = self._take_in(session)
        self.navigation.chosen.connect(self.show_page)
        self.strip.chosen.connect(self.choose_board)
        self.strip.removed.connect(self.remove_board)
        self.strip.relative_wanted.connect(self.set_relative)
        self.ports.found.connect(self._ports_found)

    def connect_desk(self, desk: BoardDesk) -> None:
        """Connect what a board's controls want with what the window does."""

    def show_message(self, tone: str, text: str) -> None:
        """Say something: tone "info", "warn" or "error"."""

    # pages

    @Slot(str)
    def show_page(self, name: str) -> None:
        """Bring a page to the front, up to date; pages that are there once come with the first board."""
        if name not in OWN_PAGES:
            self._bring_to_front(0)
        self._page = name
        self.stack.setCurrentWidget(self.desk.page(name))
        self.navigation.select(name)
        number = self.desks.index(self.desk)
        self.strip.show_chosen(number, offers_relative=number == 0 and name in RELATIVE_PAGES)
        self.slow_refresh()
        self.refresh()

    def page(self) -> View:
        """The page in front."""
        page = self.stack.currentWidget()
        assert isinstance(page, View)  # noqa: S101
        return page

    @Slot()
    def refresh(self) -> None:
        """Paint the page in front."""
        self.page().refresh()
        self.desk.refresh()

    @Slot()
    def slow_refresh(self) -> None:
        """Bring texts and controls up to date; boards that are not in front are looked after too."""
        statuses = [desk.session.status() for desk in self.desks]
        if any(status.state is State.OPENING for status in statuses):
            self.ports.paused.set()
        else:
            self.ports.paused.clear()
        for desk, status in zip(self.desks, statuses, strict=True):
            if desk is self.desk:
                desk.slow_refresh(status)
            else:
                desk.recorder.refresh()
        self.strip.refresh(self.desks[0].session)
        self.page().slow_refresh()

    # boards

    @Slot()
    def add_board(self) -> None:
        """A second board beside the first."""
        if len(self.desks) == 1:
            desk = self._take_in(self.desks[0].session.beside(), SECOND)
            desk.show_ports(self._ports)
            self._show_strip()
        self.choose_board(1)

    @Slot()
    def remove_board(self) -> None:
        """Disconnect the second board, and take it away."""
        if self.desks[-1].session.recording is not None:
            self.show_message("warn", f"{SECOND} is being recorded. Stop its recording first.")
            return
        self.set_relative(False)
        self.choose_board(0)
        if len(self.desks) > 1:
            self.desks.pop().remove()
        self._show_strip()

    @Slot(int)
    def choose_board(self, number: int) -> None:
        """Bring a board to the front."""
        self._bring_to_front(number)
        self.show_page(self._page if number == 0 or self._page in OWN_PAGES else FIRST_PAGE)

    @Slot(bool)
    def set_relative(self, on: bool) -> None:
        """Look at the first board in the frame of the second, or of the earth."""
        self.desks[0].session.measure_against(self.desks[1].session if on and len(self.desks) > 1 else None)
        self.slow_refresh()

    def stop_boards(self) -> None:
        """End all that runs."""
        for desk in reversed(self.desks):
            desk.stop()

    def _take_in(self, session: Session, name: str = "") -> BoardDesk:
        desk = BoardDesk(session, self.settings_store, self, self.stack, name)
        self.desks.append(desk)
        self.bars.addWidget(desk.bar)
        self.feet.addWidget(desk.foot)
        desk.bar.board_wanted.connect(self.add_board)
        session.state_changed.connect(self.slow_refresh)
        self.connect_desk(desk)
        return desk

    def _bring_to_front(self, number: int) -> None:
        self.desk = self.desks[number]
        for desk in self.desks:
            desk.bring_to_front(desk is self.desk)

    def _show_strip(self) -> None:
        several = len(self.desks) > 1
        self.strip.setVisible(several)
        for desk in self.desks:
            desk.bar.add_button.setVisible(not several)

    @Slot(list)
    def _ports_found(self, ports: list[Port]) -> None:
        self._ports = ports
        for desk in self.desks:
            desk.show_ports(ports)

    @Slot()
    def _take_settings(self) -> None:
        """The colours act at once; pages read the other settings when they refresh."""
        scheme = self.settings_store.settings.theme
        app = QApplication.instance()
        if scheme != self._theme and isinstance(app, QApplication):
            self._theme = scheme
            theme.apply(app, scheme)

    # of the board in front

    @property
    def session(self) -> Session:
        return self.desk.session

    @property
    def bar(self) -> ConnectionBar:
        return self.desk.bar

    @property
    def recorder(self) -> RecordControl:
        return self.desk.recorder

    @property
    def replay(self) -> ReplayBar:
        return self.desk.replay

    @property
    def status_line(self) -> StatusLine:
        return self.desk.status_line

    @property
    def link_log(self) -> LinkLogWindow:
        return self.desk.link_log

    @property
    def compare(self) -> CompareWindow:
        """The comparison of filters, made when it is first wanted."""
        return self.desk.compare

    @property
    def pages(self) -> dict[str, View]:
        """Pages that were opened."""
        return self.desk.pages
