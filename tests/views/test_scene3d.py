"""The 3D scene, by pixels and by events."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QColor, QImage, QPainter
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from imugui.fusion import quaternion
from imugui.views import theme
from imugui.views.geometry import Camera, camera_from, hull
from imugui.views.scene3d import Scene3D
from imugui.views.scene_body import FACES, HALF, TOP, Pose, paint_board, silhouette
from imugui.views.scene_cloud import dots
from imugui.views.scene_lens import Lens

SIZE = 400
IDENTITY = (1.0, 0.0, 0.0, 0.0)
Pixels = NDArray[np.int16]


def turn(axis: str, angle_deg: float) -> tuple[float, ...]:
    """Quaternion of a turn about one axis."""
    half = math.radians(angle_deg) / 2.0
    return (math.cos(half), *(math.sin(half) * (axis == name) for name in "xyz"))


@pytest.fixture(autouse=True)
def light(qapp: QApplication) -> Iterator[None]:
    theme.apply(qapp, "light")
    yield
    theme.apply(qapp, "light")


@pytest.fixture
def scene(qtbot: QtBot) -> Scene3D:
    widget = Scene3D()
    qtbot.addWidget(widget)
    widget.resize(SIZE, SIZE)
    return widget


def picture(scene: Scene3D, ratio: float = 1.0) -> Pixels:
    """What is painted, (rows, columns, 3) red, green, blue."""
    image = QImage(round(scene.width() * ratio), round(scene.height() * ratio), QImage.Format.Format_RGB32)
    image.setDevicePixelRatio(ratio)
    scene.render(image)
    raw = np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), image.width(), 4)
    return raw[:, :, 2::-1].astype(np.int16)


def near(pixels: Pixels, colour: QColor, tolerance: int = 24) -> NDArray[np.bool_]:
    """Which pixels are about this colour."""
    goal = np.array((colour.red(), colour.green(), colour.blue()))
    return (np.abs(pixels - goal) <= tolerance).all(axis=-1)


def centre(pixels: Pixels) -> Pixels:
    """The middle third of a picture in each direction."""
    rows, columns = pixels.shape[0], pixels.shape[1]
    return pixels[rows * 5 // 12 : rows * 7 // 12, columns * 5 // 12 : columns * 7 // 12]


def saturation(pixels: Pixels) -> NDArray[np.int16]:
    """Largest minus smallest of red, green and blue."""
    return pixels.max(axis=-1) - pixels.min(axis=-1)


def test_top_plate_fills_the_middle_seen_from_above(scene: Scene3D) -> None:
    scene.view_from("z")
    assert near(centre(picture(scene)), theme.palette().plate_z, 40).mean() > 0.5
    scene.set_quat(turn("x", 180.0))
    assert near(centre(picture(scene)), theme.palette().plate_z, 40).mean() < 0.25
    assert near(centre(picture(scene)), theme.palette().housing, 30).mean() > 0.5


@pytest.mark.parametrize(
    ("axis", "quat"), [(0, turn("y", -90.0)), (1, turn("x", 90.0)), (2, IDENTITY)], ids=["x", "y", "z"]
)
def test_plus_faces_have_their_axis_colour(scene: Scene3D, axis: int, quat: tuple[float, ...]) -> None:
    scene.view_from("z")
    scene.set_quat(quat)
    colours = theme.palette()
    plates = (colours.plate_x, colours.plate_y, colours.plate_z)
    shares = [near(centre(picture(scene)), plate, 40).mean() for plate in plates]
    assert int(np.argmax(shares)) == axis


def test_axis_x_points_right_and_y_up_seen_from_above(scene: Scene3D) -> None:
    scene.view_from("z")
    x, y = scene.axis_tip(0), scene.axis_tip(1)
    assert x.x() > SIZE * 0.6
    assert x.y() == pytest.approx(SIZE / 2)
    assert y.x() == pytest.approx(SIZE / 2)
    assert y.y() < SIZE * 0.4
    pixels = picture(scene)
    assert near(pixels, theme.axis_colour(0))[round(x.y()), round(x.x()) - 6]
    assert near(pixels, theme.axis_colour(1))[round(y.y()) + 6, round(y.x())]


def test_a_quarter_turn_moves_the_x_tip_to_where_geometry_says(scene: Scene3D) -> None:
    before = scene.axis_tip(1)
    scene.set_quat(turn("z", 90.0))
    after = scene.axis_tip(0)
    ((x, y),), _ = Camera().project(np.array([(0.0, 0.95, 0.0)]), SIZE, SIZE)
    assert (after.x(), after.y()) == pytest.approx((x, y), abs=1e-9)
    assert (after.x(), after.y()) == pytest.approx((before.x(), before.y()), abs=1e-9)


def test_quat_and_its_negative_look_the_same(scene: Scene3D) -> None:
    scene.set_quat(turn("y", 30.0))
    first = picture(scene)
    scene.set_quat([-value for value in turn("y", 30.0)])
    assert (picture(scene) == first).all()


@pytest.mark.parametrize("bad", [(math.nan,) * 4, (0.0,) * 4])
def test_what_is_no_rotation_is_ignored(scene: Scene3D, bad: tuple[float, ...]) -> None:
    scene.set_quat(turn("x", 40.0))
    before = picture(scene)
    scene.set_quat(bad)
    assert (picture(scene) == before).all()


@pytest.mark.parametrize("face", FACES, ids=lambda face: face.label)
def test_lettering_is_upright_and_not_mirrored(face: Any) -> None:
    assert np.cross(face.right, face.up) == pytest.approx(face.normal)
    # turn the board so that this face looks along earth z, up to the camera above
    matrix = np.array([face.right, face.up, face.normal])
    pose = Pose(Lens(camera_from("z"), SIZE, SIZE), matrix)
    assert pose.sees_face(face)
    plane = pose.plane(face, face.normal * HALF)
    origin, right, down = (plane.map(QPointF(*place)) for place in ((0, 0), (100, 0), (0, 100)))
    assert right.x() > origin.x()
    assert right.y() == pytest.approx(origin.y())
    assert down.y() > origin.y()


def test_only_sides_towards_the_camera_are_seen() -> None:
    pose = Pose(Lens(camera_from("default"), SIZE, SIZE), np.eye(3))
    assert {face.label for face in FACES if pose.sees_face(face)} == {"+X", "−Y", "+Z"}
    assert pose.light(TOP.normal) > pose.light(-TOP.normal)


def test_ghost_appears_moves_and_goes(scene: Scene3D) -> None:
    colour = theme.palette().ghost
    plain = picture(scene)
    assert not near(plain, colour).any()
    scene.set_ghost(IDENTITY)
    level = near(picture(scene), colour)
    assert level.sum() > 200
    scene.set_ghost(turn("y", 60.0))
    assert (near(picture(scene), colour) != level).sum() > 200
    scene.set_ghost(None)
    assert (picture(scene) == plain).all()


def test_dimmed_board_has_no_colour_but_a_word(scene: Scene3D) -> None:
    scene.view_from("z")
    vivid = centre(picture(scene))
    scene.set_dimmed("No data for 2 s")
    pixels = picture(scene)
    assert saturation(vivid).mean() > 60
    assert saturation(centre(pixels)).mean() < 20
    assert near(pixels[-60:], theme.palette().warn).any()
    assert scene.accessibleDescription() == "No data for 2 s"
    scene.set_dimmed(None)
    assert (centre(picture(scene)) == vivid).all()
    assert scene.accessibleDescription() == ""


def test_long_note_stays_inside_the_picture(scene: Scene3D) -> None:
    scene.set_dimmed("")
    plain = picture(scene)
    scene.set_dimmed("no data since the cable was pulled out " * 9)
    changed = (picture(scene) != plain).any(axis=(0, 2))
    assert changed.any()
    assert not changed[:8].any()
    assert not changed[-8:].any()


def test_background_follows_the_scheme(scene: Scene3D, qapp: QApplication) -> None:
    assert picture(scene)[0, 0].min() > 200
    theme.apply(qapp, "dark")
    assert picture(scene)[0, 0].max() < 60
    assert near(picture(scene), theme.palette().plate_z, 40).sum() > 1000


def test_compass_letters_and_grid_are_on_the_ground(scene: Scene3D) -> None:
    scene.view_from("z")
    pixels = picture(scene)
    top_row = np.flatnonzero(near(pixels, theme.palette().text, 8).any(axis=1))[0]
    letter = near(pixels, theme.palette().text, 60)[top_row : top_row + 14, SIZE // 2 - 12 : SIZE // 2 + 12]
    assert top_row < SIZE * 0.2  # N, above the ring
    # the N: strokes at both sides, mirrored onto itself by half a turn
    assert letter.any(axis=0).sum() >= 8
    assert not near(pixels, theme.palette().text, 8)[SIZE * 4 // 5 :].any()  # S is muted


def test_twice_the_pixels_show_the_same_picture_sharper(scene: Scene3D) -> None:
    single = picture(scene)
    double = picture(scene, 2.0)
    assert double.shape == (2 * SIZE, 2 * SIZE, 3)
    halved = double.reshape(SIZE, 2, SIZE, 2, 3).mean(axis=(1, 3))
    assert np.abs(halved - single).mean() < 3.0
    for i in range(3):  # lines are as thick, measured in the eye
        amounts = [near(pixels, theme.axis_colour(i), 40).sum() for pixels in (single, halved)]
        assert amounts[1] == pytest.approx(amounts[0], rel=0.1)
    blocks = double.reshape(SIZE, 2, SIZE, 2, 3)
    assert (blocks[:, 0] != blocks[:, 1]).any(axis=(2, 3)).mean() > 0.05  # no enlarged pixels


@pytest.mark.parametrize("size", [(1, 1), (30, 400), (900, 200)])
def test_any_size_paints(scene: Scene3D, size: tuple[int, int]) -> None:
    scene.resize(*size)
    scene.set_ghost(turn("x", 20.0))
    scene.set_points(np.eye(3))
    scene.set_dimmed("paused")
    assert picture(scene).shape == (size[1], size[0], 3)


@pytest.mark.parametrize("view", ["x", "y", "z", "default"])
@pytest.mark.parametrize("zoom", [0.1, 10.0])
def test_any_camera_paints(scene: Scene3D, view: str, zoom: float) -> None:
    scene.view_from(view)
    scene.zoom(zoom)
    for quat in (IDENTITY, turn("x", 90.0), turn("y", 180.0)):
        scene.set_quat(quat)
        assert saturation(picture(scene)).max() > 60


def test_points_are_drawn_in_their_colours(scene: Scene3D) -> None:
    red = QColor(255, 0, 0)
    scene.set_points([(0.0, 0.0, 0.9), (0.0, 0.0, 0.9)], [(255, 0, 0), (255, 0, 0)])
    spot = near(picture(scene), red, 40)
    assert 5 <= spot.sum() <= 30
    scene.set_points([])
    assert not near(picture(scene), red, 40).any()


def test_turning_points_move_with_the_board_and_others_stay(scene: Scene3D) -> None:
    red = QColor(255, 0, 0)
    scene.view_from("z")
    places = []
    for turning in (True, False):
        for angle_deg in (0.0, 90.0):
            scene.set_quat(turn("z", angle_deg))
            scene.set_points([(1.2, 0.2, 0.0)], [(255, 0, 0)], turning=turning)
            places.append(np.argwhere(near(picture(scene), red, 40)).mean(axis=0))
    assert np.linalg.norm(places[0] - places[1]) > 100.0
    assert places[2] == pytest.approx(places[3])
    assert places[0] == pytest.approx(places[2])


def test_board_hides_points_behind_it(scene: Scene3D) -> None:
    scene.view_from("z")
    plain = picture(scene)
    scene.set_points([(0.1, 0.1, -0.05)], [(255, 0, 0)])
    assert (picture(scene) == plain).all()
    scene.set_points([(0.1, 0.1, 0.4)], [(255, 0, 0)])
    assert near(picture(scene), QColor(255, 0, 0), 40).any()


def test_rows_with_nan_are_left_out_and_wrong_shapes_refused(scene: Scene3D) -> None:
    scene.set_points([(math.nan, 0.0, 0.0), (0.0, 0.0, 0.9)], [(0, 255, 0), (255, 0, 0)])
    assert near(picture(scene), QColor(255, 0, 0), 40).any()
    with pytest.raises(ValueError, match="colours"):
        scene.set_points(np.zeros((3, 3)), np.zeros((2, 3)))


def test_dots_overlap_in_order_and_leave_the_border_alone() -> None:
    places = np.array([(20.0, 20.0), (24.0, 20.0), (0.0, 0.0), (500.0, 10.0)])
    colours = np.array([(255, 0, 0), (0, 0, 255), (9, 9, 9), (9, 9, 9)], np.uint8)
    image = dots(places, colours, np.ones(4), (40, 30), 3.0)
    assert image.shape == (30, 40)
    assert image[20, 18] == 0xFFFF0000
    assert image[20, 22] == 0xFF0000FF  # the later dot covers the earlier one
    assert not image[0].any()
    assert not image[:, -1].any()


@pytest.mark.parametrize("quat", [turn("y", -35.0), turn("x", 50.0), turn("z", 130.0), turn("x", 170.0)])
def test_nothing_of_the_board_sticks_out_of_its_shape(quat: tuple[float, ...]) -> None:
    image = QImage(SIZE, SIZE, QImage.Format.Format_ARGB32)
    image.fill(Qt.GlobalColor.transparent)
    pose = Pose(Lens(camera_from("default"), SIZE, SIZE), quaternion.to_matrix(quat))
    painter = QPainter(image)
    paint_board(painter, pose, theme.palette())
    painter.end()
    alpha = np.frombuffer(image.constBits(), np.uint8).reshape(SIZE, SIZE, 4)[:, :, 3]
    rows, columns = np.nonzero(alpha)
    painted = np.column_stack((columns, rows)) + 0.5
    # the slab, and the plug on it, which stands flush with one of its sides
    corners = hull(np.vstack([pose.pixels(silhouette()), pose.pixels(silhouette() * (1.0, 0.7, 1.7))]))
    assert len(painted) > 5000
    for start, edge in zip(corners, np.roll(corners, -1, axis=0) - corners, strict=True):
        offset = painted - start
        outside = (edge[1] * offset[:, 0] - edge[0] * offset[:, 1]) / np.hypot(*edge)
        assert outside.max() < 1.5  # pixels
