"""The plots of a comparison: three angles of two attitudes, their angle difference, the place of the replay."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import pyqtgraph as pg
from numpy.typing import NDArray
from PySide6.QtCore import QEvent, Qt, Signal, Slot
from PySide6.QtWidgets import QVBoxLayout, QWidget

from imugui.fusion.attitude import euler
from imugui.recording.compare import Figures, angle_difference_deg, figures, thinned, tilt_difference_deg
from imugui.samples import Rows
from imugui.views import theme

Floats = NDArray[np.float64]
ANGLES = ("Yaw", "Pitch", "Roll")
DIFFERENCE = "Difference"
COLUMNS = 1200
AXIS_WIDTH = 62


@dataclass(frozen=True)
class Comparison:
    """Two attitudes of the same samples; times (n,) in s from the first sample."""

    times: Floats
    first: Floats  # quaternions (n, 4)
    second: Floats
    difference_deg: Floats
    tilt_deg: Floats  # the part of it that is not heading

    @classmethod
    def of(cls, first: Rows, second: Rows) -> Comparison:
        """From ATTITUDE rows, shape (n,), of the same samples."""
        times = first["t"] - first["t"][0]
        a, b = first["quat"], second["quat"]
        return cls(times, a, b, angle_difference_deg(a, b), tilt_difference_deg(a, b))

    def figures(self) -> tuple[Figures, Figures]:
        """Of the whole difference, and of the tilt."""
        return figures(self.times, self.difference_deg), figures(self.times, self.tilt_deg)

    def second_at(self, t: float) -> Floats:
        """The second attitude (4,) at a time in s."""
        place = int(np.searchsorted(self.times, t, side="right")) - 1
        return np.asarray(self.second[min(max(place, 0), len(self.second) - 1)])


class ComparePlots(QWidget):
    """Drag and wheel move and scale the time; a click goes there."""

    sought = Signal(float)

    def __init__(self) -> None:
        super().__init__()
        self.graphics = pg.GraphicsLayoutWidget()
        self.setAccessibleName("Both attitudes over time")
        self.setToolTip("Wheel: scale the time. Drag: move it. Click: go there in the replay. Double click: all of it.")
        self.setMinimumSize(360, 320)
        self._data: dict[str, list[tuple[Floats, Floats]]] = {}
        self._times: Floats = np.empty(0)
        self.plots: dict[str, Any] = {}
        self.curves: dict[str, list[Any]] = {}
        self._cursors: list[Any] = []
        for row, name in enumerate((*ANGLES, DIFFERENCE)):
            self._add(row, name)
        self.plots[DIFFERENCE].setLabel("bottom", "Time in the recording", units="s")
        self.plots[DIFFERENCE].getAxis("bottom").enableAutoSIPrefix(False)
        self.plots[DIFFERENCE].sigXRangeChanged.connect(self._thin)
        self.graphics.scene().sigMouseClicked.connect(self._clicked)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.addWidget(self.graphics)
        self._dress()

    def show_comparison(self, result: Comparison) -> None:
        """Draw it, all of its time."""
        self._times = result.times
        angles = [np.degrees(euler(quat)) for quat in (result.first, result.second)]
        self._data = {name: [(result.times, one[:, column]) for one in angles] for column, name in enumerate(ANGLES)}
        self._data[DIFFERENCE] = [(result.times, result.difference_deg), (result.times, result.tilt_deg)]
        self._show_all()
        self._thin()

    def set_position(self, t: float) -> None:
        """Put the cursor at a time in s."""
        for cursor in self._cursors:
            cursor.setValue(t)

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() == QEvent.Type.PaletteChange:
            self._dress()

    def _show_all(self) -> None:
        if len(self._times):
            self.plots[DIFFERENCE].setXRange(0.0, max(float(self._times[-1]), 1e-3), padding=0.01)

    @Slot()
    def _thin(self) -> None:
        """As many points as the width can show, of the time in view."""
        low, high = self.plots[DIFFERENCE].viewRange()[0]
        start, end = np.searchsorted(self._times, (low, high))
        part = slice(max(0, int(start) - 1), int(end) + 1)
        for name, lines in self._data.items():
            for curve, (times, values) in zip(self.curves[name], lines, strict=True):
                x, y = thinned(times[part], values[part], COLUMNS)
                follows = np.abs(np.diff(y, append=y[-1:])) < 180.0  # at +-180 the line goes round the back
                curve.setData(x, y, connect=follows.astype(np.int32))

    @Slot(object)
    def _clicked(self, event: Any) -> None:
        if event.button() is not Qt.MouseButton.LeftButton or not len(self._times):
            return
        if event.double():
            self._show_all()
        else:
            place = self.plots[DIFFERENCE].vb.mapSceneToView(event.scenePos()).x()
            self.sought.emit(min(max(float(place), 0.0), float(self._times[-1])))

    def _add(self, row: int, name: str) -> None:
        plot = self.graphics.addPlot(row=row, col=0)
        plot.setMouseEnabled(x=True, y=False)
        plot.setMenuEnabled(False)
        plot.hideButtons()
        plot.getAxis("left").setWidth(AXIS_WIDTH)
        plot.getAxis("left").enableAutoSIPrefix(False)
        plot.setLabel("left", name, units="°")
        if row:
            plot.setXLink(self.plots[ANGLES[0]])
        if name != DIFFERENCE:
            plot.getAxis("bottom").setStyle(showValues=False)
        plot.enableAutoRange(axis="y")
        plot.setAutoVisible(y=True)
        self.plots[name] = plot
        second, first = (
            plot.plot([], [], antialias=True),
            plot.plot([], [], antialias=True),
        )  # the second lies under the first, and is wider
        self.curves[name] = [first, second]
        cursor = pg.InfiniteLine(angle=90)
        plot.addItem(cursor, ignoreBounds=True)
        self._cursors.append(cursor)

    def _dress(self) -> None:
        colours = theme.palette()
        self.graphics.setBackground(colours.panel)
        for name, plot in self.plots.items():
            plot.showGrid(x=True, y=True, alpha=0.15)
            for side in ("left", "bottom"):
                plot.getAxis(side).setPen(theme.pen(colours.line))
                plot.getAxis(side).setTextPen(colours.muted)
            first, second = self.curves[name]
            first.setPen(_cosmetic(colours.text, 1.2))
            second.setPen(_cosmetic(theme.faded(colours.ghost, 0.75), 3.0))
        for cursor in self._cursors:
            cursor.setPen(_cosmetic(colours.accent, 1.5))


def _cosmetic(colour: Any, width: float) -> Any:
    pen = theme.pen(colour, width)
    pen.setCosmetic(True)
    return pen
