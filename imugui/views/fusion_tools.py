"""The right part of the connection bar: filter, origin, record button."""

from __future__ import annotations

from PySide6.QtCore import Signal, Slot
from PySide6.QtWidgets import QHBoxLayout, QWidget

from imugui.fusion import FILTER_TITLES
from imugui.views.controls import Button, StillBox
from imugui.views.filters import use_filter
from imugui.views.record_tools import RecordTools
from imugui.views.settings_store import SettingsStore
from imugui.workers.session import Session, State, Status


class FusionTools(QWidget):
    """Which filter, and where zero is."""

    origin_wanted = Signal()
    clear_wanted = Signal()

    def __init__(self, session: Session, settings_store: SettingsStore) -> None:
        super().__init__()
        self._session = session
        self._settings_store = settings_store
        self.filter = StillBox("Filter", "How the sensors are fused; another one goes on from the attitude reached")
        for name, title in FILTER_TITLES.items():
            self.filter.add(title, name, words=f"The {title} filter")
        self.filter.setMinimumContentsLength(5)
        self.filter.setSizeAdjustPolicy(StillBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
        self.filter.activated.connect(self._filter_chosen)
        self.set_button = Button("Set origin", "The board as it is held now becomes zero", "set_origin", "origin")
        self.clear_button = Button("✕", "Clear the origin: back to the earth's own axes", "clear_origin")
        self.clear_button.setFixedWidth(34)
        self.clear_button.setAccessibleName("Clear the origin")
        self.set_button.clicked.connect(self.origin_wanted)
        self.clear_button.clicked.connect(self.clear_wanted)
        self.record = RecordTools(session)
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(6)
        for widget in (self.filter, self.set_button, self.clear_button, self.record):
            row.addWidget(widget, 1 if widget is self.filter else 0)

    def refresh(self, status: Status) -> None:
        """Follow the session."""
        self.filter.choose(self._session.filter_name)
        self.set_button.setEnabled(status.state is State.STREAMING)
        self.clear_button.setEnabled(self._session.has_origin)
        self.record.refresh(status)

    @Slot(int)
    def _filter_chosen(self, row: int) -> None:
        name = self.filter.itemData(row)
        if name != self._session.filter_name:
            use_filter(self._session, self._settings_store, name)
