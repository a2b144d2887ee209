"""Madgwick's filter against the matrices of the report, and the two things added to it."""

from __future__ import annotations

import itertools

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from imugui.fusion import attitude as at
from imugui.fusion import quaternion as qt
from imugui.fusion.madgwick import Madgwick, MadgwickParams
from imugui.samples import GRAVITY

UP = (0.0, 0.0, GRAVITY)
parts = st.floats(-1.0, 1.0)
quats = st.tuples(parts, parts, parts, parts).filter(lambda q: sum(x * x for x in q) > 1e-2).map(qt.normalise)
small = st.tuples(parts, parts, parts).filter(lambda v: qt.length(v) > 0.1).map(lambda v: 0.2 * np.array(v))


def report_gradient(q: qt.Floats, acc: qt.Floats, mag: qt.Floats) -> qt.Floats:
    """Equations 25 to 34: J'f for q with our convention (sensor -> earth), x of the earth along the level field."""
    q1, q2, q3, q4 = qt.conjugate(q) * (1, -1, -1, -1)
    h = qt.rotate(q, mag)
    bx, bz = np.hypot(h[0], h[1]), h[2]
    f = [
        2 * (q2 * q4 - q1 * q3) - acc[0],
        2 * (q1 * q2 + q3 * q4) - acc[1],
        2 * (0.5 - q2 * q2 - q3 * q3) - acc[2],
        2 * bx * (0.5 - q3 * q3 - q4 * q4) + 2 * bz * (q2 * q4 - q1 * q3) - mag[0],
        2 * bx * (q2 * q3 - q1 * q4) + 2 * bz * (q1 * q2 + q3 * q4) - mag[1],
        2 * bx * (q1 * q3 + q2 * q4) + 2 * bz * (0.5 - q2 * q2 - q3 * q3) - mag[2],
    ]
    jacobian = [
        [-2 * q3, 2 * q4, -2 * q1, 2 * q2],
        [2 * q2, 2 * q1, 2 * q4, 2 * q3],
        [0, -4 * q2, -4 * q3, 0],
        [-2 * bz * q3, 2 * bz * q4, -4 * bx * q3 - 2 * bz * q1, -4 * bx * q4 + 2 * bz * q2],
        [-2 * bx * q4 + 2 * bz * q2, 2 * bx * q3 + 2 * bz * q1, 2 * bx * q2 + 2 * bz * q4, -2 * bx * q1 + 2 * bz * q3],
        [2 * bx * q3, 2 * bx * q4 - 4 * bz * q2, 2 * bx * q1 - 4 * bz * q3, 2 * bx * q2],
    ]
    return np.array(jacobian).T @ f


@given(quats, small, st.floats(0.2, 1.3))
def test_each_step_goes_down_the_gradient_of_the_report(truth: qt.Floats, off: qt.Floats, dip: float) -> None:
    """The direction of one correction is that of -J'f without its part along q, which normalising takes out."""
    field = np.array((0.0, np.cos(dip), -np.sin(dip)))
    acc, mag = qt.rotate(qt.conjugate(truth), (0.0, 0.0, 1.0)), qt.rotate(qt.conjugate(truth), field)
    begin = qt.multiply(qt.from_rotation_vector(off), truth)
    board = Madgwick(MadgwickParams(beta=0.001, zeta=0.0))
    board.start(begin)
    board.update((0.0, 0.0, 0.0), GRAVITY * acc, 47.0 * mag, 0.01)
    step = np.array(board.quat) - begin
    # our north is y, the report's x: the same sensor attitude seen from an earth turned by 90 degrees
    turn = qt.from_rotation_vector((0.0, 0.0, -np.pi / 2))
    gradient = qt.multiply(qt.conjugate(turn), report_gradient(qt.multiply(turn, begin), acc, mag))
    gradient = gradient - begin * (gradient @ begin)
    length = float(qt.length(step))
    assert length == 0.0 or step @ gradient / (length * qt.length(gradient)) < -1.0 + 1e-6
    assert length < 1.01e-5  # beta dt


def test_the_field_is_not_halved() -> None:
    """With the reference halved, as in the often copied code, the heading would take about twice as long."""
    truth = at.from_euler(0.5, -0.4, 0.7)
    board = Madgwick(MadgwickParams(beta=0.1, zeta=0.0))
    board.start(qt.multiply(qt.from_rotation_vector((0.0, 0.0, 0.6)), truth))
    field = qt.rotate(qt.conjugate(truth), (0.0, 20.0, -43.0))
    errors = []
    for _ in range(600):
        board.update((0.0, 0.0, 0.0), at.gravity(truth), field, 0.01)
        errors.append(float(np.degrees(qt.angle_between(board.quat, truth))))
    assert errors[-1] < 2.0
    assert all(later <= earlier + 1e-9 for earlier, later in itertools.pairwise(errors[50:]))


def test_a_tilt_falls_by_two_beta_and_then_stays_without_hopping() -> None:
    board = Madgwick(MadgwickParams(beta=0.2, zeta=0.0))
    board.start(qt.from_rotation_vector((0.5, 0.0, 0.0)))
    tilts = []
    for _ in range(200):
        board.update((0.0, 0.0, 0.0), UP, None, 0.01)
        tilts.append(float(qt.angle_between(board.quat, (1.0, 0.0, 0.0, 0.0))))
    assert abs(tilts[99] - (0.5 - 2 * 0.2 * 1.0)) < 1e-3
    assert tilts[-1] < 1e-9


def test_a_field_every_tenth_sample_turns_the_heading_at_least_40_percent_as_fast() -> None:
    """Not a tenth. (It is slower because gravity alone undoes the tilt of each field step in between.)"""
    headings = []
    for every in (1, 10):
        board = Madgwick(MadgwickParams(beta=0.05, zeta=0.0))
        board.start(qt.from_rotation_vector((0.0, 0.0, 1.0)))
        for i in range(400):
            board.update((0.0, 0.0, 0.0), UP, (0.0, 20.0, -43.0) if i % every == every - 1 else None, 0.01)
        headings.append(float(at.euler(board.quat)[0]))
    assert headings[0] < 0.9
    assert 1.0 - headings[1] > 0.4 * (1.0 - headings[0])


def test_zeta_learns_the_bias_of_all_axes() -> None:
    bias = np.array((0.02, -0.03, 0.01))
    board = Madgwick(MadgwickParams(beta=0.1, zeta=0.01))
    for _ in range(6000):
        board.update(bias, UP, (0.0, 20.0, -43.0), 0.01)
    assert np.allclose(board.bias, bias, atol=2e-3)
    without = Madgwick(MadgwickParams(beta=0.1, zeta=0.0))
    without.update(bias, UP, (0.0, 20.0, -43.0), 0.01)
    without.update(bias, UP, (0.0, 20.0, -43.0), 0.01)
    assert without.bias == (0.0, 0.0, 0.0)


def test_the_seeds_constants() -> None:
    presets = Madgwick.PRESETS
    assert presets["RC car 2019"] == MadgwickParams(beta=0.6046, zeta=0.0)
    assert abs(presets["RC car 2019"].beta - np.sqrt(3 / 4) * np.radians(40.0)) < 1e-4
    assert [presets[f"Motion card 2018, {name}"].beta for name in ("quiet", "medium", "fast")] == [0.03, 0.1, 0.4]
