"""The words around the game's picture: state, count and time above it, what to do below, a plate over it."""

from __future__ import annotations

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QFontMetricsF, QPainter

from imugui.targeting.game_look import GameLook
from imugui.views import game_words as words
from imugui.views import theme
from imugui.views.game_map import BOTTOM, EDGE, TOP, FieldMap
from imugui.views.game_words import Plate

_LEFT, _RIGHT = Qt.AlignmentFlag.AlignLeft, Qt.AlignmentFlag.AlignRight
_TOP, _MIDDLE = Qt.AlignmentFlag.AlignTop, Qt.AlignmentFlag.AlignVCenter
_CENTRE = Qt.AlignmentFlag.AlignCenter
_AIR = 12.0
_MARGIN = 8.0
_LINE = 2.0


def paint_top(painter: QPainter, place: FieldMap, look: GameLook) -> None:
    """State at the left, count and what matches in the middle, the time at the right."""
    room = QRectF(EDGE + _MARGIN, 4.0, place.width - 2.0 * (EDGE + _MARGIN), TOP - 8.0)
    colours = theme.palette()
    painter.setFont(theme.font("number"))
    painter.setPen(theme.tone_colour(look.tone))
    painter.drawText(room, _LEFT | _MIDDLE, words.state_words(look))
    painter.setPen(colours.text)
    painter.drawText(room, _RIGHT | _MIDDLE, f"{look.elapsed_s:.1f} s")
    painter.setFont(theme.font("body"))
    count = words.count_words(look)
    painter.drawText(room, Qt.AlignmentFlag.AlignHCenter | _TOP, f"Practice: {count}" if look.practice else count)
    _paint_matches(painter, room, look)


def _paint_matches(painter: QPainter, room: QRectF, look: GameLook) -> None:
    """Place and size, each with a tick or an open circle."""
    painter.setFont(theme.font("small"))
    metrics = QFontMetricsF(painter.font())
    parts = [(f"{'✓' if ok else '○'} {what}", ok) for what, ok in words.match_words(look)]
    widest = [metrics.horizontalAdvance(f"✓ {what}") + 2.0 * _AIR for what, _ in words.match_words(look)]
    left = room.center().x() - sum(widest) / 2.0
    for (text, ok), width in zip(parts, widest, strict=True):
        painter.setPen(theme.tone_colour("good" if ok else "neutral"))
        painter.drawText(QRectF(left, room.bottom() - metrics.height(), width, metrics.height()), _CENTRE, text)
        left += width


def paint_bottom(painter: QPainter, place: FieldMap, main: str, message: str, hint: str) -> None:
    """What to do next, large; below it why something was not done, else a hint."""
    band = QRectF(EDGE, place.height - BOTTOM + 8.0, place.width - 2.0 * EDGE, BOTTOM - 12.0)
    painter.setFont(theme.font("heading"))
    painter.setPen(theme.palette().text)
    flags = Qt.AlignmentFlag.AlignHCenter | _TOP | Qt.TextFlag.TextWordWrap
    painter.drawText(band, flags, main)
    used = painter.boundingRect(band, flags, main).height()
    painter.setFont(theme.font("body" if message else "small"))
    painter.setPen(theme.tone_colour("warn" if message else "neutral"))
    text = f"{theme.tone_glyph('warn')} {message}" if message else hint
    painter.drawText(band.adjusted(0.0, used + _LINE, 0.0, 0.0), flags, text)


def paint_plate(painter: QPainter, place: FieldMap, plate: Plate) -> None:
    """A word and a few lines on a panel in the middle of the picture, framed in the colour of the tone."""
    colours, tone = theme.palette(), theme.tone_colour(plate.tone)
    title = f"{theme.tone_glyph(plate.tone)} {plate.title}" if plate.tone != "neutral" else plate.title
    large, small = QFontMetricsF(theme.font("number")), QFontMetricsF(theme.font("body"))
    most = place.room.width() - 8.0 * _AIR
    longest = max((small.horizontalAdvance(line) for line in plate.lines), default=0.0)
    width = min(most, max(longest, large.horizontalAdvance(title))) + 4.0 * _AIR
    text = "\n".join(plate.lines)
    flags = _CENTRE | Qt.TextFlag.TextWordWrap
    inside = QRectF(0.0, 0.0, width - 2.0 * _AIR, place.room.height())
    below = small.boundingRect(inside, flags, text).height() if text else 0.0
    box = QRectF(0.0, 0.0, width, large.height() + below + 2.5 * _AIR)
    box.moveCenter(QPointF(place.centre.x(), place.room.center().y()))
    painter.setPen(theme.pen(theme.mix(colours.panel, tone, 0.8), 2.0))
    painter.setBrush(theme.faded(colours.panel, 0.94))
    painter.drawRoundedRect(box, 10.0, 10.0)
    painter.setFont(theme.font("number"))
    painter.setPen(tone if plate.tone != "neutral" else colours.text)
    head = QRectF(box.left(), box.top() + _AIR, box.width(), large.height())
    painter.drawText(head, _CENTRE, title)
    painter.setFont(theme.font("body"))
    painter.setPen(colours.text)
    painter.drawText(QRectF(box.left() + _AIR, head.bottom() + 0.5 * _AIR, inside.width(), below), flags, text)
