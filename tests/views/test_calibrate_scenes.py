"""The pictures of the calibration page: sphere of directions, cube of positions."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from PySide6.QtGui import QImage

from imugui.calibration.coverage import CELLS, fibonacci
from imugui.fusion.quaternion import rotate
from imugui.views.position_scene import PositionScene, on_cube, raised
from imugui.views.scene_sphere import circle, way
from imugui.views.sphere_scene import SphereScene

X, Y, Z = np.eye(3)


def picture(scene: Any) -> QImage:
    return scene.grab().toImage()


@pytest.fixture
def sphere(shown: Callable[[Any], Any]) -> SphereScene:
    scene = SphereScene()
    scene.resize(360, 360)
    return shown(scene)


def test_filled_cells_are_seen(sphere: SphereScene) -> None:
    sphere.set_cells(fibonacci(CELLS), np.zeros(CELLS))
    empty = picture(sphere)
    sphere.set_cells(fibonacci(CELLS), np.ones(CELLS))
    assert picture(sphere) != empty


def test_points_that_are_no_numbers_are_left_out(sphere: SphereScene) -> None:
    sphere.set_cloud(np.array([X, Y, [np.nan, 0, 0]]), np.array([[np.inf, 0, 0], Z]))
    assert sphere.cloud_size == 2
    assert len(sphere.sphere.outliers) == 1
    picture(sphere)


def test_needle_and_goal(sphere: SphereScene) -> None:
    before = picture(sphere)
    sphere.set_needle(X, -X)  # straight through: any way round will do
    opposite = picture(sphere)
    assert opposite != before
    sphere.set_needle(X, X)
    assert picture(sphere) != opposite


@pytest.mark.parametrize(("start", "end"), [(X, Y), (X, -X), (Z, Z)])
def test_the_way_is_on_the_sphere(start: np.ndarray, end: np.ndarray) -> None:
    along = way(start, end)
    assert np.allclose(np.linalg.norm(along, axis=1), 1.0)
    assert np.allclose(along[0], start)
    assert np.allclose(along[-1], end, atol=1e-6)


def test_a_circle_has_its_angle() -> None:
    assert np.allclose(circle(Z, 0.3) @ Z, np.cos(0.3))


def test_positions_are_ticked(shown: Callable[[Any], Any]) -> None:
    scene = PositionScene()
    scene.resize(360, 360)
    shown(scene)
    scene.set_positions(np.eye(3), [False, False, False], Y)
    none = picture(scene)
    scene.set_positions(np.eye(3), [True, False, True], Y)
    assert scene.reached == 2
    assert picture(scene) != none


@pytest.mark.parametrize("direction", [X, -X, Z, -Z, (X + Y) / np.sqrt(2)])
def test_the_ghost_brings_the_goal_up(direction: np.ndarray) -> None:
    here = np.array([0.9, 0.3, 0.3, 0.1]) / np.linalg.norm([0.9, 0.3, 0.3, 0.1])
    assert np.allclose(rotate(raised(here, direction), direction), Z, atol=1e-6)
    assert np.allclose(rotate(raised(here, direction, 0.0), direction), rotate(here, direction))


def test_marks_are_on_the_cube() -> None:
    places = on_cube(fibonacci(40))
    assert np.allclose(np.abs(places).max(axis=1), np.abs(places).max())
