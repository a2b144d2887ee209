"""The timeline of a replay: overview curve, events, the place it is at; click or drag to go elsewhere."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QEvent, QPointF, QRectF, QSize, Qt, QTimer, Signal, Slot
from PySide6.QtGui import QFontMetrics, QHelpEvent, QMouseEvent, QPainter, QPaintEvent, QPixmap, QPolygonF
from PySide6.QtWidgets import QSizePolicy, QToolTip, QWidget

from imugui.views import theme
from imugui.views.replay_words import EVENT_TONES, clock_words

HEIGHT = 56
EDGE = 8.0  # px left and right of the time axis
TOP, BOTTOM = 9.0, 3.0  # px above the curve (room for the events) and below it
NEAR_PX = 6.0
SEEK_MS = 50  # at most 20 seeks a second while dragging
Band = tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]


@dataclass(frozen=True)
class Tick:
    """An event on the timeline."""

    at_s: float
    kind: str
    words: str


class Timeline(QWidget):
    """Shows times from 0 to ``duration_s``; knows nothing of the player."""

    sought = Signal(float)  # a place in s, while dragging at most 20 times a second, and at its end

    def __init__(self) -> None:
        super().__init__()
        self._duration_s = 0.0
        self._position_s = 0.0
        self._band: Band | None = None
        self._ticks: list[Tick] = []
        self._still = QPixmap()
        self._still_key: object = None
        self._wanted: float | None = None  # where the pointer is, not told yet
        self._told_s = 0.0  # host time of the last telling
        self._dragging = False
        self._later = QTimer(self)
        self._later.setSingleShot(True)
        self._later.timeout.connect(self._tell)
        self.setFixedHeight(HEIGHT)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.setMouseTracking(True)
        self.setCursor(Qt.CursorShape.PointingHandCursor)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setAccessibleName("Timeline")

    @property
    def dragging(self) -> bool:
        """True while the pointer decides the place."""
        return self._dragging

    def show_recording(self, duration_s: float, ticks: list[Tick]) -> None:
        """Take another recording; its curve comes later."""
        self._duration_s, self._ticks, self._band = duration_s, ticks, None
        self._position_s = 0.0
        self._still_key = None
        self.update()

    def show_band(self, band: Band) -> None:
        """Take the overview: times (k,) in s, lowest and highest (k,) of each column."""
        self._band = band
        self._still_key = None
        self.update()

    def set_position(self, position_s: float) -> None:
        """Show the place; while the pointer drags, the pointer's place is shown."""
        if self._dragging:
            return
        moved = self._x(position_s) - self._x(self._position_s)
        if abs(moved) >= 0.5 or position_s in (0.0, self._duration_s):
            self._position_s = position_s
            self.update()
        self.setAccessibleDescription(f"{clock_words(position_s)} of {clock_words(self._duration_s)}")

    def time_at(self, x: float) -> float:
        """The time at a place on screen, s, within the recording."""
        room = max(self.width() - 2.0 * EDGE, 1.0)
        return min(max((x - EDGE) / room, 0.0), 1.0) * self._duration_s

    def words_at(self, x: float) -> str:
        """What the pointer is told there: the time, and the events near it."""
        near = [tick for tick in self._ticks if abs(self._x(tick.at_s) - x) <= NEAR_PX]
        return "\n".join(tick.words for tick in near[:8]) or clock_words(self.time_at(x))

    def sizeHint(self) -> QSize:
        return QSize(400, HEIGHT)

    def minimumSizeHint(self) -> QSize:
        return QSize(120, HEIGHT)

    def event(self, event: QEvent) -> bool:
        if isinstance(event, QHelpEvent) and event.type() == QEvent.Type.ToolTip and self._duration_s:
            QToolTip.showText(event.globalPos(), self.words_at(event.pos().x()), self)
            return True
        return super().event(event)

    def changeEvent(self, event: QEvent) -> None:
        if event.type() == QEvent.Type.PaletteChange:
            self._still_key = None
            self.update()
        super().changeEvent(event)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        if event.button() == Qt.MouseButton.LeftButton and self._duration_s:
            self._dragging = True
            self._want(event.position().x())

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        if self._dragging:
            self._want(event.position().x())

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        if self._dragging and event.button() == Qt.MouseButton.LeftButton:
            self._dragging = False
            self._tell()

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.drawPixmap(0, 0, self._still_part())
        x = self._x(self._position_s)
        colours = theme.palette()
        passed = QRectF(EDGE, TOP, x - EDGE, self.height() - TOP - BOTTOM)
        painter.fillRect(passed, theme.faded(colours.accent, 0.16))
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(theme.pen(colours.accent, 2.0))
        painter.drawLine(QPointF(x, TOP - 3.0), QPointF(x, self.height() - BOTTOM))
        painter.setBrush(colours.accent)
        painter.drawEllipse(QPointF(x, TOP - 3.0), 4.0, 4.0)
        if self.hasFocus():
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.setPen(theme.pen(theme.faded(colours.accent, 0.6)))
            painter.drawRect(QRectF(EDGE, TOP, self.width() - 2.0 * EDGE, self.height() - TOP - BOTTOM))
        painter.end()

    def _x(self, t: float) -> float:
        share = t / self._duration_s if self._duration_s else 0.0
        return EDGE + share * (self.width() - 2.0 * EDGE)

    def _want(self, x: float) -> None:
        """The pointer is there: shown at once, told at most every SEEK_MS."""
        self._wanted = self._position_s = self.time_at(x)
        self.update()
        wait_ms = SEEK_MS - (time.perf_counter() - self._told_s) * 1e3
        if wait_ms <= 0.0:
            self._tell()
        elif not self._later.isActive():
            self._later.start(int(wait_ms) + 1)

    @Slot()
    def _tell(self) -> None:
        self._later.stop()
        if self._wanted is not None:
            self._told_s = time.perf_counter()
            wanted, self._wanted = self._wanted, None
            self.sought.emit(wanted)

    def _still_part(self) -> QPixmap:
        """Everything but the place, drawn again only when it changes."""
        key = (self.size(), self.devicePixelRatioF())
        if key != self._still_key:
            self._still_key = key
            self._still = QPixmap(self.size() * self.devicePixelRatioF())
            self._still.setDevicePixelRatio(self.devicePixelRatioF())
            self._still.fill(Qt.GlobalColor.transparent)
            painter = QPainter(self._still)
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            self._paint_frame(painter)
            self._paint_ticks(painter)
            painter.end()
        return self._still

    def _paint_frame(self, painter: QPainter) -> None:
        colours = theme.palette()
        area = QRectF(EDGE, TOP, self.width() - 2.0 * EDGE, self.height() - TOP - BOTTOM)
        painter.fillRect(area, theme.mix(colours.panel, colours.window, 0.7))
        if self._band is not None and self._duration_s:
            paint_band(painter, area, self._band, self._duration_s, colours.muted)

    def _paint_ticks(self, painter: QPainter) -> None:
        for tick in self._ticks:
            colour = theme.tone_colour(EVENT_TONES.get(tick.kind, "neutral"))
            x = self._x(tick.at_s)
            painter.setPen(theme.pen(theme.faded(colour, 0.7)))
            painter.drawLine(QPointF(x, TOP - 2.0), QPointF(x, self.height() - BOTTOM))
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(colour)
            painter.drawPolygon(QPolygonF(SHAPES.get(tick.kind, DIAMOND)).translated(x, 5.0))


DIAMOND = [QPointF(0, -4), QPointF(4, 0), QPointF(0, 4), QPointF(-4, 0)]
FLAG = [QPointF(-1, -5), QPointF(7, -2.5), QPointF(-1, 0)]
CROSS = [QPointF(-4, -4), QPointF(4, -4), QPointF(0, 4)]
SHAPES = {"marker": FLAG, "lost": CROSS, "disconnect": CROSS, "problem": CROSS}
"""A flag for what the user marked, a triangle for trouble, a diamond for the rest."""


def paint_band(painter: QPainter, area: QRectF, band: Band, duration_s: float, colour: Any) -> None:
    """Fill between the lowest and highest of each column, from zero at the foot of the area to the highest."""
    times, low, high = band
    top = float(np.nanmax(high, initial=0.0))
    if len(times) == 0 or not top > 0.0:
        return
    x = area.left() + times / max(duration_s, 1e-9) * area.width()
    foot, scale = area.bottom(), area.height() / top
    upper = foot - np.nan_to_num(high) * scale - 0.5
    lower = foot - np.nan_to_num(low) * scale + 0.5
    points = [QPointF(a, b) for a, b in zip(x.tolist(), upper.tolist(), strict=True)]
    points += [QPointF(a, b) for a, b in zip(x[::-1].tolist(), lower[::-1].tolist(), strict=True)]
    painter.setPen(theme.pen(theme.faded(colour, 0.9), 0.8))
    painter.setBrush(theme.faded(colour, 0.55))
    painter.drawPolygon(QPolygonF(points))


def widest_clock(metrics: QFontMetrics, duration_s: float) -> int:
    """Width of "position / duration" at its widest, px."""
    longest = clock_words(duration_s)
    digits = "".join("0" if one.isdigit() else one for one in longest)
    return metrics.horizontalAdvance(f"{digits} / {digits}") + 4
