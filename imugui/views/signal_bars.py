"""Bars of a wireless signal, as an icon."""

from __future__ import annotations

from PySide6.QtCore import QRectF, QSize, Qt
from PySide6.QtGui import QColor, QIcon, QPainter, QPixmap

from imugui.views import theme
from imugui.views.ble_words import MOST_BARS

SIZE = 16  # logical pixels
RATIO = 2.0  # drawn finer, for screens that show it
STEP, WIDTH = 4.0, 3.0


def bars_icon(bars: int) -> QIcon:
    """So many bars of MOST_BARS in the text's colour, the others faint."""
    icon, colours = QIcon(), theme.palette()
    icon.addPixmap(_bars(bars, colours.text))
    icon.addPixmap(_bars(bars, colours.on_accent), QIcon.Mode.Selected)
    return icon


def _bars(bars: int, colour: QColor) -> QPixmap:
    pixmap = QPixmap(QSize(SIZE, SIZE) * RATIO)
    pixmap.setDevicePixelRatio(RATIO)
    pixmap.fill(Qt.GlobalColor.transparent)
    painter = QPainter(pixmap)
    painter.setPen(Qt.PenStyle.NoPen)
    for number in range(MOST_BARS):
        height = STEP * (number + 1) - 1.0
        painter.setBrush(colour if number < bars else theme.faded(colour, 0.2))
        painter.drawRoundedRect(QRectF(STEP * number, SIZE - height, WIDTH, height), 1.0, 1.0)
    painter.end()
    return pixmap
