"""The drawn board: a slab with rounded corners, coloured and lettered plates, a chip, a plug and its axes.

Sensor frame: x forward, y left, z up. Plates of plus faces are filled with the axis colour, those of minus faces
only outlined, so that a face is known by shape, word and colour.
"""

from __future__ import annotations

import functools
import itertools
import math
from dataclasses import dataclass

import numpy as np
from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QBrush, QColor, QLinearGradient, QPainter, QPainterPath, QTransform

from imugui.views import theme
from imugui.views.geometry import Points, hull
from imugui.views.scene_lens import UNITS, Lens, lettering, polygon

HALF = np.array((0.68, 0.47, 0.125))
"""Half sides of the board along x, y and z, scene units."""
_CORNER = 0.08
_CORNER_STEPS = 4
_PLATE_STEPS = 6
_MARGIN = 0.035  # from the edge of a face to its plate

_X, _Y, _Z = np.eye(3)


@dataclass(frozen=True, eq=False)
class Face:
    """One side: its label, axis number, and the directions out of it, to its right and up when looked at."""

    label: str
    axis: int
    normal: Points
    right: Points
    up: Points

    def half(self) -> tuple[float, float]:
        """Half width and half height, scene units."""
        return float(np.abs(self.right) @ HALF), float(np.abs(self.up) @ HALF)


FACES = (
    Face("+X", 0, _X, _Y, _Z),
    Face("−X", 0, -_X, -_Y, _Z),
    Face("+Y", 1, _Y, -_X, _Z),
    Face("−Y", 1, -_Y, _X, _Z),
    Face("+Z", 2, _Z, _X, _Y),
    Face("−Z", 2, -_Z, -_X, _Y),
)
TOP = FACES[4]

# Raised parts on the top: centre x, y, half sides x, y, height
_CHIP = (-0.28, 0.0, 0.13, 0.13, 0.045)
_PLUG = (-0.6, 0.0, 0.08, 0.15, 0.07)


@dataclass(frozen=True)
class Pose:
    """The board as the lens sees it: ``matrix`` (3, 3) turns sensor into earth."""

    lens: Lens
    matrix: Points

    def earth(self, points: Points) -> Points:
        """Sensor points (n, 3) or (3,) in the earth frame."""
        return points @ self.matrix.T

    def pixels(self, points: Points) -> Points:
        """Sensor points (n, 3) to pixels (n, 2)."""
        return self.lens.pixels(self.earth(points))

    @functools.cached_property
    def eye(self) -> Points:
        """The camera's place in the sensor frame, shape (3,)."""
        return self.lens.camera.position @ self.matrix

    @functools.cached_property
    def lamp(self) -> Points:
        """Direction to the lamp above the viewer's left shoulder, sensor frame, shape (3,), length 1."""
        right, _, back = self.lens.camera.basis
        lamp: Points = 0.75 * _Z + 0.5 * back - 0.3 * right
        return lamp @ self.matrix / float(np.linalg.norm(lamp))

    def sees(self, normal: Points, centre: Points) -> bool:
        """True when a plane of the board shows its outer side."""
        return bool(normal @ (self.eye - centre) > 0.0)

    def sees_face(self, face: Face) -> bool:
        """True when this side of the board is in view."""
        return self.sees(face.normal, face.normal * HALF)

    def light(self, normal: Points) -> float:
        """Brightness of a plane, for theme.shade."""
        return 0.66 + 0.42 * max(0.0, float(normal @ self.lamp))

    def plane(self, face: Face, centre: Points) -> QTransform:
        """Transform from decal coordinates to pixels, in a plane parallel to a face."""
        return self.lens.plane(self.earth(centre), self.earth(face.right), self.earth(face.up))


@functools.cache
def outline(z: float) -> Points:
    """The slab's rounded outline at height z, shape (n, 3), counter-clockwise from above."""
    flat = _rounded(float(HALF[0]), float(HALF[1]), _CORNER, _CORNER_STEPS)
    return np.column_stack((flat, np.full(len(flat), z)))


def _rounded(half_width: float, half_height: float, radius: float, steps: int) -> Points:
    """A rectangle with round corners, shape (n, 2), counter-clockwise with y up."""
    corners = []
    for quarter, (sx, sy) in enumerate(((1, 1), (-1, 1), (-1, -1), (1, -1))):
        angles = math.pi / 2 * (quarter + np.linspace(0.0, 1.0, steps + 1))
        x = sx * (half_width - radius) + radius * np.cos(angles)
        y = sy * (half_height - radius) + radius * np.sin(angles)
        corners.append(np.column_stack((x, y)))
    return np.concatenate(corners)


def silhouette() -> Points:
    """All corners of the slab, shape (n, 3), sensor frame."""
    return np.concatenate([outline(HALF[2]), outline(-HALF[2])])


def shadow_outline(pose: Pose) -> Points:
    """East and north (n, 2) of the board's outline seen from straight above."""
    corners = pose.earth(np.array(list(itertools.product(*((-side, side) for side in HALF)))))
    return hull(corners[:, :2])


def paint_board(painter: QPainter, pose: Pose, look: theme.Palette) -> None:
    """The slab, its plates and its parts, back to front."""
    painter.setPen(Qt.PenStyle.NoPen)
    top_seen = pose.sees_face(TOP)
    if not top_seen:
        _paint_parts(painter, pose, look)
    _paint_slab(painter, pose, look)
    for face in FACES:
        if pose.sees_face(face):
            _paint_plate(painter, pose, face, look)
    if top_seen:
        _paint_parts(painter, pose, look)


def _paint_slab(painter: QPainter, pose: Pose, look: theme.Palette) -> None:
    """Silhouette first, so that no background shines through between the strips of the side."""
    rim, normals = _side()
    count = len(rim)
    pixels = pose.pixels(silhouette())
    painter.setBrush(theme.shade(look.housing, 0.62))
    painter.drawPolygon(polygon(hull(pixels)))
    for i in np.flatnonzero(((pose.eye - rim) * normals).sum(1) > 0.0):
        j = (i + 1) % count
        painter.setBrush(theme.shade(look.housing, pose.light(normals[i])))
        painter.drawPolygon(polygon(pixels[[i, j, count + j, count + i]]))
    painter.setPen(theme.pen(theme.shade(look.housing, 1.45), 1.0))
    for normal, ring in ((_Z, pixels[:count]), (-_Z, pixels[count:])):
        if pose.sees(normal, normal * HALF):
            painter.setBrush(theme.shade(look.housing, pose.light(normal)))
            painter.drawPolygon(polygon(ring))
    painter.setPen(Qt.PenStyle.NoPen)


@functools.cache
def _side() -> tuple[Points, Points]:
    """The upper rim (n, 3) and the outward normal (n, 3) of the strip that begins at each of its corners."""
    rim = outline(float(HALF[2]))
    edges = np.roll(rim, -1, axis=0) - rim
    normals = np.column_stack((edges[:, 1], -edges[:, 0], np.zeros(len(rim))))
    return rim, normals / np.linalg.norm(normals, axis=1, keepdims=True)


def _paint_plate(painter: QPainter, pose: Pose, face: Face, look: theme.Palette) -> None:
    plane, light = pose.plane(face, face.normal * HALF), pose.light(face.normal)
    colour = (look.plate_x, look.plate_y, look.plate_z)[face.axis]
    plus = face.label.startswith("+")
    painter.setBrush(_sheen(plane, face, colour, light) if face is TOP else theme.shade(colour, light))
    painter.drawPath(plane.map(_plate(face)))
    if face is TOP:
        painter.setBrush(theme.shade(look.gold, light))
        painter.drawPath(plane.map(_pads()))
    painter.setBrush(theme.shade(look.print if plus else colour, min(light, 1.0)))
    painter.drawPath(plane.map(_print() if face is TOP else _label(face)))


def _sheen(plane: QTransform, face: Face, colour: QColor, light: float) -> QBrush:
    """A little more light at the upper left than at the lower right."""
    width, height = (side * UNITS for side in face.half())
    gradient = QLinearGradient(plane.map(QPointF(-width, -height)), plane.map(QPointF(width, height)))
    gradient.setColorAt(0.0, theme.shade(colour, light * 1.08))
    gradient.setColorAt(1.0, theme.shade(colour, light * 0.92))
    return QBrush(gradient)


@functools.cache
def _label(face: Face) -> QPainterPath:
    """A face's name, beside the middle of plus faces, where their axis comes out; decal units."""
    name = lettering(face.label, 260.0 if face.axis == 2 else 125.0)
    aside = 0.42 * face.half()[0] * UNITS if face.label.startswith("+") else 0.0
    return name.translated(-aside, 0.0)


@functools.cache
def _plate(face: Face) -> QPainterPath:
    """The plate inside the flat part of a face, filled on plus faces, else only its border; decal units."""
    width, height = (side - _MARGIN for side in face.half())
    if face.axis != 2:
        width -= _CORNER - _MARGIN
    path = QPainterPath()
    path.setFillRule(Qt.FillRule.OddEvenFill)
    for inset in (0.0,) if face.label.startswith("+") else (0.0, 0.014):
        # straight edges only: curves are slow under a perspective
        path.addPolygon(polygon(UNITS * _rounded(width - inset, height - inset, 0.055 - inset, _PLATE_STEPS)))
        path.closeSubpath()
    return path


@functools.cache
def _pads() -> QPainterPath:
    """Two rows of ring contacts along the long edges of the top; decal units."""
    path = QPainterPath()
    for y in (-380.0, 380.0):
        for x in range(-550, 551, 100):
            for radius, corners in ((27.0, 12), (11.0, 8)):
                angles = np.linspace(0.0, 2.0 * math.pi, corners, endpoint=False)
                path.addPolygon(polygon(np.column_stack((x + radius * np.cos(angles), y + radius * np.sin(angles)))))
                path.closeSubpath()
    return path


@functools.cache
def _print() -> QPainterPath:
    """Lettering of the top: its name and an arrow that points along +x; decal units."""
    path = QPainterPath(lettering(TOP.label, 200.0).translated(330.0, -110.0))
    corners = [(110, 152), (470, 152), (470, 100), (590, 170), (470, 240), (470, 188), (110, 188)]
    path.addPolygon(polygon(np.array(corners, dtype=float)))
    path.closeSubpath()
    return path


def _paint_parts(painter: QPainter, pose: Pose, look: theme.Palette) -> None:
    """Raised parts, the farther one first."""
    chip_last = pose.eye[0] > (_CHIP[0] + _PLUG[0]) / 2.0
    plug = theme.mix(look.housing, look.print, 0.35)
    for box, colour in ((_PLUG, plug), (_CHIP, look.chip))[:: 1 if chip_last else -1]:
        _paint_box(painter, pose, box, colour)
    if pose.sees_face(TOP):
        _paint_chip_print(painter, pose, look)


def _paint_box(painter: QPainter, pose: Pose, box: tuple[float, ...], colour: QColor) -> None:
    """The visible sides of a box that stands on the top."""
    x, y, hx, hy, height = box
    half = np.array((hx, hy, height / 2))
    centre = np.array((x, y, HALF[2] + height / 2))
    for face in FACES:
        middle = centre + face.normal * half
        if face.label == "−Z" or not pose.sees(face.normal, middle):
            continue
        right, up = face.right * half, face.up * half
        corners = np.array([middle - right - up, middle + right - up, middle + right + up, middle - right + up])
        painter.setBrush(theme.shade(colour, pose.light(face.normal) * (1.12 if face is TOP else 1.0)))
        painter.drawPolygon(polygon(pose.pixels(corners)))


def _paint_chip_print(painter: QPainter, pose: Pose, look: theme.Palette) -> None:
    x, y, _, hy, height = _CHIP
    plane = pose.plane(TOP, np.array((x, y, HALF[2] + height)))
    path = QPainterPath(lettering("IMU", 55.0))
    path.addEllipse(QPointF(-85.0, hy * UNITS - 40.0), 14.0, 14.0)
    painter.setBrush(theme.mix(look.chip, look.print, 0.6))
    painter.drawPath(plane.map(path))
