"""Angles, headings, start attitudes and display conventions."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from imugui.fusion import attitude as at
from imugui.fusion import quaternion as qt
from imugui.samples import GRAVITY

angles = st.floats(-np.pi, np.pi)
tilts = st.one_of(
    st.floats(-np.pi / 2, np.pi / 2),
    st.floats(0.0, 1e-4).map(lambda d: np.pi / 2 - d),  # into the lock
    st.floats(0.0, 1e-4).map(lambda d: -np.pi / 2 + d),
)
UP = (0.0, 0.0, GRAVITY)
FIELD = (0.0, 20.0, -43.0)


@given(angles, tilts, angles)
def test_euler_is_the_inverse_of_from_euler(yaw: float, pitch: float, roll: float) -> None:
    quat = at.from_euler(yaw, pitch, roll)
    again = at.from_euler(*at.euler(quat))
    assert qt.angle_between(quat, again) < 1e-7


@given(angles, st.floats(-1.5, 1.5), angles)
def test_away_from_the_lock_the_angles_themselves_come_back(yaw: float, pitch: float, roll: float) -> None:
    back = at.euler(at.from_euler(yaw, pitch, roll))
    assert np.allclose(np.exp(1j * back), np.exp(1j * np.array((yaw, pitch, roll))), atol=1e-12)


@pytest.mark.parametrize(
    ("angles_deg", "x_axis", "y_axis"),
    [
        ((0, 0, 0), (1, 0, 0), (0, 1, 0)),
        ((90, 0, 0), (0, 1, 0), (-1, 0, 0)),  # yaw counter-clockwise from above: x turns from east to north
        ((0, 90, 0), (0, 0, -1), (0, 1, 0)),  # a positive pitch turns x down
        ((0, 0, 90), (1, 0, 0), (0, 0, 1)),  # a positive roll turns y up
        ((90, 0, 90), (0, 1, 0), (0, 0, 1)),
    ],
)
def test_angles_mean_zyx(angles_deg: tuple[int, ...], x_axis: tuple[int, ...], y_axis: tuple[int, ...]) -> None:
    quat = at.from_euler(*np.radians(angles_deg))
    assert np.allclose(qt.rotate(quat, (1.0, 0, 0)), x_axis, atol=1e-15)
    assert np.allclose(qt.rotate(quat, (0.0, 1, 0)), y_axis, atol=1e-15)


def test_exactly_vertical_has_roll_zero() -> None:
    yaw, pitch, roll = np.degrees(at.euler(at.from_euler(np.radians(30.0), np.pi / 2, 0.0)))
    assert (round(yaw, 6), round(pitch, 6), roll) == (30.0, 90.0, 0.0)


@pytest.mark.parametrize(("pitch_deg", "reliable"), [(0, True), (84.9, True), (85.1, False), (-90, False), (-84, True)])
def test_euler_is_unreliable_near_the_vertical(pitch_deg: float, reliable: bool) -> None:
    assert at.euler_reliable(at.from_euler(1.0, np.radians(pitch_deg), 2.0)) == reliable


@pytest.mark.parametrize(("yaw_deg", "heading"), [(90, 0.0), (0, 90.0), (-90, 180.0), (180, 270.0), (135, 315.0)])
def test_heading_is_clockwise_from_north(yaw_deg: float, heading: float) -> None:
    quat = at.from_euler(np.radians(yaw_deg), 0.3, -1.0)
    assert abs((at.heading_deg(quat) - heading + 180.0) % 360.0 - 180.0) < 1e-9


@given(st.floats(0.0, 360.0), st.floats(-90.0, 90.0))
def test_heading_survives_a_pitch_through_the_vertical(heading: float, pitch_deg: float) -> None:
    quat = at.from_euler(np.radians(90.0 - heading), np.radians(pitch_deg), 0.0)
    assert abs((at.heading_deg(quat) - heading + 180.0) % 360.0 - 180.0) < 1e-6


def test_heading_takes_many_attitudes() -> None:
    quats = at.from_euler(np.radians([0.0, 90.0]), [0.0, np.pi / 2], [0.0, 0.0])
    assert np.allclose(at.heading_deg(quats), [90.0, 0.0])


@given(angles, tilts, angles)
def test_start_attitude_from_gravity_and_field_is_the_attitude(yaw: float, pitch: float, roll: float) -> None:
    quat = at.from_euler(yaw, pitch, roll)
    back = qt.conjugate(quat)
    start = at.from_acc_mag(qt.rotate(back, UP), qt.rotate(back, FIELD))
    assert qt.angle_between(start, quat) < 1e-12


@given(st.floats(-1.45, 1.45), angles)
def test_start_attitude_without_field_has_yaw_zero(pitch: float, roll: float) -> None:
    quat = at.from_euler(0.0, pitch, roll)
    assert qt.angle_between(at.from_acc_mag(qt.rotate(qt.conjugate(quat), UP)), quat) < 1e-12


@given(st.tuples(*[st.floats(-20.0, 20.0)] * 3).filter(lambda a: qt.length(a) > 0.1))
def test_start_attitude_heads_east_without_field(acc: tuple[float, ...]) -> None:
    start = at.from_acc_mag(acc)
    assert abs(at.heading_deg(start) - 90.0) < 1e-6
    assert np.allclose(at.gravity(start), GRAVITY * np.array(acc) / qt.length(acc), atol=1e-9)


@pytest.mark.parametrize("acc", [(0.0, 0.0, 0.0), (np.nan, 0.0, 9.8), (np.inf, 0.0, 0.0)])
def test_start_attitude_without_gravity_is_level(acc: tuple[float, ...]) -> None:
    assert np.allclose(at.from_acc_mag(acc), (1.0, 0.0, 0.0, 0.0))


def test_start_attitude_with_a_vertical_field_has_yaw_zero() -> None:
    assert np.allclose(at.from_acc_mag(UP, (0.0, 0.0, -43.0)), (1.0, 0.0, 0.0, 0.0))


@given(angles, tilts, angles)
def test_dip_and_norm_of_the_earth_field(yaw: float, pitch: float, roll: float) -> None:
    quat = at.from_euler(yaw, pitch, roll)
    dip, norm = at.dip_and_norm(quat, qt.rotate(qt.conjugate(quat), FIELD))
    assert abs(dip - np.arctan2(43.0, 20.0)) < 1e-12
    assert abs(norm - np.hypot(43.0, 20.0)) < 1e-12


def test_a_level_board_is_level_in_every_convention() -> None:
    north = at.from_euler(np.pi / 2, 0.0, 0.0)  # x points north
    shown = {name: np.degrees(at.euler(at.display_quat(north, name))) for name in at.CONVENTIONS}
    assert np.allclose(shown["ENU"], (90, 0, 0), atol=1e-9)
    assert np.allclose(shown["NWU"], (0, 0, 0), atol=1e-9)
    assert np.allclose(shown["NED"], (0, 0, 0), atol=1e-9)


def test_conventions_count_yaw_pitch_and_roll_their_own_way() -> None:
    # from x north: 30 degrees to the right (clockwise), then nose 20 degrees up, then right side 10 degrees down
    quat = at.from_euler(np.radians(90 - 30), np.radians(-20), np.radians(10))
    shown = {name: np.degrees(at.euler(at.display_quat(quat, name))) for name in at.CONVENTIONS}
    assert np.allclose(shown["ENU"], (60, -20, 10))
    assert np.allclose(shown["NWU"], (-30, -20, 10))
    assert np.allclose(shown["NED"], (30, 20, 10))


@given(angles, st.floats(-1.4, 1.4), angles)
def test_ned_yaw_is_the_heading(yaw: float, pitch: float, roll: float) -> None:
    quat = at.from_euler(yaw, pitch, roll)
    ned = np.degrees(at.euler(at.display_quat(quat, "NED"))[0])
    assert abs((ned - at.heading_deg(quat) + 180.0) % 360.0 - 180.0) < 1e-6
