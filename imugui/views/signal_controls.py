"""The controls above the plots: pause, window, scale, spectrum."""

from __future__ import annotations

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QHBoxLayout, QWidget

from imugui.signals.viewport import WINDOWS
from imugui.views.controls import Button, StillBox

SCALE_TIP = "Fixed scales are written in the list, or moved with the mouse over the numbers beside a plot"


class SignalControls(QWidget):
    """Says what was pressed; the page decides."""

    pause_wanted = Signal()
    window_chosen = Signal(float)
    zoom_wanted = Signal(int)
    fixed_chosen = Signal(bool)
    spectrum_wanted = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.pause = Button("Pause", "Hold the picture and set cursors", "toggle_pause", "pause")
        self.pause.setMinimumWidth(100)
        self.pause.clicked.connect(self.pause_wanted)
        self.shorter = Button("−", "A shorter window", "zoom_in")
        self.longer = Button("+", "A longer window", "zoom_out")
        self.window_box = StillBox("Window", "Length of the window")
        for seconds in WINDOWS:
            self.window_box.add(f"{seconds:g} s", seconds)
        self.scale = StillBox("Scale", SCALE_TIP)
        self.scale.add("Auto scale", False)
        self.scale.add("Fixed scale", True)
        self.spectrum = Button("Spectrum", "Frequencies instead of time, or back", "toggle_spectrum")
        self.spectrum.setCheckable(True)
        self.scale.setMinimumWidth(122)
        self._connect_parts()
        row = QHBoxLayout(self)
        row.setContentsMargins(16, 12, 14, 6)
        row.setSpacing(6)
        row.addWidget(self.pause)
        row.addSpacing(6)
        for button in (self.shorter, self.longer):
            button.setFixedWidth(34)
        for widget in (self.shorter, self.window_box, self.longer):
            row.addWidget(widget)
        row.addStretch(1)
        row.addWidget(self.scale)
        row.addWidget(self.spectrum)

    def show_state(self, paused: bool, window_s: float, fixed: bool, spectrum: bool) -> None:
        """Show how things are."""
        self.pause.setText("Resume" if paused else "Pause")
        self.pause.setAccessibleName("Resume" if paused else "Pause")
        self.pause.set_icon("play" if paused else "pause")
        self.window_box.choose(window_s)
        self.scale.choose(fixed)
        self.scale.setEnabled(not spectrum)
        self.spectrum.setChecked(spectrum)

    def _connect_parts(self) -> None:
        self.shorter.clicked.connect(lambda: self.zoom_wanted.emit(-1))
        self.longer.clicked.connect(lambda: self.zoom_wanted.emit(1))
        self.window_box.activated.connect(lambda: self.window_chosen.emit(self.window_box.currentData()))
        self.scale.activated.connect(lambda: self.fixed_chosen.emit(self.scale.currentData()))
        self.spectrum.clicked.connect(self.spectrum_wanted)
