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
    QHBoxLayout,
    QLineEdit,
    QVBoxLayout,
    QWidget,
)

from imugui.views import PAGES
from imugui.views.board_desk import BoardDesk
from imugui.views.boards_window import FIRST_PAGE, BoardsWindow
from imugui.views.record_control import show_in_folder
from imugui.views.record_words import ended_words
from imugui.views.relative_words import aligned_words
from imugui.views.settings_store import SettingsStore
from imugui.views.shortcuts import KEYS, spare_key
from imugui.workers.session import RecordingStatus, Session

FRAME_MS = 16
SLOW_MS = 125
SIZE = (1280, 800)
SMALLEST = (960, 600)
NO_ORIGIN = "The origin needs live data: connect a board first."
NO_ALIGNMENT = "Aligning needs live data of both boards: connect the tool and the reference first."


class MainWindow(BoardsWindow):
    """Everything on screen. Data are pulled by the timers; only rare events come as signals."""

    def __init__(self, session: Session, settings_store: SettingsStore) -> None:
        super().__init__(session, settings_store)
        self._lay_out()
        settings_store.failed.connect(self._save_failed)
        settings_store.changed.connect(self._take_settings)
        self._make_shortcuts()
        self.frames = self._timer(FRAME_MS, self.refresh, Qt.TimerType.PreciseTimer)
        self.slow = self._timer(SLOW_MS, self.slow_refresh, Qt.TimerType.CoarseTimer)
        self.show_page(FIRST_PAGE)
        self._restore_geometry()
        for problem in settings_store.problems:
            self.show_message("warn", problem)

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
        against = self.session.relative
        if not self.session.set_origin():
            self.show_message("warn", NO_ORIGIN if against is None else NO_ALIGNMENT)
            return
        if against is not None:
            tone, words = aligned_words(against.status())
            if words:
                self.show_message(tone, words)
        for page in self.pages.values():
            page.origin_moved()
        self.slow_refresh()

    @Slot()
    def clear_origin(self) -> None:
        """Back to the earth's axes."""
        self.session.clear_origin()
        if self.session.relative is not None:
            for page in self.pages.values():
                page.origin_moved()
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
        from imugui.formats.layout import TableError  # start-up time
        from imugui.views.column_asking import dialog_for_board, dialog_for_file

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
            self.banner.let_go()
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
        self.ports.stop()
        self.hide()  # a port that is being opened may keep the program for some seconds, but not the window
        self.stop_boards()
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
        right = QVBoxLayout()
        right.setContentsMargins(0, 0, 0, 0)
        right.setSpacing(0)
        right.addWidget(self.strip)
        right.addLayout(self.bars)
        right.addWidget(self.banner)
        right.addWidget(self.stack, 1)
        right.addLayout(self.feet)
        middle = QWidget()
        row = QHBoxLayout(middle)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(0)
        row.addWidget(self.navigation)
        row.addLayout(right, 1)
        self.setCentralWidget(middle)
        self.bar.button.setFocus()

    def connect_desk(self, desk: BoardDesk) -> None:
        desk.said.connect(self.show_message)
        desk.record_wanted.connect(self.toggle_recording)
        desk.status_line.clicked.connect(self.show_link_log)
        desk.bar.verdict.log_wanted.connect(self.show_link_log)
        desk.bar.columns_wanted.connect(self.name_columns)
        desk.bar.assumed.connect(self._say_assumed)
        desk.bar.tools.origin_wanted.connect(self.set_origin)
        desk.bar.tools.clear_wanted.connect(self.clear_origin)
        desk.bar.tools.record.button.clicked.connect(self.toggle_recording)
        desk.recorder.ended.connect(self.show_recorded)
        desk.replay.appeared.connect(self._give_keys_to_replay)
        desk.replay.compare_wanted.connect(self.show_compare)

    def _make_shortcuts(self) -> None:
        for key in (key for key in KEYS if not key.spare):
            slot = self._on_page(key.action) if key.page else getattr(self, key.action)
            QShortcut(QKeySequence(key.keys), self).activated.connect(slot)
        for number, name in enumerate(PAGES, 1):
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

    @Slot(str)
    def _save_failed(self, text: str) -> None:
        self.show_message("warn", text)
