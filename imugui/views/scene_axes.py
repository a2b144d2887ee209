"""Body axes as arrows with letters, and the outline of a target attitude."""

from __future__ import annotations

import functools
import math

import numpy as np
from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QColor, QPainter, QPainterPath, QPainterPathStroker

from imugui.views import theme
from imugui.views.geometry import Points, hull
from imugui.views.scene_body import FACES, HALF, TOP, Pose, outline, silhouette
from imugui.views.scene_lens import lettering, polygon

LENGTH = 0.95
"""From the board's centre to the tip of an axis, scene units."""
_HEAD = 0.13
_HEAD_RADIUS = 0.05
_SHAFT_WIDTH = 0.024
_LETTER_GAP = 0.11
_GHOST_ARROW = np.array(
    [(HALF[0], 0, 0), (LENGTH, 0, 0), (LENGTH - _HEAD, 0.06, 0), (LENGTH, 0, 0), (LENGTH - _HEAD, -0.06, 0)]
)


def tip(pose: Pose, axis: int) -> QPointF:
    """Where the arrow of axis 0, 1 or 2 ends, in pixels."""
    x, y = pose.pixels(LENGTH * np.eye(3)[axis : axis + 1])[0]
    return QPointF(x, y)


def paint_axes(painter: QPainter, pose: Pose, look: theme.Palette, front: bool) -> None:
    """The arrows that stick out of the board towards the viewer (``front``), or those behind it."""
    pluses = [face for face in FACES if face.label.startswith("+") and pose.sees_face(face) == front]
    towards = pose.lens.camera.position
    for face in sorted(pluses, key=lambda face: float(pose.earth(face.normal) @ towards)):
        _paint_arrow(painter, pose, face.axis, look)


def _paint_arrow(painter: QPainter, pose: Pose, axis: int, look: theme.Palette) -> None:
    colour = (look.axis_x, look.axis_y, look.axis_z)[axis]
    pixels = pose.pixels(_arrow(axis))
    centre, start, neck, end = pixels[:4]
    painter.setPen(theme.pen(colour, max(2.0, _SHAFT_WIDTH * pose.lens.scale())))
    painter.drawLine(QPointF(*start), QPointF(*neck))
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(colour)
    painter.drawPolygon(polygon(hull(pixels[3:])))
    if pose.eye[axis] < LENGTH - _HEAD:
        painter.setBrush(theme.shade(colour, 0.7))
        painter.drawPolygon(polygon(pixels[4:]))
    _paint_letter(painter, pose, axis, colour, _letter_place(centre, end, pose.lens.scale()))


@functools.cache
def _arrow(axis: int) -> Points:
    """Centre, start, neck and tip of an arrow, then the circle at the foot of its head; sensor frame."""
    angles = np.linspace(0.0, 2.0 * math.pi, 16, endpoint=False)
    points = np.zeros((20, 3))
    points[:4, axis] = (0.0, HALF[axis], LENGTH - _HEAD, LENGTH)
    points[4:, axis] = LENGTH - _HEAD
    points[4:, (axis + 1) % 3] = _HEAD_RADIUS * np.cos(angles)
    points[4:, (axis + 2) % 3] = _HEAD_RADIUS * np.sin(angles)
    return points


def _letter_place(centre: Points, end: Points, scale: float) -> Points:
    """Beyond the tip, or beside it when the arrow points at the viewer; pixels."""
    gap = _LETTER_GAP * scale + 4.0
    along = end - centre
    length = math.hypot(*along)
    share = min(1.0, length / (2.0 * gap))
    beside = np.array((-0.9, -0.9))
    place: Points = end + gap * (share * along / max(length, 1e-9) + (1.0 - share) * beside)
    return place


def _paint_letter(painter: QPainter, pose: Pose, axis: int, colour: QColor, place: Points) -> None:
    # capital height in whole pixels, so that few sizes are kept
    height = float(round(min(22.0, max(9.0, 0.085 * pose.lens.scale()))))
    letter = theme.AXES[axis]
    x, y = place.tolist()
    painter.fillPath(_halo(letter, height).translated(x, y), theme.faded(theme.palette().scene_bottom, 0.85))
    painter.fillPath(lettering(letter, height).translated(x, y), colour)


@functools.cache
def _halo(letter: str, height: float) -> QPainterPath:
    """The letter grown by two pixels, so that it reads on any ground."""
    stroker = QPainterPathStroker()
    stroker.setWidth(4.0)
    stroker.setJoinStyle(Qt.PenJoinStyle.RoundJoin)
    path = lettering(letter, height)
    return stroker.createStroke(path).united(path)


def paint_ghost(painter: QPainter, pose: Pose, look: theme.Palette) -> None:
    """A target attitude: see-through slab, strong outline, its nearer large face and an arrow along its x."""
    painter.setBrush(theme.faded(look.ghost, 0.10))
    painter.setPen(theme.pen(look.ghost, 2.2))
    painter.drawPolygon(polygon(hull(pose.pixels(silhouette()))))
    top_seen = pose.sees_face(TOP)
    thin = theme.pen(look.ghost, 1.2)
    if not top_seen:
        thin.setStyle(Qt.PenStyle.DashLine)
    painter.setPen(thin)
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.drawPolygon(polygon(pose.pixels(outline(float(HALF[2]) if top_seen else -float(HALF[2])))))
    painter.drawPolyline(polygon(pose.pixels(_GHOST_ARROW)))
