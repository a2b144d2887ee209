"""The link log: everything on the link that was not data, as it came."""

from __future__ import annotations

from PySide6.QtCore import Qt, Slot
from PySide6.QtGui import QFontDatabase, QGuiApplication
from PySide6.QtWidgets import QDialog, QHBoxLayout, QPlainTextEdit, QVBoxLayout, QWidget

from imugui.views.controls import Button, StillBox
from imugui.views.labels import muted
from imugui.workers.session import Session, Status

Entry = tuple[float, str, str]
KINDS = {"all": "Everything", "chatter": "Text from the board", "bad": "Bad messages", "note": "Notes of imugui"}
NOTHING = "Nothing yet. Banners, damaged lines and notes about the format appear here."


def line_of(entry: Entry, start: float) -> str:
    """One entry as text; time in s after ``start``."""
    t, kind, text = entry
    return f"{t - start:10.3f} s  {kind:<8} {text}"


class LinkLogWindow(QDialog):
    """Beside the main window; follows the end while the end is in view."""

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle("Link log")
        self.resize(760, 420)
        self._session = session
        self._entries: list[Entry] = []
        self._version = 0  # of the entries
        self._shown = ("", -1)
        self.counts = muted()
        self.kind = StillBox("Kind", "Which entries to show")
        for name, title in KINDS.items():
            self.kind.add(title, name)
        self.kind.currentIndexChanged.connect(self._show)
        self.text = QPlainTextEdit()
        self.text.setReadOnly(True)
        self.text.setLineWrapMode(QPlainTextEdit.LineWrapMode.NoWrap)
        self.text.setFont(QFontDatabase.systemFont(QFontDatabase.SystemFont.FixedFont))
        self.text.setAccessibleName("Entries")
        self.text.setPlaceholderText(NOTHING)
        self._lay_out()

    def refresh(self, status: Status) -> None:
        """Take what is new; nothing is done while the window is hidden."""
        if not self.isVisible():
            return
        entries = self._session.link_log()
        if entries and entries != self._entries:
            self._entries = entries
            self._version += 1
        self.counts.setText(
            f"{status.messages} messages, {status.bad_messages} bad, {status.samples} samples, "
            f"{len(self._entries)} entries kept. Times are seconds after the first entry here."
        )
        self._show()

    @Slot()
    def copy(self) -> None:
        """Put the text into the clipboard."""
        QGuiApplication.clipboard().setText(self.text.toPlainText())

    @Slot()
    def _show(self) -> None:
        kind = self.kind.currentData()
        if (kind, self._version) == self._shown:
            return
        self._shown = (kind, self._version)
        chosen = [entry for entry in self._entries if kind in ("all", entry[1])]
        start = self._entries[0][0] if self._entries else 0.0
        bar = self.text.verticalScrollBar()
        at_end = bar.value() >= bar.maximum() - 2
        place = bar.value()
        self.text.setPlainText("\n".join(line_of(entry, start) for entry in chosen))
        bar.setValue(bar.maximum() if at_end else place)

    def _lay_out(self) -> None:
        copy = Button("Copy", "Put the text into the clipboard")
        close = Button("Close", "Close the link log")
        copy.clicked.connect(self.copy)
        close.clicked.connect(self.hide)
        copy.setAutoDefault(False)
        close.setAutoDefault(False)
        foot = QHBoxLayout()
        foot.addWidget(self.kind)
        foot.addWidget(self.counts, 1, Qt.AlignmentFlag.AlignVCenter)
        foot.addWidget(copy)
        foot.addWidget(close)
        column = QVBoxLayout(self)
        column.setContentsMargins(16, 16, 16, 16)
        column.setSpacing(12)
        column.addWidget(self.text, 1)
        column.addLayout(foot)
