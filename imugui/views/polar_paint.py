"""What the polar target is painted from: dial, hatching, cross, trail, arrow. Places are px from the dial's centre."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFontMetricsF, QPainter, QPainterPath, QPen, QPolygonF

from imugui.views import theme

Floats = NDArray[np.float64]

PLAN_RADIUS = 11.0
"""Of the circle that stands for the plan, px."""
CROSS = 15.0
"""Half a stroke of the cross that stands for the tool, px."""
HATCH_STEP = 15.0
HATCH_WIDTH = 2.0
_LABEL_GAP = 8.0
_TRAIL_SHADES = 6
_ARROW_LONGEST = 84.0
_ARROW_HEAD = 11.0
_CENTRE = QPointF(0.0, 0.0)


@dataclass(frozen=True)
class Dial:
    """What does not move: ``range_deg`` at the rim, rings, tolerance, the words at its four sides."""

    radius: float  # px
    range_deg: float
    ring_deg: float
    tolerance_deg: float
    amber_deg: float
    sides: tuple[str, str, str, str]  # top, right, bottom, left
    notes: tuple[str, str]  # under the words at the right and the left

    def pixels(self, angle_deg: float) -> float:
        """How many pixels an angle is on this dial."""
        return self.radius * angle_deg / self.range_deg


def paint_dial(painter: QPainter, dial: Dial) -> None:
    """Disc, rings of true degrees, the rings of tolerance, the four directions."""
    colours = theme.palette()
    painter.setPen(theme.pen(colours.line, 1.5))
    painter.setBrush(colours.panel)
    painter.drawEllipse(_CENTRE, dial.radius, dial.radius)
    _paint_zone(painter, dial)
    _paint_rings(painter, dial)
    _paint_limits(painter, dial)
    _paint_sides(painter, dial)


def _paint_zone(painter: QPainter, dial: Dial) -> None:
    """The inside of the tolerance is tinted."""
    inside = min(dial.radius, dial.pixels(dial.tolerance_deg))
    if inside < PLAN_RADIUS:
        return
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(theme.faded(theme.palette().good, 0.14))
    painter.drawEllipse(_CENTRE, inside, inside)


def _paint_rings(painter: QPainter, dial: Dial) -> None:
    colours = theme.palette()
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.setPen(theme.pen(theme.mix(colours.line, colours.muted, 0.3), 1.0))
    painter.drawLine(QPointF(-dial.radius, 0.0), QPointF(dial.radius, 0.0))
    painter.drawLine(QPointF(0.0, -dial.radius), QPointF(0.0, dial.radius))
    for ring in ring_angles(dial):
        painter.drawEllipse(_CENTRE, dial.pixels(ring), dial.pixels(ring))
    painter.setFont(theme.font("small"))
    metrics = QFontMetricsF(painter.font())
    painter.setPen(colours.muted)
    inside = 0.6 * metrics.height()
    for ring in ring_angles(dial):
        text = f"{ring:g}°"
        along = (dial.pixels(ring) - inside) * math.sqrt(0.5)
        if dial.pixels(dial.ring_deg) > metrics.horizontalAdvance(text) and along > PLAN_RADIUS:
            painter.drawText(
                QPointF(along - metrics.horizontalAdvance(text) / 2.0, metrics.capHeight() / 2.0 - along), text
            )


def ring_angles(dial: Dial) -> list[float]:
    """The angles in deg that have a ring, without the rim."""
    return [float(angle) for angle in np.arange(dial.ring_deg, dial.range_deg * 0.999, dial.ring_deg)]


def _paint_limits(painter: QPainter, dial: Dial) -> None:
    """Tolerance: a full line; amber: a dashed one. Told apart without colour."""
    colours = theme.palette()
    painter.setBrush(Qt.BrushStyle.NoBrush)
    for angle_deg, colour, style in (
        (dial.amber_deg, colours.warn, Qt.PenStyle.DashLine),
        (dial.tolerance_deg, colours.good, Qt.PenStyle.SolidLine),
    ):
        radius = dial.pixels(angle_deg)
        if not PLAN_RADIUS < radius <= dial.radius:  # smaller ones would only blot the plan's circle
            continue
        pen = theme.pen(colour, 2.0)
        pen.setStyle(style)
        painter.setPen(pen)
        painter.drawEllipse(_CENTRE, radius, radius)


def _paint_sides(painter: QPainter, dial: Dial) -> None:
    top, right, bottom, left = dial.sides
    colours = theme.palette()
    font = theme.font("body")
    painter.setFont(font)
    painter.setPen(colours.text)
    metrics = QFontMetricsF(font)
    edge = dial.radius + _LABEL_GAP
    for words, base in ((top, -edge), (bottom, edge + metrics.ascent() - metrics.descent())):
        painter.drawText(QPointF(-metrics.horizontalAdvance(words) / 2.0, base), words)
    middle = metrics.ascent() / 2.0 - metrics.descent() / 2.0
    painter.drawText(QPointF(edge, middle), right)
    painter.drawText(QPointF(-edge - metrics.horizontalAdvance(left), middle), left)
    small = theme.font("small")
    painter.setFont(small)
    painter.setPen(colours.muted)
    under = middle + QFontMetricsF(small).height() + 1.0
    painter.drawText(QPointF(edge, under), dial.notes[0])
    painter.drawText(QPointF(-edge - QFontMetricsF(small).horizontalAdvance(dial.notes[1]), under), dial.notes[1])


def paint_hatching(painter: QPainter, radius: float) -> None:
    """Slanted lines over the whole disc: what is seen is not to be trusted."""
    disc = QPainterPath()
    disc.addEllipse(_CENTRE, radius, radius)
    colours = theme.palette()
    painter.fillPath(disc, theme.faded(colours.window, 0.45))
    ink = theme.mix(colours.window, colours.muted, 0.55)
    painter.setPen(QPen(ink, HATCH_WIDTH, Qt.PenStyle.SolidLine, Qt.PenCapStyle.FlatCap))
    for offset in np.arange(-radius, radius, HATCH_STEP):  # distance of a line from the centre
        half = math.sqrt(max(0.0, radius * radius - offset * offset))
        along, across = math.sqrt(0.5) * half, math.sqrt(0.5) * float(offset)
        painter.drawLine(QPointF(across - along, across + along), QPointF(across + along, across - along))


def paint_plan(painter: QPainter, colour: QColor) -> None:
    """The circle for the plan."""
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.setPen(theme.pen(theme.palette().panel, 6.0))
    painter.drawEllipse(_CENTRE, PLAN_RADIUS, PLAN_RADIUS)
    painter.setPen(theme.pen(colour, 3.0))
    painter.drawEllipse(_CENTRE, PLAN_RADIUS, PLAN_RADIUS)


_UPRIGHT = ((1.0, 0.0), (0.0, 1.0))
_SLANTED = ((math.sqrt(0.5), math.sqrt(0.5)), (math.sqrt(0.5), -math.sqrt(0.5)))


def paint_cross(painter: QPainter, place: QPointF, colour: QColor, state: str) -> None:
    """The cross for the tool: ringed when green, upright when amber, slanted when red, hollow when not trusted."""
    strokes = _SLANTED if state == "red" else _UPRIGHT
    lines = [(place - QPointF(x, y) * CROSS, place + QPointF(x, y) * CROSS) for x, y in strokes]
    hollow = state == "hatched"
    if hollow:
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(theme.palette().panel)
        painter.drawEllipse(place, CROSS + 5.0, CROSS + 5.0)
    painter.setBrush(Qt.BrushStyle.NoBrush)
    for pen in (theme.pen(theme.palette().panel, 8.0), theme.pen(colour, 2.5 if hollow else 4.0)):
        painter.setPen(pen)
        for start, end in lines:
            painter.drawLine(start, end)
    if hollow:
        painter.setPen(theme.pen(theme.palette().panel, 9.0))
        painter.drawPoint(place)
    if state == "green":
        painter.setPen(theme.pen(colour, 3.0))
        painter.drawEllipse(place, CROSS + 3.0, CROSS + 3.0)


def paint_sigma(painter: QPainter, place: QPointF, radius: float) -> None:
    """Where the tool may really be: 9 of 10 errors stay inside this circle around the cross."""
    colours = theme.palette()
    pen = theme.pen(theme.faded(colours.text, 0.5), 1.2)
    pen.setStyle(Qt.PenStyle.DotLine)
    painter.setPen(pen)
    painter.setBrush(theme.faded(colours.text, 0.07))
    painter.drawEllipse(place, radius, radius)


def paint_trail(painter: QPainter, points: Floats, colour: QColor) -> None:
    """Where the tool was, (n, 2) px, oldest first and faintest."""
    painter.setBrush(Qt.BrushStyle.NoBrush)
    parts = np.array_split(np.arange(len(points)), _TRAIL_SHADES)
    for shade, part in enumerate(parts, 1):
        if len(part) == 0:
            continue
        first = max(0, int(part[0]) - 1)  # joined to the part before
        line = QPolygonF([QPointF(x, y) for x, y in points[first : int(part[-1]) + 1].tolist()])
        painter.setPen(theme.pen(theme.faded(colour, 0.6 * shade / _TRAIL_SHADES), 2.5))
        painter.drawPolyline(line)


def paint_arrow(painter: QPainter, place: QPointF, way: QPointF, colour: QColor) -> None:
    """From the cross in the direction of ``way`` (a unit vector), not farther than the plan's circle."""
    distance = math.hypot(place.x(), place.y())
    length = min(_ARROW_LONGEST, distance - CROSS - PLAN_RADIUS - 16.0)
    if length < _ARROW_HEAD + 4.0:
        return
    start, end = place + way * (CROSS + 7.0), place + way * (CROSS + 7.0 + length)
    aside = QPointF(-way.y(), way.x()) * (0.62 * _ARROW_HEAD)
    back = end - way * _ARROW_HEAD
    painter.setPen(theme.pen(colour, 3.5))
    painter.drawLine(start, back)
    painter.setBrush(colour)
    painter.setPen(theme.pen(colour, 1.5))
    painter.drawPolygon(QPolygonF([end, back + aside, back - aside]))


def paint_hold(painter: QPainter, radius: float, share: float, colour: QColor) -> None:
    """How much of the hold is done, clockwise from the top along a circle."""
    box = QRectF(-radius, -radius, 2.0 * radius, 2.0 * radius)
    pen = QPen(colour, 7.0, Qt.PenStyle.SolidLine, Qt.PenCapStyle.FlatCap)
    painter.setPen(pen)
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.drawArc(box, 90 * 16, round(-360.0 * 16.0 * min(1.0, share)))
