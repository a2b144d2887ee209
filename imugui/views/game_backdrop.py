"""The still part of the game's picture, in two layers: dim everywhere, and lit, of which only the view is shown."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from PySide6.QtCore import QRectF, QSize, Qt
from PySide6.QtGui import QColor, QPainter, QPainterPath, QPixmap, QRadialGradient

from imugui.targeting.view_pose import FIELD_PX
from imugui.views import theme
from imugui.views.game_map import FieldMap, picture
from imugui.views.game_tissue import tissue

DIM = 0.42
"""How dark the tissue is outside of the view, 0 to 1."""
GRID_PX = 100.0


class Backdrop:
    """Keeps both layers until size, scale, look or scheme change."""

    def __init__(self) -> None:
        self._key: object = None
        self._dim = self._lit = QPixmap()

    def paint(self, painter: QPainter, size: QSize, ratio: float, plain: bool, lit: QPainterPath | None) -> None:
        """Paint it, lit inside of a path (px of the widget)."""
        key = (size.toTuple(), ratio, plain, theme.is_dark())
        if key != self._key:
            self._key = key
            self._dim, self._lit = (_layer(size, ratio, plain, lit) for lit in (False, True))
        painter.drawPixmap(0, 0, self._dim)
        if lit is not None:
            painter.save()
            painter.setClipPath(lit)
            painter.drawPixmap(0, 0, self._lit)
            painter.restore()


def _layer(size: QSize, ratio: float, plain: bool, lit: bool) -> QPixmap:
    pixmap = QPixmap(round(size.width() * ratio), round(size.height() * ratio))
    pixmap.setDevicePixelRatio(ratio)
    painter = QPainter(pixmap)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform)
    painter.fillRect(QRectF(0.0, 0.0, size.width(), size.height()), theme.palette().window)
    _PICTURES[plain](painter, FieldMap(size.width(), size.height()), lit)
    painter.end()
    return pixmap


def _paint_plain(painter: QPainter, place: FieldMap, lit: bool) -> None:
    """Squared paper."""
    now = theme.palette()
    painter.setClipPath(picture(place, plain=True))
    painter.fillRect(place.field, theme.mix(now.panel, now.axis_z, 0.1) if lit else now.panel)
    painter.setPen(theme.pen(theme.mix(now.panel, now.line, 0.7)))
    half = 0.5 * FIELD_PX
    for step in np.arange(-half + GRID_PX, half, GRID_PX).tolist():
        painter.drawLine(place.at(step, -half), place.at(step, half))
        painter.drawLine(place.at(-half, step), place.at(half, step))
    painter.setClipping(False)
    _paint_rim(painter, place, plain=True)


def _paint_endoscope(painter: QPainter, place: FieldMap, lit: bool) -> None:
    """Tissue, darker towards the edge of the round picture."""
    image, shape = tissue(), picture(place, plain=False)
    box = shape.boundingRect()
    scale = max(box.width() / image.width(), box.height() / image.height())
    width, height = image.width() * scale, image.height() * scale
    middle = box.center()
    painter.setClipPath(shape)
    painter.drawImage(QRectF(middle.x() - width / 2.0, middle.y() - height / 2.0, width, height), image)
    dark = QColor(Qt.GlobalColor.black)
    edge = QRadialGradient(place.centre, 0.75 * FIELD_PX * place.scale)
    for at, alpha in ((0.0, 0.0), (0.6, 0.04), (0.86, 0.38), (1.0, 0.8)):
        edge.setColorAt(at, theme.faded(dark, alpha))
    painter.fillRect(box, edge)
    if not lit:
        painter.fillRect(box, theme.faded(dark, DIM))
    painter.setClipping(False)
    _paint_rim(painter, place, plain=False)


def _paint_rim(painter: QPainter, place: FieldMap, plain: bool) -> None:
    now = theme.palette()
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.setPen(theme.pen(theme.mix(now.line, now.muted, 0.35), 1.5))
    painter.drawPath(picture(place, plain))


_PICTURES: dict[bool, Callable[[QPainter, FieldMap, bool], None]] = {True: _paint_plain, False: _paint_endoscope}
