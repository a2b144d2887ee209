"""Compass: a dial with a pointer at the heading, which greys and says why when the heading is not to be trusted."""

from __future__ import annotations

import math

from PySide6.QtCore import QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QFontMetricsF, QPainter, QPaintEvent, QPolygonF
from PySide6.QtWidgets import QSizePolicy, QWidget

from imugui.views import theme
from imugui.views.painted import Painted

_LETTERS = {"N": 0.0, "E": 90.0, "S": 180.0, "W": 270.0}
_WINDS = ("N", "NNE", "NE", "ENE", "E", "ESE", "SE", "SSE", "S", "SSW", "SW", "WSW", "W", "WNW", "NW", "NNW")
_UNKNOWN = "---°"


def heading_text(heading_deg: float | None) -> str:
    """Three digits, 000° to 359°, or dashes for None and what is not finite."""
    if heading_deg is None or not math.isfinite(heading_deg):
        return _UNKNOWN
    return f"{round(heading_deg) % 360:03d}°"


def wind(heading_deg: float) -> str:
    """The nearest of the sixteen winds: N, NNE, NE and so on."""
    return _WINDS[round(heading_deg / 22.5) % 16]


class Compass(Painted):
    """North is up and stays there; the pointer on the rim is where the board's x axis heads."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._heading_deg: float | None = None
        self._doubt = ""
        self.setAccessibleName("Compass")
        self.setToolTip("Heading of the board's x axis, clockwise from magnetic north.")
        policy = QSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Preferred)
        policy.setHeightForWidth(True)
        self.setSizePolicy(policy)

    def set_heading(self, heading_deg: float | None, doubt: str = "") -> None:
        """Point at a heading in degrees clockwise from north; None when unknown, ``doubt`` says why not to trust."""
        known = heading_deg is not None and math.isfinite(heading_deg)
        new = (heading_deg if known else None, doubt)
        # half a pixel on a large dial is about 0.2 degrees
        if doubt == self._doubt and _close(new[0], self._heading_deg):
            return
        self._heading_deg, self._doubt = new
        self.setAccessibleDescription(f"{self.text()} {doubt}".strip())
        self.update()

    def text(self) -> str:
        """The heading as shown, such as "007°"."""
        return heading_text(self._heading_deg)

    def sizeHint(self) -> QSize:
        return QSize(200, 200)

    def minimumSizeHint(self) -> QSize:
        return QSize(130, 130)

    def hasHeightForWidth(self) -> bool:
        return True

    def heightForWidth(self, width: int) -> int:
        return width

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        try:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            painter.translate(self.width() / 2.0, self.height() / 2.0)
            radius = min(self.width(), self.height()) / 2.0 - 2.0
            _paint_dial(painter, radius)
            if self._heading_deg is not None:
                self._paint_pointer(painter, radius)
            self._paint_words(painter, radius)
        finally:
            painter.end()

    def _paint_pointer(self, painter: QPainter, radius: float) -> None:
        """A filled arrow head on the rim; only its outline when in doubt."""
        colours = theme.palette()
        painter.save()
        painter.rotate(self._heading_deg or 0.0)
        size = radius * 0.1
        tip = -radius + 1.0
        shape = QPolygonF([QPointF(0, tip), QPointF(size, tip + 2 * size), QPointF(0, tip + 1.6 * size)])
        shape.append(QPointF(-size, tip + 2 * size))
        colour = colours.muted if self._doubt else colours.accent
        painter.setPen(theme.pen(colour, 1.5))
        painter.setBrush(colours.panel if self._doubt else colour)
        painter.drawPolygon(shape)
        painter.restore()

    def _paint_words(self, painter: QPainter, radius: float) -> None:
        """The number in the middle, under it the wind or the reason for doubt."""
        colours = theme.palette()
        doubtful = bool(self._doubt) or self._heading_deg is None
        painter.setPen(colours.muted if doubtful else colours.text)
        big = theme.font("huge")
        big.setPixelSize(max(14, round(radius * 0.36)))
        painter.setFont(big)
        middle = QRectF(-radius, -radius * 0.32, 2 * radius, radius * 0.5)
        painter.drawText(middle, Qt.AlignmentFlag.AlignCenter, self.text())
        painter.setFont(theme.font("small"))
        if self._doubt:
            painter.setPen(colours.warn)
            words = f"{theme.tone_glyph('warn')} {self._doubt}"
        else:
            words = "" if self._heading_deg is None else wind(self._heading_deg)
        room = QRectF(-radius * 0.72, radius * 0.16, radius * 1.44, radius * 0.42)
        flags = Qt.AlignmentFlag.AlignHCenter | Qt.AlignmentFlag.AlignTop | Qt.TextFlag.TextWordWrap
        painter.drawText(room, flags, words)


def _close(a: float | None, b: float | None) -> bool:
    if a is None or b is None:
        return a is b
    return abs(math.remainder(a - b, 360.0)) < 0.2


def _towards(angle_deg: float) -> QPointF:
    """One pixel from the centre, clockwise from the top."""
    return QPointF(math.sin(math.radians(angle_deg)), -math.cos(math.radians(angle_deg)))


def _paint_dial(painter: QPainter, radius: float) -> None:
    colours = theme.palette()
    painter.setPen(theme.pen(colours.line, 1.5))
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.drawEllipse(QPointF(0, 0), radius, radius)
    for step, length, colour in ((10, 0.05, colours.line), (30, 0.09, colours.muted)):
        painter.setPen(theme.pen(colour, 1.5))
        for angle_deg in range(0, 360, step):
            out = _towards(angle_deg)
            painter.drawLine(out * radius, out * (radius * (1.0 - length)))
    font = theme.font("heading")
    font.setPixelSize(max(10, round(radius * 0.16)))
    painter.setFont(font)
    metrics = QFontMetricsF(font)
    for letter, direction_deg in _LETTERS.items():
        painter.setPen(colours.text if letter == "N" else colours.muted)
        place = _towards(direction_deg) * (radius * 0.66)
        left = place.x() - metrics.horizontalAdvance(letter) / 2.0
        painter.drawText(QPointF(left, place.y() + metrics.capHeight() / 2.0), letter)
