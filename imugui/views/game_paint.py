"""What moves in the game's picture: target, view, ring, the way between them, dwell, the last result.

Target and view differ in colour, shape and word: brackets with a box in the middle, a frame with ticks and a dot.
"""

from __future__ import annotations

import math

from PySide6.QtCore import QLineF, QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFontMetricsF, QPainter, QPainterPath, QPolygonF

from imugui.targeting.game_look import DONE, GameLook
from imugui.targeting.tasks import Target
from imugui.views import theme
from imugui.views.game_colours import Colours
from imugui.views.game_map import FieldMap

LINE = 2.5
CASE = 3.0
"""A casing is so much wider than its line."""
DOT = 4.0
RETICLE = 17.0
_BRACKET, _TICK = 20.0, 9.0
_ARROW_HEAD = 11.0
_DWELL_RADIUS = 30.0
_FLASH_S = 1.2
"""The last result fades for so long."""


def paint_marks(painter: QPainter, place: FieldMap, look: GameLook, colours: Colours) -> None:
    """Everything that moves."""
    if look.phase != DONE:
        if look.task.sized:
            _paint_square_target(painter, place, look, colours)
        else:
            _paint_ring(painter, place, look, colours)
    paint_view(painter, place, look, colours)
    if look.phase != DONE:
        if not look.position_ok:
            _paint_way(painter, place, look, colours)
        _paint_dwell(painter, place, look, colours)
        _paint_last(painter, place, look, colours)


def paint_veil(painter: QPainter, shape: QPainterPath, tone: str) -> None:
    """Nothing goes on: the picture is veiled, and framed in the colour of what is wrong."""
    painter.fillPath(shape, theme.faded(theme.palette().window, 0.45))
    if tone in ("warn", "bad"):
        painter.strokePath(shape, theme.pen(theme.tone_colour(tone), 5.0))


def paint_view(painter: QPainter, place: FieldMap, look: GameLook, colours: Colours) -> None:
    """The field of view: a frame, or the cross of a ring task; another colour, a tick and a word when it matches."""
    matched = look.matched and look.phase != DONE
    colour = colours.good if matched else colours.view
    word = "✓ View" if matched else "View"
    middle = place.at(look.view.x, look.view.y)
    if look.task.sized:
        box = place.square(*look.view)
        _stroke(painter, frame(box), colour, colours, LINE + (1.0 if matched else 0.0))
        _paint_tag(painter, QPointF(box.right(), box.bottom() + 5.0), word, colour, colours, right=True)
    else:
        _stroke(painter, reticle(middle), colour, colours, LINE)
        below = middle + QPointF(RETICLE + 5.0, RETICLE - 4.0)
        _paint_tag(painter, below, word, colour, colours)
    painter.setPen(theme.pen(colours.casing, 1.5))
    painter.setBrush(colour)
    painter.drawEllipse(middle, DOT, DOT)


def frame(box: QRectF) -> QPainterPath:
    """A square with a tick inwards from the middle of each side."""
    path = QPainterPath()
    path.addRect(box)
    tick, middle = min(_TICK, 0.2 * box.width()), box.center()
    for x, y in ((-1.0, 0.0), (1.0, 0.0), (0.0, -1.0), (0.0, 1.0)):
        side = middle + QPointF(x, y) * (0.5 * box.width())
        path.moveTo(side)
        path.lineTo(side - QPointF(x, y) * tick)
    return path


def reticle(middle: QPointF) -> QPainterPath:
    """A cross that is open in the middle, in a circle."""
    path = QPainterPath()
    path.addEllipse(middle, 0.62 * RETICLE, 0.62 * RETICLE)
    for x, y in ((-1.0, 0.0), (1.0, 0.0), (0.0, -1.0), (0.0, 1.0)):
        path.moveTo(middle + QPointF(x, y) * (0.45 * RETICLE))
        path.lineTo(middle + QPointF(x, y) * RETICLE)
    return path


def brackets(box: QRectF) -> QPainterPath:
    """The four corners of a square."""
    path = QPainterPath()
    length = min(_BRACKET, 0.3 * box.width())
    for corner, x, y in (
        (box.topLeft(), 1.0, 1.0), (box.topRight(), -1.0, 1.0),
        (box.bottomRight(), -1.0, -1.0), (box.bottomLeft(), 1.0, -1.0),
    ):  # fmt: skip
        path.moveTo(corner + QPointF(x * length, 0.0))
        path.lineTo(corner)
        path.lineTo(corner + QPointF(0.0, y * length))
    return path


def _paint_square_target(painter: QPainter, place: FieldMap, look: GameLook, colours: Colours) -> None:
    """Brackets on a thin square; the band that takes the view's side, the box that takes its centre."""
    target, tolerance = look.target, look.task.tolerance_px
    box = place.square(target.x, target.y, target.size)
    band = theme.pen(theme.faded(colours.target, 0.3), tolerance * place.scale)
    band.setJoinStyle(Qt.PenJoinStyle.MiterJoin)
    painter.setPen(band)
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.drawRect(box)
    outline = QPainterPath()
    outline.addRect(box)
    _stroke(painter, outline, colours.target, colours, 1.0)
    _stroke(painter, brackets(box), colours.target, colours, LINE + 1.5)
    centre = QPainterPath()
    centre.addRect(place.square(target.x, target.y, 2.0 * tolerance))
    painter.fillRect(centre.boundingRect(), theme.faded(colours.target, 0.3))
    _stroke(painter, centre, colours.target, colours, 1.0)
    _paint_tag(painter, box.topLeft() - QPointF(0.0, 5.0), "Target", colours.target, colours, above=True)


def _paint_ring(painter: QPainter, place: FieldMap, look: GameLook, colours: Colours) -> None:
    """All circles of the sequence; the target is filled, bold and named, the one after it dashed."""
    painter.setBrush(Qt.BrushStyle.NoBrush)
    for one in look.ring:
        painter.setPen(theme.pen(colours.casing, 1.0 + CASE))
        painter.drawEllipse(circle(place, one))
        painter.setPen(theme.pen(theme.faded(colours.guide, 0.55), 1.0))
        painter.drawEllipse(circle(place, one))
    if look.following is not None:
        pen = theme.pen(colours.guide, 2.0)
        pen.setStyle(Qt.PenStyle.DashLine)
        painter.setPen(pen)
        painter.drawEllipse(circle(place, look.following))
    box = circle(place, look.target)
    disc = QPainterPath()
    disc.addEllipse(box)
    painter.fillPath(disc, theme.faded(colours.target, 0.35))
    disc.addPath(_plus(box.center(), 0.16 * box.width()))
    _stroke(painter, disc, colours.target, colours, LINE + 0.5)
    word = "Start" if look.target.start else "Target"
    _paint_tag(painter, QPointF(box.left(), box.top() - 5.0), word, colours.target, colours, above=True)


def circle(place: FieldMap, target: Target) -> QRectF:
    """The circle of a ring task."""
    return place.square(target.x, target.y, target.size)


def _plus(middle: QPointF, half: float) -> QPainterPath:
    path = QPainterPath()
    for x, y in ((half, 0.0), (0.0, half)):
        path.moveTo(middle - QPointF(x, y))
        path.lineTo(middle + QPointF(x, y))
    return path


def _paint_way(painter: QPainter, place: FieldMap, look: GameLook, colours: Colours) -> None:
    """A dashed arrow from the view towards the target; none where they are close."""
    start, end = (place.at(one.x, one.y) for one in (look.view, look.target))
    way = end - start
    length = math.hypot(way.x(), way.y())
    gap = 22.0
    if length < 2.0 * gap + 2.0 * _ARROW_HEAD:
        return
    unit = way / length
    across = QPointF(-unit.y(), unit.x())
    line = QLineF(start + unit * gap, end - unit * (gap + _ARROW_HEAD))
    for colour, width in ((colours.casing, 1.5 + CASE), (colours.guide, 1.5)):
        pen = theme.pen(colour, width)
        if colour == colours.guide:
            pen.setDashPattern([3.0, 4.0])
        painter.setPen(pen)
        painter.drawLine(line)
    head = end - unit * gap
    back = head - unit * _ARROW_HEAD
    painter.setPen(theme.pen(colours.casing, 1.5))
    painter.setBrush(colours.guide)
    painter.drawPolygon(QPolygonF([head, back + across * 0.5 * _ARROW_HEAD, back - across * 0.5 * _ARROW_HEAD]))


def _paint_dwell(painter: QPainter, place: FieldMap, look: GameLook, colours: Colours) -> None:
    """How much of the dwell has passed: an arc that closes around the view's centre."""
    if look.dwell <= 0.0:
        return
    box = QRectF(0.0, 0.0, 2.0 * _DWELL_RADIUS, 2.0 * _DWELL_RADIUS)
    box.moveCenter(place.at(look.view.x, look.view.y))
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.setPen(theme.pen(colours.casing, 9.0))
    painter.drawEllipse(box)
    painter.setPen(theme.pen(theme.faded(colours.guide, 0.35), 5.0))
    painter.drawEllipse(box)
    painter.setPen(theme.pen(colours.good, 5.0))
    painter.drawArc(box, 90 * 16, -round(360 * 16 * look.dwell))


def _paint_last(painter: QPainter, place: FieldMap, look: GameLook, colours: Colours) -> None:
    """The time of the target before, where it was selected; it fades."""
    last, age = look.last, look.target_s
    if last is None or age >= _FLASH_S:
        return
    words = f"✕ missed, {last.movement_time_s:.1f} s" if last.error else f"✓ {last.movement_time_s:.1f} s"
    colour = colours.target if last.error else colours.good
    painter.setOpacity(1.0 - age / _FLASH_S)
    at = place.at(last.sel_x, last.sel_y) - QPointF(0.0, 26.0 + 16.0 * age)
    _paint_tag(painter, at, words, colour, colours, above=True, middle=True)
    painter.setOpacity(1.0)


def _stroke(painter: QPainter, path: QPainterPath, colour: QColor, colours: Colours, width: float) -> None:
    """A line in its casing."""
    painter.strokePath(path, theme.pen(colours.casing, width + CASE))
    painter.strokePath(path, theme.pen(colour, width))


def _paint_tag(
    painter: QPainter,
    at: QPointF,
    word: str,
    colour: QColor,
    colours: Colours,
    above: bool = False,
    right: bool = False,
    middle: bool = False,
) -> None:
    """A word on a plate: ``at`` is its upper left corner, lower when ``above``, right when ``right``."""
    font = theme.font("small")
    metrics = QFontMetricsF(font)
    width, height = metrics.horizontalAdvance(word) + 10.0, metrics.height() + 2.0
    left = at.x() - (width / 2.0 if middle else width if right else 0.0)
    box = QRectF(left, at.y() - (height if above else 0.0), width, height)
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(colour)
    painter.drawRoundedRect(box, 3.0, 3.0)
    painter.setFont(font)
    painter.setPen(colours.on_tag)
    painter.drawText(box, Qt.AlignmentFlag.AlignCenter, word)
