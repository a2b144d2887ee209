"""StopButton: the emergency stop, large and red, with its key on it."""

from __future__ import annotations

import math

from PySide6.QtCore import QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QPainter, QPaintEvent, QPolygonF
from PySide6.QtWidgets import QPushButton

from imugui.views import theme

HEIGHT = 56
_SIGN = 15.0


class StopButton(QPushButton):
    """Grey while there is nothing to stop."""

    def __init__(self) -> None:
        super().__init__("STOP")
        self.setToolTip("Emergency stop (Esc): the view stands still at once, until it is reset and confirmed")
        self.setAccessibleName("Emergency stop")
        self.setFixedHeight(HEIGHT)
        self.setFont(theme.font("number"))

    def sizeHint(self) -> QSize:
        return QSize(200, HEIGHT)

    def paintEvent(self, event: QPaintEvent) -> None:
        colours = theme.palette()
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        on = self.isEnabled()
        ground = theme.shade(colours.bad, 0.85 if self.isDown() else 1.0) if on else colours.raised
        ink = colours.panel if on else colours.muted
        box = QRectF(self.rect()).adjusted(1.5, 1.5, -1.5, -1.5)
        painter.setPen(theme.pen(colours.text if self.hasFocus() or self.underMouse() else ground, 2.0))
        painter.setBrush(ground)
        painter.drawRoundedRect(box, 8.0, 8.0)
        width = painter.fontMetrics().horizontalAdvance(self.text())
        middle = QPointF(box.center().x() - 0.5 * width - _SIGN, box.center().y())
        painter.setPen(theme.pen(ink, 2.5))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.drawPolygon(octagon(middle, _SIGN - 4.0))
        painter.drawText(box.adjusted(_SIGN, 0.0, _SIGN, 0.0), Qt.AlignmentFlag.AlignCenter, self.text())
        painter.setFont(theme.font("small"))
        right = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
        painter.drawText(box.adjusted(0.0, 0.0, -14.0, 0.0), right, "Esc")
        painter.end()


def octagon(middle: QPointF, radius: float) -> QPolygonF:
    """The shape of a stop sign."""
    angles = (math.pi * (k / 4.0 + 0.125) for k in range(8))
    return QPolygonF([middle + QPointF(math.cos(a), math.sin(a)) * radius for a in angles])
