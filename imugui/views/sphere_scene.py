"""SphereScene: the board inside a sphere of directions that fill up as it is turned."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
from PySide6.QtGui import QPainter

from imugui.views import theme
from imugui.views.geometry import Points
from imugui.views.hand_scene import HandScene
from imugui.views.scene_axes import paint_axes
from imugui.views.scene_body import paint_board
from imugui.views.scene_cloud import Cloud, make_cloud, paint_cloud
from imugui.views.scene_sphere import RADIUS, Sphere, paint_cells, paint_marks


class SphereScene(HandScene):
    """A cloud of directions in the sensor frame, on equal-area cells."""

    def __init__(self) -> None:
        super().__init__()
        self._sphere = Sphere()
        self._directions = Cloud()
        self.setAccessibleName("The board in a sphere of directions")

    @property
    def sphere(self) -> Sphere:
        """What is drawn on the sphere."""
        return self._sphere

    @property
    def cloud_size(self) -> int:
        """How many points are drawn."""
        return len(self._directions.points)

    def set_cells(self, directions: Any, levels: Any) -> None:
        """Cells by their middle (n, 3), unit directions, and how full each is (n,), 0 to 1."""
        cells, filled = np.ascontiguousarray(directions, dtype=float).reshape(-1, 3), np.asarray(levels, float)
        if not (np.array_equal(cells, self._sphere.cells) and np.array_equal(filled, self._sphere.levels)):
            self._change(cells=cells, levels=filled)

    def set_cloud(self, points: Any, outliers: Any = ()) -> None:
        """Points (n, 3) in radii of the sphere, and those left out of the fit (k, 3), drawn as crosses."""
        self._directions = make_cloud(RADIUS * np.asarray(points, float).reshape(-1, 3), None, turning=True)
        left_out = RADIUS * np.asarray(outliers, float).reshape(-1, 3)
        self._change(outliers=left_out[np.isfinite(left_out).all(axis=1)])

    def set_needle(self, needle: Points | None, goal: Points | None) -> None:
        """Where the direction is now, and where it is wanted next: unit vectors (3,) of the sensor frame, or None."""
        self._change(needle=needle, goal=goal)

    def _change(self, **changes: Any) -> None:
        self._sphere = dataclasses.replace(self._sphere, **changes)
        self.update()

    def _paint_moving(self, painter: QPainter) -> None:
        pose, look = self._pose(self._quat), theme.palette()
        paint_cells(painter, pose, self._sphere, near=False)
        paint_cloud(painter, pose, self._directions, near=False)
        paint_axes(painter, pose, look, front=False)
        paint_board(painter, pose, look)
        paint_axes(painter, pose, look, front=True)
        paint_cells(painter, pose, self._sphere, near=True)
        paint_cloud(painter, pose, self._directions, near=True)
        paint_marks(painter, pose, self._sphere)
