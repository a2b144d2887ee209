"""The complementary filter: time constants that mean what they say, at any attitude."""

from __future__ import annotations

import numpy as np
import pytest

from imugui.fusion import attitude as at
from imugui.fusion import quaternion as qt
from imugui.fusion.complementary import Complementary, ComplementaryParams
from imugui.samples import GRAVITY

FIELD = (0.0, 20.0, -43.0)
STILL = (0.0, 0.0, 0.0)


@pytest.mark.parametrize("truth_deg", [(0, 0, 0), (30, 80, -20), (-120, -90, 0), (10, 5, 179)])
@pytest.mark.parametrize("tilt_deg", [1.0, 45.0, 170.0])
def test_63_percent_of_a_tilt_is_gone_after_tau(truth_deg: tuple[float, ...], tilt_deg: float) -> None:
    truth = at.from_euler(*np.radians(truth_deg))
    board = Complementary(ComplementaryParams(tau=0.5))
    board.start(qt.multiply(qt.from_rotation_vector((np.radians(tilt_deg), 0.0, 0.0)), truth))
    for _ in range(5000):
        board.update(STILL, at.gravity(truth), None, 1e-4)
    tilt = np.degrees(qt.angle_between(board.quat, truth))
    assert tilt == pytest.approx(tilt_deg * np.exp(-1.0), rel=0.01)


@pytest.mark.parametrize("every", [1, 10])
def test_63_percent_of_a_heading_error_is_gone_after_tau_mag(every: int) -> None:
    board = Complementary(ComplementaryParams(tau_mag=2.0))
    board.start(qt.from_rotation_vector((0.0, 0.0, 1.0)))
    for i in range(2000):
        board.update(STILL, (0.0, 0.0, GRAVITY), FIELD if i % every == every - 1 else None, 1e-3)
    assert at.euler(board.quat)[0] == pytest.approx(np.exp(-1.0), rel=0.01)


def test_one_step_is_the_seeds_recursion() -> None:
    """angle = a (angle + rate dt) + (1 - a) measured, a = tau/(tau + dt) = 0.909 at 100 Hz."""
    board = Complementary(Complementary.PRESETS["Motion card 2018"])
    board.start(qt.from_rotation_vector((0.3, 0.0, 0.0)))
    board.update((0.2, 0.0, 0.0), (0.0, 0.0, GRAVITY), None, 0.01)
    expected = 0.1 / 0.11 * (0.3 + 0.2 * 0.01)
    assert at.euler(board.quat)[2] == pytest.approx(expected, abs=1e-5)


def test_the_field_does_not_tilt() -> None:
    board = Complementary()
    board.start((1.0, 0.0, 0.0, 0.0))
    for _ in range(100):
        board.update(STILL, (0.0, 0.0, GRAVITY), (30.0, 5.0, 20.0), 0.01)
    assert np.allclose(at.euler(board.quat)[1:], 0.0, atol=1e-12)
    assert at.euler(board.quat)[0] > 0.05


def test_tau_mag_0_takes_the_heading_straight_from_the_magnetometer() -> None:
    board = Complementary(Complementary.PRESETS["TIPS probe 2016"])
    for yaw in np.radians((0.0, 10.0, 25.0, 5.0)):
        truth = at.from_euler(yaw, 0.3, -0.2)
        for _ in range(3):
            board.update(STILL, at.gravity(truth), qt.rotate(qt.conjugate(truth), FIELD), 0.015)
    for _ in range(60):
        board.update(STILL, at.gravity(truth), qt.rotate(qt.conjugate(truth), FIELD), 0.015)
    assert np.degrees(qt.angle_between(board.quat, truth)) < 0.1


def test_the_seeds_constants() -> None:
    presets = Complementary.PRESETS
    assert presets["Motion card 2018"].tau == 0.1
    assert presets["TIPS probe 2016"].tau == pytest.approx(0.015 * 0.9 / (1.0 - 0.9))
    assert presets["RC car 2019"].tau == pytest.approx(0.005 * 0.9 / (1.0 - 0.9))
