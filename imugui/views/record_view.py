"""The Record page: collect data for a set time, and all recordings there are."""

from __future__ import annotations

from PySide6.QtCore import Qt, Slot
from PySide6.QtWidgets import QHBoxLayout, QScrollArea, QVBoxLayout, QWidget

from imugui import paths
from imugui.views.collect_panel import CollectPanel
from imugui.views.collection import Collection
from imugui.views.recording_list import RecordingList
from imugui.views.settings_store import SettingsStore
from imugui.views.view import View
from imugui.workers.session import Session

COLUMN = 336


class RecordView(View):
    """What is made here is listed here; a collection goes on while another page is in front."""

    title = "Record"
    icon = "record"
    tip = "Collect data for a set time; all recordings"

    def __init__(self, session: Session, settings_store: SettingsStore) -> None:
        super().__init__(session, settings_store)
        self.collection = Collection(session, self)
        self.collect = CollectPanel(session, self.collection)
        self.recordings = RecordingList()
        self.collection.changed.connect(self._made)
        self.collection.ended.connect(self.said)
        self.recordings.opened.connect(lambda path: self.wanted.emit("replay", path))
        self._lay_out()
        self.slow_refresh()

    def refresh(self) -> None:
        self.collect.refresh()

    def slow_refresh(self) -> None:
        running = self.session.recording
        self.collect.slow_refresh(self.session.status())
        self.recordings.refresh(paths.documents_folder(), running.path if running is not None else None)

    def stop(self) -> None:
        self.collection.stop()
        self.recordings.stop()

    @Slot()
    def _made(self) -> None:
        """Show what was just made."""
        self.slow_refresh()
        if self.collection.made:
            self.recordings.select_later(self.collection.made[-1])

    def _lay_out(self) -> None:
        column = QVBoxLayout()
        column.setContentsMargins(0, 14, 12, 14)
        column.addWidget(self.collect)
        column.addStretch(1)
        inside = QWidget()
        inside.setLayout(column)
        inside.setFixedWidth(COLUMN - 12)
        area = QScrollArea()
        area.setWidget(inside)
        area.setWidgetResizable(True)
        area.setAlignment(Qt.AlignmentFlag.AlignLeft)
        area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        area.setFixedWidth(COLUMN)
        left = QVBoxLayout()
        left.setContentsMargins(16, 14, 16, 14)
        left.addWidget(self.recordings)
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(0)
        row.addLayout(left, 1)
        row.addWidget(area)
