"""What the simulated endoscope looks at: tissue with folds, vessels and wet lights, computed from a seed."""

from __future__ import annotations

import functools
import math

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QColor, QImage, QPainter, QPainterPath, QPen

Floats = NDArray[np.float64]

WIDTH, HEIGHT = 780, 520
"""Pixels of the picture; it is scaled to whatever the screen needs."""
SEED = 4
_OCTAVES = ((3, 1.0), (6, 0.55), (13, 0.3), (29, 0.16), (61, 0.08))
"""Cells across, and how much they count, of the layers of noise."""
_DEEP, _WET, _PALE = (112, 30, 34), (206, 104, 92), (240, 176, 152)
"""Red, green, blue of a hollow, of the wall, and of a ridge."""
_VESSEL = QColor(122, 18, 30)
_FOLDS = 15.0
_LIGHTS = 1200
_TREES, _BRANCHES = 5, 4
_LUMEN = (0.66, 0.40)
"""Where the way goes on: right and down, in heights of the picture."""


@functools.cache
def tissue() -> QImage:
    """The picture (WIDTH x HEIGHT), made at the first call."""
    random = np.random.default_rng(SEED)
    relief, away = _relief(random)
    lit = _lighting(relief)
    rgb = _coloured(relief, lit, away)
    image = QImage(rgb.tobytes(), WIDTH, HEIGHT, 3 * WIDTH, QImage.Format.Format_RGB888).copy()
    _paint_vessels(image, random)
    _add_lights(image, lit, random)
    return image


def _noise(random: np.random.Generator, cells: int) -> Floats:
    """Smooth noise (HEIGHT, WIDTH) between 0 and 1 with so many cells across."""
    rows = max(2, round(cells * HEIGHT / WIDTH))
    grid = random.random((rows + 2, cells + 2))
    down, right = _steps(HEIGHT, rows), _steps(WIDTH, cells)
    upper, lower = (grid[down[0] + k] for k in (0, 1))
    lines = upper + (lower - upper) * down[1][:, None]
    left, beside = lines[:, right[0]], lines[:, right[0] + 1]
    return np.asarray(left + (beside - left) * right[1])


def _steps(count: int, cells: int) -> tuple[NDArray[np.int64], Floats]:
    """For each of ``count`` pixels its cell, and the eased way through it, 0 to 1."""
    place = np.linspace(0.0, cells, count, endpoint=False)
    cell = place.astype(int)
    way = place - cell
    return cell, way * way * (3.0 - 2.0 * way)


def _relief(random: np.random.Generator) -> tuple[Floats, Floats]:
    """Heights (HEIGHT, WIDTH), about 0 to 1: ring folds around a way on, bent by noise; and how far away that is."""
    layers = sum(weight * _noise(random, cells) for cells, weight in _OCTAVES)
    noise = np.asarray(layers) / sum(weight for _, weight in _OCTAVES)
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH] / HEIGHT
    away = np.hypot(x - _LUMEN[0], 1.15 * (y - _LUMEN[1])) + 0.36 * (noise - 0.5)
    folds = 0.5 + 0.5 * np.cos(_FOLDS * np.log1p(4.0 * np.maximum(away, 0.0)))
    return np.asarray(0.62 * noise + 0.38 * folds**1.5), away


def _lighting(relief: Floats) -> Floats:
    """Light (HEIGHT, WIDTH) on the slopes, -1 to 1, from above and a little from the left."""
    down, right = np.gradient(relief)
    return np.asarray(np.tanh((down + 0.6 * right) * WIDTH / 20.0))


def _coloured(relief: Floats, lit: Floats, away: Floats) -> NDArray[np.uint8]:
    """Red, green, blue (HEIGHT, WIDTH, 3) of heights and light; the way on lies in the dark."""
    height = np.clip(relief[..., None] * 1.1 - 0.05, 0.0, 1.0)
    deep, wet, pale = (np.array(colour, float) for colour in (_DEEP, _WET, _PALE))
    base = np.where(height < 0.5, deep + (wet - deep) * 2.0 * height, wet + (pale - wet) * (2.0 * height - 1.0))
    depth = 1.0 - 0.85 * np.exp(-((np.maximum(away, 0.0) / 0.13) ** 2))
    shaded = base * (0.9 + 0.24 * lit[..., None]) * depth[..., None]
    return np.asarray(np.clip(shaded, 0.0, 255.0), np.uint8)


def _paint_vessels(image: QImage, random: np.random.Generator) -> None:
    """Trees of fine vessels that fork and thin out."""
    painter = QPainter(image)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    for _ in range(_TREES):
        side = random.uniform(0.0, 2.0 * math.pi)
        start = QPointF(0.5 * WIDTH * (1.0 + math.cos(side)), 0.5 * HEIGHT * (1.0 + math.sin(side)))
        _paint_branch(painter, random, start, side + math.pi + random.normal(0.0, 0.4), 3.0, _BRANCHES)
    painter.end()


def _paint_branch(
    painter: QPainter, random: np.random.Generator, at: QPointF, way: float, width: float, forks: int
) -> None:
    """One vessel from ``at`` in the direction ``way`` (rad), and those it forks into."""
    path = QPainterPath(at)
    for _ in range(6):
        way += random.normal(0.0, 0.28)
        bend = at + QPointF(math.cos(way), math.sin(way)) * 14.0
        way += random.normal(0.0, 0.28)
        at = bend + QPointF(math.cos(way), math.sin(way)) * 14.0
        path.quadTo(bend, at)
    colour = QColor(_VESSEL)
    colour.setAlphaF(0.16 + 0.09 * width)
    painter.setPen(QPen(colour, width, Qt.PenStyle.SolidLine, Qt.PenCapStyle.RoundCap, Qt.PenJoinStyle.RoundJoin))
    painter.drawPath(path)
    if forks:
        for side in (-0.5, 0.5):
            _paint_branch(painter, random, at, way + side * random.uniform(0.6, 1.6), 0.68 * width, forks - 1)


def _add_lights(image: QImage, lit: Floats, random: np.random.Generator) -> None:
    """Small wet lights where a slope faces the lamp."""
    places = np.column_stack((random.integers(0, HEIGHT, _LIGHTS), random.integers(0, WIDTH, _LIGHTS)))
    painter = QPainter(image)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    painter.setPen(Qt.PenStyle.NoPen)
    for row, column in places[lit[places[:, 0], places[:, 1]] > 0.5].tolist():
        for radius, alpha in ((3.4, 26), (2.2, 60), (1.1, 190)):
            painter.setBrush(QColor(255, 244, 236, alpha))
            painter.drawEllipse(QPointF(column, row), 1.5 * radius, radius)
    painter.end()
