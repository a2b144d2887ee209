"""PositionScene: the board in a cube whose faces, edges and corners are ticked, and a ghost of how to hold it next."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QPainter

from imugui.fusion import quaternion
from imugui.views import theme
from imugui.views.geometry import Points
from imugui.views.hand_scene import HandScene
from imugui.views.scene_body import Pose
from imugui.views.scene_lens import polygon

HALF_SIDE = 0.86
"""Of the cube, scene units."""
_BADGE = 9.0  # radius of a tick's disc, px
_TURN_S, _WAIT_S = 1.4, 1.2  # of the ghost
_UP = np.array((0.0, 0.0, 1.0))
_TICK = np.array([(-4.0, 0.2), (-1.2, 3.2), (4.2, -3.4)])
_CORNERS = np.array(list(itertools.product((-1.0, 1.0), repeat=3)))
_EDGES = [
    (i, j) for i, j in itertools.combinations(range(len(_CORNERS)), 2) if np.abs(_CORNERS[i] - _CORNERS[j]).sum() == 2.0
]


class PositionScene(HandScene):
    """Directions of the sensor frame that have been, or have yet to be, turned upwards."""

    def __init__(self) -> None:
        super().__init__()
        self._directions: Points = np.empty((0, 3))
        self._reached = np.empty(0, bool)
        self._goal: Points | None = None
        self._share = 1.0
        self.setAccessibleName("The board in a cube of positions")

    @property
    def reached(self) -> int:
        """How many positions are ticked."""
        return int(self._reached.sum())

    def set_positions(self, directions: Any, reached: Any, goal: Points | None) -> None:
        """Unit directions (n, 3), which of them have pointed up (n,), and the one to turn up next (3,), or None."""
        self._directions = np.asarray(directions, float).reshape(-1, 3)
        self._reached = np.asarray(reached, bool).ravel()
        self._goal = goal
        self._aim()
        self.update()

    def set_quat(self, quat: Any) -> None:
        super().set_quat(quat)
        self._aim()

    def _aim(self) -> None:
        """The ghost: the shortest turn from here that brings the goal up."""
        self.set_ghost(None if self._goal is None else raised(self._quat, self._goal, self._share))

    def show_turn(self, t: float) -> None:
        """Let the ghost turn from here to the goal and wait there, again and again; ``t`` in s."""
        within = t % (_TURN_S + _WAIT_S) / _TURN_S
        self._share = float(np.clip(within, 0.0, 1.0)) ** 2 * (3.0 - 2.0 * min(1.0, within))
        if self._goal is not None:
            self._aim()

    def _paint_moving(self, painter: QPainter) -> None:
        if len(self._directions) == 0:
            super()._paint_moving(painter)
            return
        pose = self._pose(self._quat)
        paint_edges(painter, pose, near=False)
        self._paint_badges(painter, pose, near=False)
        super()._paint_moving(painter)
        paint_edges(painter, pose, near=True)
        self._paint_badges(painter, pose, near=True)

    def _paint_badges(self, painter: QPainter, pose: Pose, near: bool) -> None:
        places = on_cube(self._directions)
        facing = (places * (pose.eye - places)).sum(1) > 0.0
        for i in np.flatnonzero(facing == near):
            middle = QPointF(*pose.pixels(places[i : i + 1])[0])
            paint_badge(painter, middle, bool(self._reached[i]), 1.0 if near else 0.35)
        if self._goal is not None and bool(self._goal @ (pose.eye - self._goal) > 0.0) == near:
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.setPen(theme.pen(theme.palette().ghost, 3.0))
            painter.drawEllipse(QPointF(*pose.pixels(on_cube(self._goal[None]))[0]), _BADGE + 5.0, _BADGE + 5.0)


def on_cube(directions: Points) -> Points:
    """Where unit directions (n, 3) go through the cube's surface, scene units."""
    return np.asarray(HALF_SIDE * directions / np.abs(directions).max(axis=1, keepdims=True))


def raised(quat: Any, direction: Points, share: float = 1.0) -> Points:
    """The attitude (4,) nearest to ``quat`` in which a sensor direction (3,) points up, or a share of the way."""
    here = quaternion.rotate(quat, direction)
    axis = np.cross(here, _UP)
    sine, cosine = float(np.linalg.norm(axis)), float(here @ _UP)
    if sine < 1e-9:  # up already, or straight down: any level axis does
        axis, sine = np.array((1.0, 0.0, 0.0)), 1e-9
    turn = quaternion.from_rotation_vector(axis / np.linalg.norm(axis) * share * np.arctan2(sine, cosine))
    return quaternion.multiply(turn, quat)


def paint_edges(painter: QPainter, pose: Pose, near: bool) -> None:
    """The cube's edges before the board, or those behind it."""
    pixels = pose.pixels(HALF_SIDE * _CORNERS)
    colour = theme.palette().grid
    painter.setPen(theme.pen(theme.faded(colour, 0.7 if near else 0.25), 1.2))
    for i, j in _EDGES:
        middle = HALF_SIDE * (_CORNERS[i] + _CORNERS[j]) / 2.0
        if bool(middle @ (pose.eye - middle) > 0.0) == near:
            painter.drawLine(QPointF(*pixels[i]), QPointF(*pixels[j]))


def paint_badge(painter: QPainter, middle: QPointF, reached: bool, strength: float) -> None:
    """A filled disc with a tick, or an empty ring."""
    colours = theme.palette()
    if not reached:
        painter.setBrush(theme.faded(colours.panel, 0.5 * strength))
        painter.setPen(theme.pen(theme.faded(colours.muted, strength), 1.4))
        painter.drawEllipse(middle, 0.7 * _BADGE, 0.7 * _BADGE)
        return
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(theme.faded(colours.good, strength))
    painter.drawEllipse(middle, _BADGE, _BADGE)
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.setPen(theme.pen(theme.faded(colours.panel, strength), 2.2))
    painter.drawPolyline(polygon(_TICK + np.array((middle.x(), middle.y()))))
