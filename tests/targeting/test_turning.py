"""The turn since engaging, and its steering parts in view axes."""

from __future__ import annotations

from math import degrees, radians

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from imugui.fusion import quaternion as qt
from imugui.fusion.scalar import Quat
from imugui.targeting.settings import PRESETS, Control
from imugui.targeting.turning import Steering, turn_deg

parts = st.floats(-1.0, 1.0)
quats = (
    st.tuples(parts, parts, parts, parts)
    .filter(lambda q: sum(x * x for x in q) > 1e-3)
    .map(lambda q: tuple(qt.normalise(q).tolist()))
)
UP, EAST, NORTH = (0.0, 0.0, 1.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)


def turned(quat: Quat, axis: tuple[float, float, float], angle_deg: float) -> Quat:
    """The attitude after a turn about an axis of the earth."""
    turn = qt.from_rotation_vector(radians(angle_deg) * np.array(axis))
    w, x, y, z = qt.multiply(turn, quat).tolist()
    return w, x, y, z


def about(axis: tuple[float, float, float], angle_deg: float) -> Quat:
    return turned((1.0, 0.0, 0.0, 0.0), axis, angle_deg)


@given(quats, quats)
def test_it_is_the_rotation_vector_in_the_first_boards_axes(p: Quat, q: Quat) -> None:
    expected = np.degrees(qt.to_rotation_vector(qt.multiply(qt.conjugate(p), q)))
    angle = np.linalg.norm(expected)
    if angle < 179.0:  # half a turn has two directions
        assert np.allclose(turn_deg(p, q), expected, atol=1e-9)
    assert np.linalg.norm(turn_deg(p, q)) == pytest.approx(angle, abs=1e-9)


@given(quats)
def test_no_movement_is_exactly_nothing(q: Quat) -> None:
    w, x, y, z = q
    assert turn_deg(q, q) == turn_deg(q, (-w, -x, -y, -z)) == (0.0, 0.0, 0.0)


@given(quats, quats, st.floats(0.99, 1.01))
def test_a_length_a_little_off_does_not_matter(p: Quat, q: Quat, length: float) -> None:
    w, x, y, z = (length * part for part in q)
    assert turn_deg(p, (w, x, y, z)) == pytest.approx(turn_deg(p, q), abs=1e-9)


def test_by_default_the_view_follows_a_pointer() -> None:
    control, level = Control(), about(UP, 0.0)
    pan, zoom = Steering(control, "pan", level), Steering(control, "zoom", level)
    right = turn_deg(level, turned(level, UP, -10.0))  # clockwise from above
    raised = turn_deg(level, turned(level, EAST, 10.0))  # the front, north, goes up
    assert pan.pair(right) == pytest.approx((10.0, 0.0))
    assert pan.pair(raised) == pytest.approx((0.0, 10.0))
    assert zoom.pair(raised) == pytest.approx((10.0, 0.0))


@pytest.mark.parametrize("pitch", [-60.0, 0.0, 45.0])
@pytest.mark.parametrize("roll", [-170.0, -90.0, -30.0, 0.0, 45.0, 90.0, 180.0])
@pytest.mark.parametrize("heading", [0.0, 130.0])
def test_right_is_right_however_the_board_is_rolled(roll: float, pitch: float, heading: float) -> None:
    """T8. The board points along its y; right and up are seen from behind it, whatever its roll."""
    unrolled = turned(turned(about(NORTH, 0.0), EAST, pitch), UP, heading)
    forward, right = qt.rotate(unrolled, NORTH), qt.rotate(unrolled, EAST)
    upward = np.cross(right, forward)
    held = turned(unrolled, tuple(forward.tolist()), roll)
    pan = Steering(Control(), "pan", held)
    assert pan.pair(turn_deg(held, turned(held, tuple((-upward).tolist()), 8.0))) == pytest.approx((8.0, 0.0))
    assert pan.pair(turn_deg(held, turned(held, tuple(right.tolist()), 8.0))) == pytest.approx((0.0, 8.0))
    spun = pan.pair(turn_deg(held, turned(held, tuple(forward.tolist()), 8.0)))
    assert spun == pytest.approx((0.0, 0.0), abs=1e-9)


def test_a_board_that_points_straight_up_has_no_roll() -> None:
    held = about(EAST, 90.0)
    spun = turned(held, UP, 30.0)
    for attitude in (held, spun):
        body_x = tuple(qt.rotate(attitude, EAST).tolist())
        pan = Steering(Control(), "pan", attitude)
        assert pan.pair(turn_deg(attitude, turned(attitude, body_x, 5.0))) == pytest.approx((0.0, 5.0))


def test_the_thesis_steers_with_the_boards_own_axes() -> None:
    control = PRESETS["thesis position"]
    held = turned(about(EAST, 25.0), UP, 70.0)
    turn = (3.0, -4.0, 5.0)
    assert Steering(control, "pan", held).pair(turn) == (3.0, -4.0)
    assert Steering(control, "zoom", held).pair(turn) == (3.0, 0.0)


def test_two_choices_of_the_same_axis_are_taken_as_they_are() -> None:
    control = Control(x_axis="+z", y_axis="-z")
    assert Steering(control, "pan", about(NORTH, 40.0)).pair((1.0, 2.0, 3.0)) == (3.0, -3.0)


def test_half_a_turn_is_the_longest() -> None:
    assert degrees(np.pi) == pytest.approx(np.linalg.norm(turn_deg(about(UP, -90.0), about(UP, 90.0))))
