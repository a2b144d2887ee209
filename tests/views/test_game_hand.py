"""A drag on the game's picture turns the virtual board so that the view goes where the pointer goes."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from imugui.fusion.attitude import from_euler
from imugui.fusion.quaternion import from_rotation_vector, multiply, rotate
from imugui.targeting.settings import PRESETS, SPEED, Control
from imugui.targeting.turning import Steering, turn_deg
from imugui.targeting.view_pose import PAN, ZOOM
from imugui.views.game_hand import TILT_PX_PER_DEG, turn_rad, viewer

ATTITUDES = {"level": (0.0, 0.0, 0.0), "turned": (1.2, 0.3, -0.2), "rolled": (-0.7, 0.1, 0.9)}


def steered(control: Control, mode: str, angles: tuple[float, ...], right: float, up: float) -> tuple[float, float]:
    """What the controller makes, deg, of the turn that ``Session.turn_board(right, up, viewer)`` asks for."""
    before = tuple(from_euler(*angles).tolist())
    axis = rotate(viewer(control, mode, before), np.array([up, right, 0.0]))
    after = tuple(multiply(from_rotation_vector(axis), before).tolist())
    return Steering(control, mode, before).pair(turn_deg(before, after))


@pytest.mark.parametrize("angles", ATTITUDES.values(), ids=ATTITUDES)
@pytest.mark.parametrize("name", PRESETS)
def test_right_and_up_are_right_and_up(name: str, angles: tuple[float, ...]) -> None:
    control = PRESETS[name]
    assert steered(control, PAN, angles, 0.02, 0.0) == pytest.approx((math.degrees(0.02), 0.0), abs=1e-9)
    assert steered(control, PAN, angles, 0.0, 0.02) == pytest.approx((0.0, math.degrees(0.02)), abs=1e-9)
    assert steered(control, ZOOM, angles, 0.0, 0.02) == pytest.approx((math.degrees(0.02), 0.0), abs=1e-9)


def test_one_axis_for_both_still_goes_up() -> None:
    control = dataclasses.replace(Control(), x_axis="+x", y_axis="+x", roll_corrected=False)
    quat = viewer(control, PAN, (1.0, 0.0, 0.0, 0.0))
    assert np.isfinite(quat).all()
    assert np.linalg.norm(quat) == pytest.approx(1.0)
    assert steered(control, PAN, (0.0, 0.0, 0.0), 0.0, 0.02)[1] == pytest.approx(math.degrees(0.02))


def test_the_pointer_and_the_view_go_equally_far() -> None:
    control = Control()
    right, up = turn_rad(control, PAN, 80.0, -40.0)
    assert (math.degrees(right) * control.gain, math.degrees(up) * control.gain) == pytest.approx((80.0, -40.0))
    assert turn_rad(control, ZOOM, 80.0, 10.0) == pytest.approx((0.0, math.radians(2.0 * 10.0 / control.zoom_gain)))
    speed = dataclasses.replace(control, mapping=SPEED, gain=50.0)
    assert math.degrees(turn_rad(speed, PAN, TILT_PX_PER_DEG, 0.0)[0]) == pytest.approx(1.0)
