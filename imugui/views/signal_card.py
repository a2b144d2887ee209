"""The column at the right of the Signals page: channels with their numbers, and what can be taken away."""

from __future__ import annotations

from collections.abc import Mapping

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QButtonGroup, QFrame, QHBoxLayout, QScrollArea, QVBoxLayout, QWidget

from imugui.signals.channels import QUANTITIES
from imugui.signals.choice import Choice
from imugui.views import theme
from imugui.views.controls import Button, StillBox
from imugui.views.labels import Chip, ElidedLabel, heading
from imugui.views.signal_list import INDENT, NAME, SWATCH, UNIT_PAD, Cells, QuantityRows
from imugui.views.signal_words import MODES

RAW_TIP = (
    "Corrected: calibrated, the gyroscope without its bias, as the filter uses it. "
    "Raw: as the board sent it, in the same units and in the accelerometer's axes. "
    "Gravity, linear acceleration and angles always come from corrected data"
)
MASK_TIP = (
    "Leave the accelerometer out while the board's button moves and 20 ms longer: the gyroscope alone turns the "
    "attitude. Such stretches are shaded, and the corrected accelerometer holds its value"
)
WIDTH = 372
MARGIN = 16
INSIDE = WIDTH - 2 * MARGIN + 4  # the scroll bar comes and goes beside it, the numbers keep their places


class SignalCard(QFrame):
    """Shows what it is told; the page decides."""

    plot_toggled = Signal(str, bool)
    channel_toggled = Signal(str, bool)
    unit_wanted = Signal(str)
    range_edited = Signal(str, float, float)
    mode_chosen = Signal(str)  # key of MODES
    raw_chosen = Signal(bool)
    mask_wanted = Signal()

    def __init__(self, choice: Choice) -> None:
        super().__init__()
        self.setProperty("role", "card")
        self.setFixedWidth(WIDTH)
        self.state = Chip(("Live", "Paused", "Playing"), "Plots")
        self.data = StillBox("Raw or corrected", RAW_TIP)
        self.data.add("Corrected", False)
        self.data.add("Raw", True)
        self.data.setFont(theme.font("small"))
        self.data.setFixedWidth(INDENT + SWATCH + NAME + 4)
        self.data.activated.connect(lambda: self.raw_chosen.emit(self.data.currentData()))
        self.modes = {name: _mode_button(name) for name in MODES}
        self.spikes = Button("Spike mask", MASK_TIP, "toggle_spike_mask", small=True)
        self.spikes.setCheckable(True)
        self.spikes.clicked.connect(self.mask_wanted)
        self.heads = Cells()
        self.heads.setEnabled(False)
        self.foot = ElidedLabel()
        self.foot.setProperty("role", "muted")
        self.copy = Button("Copy picture", "Put the plots on the clipboard as a picture", "copy_picture", small=True)
        self.export = Button("Export…", "Write the data on screen to a CSV file", "export_data", small=True)
        self.quantities = {
            key: QuantityRows(key, quantity, key in choice.plots, choice.channels)
            for key, quantity in QUANTITIES.items()
        }
        for rows in self.quantities.values():
            for name in ("plot_toggled", "channel_toggled", "unit_wanted", "range_edited"):
                getattr(rows, name).connect(getattr(self, name))
        self._lay_out()

    def show_liveness(self, tone: str, word: str) -> None:
        """Say whether the right edge of the plots is now."""
        self.state.show_state(tone, word)
        self.state.updateGeometry()

    def show_mode(self, mode: str, offered: tuple[str, ...]) -> None:
        """Show the numbers of a mode; only the offered ones can be chosen."""
        for name, button in self.modes.items():
            button.setVisible(name in offered)
            button.setChecked(name == mode)
        self.heads.show_cells(MODES[mode].heads)

    def show_mask(self, offered: bool, on: bool) -> None:
        """Say whether the spike mask is on; it is offered where the board has a button."""
        self.spikes.setVisible(offered)
        self.spikes.setChecked(on)

    def show_numbers(self, cells: Mapping[str, tuple[str, ...]], line: str) -> None:
        """Show the numbers of channels, by key; those not given stay empty."""
        for rows in self.quantities.values():
            for key, row in rows.rows.items():
                row.cells.show_cells(cells.get(key, ()))
        self.foot.show_line(line)

    def show_progress(self, share: float) -> None:
        """A file is being written: the button cancels."""
        self.export.setText(f"Cancel, {100.0 * share:.0f} % written")

    def show_no_progress(self) -> None:
        """No file is being written."""
        self.export.setText("Export…")

    def _lay_out(self) -> None:
        head = QHBoxLayout()
        head.addWidget(heading("Channels"))
        head.addStretch(1)
        head.addWidget(self.state)
        modes = QHBoxLayout()
        modes.setSpacing(4)
        group = QButtonGroup(self)
        for name, button in self.modes.items():
            group.addButton(button)
            button.clicked.connect(lambda _=False, name=name: self.mode_chosen.emit(name))
            modes.addWidget(button)
        modes.addStretch(1)
        modes.addWidget(self.spikes)
        titles = QHBoxLayout()
        titles.setSpacing(4)
        titles.setContentsMargins(0, 0, WIDTH - MARGIN - 2 - INSIDE + UNIT_PAD, 0)
        titles.addWidget(self.data)
        titles.addWidget(self.heads)
        buttons = QHBoxLayout()
        buttons.setSpacing(8)
        buttons.addWidget(self.copy)
        buttons.addWidget(self.export)
        buttons.addStretch(1)
        column = QVBoxLayout(self)
        column.setContentsMargins(MARGIN, 12, 2, 12)
        column.setSpacing(8)
        head.setContentsMargins(0, 0, MARGIN, 0)
        modes.setContentsMargins(0, 0, MARGIN, 0)
        for line in (head, modes, titles):
            column.addLayout(line)
        column.addWidget(self._list(), 1)
        column.addWidget(self.foot)
        column.addLayout(buttons)

    def _list(self) -> QScrollArea:
        inside = QWidget()
        inside.setFixedWidth(INSIDE)
        column = QVBoxLayout(inside)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(2)
        for rows in self.quantities.values():
            column.addWidget(rows)
        column.addStretch(1)
        area = QScrollArea()
        area.setWidget(inside)
        area.setWidgetResizable(True)
        area.setAlignment(Qt.AlignmentFlag.AlignLeft)
        for part in (area.viewport(), inside):
            part.setAutoFillBackground(False)  # the card shows through
        area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        return area


def _mode_button(name: str) -> Button:
    mode = MODES[name]
    button = Button(mode.title, mode.tip, small=True)
    button.setCheckable(True)
    return button
