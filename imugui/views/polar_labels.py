"""The words around the polar target: state and scale, age and twist in the corners, what to do in the band below."""

from __future__ import annotations

import math

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QFontMetricsF, QPainter

from imugui.guidance.look import Look
from imugui.views import polar_words as words
from imugui.views import theme

_LEFT, _RIGHT = Qt.AlignmentFlag.AlignLeft, Qt.AlignmentFlag.AlignRight
_TOP, _BOTTOM = Qt.AlignmentFlag.AlignTop, Qt.AlignmentFlag.AlignBottom
_RING, _DOT = 5.0, 2.6  # px, of the mark that goes round
_BEAT = 0.15  # rad for each row


def paint_corners(painter: QPainter, room: QRectF, look: Look | None, ring_deg: float, hint: str) -> None:
    """The state upper left, the scale upper right, twist and hint lower right."""
    painter.setFont(theme.font("small"))
    painter.setPen(theme.palette().muted)
    painter.drawText(room, _RIGHT | _TOP, f"{ring_deg:g}° from ring to ring")
    if look is None:
        return
    painter.drawText(room, _RIGHT | _BOTTOM, "\n".join(filter(None, (words.twist_words(look), hint))))
    tone, word = words.STATES[look.colour]
    painter.setFont(theme.font("number"))
    painter.setPen(theme.tone_colour(tone))
    painter.drawText(room, _LEFT | _TOP, f"{theme.tone_glyph(tone)} {word}")


def paint_age(painter: QPainter, room: QRectF, look: Look, beat: int) -> None:
    """Lower left: the age of the newest sample with a mark that goes round while samples come; the age of the zero."""
    colours = theme.palette()
    stale = look.colour == "blank"
    painter.setFont(theme.font("small"))
    painter.setPen(colours.muted)
    metrics = QFontMetricsF(painter.font())
    painter.drawText(room, _LEFT | _BOTTOM, words.heading_words(look))
    line = room.adjusted(18.0, 0.0, 0.0, -metrics.height() - 2.0)
    painter.setPen(colours.bad if stale else colours.muted)
    painter.drawText(line, _LEFT | _BOTTOM, words.age_words(look))
    middle = QPointF(room.left() + 6.0, line.bottom() - metrics.height() / 2.0)
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.setPen(theme.pen(colours.line, 2.0))
    painter.drawEllipse(middle, _RING, _RING)
    turn = beat * _BEAT
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(colours.bad if stale else colours.good)
    painter.drawEllipse(middle + QPointF(math.sin(turn), -math.cos(turn)) * _RING, _DOT, _DOT)


def paint_band(painter: QPainter, band: QRectF, look: Look) -> None:
    """What to do now, large, and what comes after; or why nothing is to be trusted."""
    main = words.main_words(look)
    painter.setFont(theme.font("number" if look.trusted else "heading"))
    painter.setPen(theme.palette().text)
    flags = Qt.AlignmentFlag.AlignHCenter | _TOP | Qt.TextFlag.TextWordWrap
    painter.drawText(band, flags, main)
    used = painter.boundingRect(band, flags, main).height()
    painter.setFont(theme.font("body"))
    painter.setPen(theme.palette().muted)
    painter.drawText(band.adjusted(0.0, used + 3.0, 0.0, 0.0), flags, words.more_words(look))
