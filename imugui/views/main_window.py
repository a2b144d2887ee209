"""The one window: rail, connection bar, pages, status line, and the two timers that drive them."""

from __future__ import annotations

import base64
import binascii
from collections.abc import Callable

from PySide6.QtCore import QByteArray, Qt, QTimer, Slot
from PySide6.QtGui import (
    QCloseEvent,
    QDragEnterEvent,
    QDropEvent,
    QHideEvent,
    QKeyEvent,
    QKeySequence,
    QShortcut,
    QShowEvent,
)
from PySide6.QtWidgets import (
    QAbstractSpinBox,
    QApplication,
    QHBoxLayout,
    QLineEdit,
    QMainWindow,
    QStackedWidget,
    QVBoxLayout,
    QWidget,
)

from imugui.formats.layout import TableError
from imugui.views import VIEWS, theme
from imugui.views.banner import Banner
from imugui.views.column_asking import dialog_for_board, dialog_for_file
from imugui.views.compare_window import CompareWindow
from imugui.views.connection_bar import ConnectionBar
from imugui.views.link_log import LinkLogWindow
from imugui.views.navigation import Navigation
from imugui.views.port_watch import PortWatch
from imugui.views.record_control import RecordControl, show_in_folder
from imugui.views.record_words import ended_words
from imugui.views.replay_bar import ReplayBar
from imugui.views.settings_store import SettingsStore
from imugui.views.shortcuts import KEYS, spare_key
from imugui.views.status_line import StatusLine
from imugui.views.view import View
from imugui.workers.session import Port, RecordingStatus, Session, State

FRAME_MS = 16
SLOW_MS = 125
SIZE = (1280, 800)
SMALLEST = (960, 600)
FIRST_PAGE = "live"


class MainWindow(QMainWindow):
    """Everything on screen. Data are pulled by the timers; only rare events come as signals."""

    def __init__(self, session: Session, settings_store: SettingsStore) -> None:
        super().__init__()
        self.session = session
        self.settings_store = settings_store
        self._theme = ""
        self._take_settings()
        self.pages: dict[str, View] = {name: view(session, settings_store) for name, view in VIEWS.items()}
        self.navigation = Navigation(VIEWS)
        self.bar = ConnectionBar(session, settings_store)
        self.recorder = RecordControl(session)
        self.banner = Banner()
        self.replay = ReplayBar(session)
        self.compare = CompareWindow(session, settings_store, self)
        self.status_line = StatusLine()
        self.link_log = LinkLogWindow(session, self)
        self.stack = QStackedWidget()
        self.ports = PortWatch(session)
        self._lay_out()
        self._connect_parts()
        self._make_shortcuts()
        self.frames = self._timer(FRAME_MS, self.refresh, Qt.TimerType.PreciseTimer)
        self.slow = self._timer(SLOW_MS, self.slow_refresh, Qt.TimerType.CoarseTimer)
        self.show_page(FIRST_PAGE)
        self._restore_geometry()
        for problem in settings_store.problems:
            self.show_message("warn", problem)

    # pages

    @Slot(str)
    def show_page(self, name: str) -> None:
        """Bring a page to the front, up to date."""
        self.stack.setCurrentWidget(self.pages[name])
        self.navigation.select(name)
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
        self.replay.refresh()
        self.compare.refresh()

    @Slot()
    def slow_refresh(self) -> None:
        """Bring texts and controls up to date."""
        status = self.session.status()
        if status.state is State.OPENING:
            self.ports.paused.set()
        else:
            self.ports.paused.clear()
        self.recorder.refresh()
        self.bar.refresh(status)
        self.replay.slow_refresh()
        self.compare.slow_refresh()
        self.status_line.refresh(status)
        self.link_log.refresh(status)
        self.page().slow_refresh()

    # what the keys and buttons do

    @Slot()
    def toggle_connection(self) -> None:
        """Connect or disconnect."""
        self.bar.toggle()

    @Slot()
    def open_recording(self) -> None:
        """Ask for a recording and play it."""
        self.bar.open_recording()

    @Slot()
    def set_origin(self) -> None:
        """Make the present attitude zero."""
        if not self.session.set_origin():
            self.show_message("warn", "The origin needs live data: connect a board first.")
            return
        for page in self.pages.values():
            page.origin_moved()
        self.slow_refresh()

    @Slot()
    def clear_origin(self) -> None:
        """Back to the earth's axes."""
        self.session.clear_origin()
        self.slow_refresh()

    @Slot()
    def toggle_recording(self) -> None:
        """Start or stop recording."""
        self.recorder.toggle()
        self.slow_refresh()

    @Slot()
    def mark(self) -> None:
        """Put a marker into the recording."""
        self.recorder.mark()

    @Slot(object)
    def show_recorded(self, recorded: RecordingStatus) -> None:
        """A recording ended: say so, unless an error has just said why, and offer what to do with it."""
        if self.banner.text() == "" or self.banner.tone != "bad":
            self.show_message("info", ended_words(recorded))
        play = ("Open", "Play this recording", lambda: self.bar.connect_to("replay", str(recorded.path)))
        show = ("Show in folder", f"Show {recorded.path} in the file manager", lambda: show_in_folder(recorded.path))
        self.banner.offer([play, show])

    @Slot()
    def show_link_log(self) -> None:
        """Open the link log, or bring it to the front."""
        self.link_log.show()
        self.link_log.raise_()
        self.link_log.activateWindow()
        self.link_log.refresh(self.session.status())

    @Slot()
    def show_compare(self) -> None:
        """Open the comparison of filters, or bring it to the front."""
        self.compare.show()
        self.compare.raise_()
        self.compare.activateWindow()
        self.compare.slow_refresh()

    @Slot()
    def dismiss_message(self) -> None:
        """Take the message away."""
        self.banner.dismiss()

    @Slot()
    def toggle_full_screen(self) -> None:
        """Full screen on or off."""
        self.setWindowState(self.windowState() ^ Qt.WindowState.WindowFullScreen)

    @Slot()
    def name_columns(self) -> None:
        """Let the user say what the columns of this board, or of this file, mean."""
        choice = self.bar.source.choice()
        try:
            if choice.transport == "replay":
                dialog = dialog_for_file(self.bar.files, choice.address, self.bar.options(), self)
            else:
                dialog = dialog_for_board(self.bar.lines(), choice.text, self.bar.options(), self)
        except (TableError, OSError) as error:
            self.show_message("warn", f"There are no columns to name: {error}.")
            return
        dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        dialog.named.connect(self.bar.keep_options)
        dialog.open()

    @Slot(str, str)
    def _say_assumed(self, tone: str, text: str) -> None:
        """Say what is assumed of a file's columns, and offer to change it."""
        self.show_message(tone, text)
        self.banner.offer([("Columns…", "See and change what the columns mean", self.name_columns)])

    @Slot(str, str)
    def show_message(self, tone: str, text: str) -> None:
        """Say something, unless the verdict says it already: tone "info", "warn" or "error"."""
        if text == self.session.status().sentence:
            return
        self.banner.show_message(tone, text)

    # Qt's events

    def showEvent(self, event: QShowEvent) -> None:
        super().showEvent(event)
        self.ports.start()
        self.frames.start()
        self.slow.start()

    def hideEvent(self, event: QHideEvent) -> None:
        super().hideEvent(event)
        self.frames.stop()
        self.slow.stop()

    def closeEvent(self, event: QCloseEvent) -> None:
        self.frames.stop()
        self.slow.stop()
        self.settings_store.update(window=bytes(self.saveGeometry().toBase64().data()).decode("ascii"))
        self.settings_store.flush()
        self.link_log.close()
        self.ports.stop()
        self.compare.close()
        self.compare.stop()
        self.replay.stop()
        for page in self.pages.values():
            page.stop()
        self.session.close()
        super().closeEvent(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """A key that the widget in focus had no use for."""
        key = spare_key(event.key(), event.modifiers())
        if key is None or self.session.player is None:
            super().keyPressEvent(event)
        else:
            getattr(self.replay, key.action)()

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:
        if any(url.isLocalFile() for url in event.mimeData().urls()):
            event.acceptProposedAction()

    def dropEvent(self, event: QDropEvent) -> None:
        files = [url.toLocalFile() for url in event.mimeData().urls() if url.isLocalFile()]
        if files:
            event.acceptProposedAction()
            self.bar.open_files(files)

    # parts

    def _lay_out(self) -> None:
        self.setWindowTitle("imugui")
        self.setAcceptDrops(True)
        self.setMinimumSize(*SMALLEST)
        self.resize(*SIZE)
        for page in self.pages.values():
            self.stack.addWidget(page)
        right = QVBoxLayout()
        right.setContentsMargins(0, 0, 0, 0)
        right.setSpacing(0)
        for widget in (self.bar, self.banner):
            right.addWidget(widget)
        right.addWidget(self.stack, 1)
        right.addWidget(self.replay)
        right.addWidget(self.status_line)
        middle = QWidget()
        row = QHBoxLayout(middle)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(0)
        row.addWidget(self.navigation)
        row.addLayout(right, 1)
        self.setCentralWidget(middle)
        self.bar.button.setFocus()

    def _connect_parts(self) -> None:
        self.session.message.connect(self.show_message)
        self.session.state_changed.connect(self.slow_refresh)
        self.settings_store.failed.connect(self._save_failed)
        self.settings_store.changed.connect(self._take_settings)
        self.navigation.chosen.connect(self.show_page)
        self.status_line.clicked.connect(self.show_link_log)
        self.bar.verdict.log_wanted.connect(self.show_link_log)
        self.bar.columns_wanted.connect(self.name_columns)
        self.bar.assumed.connect(self._say_assumed)
        self.bar.tools.origin_wanted.connect(self.set_origin)
        self.bar.tools.clear_wanted.connect(self.clear_origin)
        self.bar.tools.record.button.clicked.connect(self.toggle_recording)
        self.recorder.ended.connect(self.show_recorded)
        self.recorder.marked.connect(self.bar.recording.show_marker)
        self.recorder.said.connect(self.show_message)
        self.replay.appeared.connect(self._give_keys_to_replay)
        self.replay.compare_wanted.connect(self.show_compare)
        self.compare.sought.connect(self.replay.seek)
        self.ports.found.connect(self._ports_found)
        for page in self.pages.values():
            page.wanted.connect(self.bar.connect_to)
            page.said.connect(self.show_message)
            page.record_wanted.connect(self.toggle_recording)
            self.compare.ghost.connect(page.show_ghost)

    def _make_shortcuts(self) -> None:
        for key in (key for key in KEYS if not key.spare):
            slot = self._on_page(key.action) if key.page else getattr(self, key.action)
            QShortcut(QKeySequence(key.keys), self).activated.connect(slot)
        for number, name in enumerate(self.pages, 1):
            QShortcut(QKeySequence(str(number)), self).activated.connect(lambda name=name: self.show_page(name))

    def _on_page(self, action: str) -> Callable[[], None]:
        """What a key does on the page in front, if that page knows it."""
        return lambda: getattr(self.page(), action, lambda: None)()

    def _timer(self, period_ms: int, slot: Callable[[], None], kind: Qt.TimerType) -> QTimer:
        timer = QTimer(self)
        timer.setTimerType(kind)
        timer.setInterval(period_ms)
        timer.timeout.connect(slot)
        return timer

    def _restore_geometry(self) -> None:
        try:
            kept = base64.b64decode(self.settings_store.settings.window, validate=True)
        except (binascii.Error, ValueError):
            return
        self.restoreGeometry(QByteArray(kept))

    @Slot()
    def _give_keys_to_replay(self) -> None:
        """Space plays and pauses from now on: it must not disconnect what was connected with it."""
        if not isinstance(self.focusWidget(), (QLineEdit, QAbstractSpinBox)):
            self.replay.timeline.setFocus()

    @Slot(list)
    def _ports_found(self, ports: list[Port]) -> None:
        self.bar.show_ports(ports)
        for page in self.pages.values():
            page.show_ports(ports)

    @Slot()
    def _take_settings(self) -> None:
        """The colours act at once; pages read the other settings when they refresh."""
        scheme = self.settings_store.settings.theme
        app = QApplication.instance()
        if scheme != self._theme and isinstance(app, QApplication):
            self._theme = scheme
            theme.apply(app, scheme)

    @Slot(str)
    def _save_failed(self, text: str) -> None:
        self.show_message("warn", text)
