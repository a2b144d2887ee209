"""The recordings of the folder, and what can be done with each."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QFile, QItemSelectionModel, Qt, Signal, Slot
from PySide6.QtGui import QKeySequence, QShortcut
from PySide6.QtWidgets import QAbstractItemView, QFrame, QHBoxLayout, QLabel, QListView, QMessageBox, QVBoxLayout

from imugui.views import theme
from imugui.views.controls import Button
from imugui.views.labels import ElidedLabel, ToneLabel, heading
from imugui.views.record_control import show_in_folder
from imugui.views.recording_model import PATH, RecordingModel
from imugui.views.recording_row import RecordingRow
from imugui.views.verifier import Verifier

NONE_YET = "Nothing is recorded yet.\nPress Record (R), or collect data for a set time."
BUSY_S = 0.5


class RecordingList(QFrame):
    """Follows its folder by itself, whenever that changes."""

    opened = Signal(str)  # path

    def __init__(self) -> None:
        super().__init__()
        self.setProperty("role", "card")
        self._seen: object = None
        self._wanted: Path | None = None
        self.model = RecordingModel(self)
        self.verifier = Verifier(self)
        self.list = QListView()
        self.list.setModel(self.model)
        self.list.setItemDelegate(RecordingRow(self.list))
        self.list.setUniformItemSizes(True)
        self.list.setMouseTracking(True)
        self.list.setFrameShape(QFrame.Shape.NoFrame)
        self.list.setVerticalScrollMode(QAbstractItemView.ScrollMode.ScrollPerPixel)
        self.list.setAccessibleName("Recordings")
        self.nothing = QLabel(NONE_YET)
        self.nothing.setProperty("role", "muted")
        self.nothing.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.folder = ElidedLabel()
        self.folder.setProperty("role", "muted")
        self.folder.setFont(theme.font("small"))
        self.result = QLabel()
        self.result.setWordWrap(True)
        self.tone = ToneLabel()
        self.open_button = Button("Open", "Play this recording (Enter)", icon="open")
        self.verify_button = Button("Verify", "Compute its attitudes again from the raw data and compare")
        self.show_button = Button("Show in folder", "Show it in the file manager")
        self.delete_button = Button("Delete…", "Move it to the trash (Del)")
        self._lay_out()
        self._connect_parts()
        self._follow_selection()

    def buttons(self) -> list[Button]:
        """What acts on the selected recording."""
        return [self.open_button, self.verify_button, self.show_button, self.delete_button]

    def selected(self) -> Path | None:
        """The recording that is selected."""
        index = self.list.currentIndex()
        return index.data(PATH) if index.isValid() else None

    def select(self, path: Path) -> None:
        """Select a recording, if it is in the list."""
        row = self.model.row_of(path)
        if row >= 0:
            self.list.selectionModel().setCurrentIndex(
                self.model.index(row), QItemSelectionModel.SelectionFlag.ClearAndSelect
            )

    def select_later(self, path: Path) -> None:
        """Select a recording as soon as it is in the list."""
        self._wanted = path
        self._counted(self.model.rowCount())

    def refresh(self, folder: Path, running: Path | None) -> None:
        """Read the folder again if it changed; ``running`` is the recording that is being made."""
        try:
            seen: object = (folder, running, folder.stat().st_mtime_ns)
        except OSError:
            seen = (folder, running, 0)
        if seen != self._seen:
            self._seen = seen
            self.folder.show_line(str(folder))
            self.model.read(folder, running)
        verifying = self.verifier.path
        if verifying is not None and self.verifier.running_s > BUSY_S:
            self._say("neutral", f"Computing {verifying.name} again, {self.verifier.running_s:.0f} s so far…")
        self.verify_button.setText("Verify" if verifying is None else "Cancel")

    def stop(self) -> None:
        """End what runs beside."""
        self.verifier.cancel()
        self.model.stop()

    @Slot()
    def open(self) -> None:
        """Play the selected recording."""
        path = self.selected()
        if path is not None:
            self.opened.emit(str(path))

    @Slot()
    def verify(self) -> None:
        """Verify the selected recording, or give up the one that is being verified."""
        path = self.selected()
        if self.verifier.path is not None:
            self._say("neutral", f"{self.verifier.path.name} was not verified: cancelled.")
            self.verifier.cancel()
            self._follow_selection()
        elif path is not None:
            self._say("neutral", f"Computing {path.name} again…")
            self.verifier.start(path)
        self.verify_button.setText("Verify" if self.verifier.path is None else "Cancel")

    @Slot()
    def delete(self) -> None:
        """Ask, and move the selected recording to the trash."""
        path = self.selected()
        if path is None:
            return
        words = f"Move {path.name} to the trash?"
        if QMessageBox.question(self, "Delete a recording", words) is not QMessageBox.StandardButton.Yes:
            return
        if QFile.moveToTrash(str(path)):
            self._say("neutral", f"{path.name} was moved to the trash.")
        else:
            self._say("bad", f"{path.name} cannot be moved to the trash: this disk has none, or it may not be changed.")
        self._seen = None

    @Slot()
    def _follow_selection(self) -> None:
        chosen = self.selected() is not None
        for button in self.buttons():
            button.setEnabled(chosen or (button is self.verify_button and self.verifier.path is not None))

    @Slot(int)
    def _counted(self, count: int) -> None:
        self.nothing.setVisible(count == 0)
        self.list.setVisible(count > 0)
        if self._wanted is not None and self.model.row_of(self._wanted) >= 0:
            self.select(self._wanted)
            self._wanted = None
        elif count and self.selected() is None:
            self.select(self.model.index(0).data(PATH))
        self._follow_selection()

    @Slot(str, str)
    def _verified(self, tone: str, words: str) -> None:
        self._say(tone, words)
        self.verify_button.setText("Verify")
        self._follow_selection()

    def _say(self, tone: str, words: str) -> None:
        self.tone.show_phrase(tone, " " if tone != "neutral" else "")
        self.tone.setVisible(tone != "neutral")
        self.result.setText(words)
        self.result.setVisible(bool(words))

    def _connect_parts(self) -> None:
        self.open_button.clicked.connect(self.open)
        self.verify_button.clicked.connect(self.verify)
        self.show_button.clicked.connect(lambda: show_in_folder(self.selected() or Path()))
        self.delete_button.clicked.connect(self.delete)
        self.list.doubleClicked.connect(self.open)
        self.list.selectionModel().currentChanged.connect(self._follow_selection)
        self.model.counted.connect(self._counted)
        self.verifier.said.connect(self._verified)
        for keys, act in (("Return", self.open), ("Enter", self.open), ("Del", self.delete)):
            shortcut = QShortcut(QKeySequence(keys), self.list)
            shortcut.setContext(Qt.ShortcutContext.WidgetShortcut)
            shortcut.activated.connect(act)

    def _lay_out(self) -> None:
        head = QHBoxLayout()
        head.setContentsMargins(16, 0, 16, 0)
        head.setSpacing(14)
        head.addWidget(heading("Recordings"))
        head.addWidget(self.folder, 1)
        said = QHBoxLayout()
        said.setContentsMargins(16, 0, 16, 0)
        said.addWidget(self.tone, 0, Qt.AlignmentFlag.AlignTop)
        said.addWidget(self.result, 1)
        foot = QHBoxLayout()
        foot.setContentsMargins(16, 0, 16, 0)
        foot.setSpacing(8)
        for button in self.buttons():
            foot.addWidget(button)
            if button is self.show_button:
                foot.addStretch(1)
        column = QVBoxLayout(self)
        column.setContentsMargins(1, 12, 1, 12)
        column.setSpacing(10)
        column.addLayout(head)
        column.addWidget(self.list, 1)
        column.addWidget(self.nothing, 1)
        column.addLayout(said)
        column.addLayout(foot)
        self.list.hide()
        self._say("neutral", "")
