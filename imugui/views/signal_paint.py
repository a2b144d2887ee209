"""Painting of plots: curves from arrays in one call each, grid, words, cursors. Pure functions of a painter.

Dense curves are bars, one a column of pixels, from the least to the greatest value; smooth edges make them look like
a line. That is twenty times faster than stroking the same curve as a path.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import shiboken6
from numpy.typing import NDArray
from PySide6.QtCore import QLineF, QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFontMetricsF, QPainter

from imugui.signals.channels import PLAIN
from imugui.signals.strokes import Strokes
from imugui.views import theme
from imugui.views.signal_frame import CursorLine, Curve, Mark, Plot, Ticks

Floats = NDArray[np.float64]

WIDTH = 1.3  # of curves, logical pixels
LEAST_BAR = 1.0  # width of a bar
DOT = 4.0
DOTS_FROM = 8.0  # pixels between samples from which on each gets a dot
RADIUS = 6.0
TAB = 16.0
LEAST_BAND = 2.0
CAP = 3.0


@dataclass(frozen=True)
class Body:
    """Where a plot is drawn, and its scale: ``column`` is the width of a column in logical pixels."""

    rect: QRectF
    column: float
    low: float
    high: float

    def x(self, column: Any) -> Any:
        """Pixel of a column, number or array."""
        return self.rect.left() + self.column * column

    def y(self, value: Any) -> Any:
        """Pixel of a value, number or array."""
        return self.rect.bottom() - (value - self.low) * (self.rect.height() / (self.high - self.low))


def tone_colour(tone: int) -> QColor:
    """The colour of a curve: an axis 0 to 2, or PLAIN."""
    return theme.palette().text if tone == PLAIN else theme.axis_colour(tone)


def paint_curve(painter: QPainter, body: Body, curve: Curve) -> None:
    """Draw one curve; outside the body it is cut."""
    colour = tone_colour(curve.tone)
    if curve.strokes.dense:
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(colour)
        _draw(painter.drawRects, QRectF, _bars(body, curve.strokes))
        return
    lines = _lines(body, curve.strokes)
    painter.setPen(theme.pen(colour, WIDTH))
    _draw(painter.drawLines, QLineF, lines)
    dots = _dots(lines)
    if len(dots):
        painter.setPen(theme.pen(colour, DOT))
        _draw(painter.drawPoints, QPointF, dots)


def _bars(body: Body, strokes: Strokes) -> Floats:
    """Rectangles (m, 4) of x, y, width, height in pixels; on a fine screen they overlap, else steep curves fade."""
    column, low, high = strokes.marks.T
    top, bottom = body.y(high) - 0.5 * WIDTH, body.y(low) + 0.5 * WIDTH
    width = max(body.column, LEAST_BAR)
    return np.column_stack(
        (body.x(column) - 0.5 * (width - body.column), top, np.full(len(column), width), bottom - top)
    )


def _lines(body: Body, strokes: Strokes) -> Floats:
    x0, y0, x1, y1 = strokes.marks.T
    return np.column_stack((body.x(x0), body.y(y0), body.x(x1), body.y(y1)))


def _dots(lines: Floats) -> Floats:
    """The samples themselves, where they stand far enough apart or alone."""
    if len(lines) == 0:
        return np.empty((0, 2))
    wide = float(np.median(lines[:, 2] - lines[:, 0])) >= DOTS_FROM
    chosen = lines if wide else lines[lines[:, 0] == lines[:, 2]]
    return np.concatenate((chosen[:, :2], chosen[:, 2:]))


def _draw(draw: Any, kind: type, shapes: Floats) -> None:
    """Hand an array of shapes to Qt without a Python object for each: their numbers lie in memory as Qt's own do."""
    if len(shapes):
        shapes = np.ascontiguousarray(np.clip(shapes, -1e6, 1e6))  # the rasteriser cannot count further
        draw(shiboken6.wrapInstance(shapes.ctypes.data, kind), len(shapes))


def paint_back(painter: QPainter, body: Body, x_ticks: Ticks, y_ticks: Ticks) -> None:
    """The plot's ground and grid."""
    colours = theme.palette()
    painter.setPen(theme.pen(colours.line))
    painter.setBrush(colours.panel)
    painter.drawRoundedRect(body.rect.adjusted(-0.5, -0.5, 0.5, 0.5), RADIUS, RADIUS)
    faint = theme.pen(theme.mix(colours.line, colours.panel, 0.45))
    painter.setPen(faint)
    for column in x_ticks.values.tolist():
        x = round(body.x(column)) + 0.5
        painter.drawLine(QPointF(x, body.rect.top()), QPointF(x, body.rect.bottom()))
    for value in y_ticks.values.tolist():
        y = round(body.y(value)) + 0.5
        painter.setPen(theme.pen(colours.line) if value == 0.0 else faint)
        painter.drawLine(QPointF(body.rect.left(), y), QPointF(body.rect.right(), y))


def paint_bands(painter: QPainter, body: Body, bands: Sequence[tuple[float, float]]) -> None:
    """Shade from column to column, at the least so wide that it can be seen, with a cap on top beside the colour."""
    painter.setPen(Qt.PenStyle.NoPen)
    colour = theme.tone_colour("warn")
    for start, end in bands:
        left, right = max(body.x(start), body.rect.left()), min(body.x(end), body.rect.right())
        if right < body.rect.left() or left > body.rect.right():
            continue
        width = max(right - left, LEAST_BAND)
        painter.fillRect(QRectF(left, body.rect.top(), width, body.rect.height()), theme.faded(colour, 0.28))
        painter.fillRect(QRectF(left, body.rect.top(), width, CAP), colour)


def paint_y_words(painter: QPainter, body: Body, ticks: Ticks, gutter: float) -> None:
    """Numbers left of the plot."""
    metrics = QFontMetricsF(painter.font())
    painter.setPen(theme.palette().muted)
    half = 0.5 * metrics.height()
    for value, words in zip(ticks.values.tolist(), ticks.words, strict=True):
        room = QRectF(body.rect.left() - gutter, body.y(value) - half, gutter - 8.0, 2.0 * half)
        painter.drawText(room, Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter, words)


def paint_x_words(painter: QPainter, body: Body, ticks: Ticks, right: float) -> None:
    """Numbers below the lowest plot."""
    metrics = QFontMetricsF(painter.font())
    painter.setPen(theme.palette().muted)
    y = body.rect.bottom() + 5.0 + metrics.ascent()
    for column, words in zip(ticks.values.tolist(), ticks.words, strict=True):
        width = metrics.horizontalAdvance(words)
        x = max(body.x(column) - 0.5 * width, body.rect.left())
        painter.drawText(QPointF(min(x, right - width), y), words)


def paint_head(painter: QPainter, body: Body, plot: Plot, height: float) -> None:
    """Title and unit above the plot, and the curves' names in their colours at the right."""
    colours = theme.palette()
    small = theme.font("small")
    metrics = QFontMetricsF(small)
    base = body.rect.top() - 0.5 * (height - metrics.capHeight())
    painter.setFont(small)
    painter.setPen(colours.text)
    painter.drawText(QPointF(body.rect.left(), base), plot.title)
    left = body.rect.left() + metrics.horizontalAdvance(plot.title) + 10.0
    painter.setPen(colours.muted)
    painter.drawText(QPointF(left, base), plot.unit)
    x = body.rect.right()
    for curve in reversed(plot.curves):
        x -= metrics.horizontalAdvance(curve.label)
        painter.setPen(colours.text)
        painter.drawText(QPointF(x, base), curve.label)
        painter.setPen(theme.pen(tone_colour(curve.tone), 2.5))
        line = base - 0.5 * metrics.xHeight()
        painter.drawLine(QPointF(x - 20.0, line), QPointF(x - 7.0, line))
        x -= 36.0


def paint_note(painter: QPainter, room: QRectF, words: str) -> None:
    """Why there is nothing to see, in the middle."""
    painter.setFont(theme.font("small"))
    painter.setPen(theme.palette().muted)
    painter.drawText(room, Qt.AlignmentFlag.AlignCenter, words)


def paint_cursor(painter: QPainter, body: Body, cursor: CursorLine, top: bool) -> None:
    """A line through one plot, with a tab that bears its letter on the topmost."""
    x = body.x(cursor.column)
    if not body.rect.left() <= x <= body.rect.right():
        return
    colours = theme.palette()
    width = 2.0 if cursor.active else 1.0
    pen = theme.pen(colours.accent, width)
    if not cursor.active:
        pen.setStyle(Qt.PenStyle.DashLine)
    painter.setPen(pen)
    sharp = round(x) + 0.5 * width
    painter.drawLine(QPointF(sharp, body.rect.top()), QPointF(sharp, body.rect.bottom()))
    if top:
        tab = QRectF(x - 0.5 * TAB, body.rect.top() + 1.0, TAB, TAB)
        painter.setBrush(colours.accent if cursor.active else colours.panel)
        painter.setPen(theme.pen(colours.accent))
        painter.drawRoundedRect(tab, 4.0, 4.0)
        painter.setPen(colours.on_accent if cursor.active else colours.accent)
        painter.setFont(theme.font("small"))
        painter.drawText(tab, Qt.AlignmentFlag.AlignCenter, cursor.name)


def paint_mark(painter: QPainter, body: Body, mark: Mark) -> None:
    """A ring where a cursor meets a curve."""
    centre = QPointF(body.x(mark.column), body.y(mark.value))
    if body.rect.contains(centre):
        painter.setPen(theme.pen(tone_colour(mark.tone), 2.0))
        painter.setBrush(theme.palette().panel)
        painter.drawEllipse(centre, 3.5, 3.5)
