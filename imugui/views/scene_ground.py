"""The still part of the 3D scene: background, earth grid that fades with distance, compass rose on the ground."""

from __future__ import annotations

import functools
import math

import numpy as np
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QImage, QLinearGradient, QPainter

from imugui.views import theme
from imugui.views.geometry import Points
from imugui.views.scene_lens import UNITS, Lens, lettering, polygon

GROUND_Z = -0.95
_REACH = 3.0  # half side of the grid
_CELL = 0.25
_SHADES = 6  # steps of the fading
_RING = 1.3
_UPRIGHT = math.radians(40.0)  # letters lean towards a low camera until it sees them at this angle
_SHADOW_LAYERS = (0.84, 0.9, 0.96, 1.02, 1.08, 1.14, 1.2)
_SHADOW_STEP = 6.0  # logical pixels of the scene per pixel of its shadow
_LETTERS = {"E": 0.0, "N": 90.0, "W": 180.0, "S": 270.0}


def paint_ground(painter: QPainter, lens: Lens, north: bool = True) -> None:
    """Everything that depends on camera, size and theme only; not ``north``: the ground is not the earth's."""
    colours = theme.palette()
    sky = QLinearGradient(0.0, 0.0, 0.0, lens.height)
    sky.setColorAt(0.0, colours.scene_top)
    sky.setColorAt(1.0, colours.scene_bottom)
    painter.fillRect(QRectF(0.0, 0.0, lens.width, lens.height), sky)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    _paint_grid(painter, lens)
    _paint_ring(painter, lens)
    if north:
        _paint_north(painter, lens)
        _paint_letters(painter, lens)


@functools.cache
def _grid_segments() -> tuple[Points, Points]:
    """Ends (n, 2, 3) of every cell's edge, and the distance (n,) of its middle from the centre."""
    ticks = np.arange(-_REACH, _REACH + 1e-9, _CELL)
    along, across = (grid.ravel() for grid in np.meshgrid(ticks[:-1], ticks))
    level = np.full_like(along, GROUND_Z)
    east = np.stack([np.stack([along, across, level], 1), np.stack([along + _CELL, across, level], 1)], 1)
    segments = np.concatenate([east, east[:, :, [1, 0, 2]]])
    return segments, np.linalg.norm(segments.mean(1)[:, :2], axis=1)


def _paint_grid(painter: QPainter, lens: Lens) -> None:
    segments, distance = _grid_segments()
    pixels = lens.pixels(segments.reshape(-1, 3)).reshape(-1, 4)
    shade = np.floor(distance / _REACH * _SHADES)
    colour = theme.palette().grid
    for step in range(_SHADES):
        ends = pixels[shade == step].tolist()
        painter.setPen(theme.pen(theme.faded(colour, 0.32 * (1.0 - step / _SHADES)), 1.0))
        painter.drawLines([point for x1, y1, x2, y2 in ends for point in (QPointF(x1, y1), QPointF(x2, y2))])


def _circle(radius: float, angles: Points) -> Points:
    return np.column_stack((radius * np.cos(angles), radius * np.sin(angles), np.full_like(angles, GROUND_Z)))


def _paint_ring(painter: QPainter, lens: Lens) -> None:
    """A ring with a tick every 10 degrees, longer every 30."""
    colours = theme.palette()
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.setPen(theme.pen(theme.faded(colours.grid, 0.9), 1.4))
    painter.drawPolygon(lens.polygon(_circle(_RING, np.linspace(0.0, 2.0 * math.pi, 120, endpoint=False))))
    angles = np.radians(np.arange(0.0, 360.0, 10.0))
    inner = np.where(np.arange(36) % 3 == 0, _RING - 0.09, _RING - 0.045)
    starts, ends = _circle(1.0, angles), _circle(_RING, angles)
    starts[:, :2] *= inner[:, None]
    pixels = lens.pixels(np.stack([starts, ends], 1).reshape(-1, 3)).tolist()
    painter.drawLines([QPointF(x, y) for x, y in pixels])


def _paint_north(painter: QPainter, lens: Lens) -> None:
    """An arrow head on the ring."""
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(theme.palette().text)
    painter.drawPolygon(lens.polygon(_north_mark()))


def _north_mark() -> Points:
    corners = [(-0.06, _RING - 0.13), (0.0, _RING + 0.02), (0.06, _RING - 0.13), (0.0, _RING - 0.1)]
    return np.array([(x, y, GROUND_Z) for x, y in corners])


def _paint_letters(painter: QPainter, lens: Lens) -> None:
    """E, N, W, S on the ground, turned so that they read from where the camera is."""
    colours = theme.palette()
    right, up = _letter_plane(lens)
    painter.setPen(Qt.PenStyle.NoPen)
    for letter, angle_deg in _LETTERS.items():
        centre = _circle(_RING + 0.15, np.radians([angle_deg]))[0]
        painter.setBrush(colours.text if letter == "N" else colours.muted)
        painter.drawPath(lens.plane(centre, right, up).map(lettering(letter, 0.15 * UNITS)))


def _letter_plane(lens: Lens) -> tuple[Points, Points]:
    """Right and up of a letter: flat on the ground, or leaning towards a camera that is low; (3,) each."""
    right = lens.camera.basis[0]
    side = -1.0 if lens.camera.position[2] < GROUND_Z else 1.0
    lean = max(0.0, _UPRIGHT - abs(lens.camera.elevation))
    away = side * math.cos(lean) * np.array((-right[1], right[0], 0.0))
    return right, away + np.array((0.0, 0.0, math.sin(lean)))


def paint_shadow(painter: QPainter, lens: Lens, outline: Points) -> None:
    """A soft shadow under a convex outline (n, 2), east and north: painted small and drawn large."""
    middle = outline.mean(0)
    spread = np.concatenate([middle + (outline - middle) * growth for growth in _SHADOW_LAYERS])
    pixels = lens.pixels(np.column_stack((spread, np.full(len(spread), GROUND_Z))))
    layers = np.split(pixels, len(_SHADOW_LAYERS))
    low = np.floor(np.maximum(pixels.min(0), 0.0) / _SHADOW_STEP) - 1.0
    high = np.ceil(np.minimum(pixels.max(0), (lens.width, lens.height)) / _SHADOW_STEP) + 1.0
    if (high - low < 1.0).any():
        return
    columns, rows = (high - low).astype(int).tolist()
    small = QImage(columns, rows, QImage.Format.Format_ARGB32_Premultiplied)
    small.fill(Qt.GlobalColor.transparent)
    brush = QPainter(small)
    brush.setRenderHint(QPainter.RenderHint.Antialiasing)
    brush.setPen(Qt.PenStyle.NoPen)
    colour = theme.palette().shadow
    brush.setBrush(theme.faded(colour, colour.alphaF() / len(layers)))
    for layer in layers:
        brush.drawPolygon(polygon(layer / _SHADOW_STEP - low))
    brush.end()
    painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform)
    painter.drawImage(QRectF(*(low * _SHADOW_STEP), *((high - low) * _SHADOW_STEP)), small)
