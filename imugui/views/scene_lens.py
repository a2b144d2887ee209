"""What the parts of the 3D scene share: earth points to Qt polygons, and lettering laid into planes."""

from __future__ import annotations

import functools
from dataclasses import dataclass

import numpy as np
from PySide6.QtCore import QPointF
from PySide6.QtGui import QFont, QPainterPath, QPolygonF, QTransform

from imugui.views import theme
from imugui.views.geometry import Camera, Points

UNITS = 1000.0
"""Decals are drawn in thousandths of a scene unit: fonts have whole pixel sizes."""


@dataclass(frozen=True)
class Lens:
    """A camera and the picture it draws, in logical pixels."""

    camera: Camera
    width: float
    height: float

    def pixels(self, points: Points) -> Points:
        """Earth points (n, 3) to pixels (n, 2)."""
        return self.camera.project(points, self.width, self.height)[0]

    def polygon(self, points: Points) -> QPolygonF:
        """Earth points (n, 3) as a polygon in pixels."""
        return polygon(self.pixels(points))

    def scale(self) -> float:
        """Pixels per scene unit at the origin."""
        return self.camera.focal(self.width, self.height) / self.camera.distance

    def plane(self, centre: Points, right: Points, up: Points) -> QTransform:
        """Transform from decal coordinates (x right, y down, thousandths of a unit) in a plane to pixels."""
        corners = np.array([centre, centre + right, centre + right - up, centre - up])
        to_pixels = QTransform()
        QTransform.squareToQuad(self.polygon(corners), to_pixels)
        return QTransform.fromScale(1.0 / UNITS, 1.0 / UNITS) * to_pixels


def polygon(pixels: Points) -> QPolygonF:
    """Pixels (n, 2) as a polygon."""
    return QPolygonF([QPointF(x, y) for x, y in pixels.tolist()])


@functools.cache
def lettering(text: str, height: float) -> QPainterPath:
    """Bold text centred on (0, 0) whose capitals are ``height`` tall."""
    font = QFont(theme.font("heading"))
    font.setPixelSize(200)
    font.setWeight(QFont.Weight.Bold)
    path = QPainterPath()
    path.addText(0.0, 0.0, font, text)
    capital = QPainterPath()
    capital.addText(0.0, 0.0, font, "X")
    scale = height / capital.boundingRect().height()
    centre = path.boundingRect().center()
    return QTransform().scale(scale, scale).translate(-centre.x(), -centre.y()).map(path)
