"""Camera and hull, against formulas written another way."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from imugui.views.geometry import AIM, FARTHEST, HIGHEST, LOWEST, NEAREST, VIEWS, Camera, camera_from, hull, unit_quat

ANGLE = st.floats(-math.pi, math.pi)
COORDINATE = st.floats(-1.5, 1.5)
SIZE = (640.0, 480.0)


@given(ANGLE, st.floats(LOWEST, HIGHEST))
def test_camera_axes_are_a_right_handed_frame_that_looks_at_the_aim(azimuth: float, elevation: float) -> None:
    camera = Camera(azimuth, elevation)
    basis = camera.basis
    assert basis @ basis.T == pytest.approx(np.eye(3), abs=1e-12)
    assert np.linalg.det(basis) == pytest.approx(1.0)
    assert camera.position - AIM == pytest.approx(camera.distance * basis[2], abs=1e-12)
    assert basis[0, 2] == 0.0  # the horizon is level


@given(ANGLE, st.floats(LOWEST, HIGHEST), COORDINATE, COORDINATE, COORDINATE)
def test_projection_is_the_ray_through_the_picture_plane(
    azimuth: float, elevation: float, x: float, y: float, z: float
) -> None:
    camera = Camera(azimuth, elevation, distance=5.0)
    point = np.array((x, y, z))
    (pixel,), (depth,) = camera.project(point[None, :], *SIZE)
    right, up, back = camera.basis
    focal = camera.focal(*SIZE)
    ray = (pixel[0] - SIZE[0] / 2) / focal * right - (pixel[1] - SIZE[1] / 2) / focal * up - back
    assert camera.position + depth * ray == pytest.approx(point, abs=1e-9)


def test_picture_spans_the_field_of_view() -> None:
    camera = camera_from("z")
    reach = camera.distance * math.tan(camera.field_of_view / 2)
    (right, top), _ = camera.project(AIM + np.array([(reach, 0.0, 0.0), (0.0, reach, 0.0)]), 400.0, 400.0)
    assert right == pytest.approx((400.0, 200.0), abs=1e-9)
    assert top == pytest.approx((200.0, 0.0), abs=1e-9)


@pytest.mark.parametrize(
    ("view", "right", "up"),
    [("x", (0, 1, 0), (0, 0, 1)), ("y", (-1, 0, 0), (0, 0, 1)), ("z", (1, 0, 0), (0, 1, 0))],
)
def test_named_views(view: str, right: tuple[int, ...], up: tuple[int, ...]) -> None:
    basis = camera_from(view).basis
    assert basis[0] == pytest.approx(right, abs=1e-12)
    assert basis[1] == pytest.approx(up, abs=1e-12)


def test_default_view_shows_all_three_axes_towards_the_upper_right_and_front() -> None:
    right, _, back = camera_from("default").basis
    assert right[0] > 0.5
    assert right[1] > 0.5
    assert back[2] > 0.3
    assert set(VIEWS) == {"default", "x", "y", "z"}


def test_unknown_view_is_refused() -> None:
    with pytest.raises(KeyError):
        camera_from("w")


def test_point_behind_the_camera_stays_finite() -> None:
    camera = Camera()
    pixels, depth = camera.project(np.array([2.0 * camera.position, camera.position]), *SIZE)
    assert np.isfinite(pixels).all()
    assert (depth > 0.0).all()


def test_zoom_and_orbit_stay_within_bounds() -> None:
    camera = Camera()
    assert camera.zoomed(1e-3).distance == NEAREST
    assert camera.zoomed(1e3).distance == FARTHEST
    assert camera.orbited(0.0, 9.0).elevation == HIGHEST
    assert camera.orbited(0.0, -9.0).elevation == LOWEST
    turned = camera.orbited(2.0 * math.pi, 0.0)
    assert turned.position == pytest.approx(camera.position, abs=1e-12)


def test_orbit_to_the_right_moves_the_camera_to_its_right() -> None:
    camera = Camera()
    step = camera.orbited(1e-4, 0.0).position - camera.position
    assert step @ camera.basis[0] > 0.0
    assert camera.orbited(0.0, 1e-4).position[2] > camera.position[2]


def test_hull_of_a_square_with_points_inside_and_on_edges() -> None:
    points = np.array([(0, 0), (2, 0), (2, 2), (0, 2), (1, 1), (1, 0), (0, 0)], dtype=float)
    assert {tuple(corner) for corner in hull(points).tolist()} == {(0, 0), (2, 0), (2, 2), (0, 2)}


def test_hull_of_too_few_points_is_those_points() -> None:
    assert hull(np.array([(1.0, 2.0), (1.0, 2.0)])).tolist() == [[1.0, 2.0]]


@given(st.lists(st.tuples(st.integers(-50, 50), st.integers(-50, 50)), min_size=3, max_size=40))
def test_hull_holds_every_point_and_turns_one_way(points: list[tuple[int, int]]) -> None:
    cloud = np.array(points, dtype=float)
    corners = hull(cloud)
    edges = np.roll(corners, -1, axis=0) - corners
    for start, edge in zip(corners, edges, strict=True):
        offset = cloud - start
        assert (edge[0] * offset[:, 1] - edge[1] * offset[:, 0] >= 0.0).all()


def test_unit_quat_scales_and_refuses_what_is_no_rotation() -> None:
    assert unit_quat((0.0, 0.0, 0.0, 2.0)) == (0.0, 0.0, 0.0, 1.0)
    assert unit_quat(np.array((3.0, 0.0, 4.0, 0.0))) == pytest.approx((0.6, 0.0, 0.8, 0.0))
    for bad in ((0.0,) * 4, (math.nan, 0.0, 0.0, 1.0), (math.inf, 0.0, 0.0, 1.0), (1.0, 0.0, 0.0)):
        assert unit_quat(bad) is None
