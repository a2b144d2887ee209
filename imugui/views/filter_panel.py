"""The parameters of the filter in use, live; folded away until wanted."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from PySide6.QtCore import Qt, Slot
from PySide6.QtWidgets import QCheckBox, QFrame, QToolButton, QVBoxLayout, QWidget

from imugui.fusion import FILTER_TITLES, FILTERS, VQF_MISSING
from imugui.views import theme
from imugui.views.filters import use_magnetometer, use_params, use_spike_mask
from imugui.views.labels import muted
from imugui.views.settings_store import SettingsStore
from imugui.workers.session import Session

if TYPE_CHECKING:
    from imugui.views.filter_board import FilterBoard
    from imugui.views.form import Form


class FilterPanel(QFrame):
    """Follows the session: another filter brings another form."""

    def __init__(self, session: Session, settings_store: SettingsStore) -> None:
        super().__init__()
        self.setProperty("role", "card")
        self._session = session
        self._settings_store = settings_store
        self.form: Form | None = None
        self.board: FilterBoard | None = None
        self._filter = ""
        self.head = QToolButton()
        self.head.setProperty("role", "quiet")
        self.head.setFont(theme.font("heading"))
        self.head.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
        self.head.setCheckable(True)
        self.head.setToolTip("Show or hide the parameters of the filter")
        self.head.toggled.connect(self._unfold)
        self.mag = QCheckBox("Use the magnetometer")
        self.mag.setAccessibleName("Use the magnetometer")
        self.mag.setToolTip("Without it the heading is free to drift, but no iron disturbs it")
        self.mag.toggled.connect(self._mag_toggled)
        self.spikes = QCheckBox("Mask spikes of the board's button")
        self.spikes.setAccessibleName("Mask spikes of the board's button")
        self.spikes.setToolTip("A press shakes the board: for 20 ms the gyroscope alone turns the attitude")
        self.spikes.toggled.connect(self._mask_toggled)
        self._body = QWidget()
        self._column = QVBoxLayout(self._body)
        self._column.setContentsMargins(12, 8, 0, 4)
        self._column.setSpacing(12)
        self._column.addWidget(self.mag)
        self._column.addWidget(self.spikes)
        if VQF_MISSING:
            self._column.addWidget(muted(VQF_MISSING))
        column = QVBoxLayout(self)
        column.setContentsMargins(4, 8, 14, 8)
        column.setSpacing(0)
        column.addWidget(self.head)
        column.addWidget(self._body)
        self.refresh()
        self._unfold(False)

    def refresh(self) -> None:
        """Follow the session."""
        if self._session.filter_name != self._filter:
            self._take_filter()
        elif self.form is not None and self.board is not None:
            self.form.set_presets(self._presets())
            if self.form.value() != self._session.filter_params:
                self.form.set_value(self._session.filter_params)
            self.board.refresh()
        for box, on in ((self.mag, self._session.use_mag), (self.spikes, self._session.spike_mask)):
            box.blockSignals(True)
            box.setChecked(on)
            box.blockSignals(False)

    def _take_filter(self) -> None:
        self._filter = self._session.filter_name
        title = FILTER_TITLES[self._filter]
        self.head.setText(f"{title} filter")
        self.head.setAccessibleName(f"Parameters of the {title} filter")
        if self.form is not None:
            self._column.removeWidget(self.form)
            self.form.deleteLater()
            self.form = None
        if self.head.isChecked():
            self._make_form()

    def _make_form(self) -> None:
        from imugui.views.form import Form  # start-up time: made when it is first unfolded

        if self.board is None:
            from imugui.views.filter_board import FilterBoard

            self.board = FilterBoard(self._session)
            self._column.addWidget(self.board)
        self.form = Form(self._session.filter_params, self._presets())
        self.form.changed.connect(self._params_changed)
        self._column.addWidget(self.form)
        self.board.refresh()

    def _presets(self) -> dict[str, Any]:
        """The filter's presets; none of them changes the delays of the connected board."""
        return {name: self._session.board_params(one) for name, one in FILTERS[self._filter].PRESETS.items()}

    @Slot(object)
    def _params_changed(self, params: Any) -> None:
        use_params(self._session, self._settings_store, params)

    @Slot(bool)
    def _mag_toggled(self, on: bool) -> None:
        use_magnetometer(self._session, self._settings_store, on)

    @Slot(bool)
    def _mask_toggled(self, on: bool) -> None:
        use_spike_mask(self._session, self._settings_store, on)

    @Slot(bool)
    def _unfold(self, on: bool) -> None:
        if on and self.form is None:
            self._make_form()
        self._body.setVisible(on)
        self.head.setArrowType(Qt.ArrowType.DownArrow if on else Qt.ArrowType.RightArrow)
