"""Readout: one large number with its label and unit, which keeps its place whatever the value."""

from __future__ import annotations

import math

from PySide6.QtCore import QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QAccessible, QFontMetricsF, QPainter, QPaintEvent
from PySide6.QtWidgets import QSizePolicy, QWidget

from imugui.views import theme
from imugui.views.painted import Painted

MINUS = "−"
_BAR = 3.0  # width of the axis mark
_GAP = 8.0
_UNIT_GAP = 3.0


def number_text(value: float, decimals: int, signed: bool) -> str:
    """A number with a real minus sign; what rounds to zero has no minus."""
    rounded = round(value, decimals) + 0.0
    return f"{rounded:{'+' if signed else ''}.{decimals}f}".replace("-", MINUS)


class Readout(Painted):
    """Shows values from -limit to limit with fixed decimals; the room is that of the widest such number."""

    def __init__(
        self,
        label: str,
        unit: str = "°",
        *,
        decimals: int = 1,
        limit: float = 180.0,
        signed: bool = True,
        axis: int | None = None,
        font: str = "number",
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self._label, self._unit, self._axis = label, unit, axis
        self._decimals, self._signed = decimals, signed
        whole = len(str(int(limit)))
        point = "." if decimals else ""
        self._blank = "-" * whole + point + "-" * decimals
        self._widest = MINUS * signed + "8" * whole + point + "8" * decimals
        self._font = font  # a role of theme.font
        self._unit_font = font if unit == "°" else "small"
        self._text = self._blank
        self._doubt = ""
        self.setAccessibleName(label)
        self.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Fixed)

    def set_value(self, value: float | None, doubt: str = "") -> None:
        """Show a value in the readout's unit, or dashes for None and NaN; ``doubt`` greys it and says why."""
        known = value is not None and math.isfinite(value)
        text = number_text(value, self._decimals, self._signed) if known and value is not None else self._blank
        if (text, doubt) == (self._text, self._doubt):
            return
        self._text, self._doubt = text, doubt
        self.setToolTip(doubt)
        if QAccessible.isActive():
            self.setAccessibleDescription(f"{text} {self._unit} {doubt}".strip())
        self.update()

    def text(self) -> str:
        """The number as shown, such as "+12.3" or "---.-"."""
        return self._text

    def doubt(self) -> str:
        """Why the number is not to be trusted, or nothing."""
        return self._doubt

    def sizeHint(self) -> QSize:
        number, small = self._metrics()
        unit = QFontMetricsF(theme.font(self._unit_font)).horizontalAdvance(self._unit)
        width = number.horizontalAdvance(self._widest) + _UNIT_GAP + unit + _BAR + 2 * _GAP
        label = small.horizontalAdvance(self._label) + _BAR + 2 * _GAP
        return QSize(math.ceil(max(width, label)), math.ceil(number.height() + small.height() + 4.0))

    def minimumSizeHint(self) -> QSize:
        return self.sizeHint()

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        try:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            self._paint_label(painter)
            self._paint_number(painter)
        finally:
            painter.end()

    def _metrics(self) -> tuple[QFontMetricsF, QFontMetricsF]:
        return QFontMetricsF(theme.font(self._font)), QFontMetricsF(theme.font("small"))

    def _paint_label(self, painter: QPainter) -> None:
        colours = theme.palette()
        left = 0.0
        if self._axis is not None:
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(theme.axis_colour(self._axis))
            painter.drawRoundedRect(QRectF(0.0, 3.0, _BAR, self.height() - 6.0), 1.5, 1.5)
            left = _BAR + _GAP
        font = theme.font("small")
        metrics = QFontMetricsF(font)
        painter.setFont(font)
        painter.setPen(colours.muted)
        painter.drawText(QPointF(left, metrics.ascent()), self._label)
        if self._doubt:
            start = left + metrics.horizontalAdvance(self._label) + _GAP
            words = f"{theme.tone_glyph('warn')} {self._doubt}"
            painter.setPen(colours.warn)
            words = metrics.elidedText(words, Qt.TextElideMode.ElideRight, self.width() - start)
            painter.drawText(QPointF(start, metrics.ascent()), words)

    def _paint_number(self, painter: QPainter) -> None:
        """Right-aligned in the room of the widest number, so that the point stays where it is."""
        colours = theme.palette()
        number, small = self._metrics()
        left = 0.0 if self._axis is None else _BAR + _GAP
        right = left + number.horizontalAdvance(self._widest)
        base = small.height() + 2.0 + number.ascent()
        painter.setFont(theme.font(self._font))
        painter.setPen(colours.muted if self._doubt or self._text == self._blank else colours.text)
        painter.drawText(QPointF(right - number.horizontalAdvance(self._text), base), self._text)
        painter.setFont(theme.font(self._unit_font))
        painter.setPen(colours.muted)
        painter.drawText(QPointF(right + _UNIT_GAP, base), self._unit)
