"""The patient's axes from two axes, from gravity and a mark, and from Set origin; each with an honest residual."""

from __future__ import annotations

import json
import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from imugui.fusion.attitude import from_euler
from imugui.fusion.quaternion import from_rotation_vector, multiply, normalise, rotate, to_matrix
from imugui.guidance.aiming import axis_error
from imugui.guidance.plan import Plan, attitude, direction
from imugui.guidance.registration import (
    POSITIONS,
    Registration,
    from_axes,
    from_dict,
    from_mark,
    from_origin,
    mean_axis,
    to_patient,
    tool_direction,
)

QUAT = st.tuples(*[st.floats(-1, 1)] * 4).filter(lambda v: math.hypot(*v) > 1e-3)
EAST, NORTH, UP = np.eye(3)
X = (1.0, 0.0, 0.0)


def columns(found: Registration) -> np.ndarray:
    """Right, anterior, cranial in the earth frame."""
    return np.array(found.matrix).T


def leaning(angle_deg: float) -> tuple[float, float, float]:
    """North, tilted up."""
    return (0.0, math.cos(math.radians(angle_deg)), math.sin(math.radians(angle_deg)))


@given(QUAT)
def test_two_axes_give_back_any_patient(q: tuple[float, ...]) -> None:
    patient = to_matrix(normalise(q))
    found = from_axes(3.0 * patient[:, 1], patient[:, 2], 12.5, ((10, 60), (90, 140)))
    assert np.array(found.matrix) == pytest.approx(patient, abs=1e-12)
    assert found.residual_deg == pytest.approx(0.0, abs=1e-9)
    assert (found.method, found.t, found.rows, found.warning) == ("axes", 12.5, ((10, 60), (90, 140)), "")


@pytest.mark.parametrize("off_deg", [-9.9, -2.0, 0.5, 6.0])
def test_two_axes_share_what_misses_the_right_angle(off_deg: float) -> None:
    found = from_axes(EAST, (math.sin(math.radians(-off_deg)), 0.0, math.cos(math.radians(off_deg))))
    assert found.residual_deg == pytest.approx(abs(off_deg), abs=1e-9)
    right, anterior, cranial = columns(found)
    assert math.degrees(float(axis_error(anterior, EAST))) == pytest.approx(abs(off_deg) / 2, abs=1e-9)
    assert np.stack((right, anterior, cranial)) @ np.stack((right, anterior, cranial)).T == pytest.approx(np.eye(3))
    assert np.linalg.det(found.matrix) == pytest.approx(1.0)
    assert f"{90 + off_deg:.1f}° apart instead of 90°" in found.words
    assert ("Register again" in found.warning) == (abs(off_deg) > 3.0)


@pytest.mark.parametrize(
    ("anterior", "cranial", "said"),
    [
        (EAST, EAST, "0° apart instead of 90°; 10° off is the most"),
        (EAST, -EAST, "180° apart"),
        (EAST, leaning(90 - 0.0) + 0.3 * EAST, "apart instead of 90°"),
        (EAST, (0.0, 0.0, 0.0), "cranial direction is not known"),
        ((math.nan, 0.0, 0.0), UP, "anterior direction is not known"),
        ((math.inf, 0.0, 0.0), UP, "anterior direction is not known"),
    ],
)
def test_two_axes_that_are_none_are_refused(anterior: Any, cranial: Any, said: str) -> None:
    with pytest.raises(ValueError, match=said):
        from_axes(anterior, cranial)


@pytest.mark.parametrize(
    ("position", "right", "anterior"),
    [
        ("prone", EAST, -UP),
        ("supine", -EAST, UP),
        ("on the left side", UP, EAST),
        ("on the right side", -UP, -EAST),
    ],
)
def test_gravity_and_one_mark(position: str, right: np.ndarray, anterior: np.ndarray) -> None:
    """The head lies in the north, and the mark points two degrees above the horizon."""
    found = from_mark(leaning(2.0), position)
    assert columns(found) == pytest.approx(np.stack((right, anterior, NORTH)), abs=1e-12)
    assert found.residual_deg == pytest.approx(2.0, abs=1e-9)
    assert f"patient {position}; the mark is 2.0° above the horizon" in found.words
    assert set(POSITIONS) == {"prone", "supine", "on the left side", "on the right side"}


@pytest.mark.parametrize(
    ("mark", "position", "said"),
    [
        (UP, "prone", "90° above the horizon; 10° is the most"),
        (leaning(-11.0), "prone", "11° below"),
        (NORTH, "upright", "unknown; there are prone"),
        ((0.0, 0.0, 0.0), "prone", "mark direction is not known"),
    ],
)
def test_marks_that_are_none_are_refused(mark: Any, position: str, said: str) -> None:
    with pytest.raises(ValueError, match=said):
        from_mark(mark, position)


def test_a_mark_off_the_horizon_is_warned_about() -> None:
    assert from_mark(leaning(2.9)).warning == ""
    assert "more than 3°" in from_mark(leaning(-4.0)).warning


@given(QUAT, st.floats(-180, 180), st.floats(-90, 90), st.floats(-180, 180))
def test_set_origin_is_the_seeds_rule(q: tuple[float, ...], yaw: float, pitch: float, roll: float) -> None:
    """Shown attitude q0^-1 q at the planned angles: the tool is on the plan, whatever its axis."""
    origin = normalise(q)
    plan = Plan("a", "plain", yaw_deg=yaw, pitch_deg=pitch, roll_deg=roll)
    found = from_origin(origin)
    quat = multiply(origin, from_euler(*np.radians((yaw, pitch, roll))))
    for axis in np.eye(3):
        assert tool_direction(found, quat, axis) == pytest.approx(direction(plan, axis), abs=1e-12)
    assert abs(to_patient(found, quat) @ attitude(plan)) == pytest.approx(1.0, abs=1e-12)
    assert found.residual_deg == pytest.approx(0.0, abs=1e-6)


def test_origin_of_a_held_pose() -> None:
    sway = from_rotation_vector(np.radians([[1.0, 0, 0], [-1.0, 0, 0], [0, 0, 1.0], [0, 0, -1.0], [np.nan, 0, 0]]))
    found = from_origin(sway, (0.0, 0.0, 1.0))
    assert found.residual_deg == pytest.approx(1.0, abs=1e-9)
    assert columns(found) == pytest.approx(np.stack((-NORTH, EAST, UP)), abs=1e-9)
    assert "moved by 1.0°" in found.words
    assert "90.0° from the box's x axis" in found.words


@pytest.mark.parametrize(
    ("quats", "said"),
    [
        (np.full((3, 4), np.nan), "no attitude"),
        (from_euler(np.radians([0.0, 40.0]), 0.0, 0.0), "moved by 20°"),
    ],
)
def test_origins_that_are_none_are_refused(quats: np.ndarray, said: str) -> None:
    with pytest.raises(ValueError, match=said):
        from_origin(quats)


def test_tool_direction_undoes_the_matrix() -> None:
    found = from_axes(leaning(20.0), leaning(110.0))
    quats = normalise(np.random.default_rng(1).normal(size=(50, 4)))
    seen = tool_direction(found, quats, (0.0, 0.6, 0.8))
    assert seen @ np.transpose(found.matrix) == pytest.approx(rotate(quats, (0.0, 0.6, 0.8)), abs=1e-12)
    assert rotate(to_patient(found, quats), (0.0, 0.6, 0.8)) == pytest.approx(seen, abs=1e-12)


def test_mean_axis_of_a_held_pose() -> None:
    quats = from_euler(np.radians([88.0, 92.0, 88.0, 92.0, np.nan]), 0.0, np.radians([0, 90, 180, 270, 0]))
    mean, spread = mean_axis(quats, X)
    assert mean == pytest.approx(NORTH, abs=1e-12)
    assert math.degrees(spread) == pytest.approx(2.0, abs=1e-9)
    assert mean_axis((1.0, 0.0, 0.0, 0.0), X)[1] == 0.0
    with pytest.raises(ValueError, match="no attitude"):
        mean_axis(np.zeros((0, 4)), X)


@pytest.mark.parametrize("found", [from_axes(EAST, leaning(88.0), 1.5, ((0, 9),)), from_mark(leaning(1.0))])
def test_a_registration_survives_json(found: Registration) -> None:
    values = json.loads(json.dumps(found.to_dict()))
    again = from_dict(values)
    assert repr(again) == repr(found)  # NaN times are equal only in writing
    assert from_dict({**values, "t": None if math.isnan(found.t) else found.t}).id == found.id
    assert len(found.id) == 12


def test_identity_follows_the_values() -> None:
    ids = {from_axes(EAST, leaning(angle)).id for angle in (88.0, 88.0, 88.001)} | {from_origin((1.0, 0, 0, 0)).id}
    assert len(ids) == 3


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"matrix": [[1, 0, 0], [0, 1, 0], [0, 0, 2]]}, "right angles"),
        ({"matrix": [[1e300, 0, 0], [0, 1, 0], [0, 0, 1]]}, "right angles"),
        ({"matrix": [[1, 0], [0, 1]]}, "no registration"),
        ({"matrix": [[-1, 0, 0], [0, 1, 0], [0, 0, 1]]}, "right angles"),
        ({"method": "guess"}, "no registration"),
        ({"residual_deg": 0.1}, "changed after"),
        ({"words": None}, "changed after"),
        ({"rows": [1]}, "no registration"),
        ({"id": "0" * 12}, "changed after"),
    ],
)
def test_a_changed_registration_is_refused(changes: dict[str, Any], said: str) -> None:
    with pytest.raises(ValueError, match=said):
        from_dict({**from_mark(NORTH).to_dict(), **changes})
