"""Mahony's filter: the differential equations of the paper, the bias, and gains that are large for the step."""

from __future__ import annotations

import numpy as np

from imugui.fusion import attitude as at
from imugui.fusion import quaternion as qt
from imugui.fusion.mahony import Mahony, MahonyParams
from imugui.samples import GRAVITY

UP = (0.0, 0.0, GRAVITY)
FIELD = (0.0, 20.0, -43.0)
STILL = (0.0, 0.0, 0.0)


def test_small_steps_follow_the_papers_equation() -> None:
    """dR/dt = R (gyr - b + kp w)x, db/dt = -ki w, w = sum of measured x estimated, integrated finely on matrices."""
    truth = at.from_euler(0.4, 0.3, -0.5)
    acc, mag = qt.rotate(qt.conjugate(truth), (0.0, 0.0, 1.0)), qt.rotate(qt.conjugate(truth), FIELD)
    mag = mag / qt.length(mag)
    begin = qt.multiply(truth, qt.from_rotation_vector((0.1, -0.15, 0.2)))
    kp, ki, dt = 1.4, 0.3, 1e-3
    matrix, bias = qt.to_matrix(begin), np.zeros(3)
    board = Mahony(MahonyParams(kp=kp, ki=ki))
    board.start(begin)
    gyr = np.array((0.02, -0.01, 0.03))
    for _ in range(1500):
        h = matrix @ mag
        w = np.cross(acc, matrix[2]) + np.cross(mag, matrix.T @ (0.0, np.hypot(h[0], h[1]), h[2]))
        matrix = matrix @ qt.to_matrix(qt.from_rotation_vector((gyr - bias + kp * w) * dt))
        bias = bias - ki * w * dt
        board.update(gyr, GRAVITY * acc, 47.0 * mag, dt)
    assert np.degrees(qt.angle_between(board.quat, qt.from_matrix(matrix))) < 0.02
    assert np.allclose(board.bias, bias, atol=1e-4)


def test_the_integral_learns_the_bias_whatever_the_rate() -> None:
    bias = np.array((0.02, -0.03, 0.01))
    for rate_hz in (50.0, 200.0):
        board = Mahony(MahonyParams(kp=1.0, ki=0.1))
        for _ in range(int(90 * rate_hz)):
            board.update(bias, UP, FIELD, 1.0 / rate_hz)
        assert np.allclose(board.bias, bias, atol=5e-4)


def test_a_tilt_falls_with_the_time_constant_of_kp() -> None:
    board = Mahony(MahonyParams(kp=1.4, ki=0.0))
    board.start(qt.from_rotation_vector((0.05, 0.0, 0.0)))
    for _ in range(int(200 / 1.4)):
        board.update(STILL, UP, None, 0.005)
    assert abs(qt.angle_between(board.quat, (1.0, 0, 0, 0)) - 0.05 * np.exp(-1.0)) < 5e-4


def test_kp_15_with_a_field_every_eighth_of_a_second_does_not_swing() -> None:
    board = Mahony(Mahony.PRESETS["Screw assistant 2018"])
    board.start(qt.from_rotation_vector((0.0, 0.0, 0.6)))
    yaws = []
    for i in range(1000):
        board.update(STILL, UP, FIELD if i % 17 == 16 else None, 1 / 138.6)
        yaws.append(float(at.euler(board.quat)[0]))
    assert min(yaws) > -1e-9
    assert yaws[-1] < 0.01


def test_a_gross_tilt_teaches_no_bias() -> None:
    board = Mahony()
    board.start((0.0, 1.0, 0.0, 0.0))
    for _ in range(1000):
        board.update(STILL, UP, None, 0.02)
    assert np.degrees(np.abs(board.bias)).max() < 0.1


def test_the_seeds_constants() -> None:
    presets = Mahony.PRESETS
    assert presets["Screw assistant 2018"] == MahonyParams(kp=15.0, ki=0.0)
    assert presets["Motion card 2018"] == MahonyParams(kp=1.4, ki=0.002)
    assert presets["Winer sketch"] == MahonyParams(kp=10.0, ki=0.0)
