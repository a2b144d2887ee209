"""NormPlot: the length of a measured vector before and after calibration; it should be one flat line."""

from __future__ import annotations

from typing import Any

import numpy as np
import pyqtgraph as pg
from numpy.typing import NDArray
from PySide6.QtCore import QEvent, Qt
from PySide6.QtWidgets import QVBoxLayout, QWidget

from imugui.views import theme

HEIGHT = 124
MOST_POINTS = 2000
FEW = 60  # points that are drawn larger
_EDGE = 0.06  # of the range, above and below


class NormPlot(QWidget):
    """Dots over the sample number: before in grey, after in the accent, and the line where they should be."""

    def __init__(self, name: str, unit: str) -> None:
        super().__init__()
        self.setAccessibleName(name)
        self.setToolTip("Each dot is one sample. After a good calibration all of them lie on the line.")
        self.setFixedHeight(HEIGHT)
        self._plot = pg.PlotWidget()
        self._plot.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self._plot.setMouseEnabled(x=False, y=False)
        self._plot.setMenuEnabled(False)
        self._plot.hideButtons()
        self._plot.getAxis("left").setWidth(56)
        self._plot.getAxis("left").enableAutoSIPrefix(False)
        self._plot.setLabel("left", unit)
        self._plot.getAxis("bottom").setStyle(showValues=False)
        self._before = self._plot.plot([], [], pen=None, symbol="o", symbolSize=3)
        self._after = self._plot.plot([], [], pen=None, symbol="o", symbolSize=3)
        self._line = pg.InfiniteLine(angle=0)
        self._plot.addItem(self._line)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.addWidget(self._plot)
        self._dress()

    def show_norms(self, before: NDArray[np.float64], after: NDArray[np.float64], wanted: float) -> None:
        """Lengths (n,) before and after (either may be empty) and the length that is right, all in one unit."""
        for curve, values in ((self._before, before), (self._after, after)):
            step = max(1, len(values) // MOST_POINTS)
            curve.setData(np.arange(0, len(values), step), values[::step])
            curve.setSymbolSize(3 if len(values) > FEW else 7)
        self._line.setVisible(bool(np.isfinite(wanted)))
        self._line.setValue(wanted if np.isfinite(wanted) else 0.0)
        known = np.concatenate((before, after, np.array([wanted])))
        known = known[np.isfinite(known)]
        if len(known):
            room = _EDGE * max(float(np.ptp(known)), 0.02 * float(np.abs(known).max()))
            self._plot.setYRange(float(known.min()) - room, float(known.max()) + room, padding=0.0)
        self._plot.setXRange(0.0, max(1.0, float(max(len(before), len(after)))), padding=0.02)

    def curves(self) -> tuple[Any, Any]:
        """The curves before and after."""
        return self._before, self._after

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() == QEvent.Type.PaletteChange and hasattr(self, "_line"):
            self._dress()

    def _dress(self) -> None:
        colours = theme.palette()
        self._plot.setBackground(colours.panel)
        for side in ("left", "bottom"):
            axis = self._plot.getAxis(side)
            axis.setPen(theme.pen(colours.line))
            axis.setTextPen(colours.muted)
            axis.setStyle(tickFont=theme.font("small"))
        for curve, colour in ((self._before, colours.muted), (self._after, colours.accent)):
            curve.setSymbolBrush(theme.faded(colour, 0.7))
            curve.setSymbolPen(None)
        line = theme.pen(colours.good, 1.4)
        line.setCosmetic(True)
        self._line.setPen(line)
