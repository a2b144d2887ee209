"""The sphere of directions about the board: cells that fill, outliers, a needle, and the way to the next goal.

Everything is in the sensor frame and turns with the board: in the earth frame all points of a field would coincide.
"""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass, field

import numpy as np
from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QColor, QPainter, QPen

from imugui.views import theme
from imugui.views.geometry import Points
from imugui.views.scene_body import Pose
from imugui.views.scene_lens import polygon

RADIUS = 1.18
"""Of the sphere, scene units: board and axes are inside."""
_CORNERS = 8  # of a cell's disc
_GOAL = math.radians(13.0)  # radius of the ring around the goal
_CROSS = 4.5  # half an outlier's cross, px
_LEVELS = 3  # shades of a cell: empty, begun, full
_FRONT = (0.0, 0.22, 0.42)
_BACK = (0.0, 0.10, 0.18)


def _no_points() -> Points:
    return np.empty((0, 3))


@dataclass(frozen=True, eq=False)
class Sphere:
    """``cells`` (n, 3) unit directions, ``levels`` (n,) 0 empty to 1 full, ``outliers`` (k, 3) scene units.

    ``needle`` and ``goal`` (3,) are unit directions, or None.
    """

    cells: Points = field(default_factory=_no_points)
    levels: Points = field(default_factory=lambda: np.empty(0))
    outliers: Points = field(default_factory=_no_points)
    needle: Points | None = None
    goal: Points | None = None


def paint_cells(painter: QPainter, pose: Pose, sphere: Sphere, near: bool) -> None:
    """The cells on the viewer's side (``near``), or those beyond the board."""
    if len(sphere.cells) == 0:
        return
    discs = _discs(sphere.cells.tobytes())
    facing = (sphere.cells * (pose.eye - RADIUS * sphere.cells)).sum(1) > 0.0
    pixels = pose.pixels(discs.reshape(-1, 3)).reshape(len(discs), -1, 2)
    shade = np.where(sphere.levels >= 1.0, 2, np.where(sphere.levels > 0.0, 1, 0))
    for level in range(1 - near, _LEVELS):  # empty cells beyond the board would only be clutter
        _set_level(painter, level, near)
        for corners in pixels[(facing == near) & (shade == level)]:
            painter.drawPolygon(polygon(corners))


def _set_level(painter: QPainter, level: int, near: bool) -> None:
    """Empty cells are rings, the others are filled: told apart without colour."""
    colours = theme.palette()
    if level == 0:
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.setPen(theme.pen(theme.faded(colours.grid, 0.55), 1.0))
    else:
        painter.setBrush(theme.faded(colours.good, (_FRONT if near else _BACK)[level]))
        painter.setPen(Qt.PenStyle.NoPen)


def paint_marks(painter: QPainter, pose: Pose, sphere: Sphere) -> None:
    """Outliers as crosses, then the needle, the goal's ring and the way between them."""
    if len(sphere.outliers):
        _paint_crosses(painter, pose, sphere.outliers)
    if sphere.goal is not None:
        _paint_goal(painter, pose, sphere.goal)
    if sphere.needle is not None:
        if sphere.goal is not None:
            _paint_way(painter, pose, sphere.needle, sphere.goal)
        _paint_needle(painter, pose, sphere.needle)


def way(start: Points, end: Points, steps: int = 25) -> Points:
    """Unit directions (steps, 3) along the great circle from one unit direction to another."""
    angle = math.atan2(float(np.linalg.norm(np.cross(start, end))), float(start @ end))
    aside = end - (start @ end) * start
    if np.linalg.norm(aside) < 1e-9:  # the same or the opposite direction: any great circle does
        aside = np.cross(start, np.eye(3)[np.argmin(np.abs(start))])
    aside = aside / np.linalg.norm(aside)
    along = np.linspace(0.0, angle, steps)[:, None]
    points: Points = np.cos(along) * start + np.sin(along) * aside
    return points


def circle(middle: Points, angle: float, steps: int = 28) -> Points:
    """Unit directions (steps, 3) that are ``angle`` rad from a unit direction."""
    right, up = _across(middle)
    turn = np.linspace(0.0, 2.0 * math.pi, steps, endpoint=False)[:, None]
    points: Points = math.cos(angle) * middle + math.sin(angle) * (np.cos(turn) * right + np.sin(turn) * up)
    return points


@functools.lru_cache(maxsize=4)
def _discs(cells: bytes) -> Points:
    """Corners (n, corners, 3) of a disc on each cell, nearly as large as its share of the sphere; scene units."""
    directions = np.frombuffer(cells).reshape(-1, 3)
    angle = 0.84 * math.acos(1.0 - 2.0 / len(directions))
    return RADIUS * np.array([circle(one, angle, _CORNERS) for one in directions])


def _across(direction: Points) -> tuple[Points, Points]:
    """Two unit vectors square to a direction and to each other."""
    right = np.cross(direction, np.eye(3)[np.argmin(np.abs(direction))])
    right = right / np.linalg.norm(right)
    return right, np.cross(direction, right)


def _paint_crosses(painter: QPainter, pose: Pose, points: Points) -> None:
    painter.setPen(theme.pen(theme.palette().bad, 1.8))
    painter.drawLines(
        [
            QPointF(x + sign * side, y + side)
            for x, y in pose.pixels(points).tolist()
            for sign in (1.0, -1.0)
            for side in (-_CROSS, _CROSS)
        ]
    )


def _seen(pose: Pose, direction: Points) -> bool:
    return bool(direction @ (pose.eye - RADIUS * direction) > 0.0)


def _line(pose: Pose, colour: QColor, width: float, direction: Points) -> QPen:
    """A pen, dashed on the far side of the sphere."""
    pen = theme.pen(colour, width)
    if not _seen(pose, direction):
        pen.setStyle(Qt.PenStyle.DotLine)
    return pen


def _paint_goal(painter: QPainter, pose: Pose, goal: Points) -> None:
    painter.setPen(_line(pose, theme.palette().ghost, 3.0, goal))
    painter.setBrush(theme.faded(theme.palette().ghost, 0.14))
    painter.drawPolygon(polygon(pose.pixels(RADIUS * circle(goal, _GOAL))))


def _paint_way(painter: QPainter, pose: Pose, needle: Points, goal: Points) -> None:
    """An arrow along the sphere, from the needle's tip to the edge of the goal's ring."""
    along = way(needle, goal)
    outside = (along @ goal) < math.cos(_GOAL)
    if int(outside.sum()) < 3:
        return
    pixels = pose.pixels(1.03 * RADIUS * along[outside])
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.setPen(_line(pose, theme.palette().ghost, 3.0, goal))
    painter.drawPolyline(polygon(pixels))
    step = pixels[-1] - pixels[-2]
    length = math.hypot(*step)
    if length < 1e-6:
        return
    back, aside = -step / length, np.array((-step[1], step[0])) / length
    painter.setPen(theme.pen(theme.palette().ghost, 3.0))
    painter.drawPolyline(polygon(pixels[-1] + 13.0 * np.array([back + 0.6 * aside, (0.0, 0.0), back - 0.6 * aside])))


def _paint_needle(painter: QPainter, pose: Pose, needle: Points) -> None:
    """From the board's centre to the sphere: where the measured direction is now."""
    centre, end = pose.pixels(np.array([np.zeros(3), RADIUS * needle]))
    colours = theme.palette()
    painter.setPen(_line(pose, colours.text, 2.4, needle))
    painter.drawLine(QPointF(*centre), QPointF(*end))
    painter.setPen(theme.pen(colours.scene_bottom, 2.0))
    painter.setBrush(colours.text)
    painter.drawEllipse(QPointF(*end), 7.0, 7.0)
