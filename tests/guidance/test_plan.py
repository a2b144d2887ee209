"""Plans as vectors, against exact formulas and the printed vectors of guidance-teleop.md B.3 and TV-B."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from imugui.fusion.quaternion import rotate
from imugui.guidance.plan import (
    ANTERIOR,
    CRANIAL,
    MEDIAL,
    Plan,
    attitude,
    direction,
    list_problems,
    plan_words,
    plane_angles,
    problems,
    target_basis,
    title,
)

LEFT = Plan("L4", "projected", "left", 12.0, -5.0)
PLAIN = Plan("tilt", "plain", yaw_deg=45.0, pitch_deg=34.0)
STEEP = st.floats(-89.0, 89.0)
UNIT = st.tuples(*[st.floats(-1, 1)] * 3).filter(lambda v: math.hypot(*v) > 1e-3)


def angle_deg(a: Any, b: Any) -> float:
    """Between two vectors (3,), by another formula than ours (W. Kahan)."""
    a, b = np.asarray(a) / np.linalg.norm(a), np.asarray(b) / np.linalg.norm(b)
    return math.degrees(2 * math.atan2(np.linalg.norm(a - b), np.linalg.norm(a + b)))


def projected(axial_deg: float, sagittal_deg: float, side: str = "left") -> Plan:
    return Plan("L4", "projected", side, axial_deg, sagittal_deg)


def sequential(axial_deg: float, sagittal_deg: float) -> np.ndarray:
    """The rival reading: turned by the axial angle, then lifted by the sagittal one; left side."""
    a, s = math.radians(axial_deg), math.radians(sagittal_deg)
    return np.array((math.sin(a) * math.cos(s), math.cos(a) * math.cos(s), math.sin(s)))


@pytest.mark.parametrize(
    ("axial", "sagittal", "amc", "tilt"),
    [
        (20.0, 10.0, (0.92705, 0.33742, 0.16346), 22.020),
        (30.0, 20.0, (0.82596, 0.47687, 0.30063), 34.314),
        (30.0, -15.0, (0.84361, 0.48706, -0.22604), 32.477),
    ],
)
@pytest.mark.parametrize("side", ["left", "right"])
def test_conversion_vectors(axial: float, sagittal: float, amc: tuple[float, ...], tilt: float, side: str) -> None:
    d = direction(projected(axial, sagittal, side))
    seen = np.array([d @ ANTERIOR, d @ MEDIAL[side], d @ CRANIAL])
    a, b = math.tan(math.radians(axial)), math.tan(math.radians(sagittal))
    exact = np.array((1.0, a, b)) / math.sqrt(1 + a * a + b * b)
    assert seen == pytest.approx(exact, abs=1e-12)
    assert seen == pytest.approx(amc, abs=6e-6)
    assert angle_deg(d, ANTERIOR) == pytest.approx(math.degrees(math.atan(math.hypot(a, b))), abs=1e-9)
    assert angle_deg(d, ANTERIOR) == pytest.approx(tilt, abs=6e-4)


@pytest.mark.parametrize(
    ("axial", "sagittal", "difference"), [(10, 5, 0.076), (20, 10, 0.592), (30, 20, 2.505), (45, 30, 7.792)]
)
def test_it_is_projected_and_not_sequential(axial: float, sagittal: float, difference: float) -> None:
    apart = angle_deg(direction(projected(axial, sagittal)), sequential(axial, sagittal))
    assert apart == pytest.approx(difference, abs=6e-4)


@pytest.mark.parametrize(("axial", "sagittal", "error"), [(0, 0, 2.827), (30, 20, 2.371), (45, 30, 2.042)])
def test_two_degrees_more_of_each(axial: float, sagittal: float, error: float) -> None:
    apart = angle_deg(direction(projected(axial, sagittal)), direction(projected(axial + 2, sagittal + 2)))
    assert apart == pytest.approx(error, abs=6e-4)


@given(STEEP, STEEP, st.sampled_from(["left", "right"]))
def test_plane_angles_invert_the_direction(axial: float, sagittal: float, side: str) -> None:
    d = direction(projected(axial, sagittal, side))
    assert np.linalg.norm(d) == pytest.approx(1.0, abs=1e-12)
    assert np.degrees(plane_angles(d, side)) == pytest.approx((axial, sagittal), abs=1e-9)


@given(st.floats(-180, 180), st.floats(-90, 90))
def test_plain_direction(yaw: float, pitch: float) -> None:
    y, p = math.radians(yaw), math.radians(pitch)
    exact = (-math.sin(y) * math.cos(p), math.cos(y) * math.cos(p), -math.sin(p))
    assert direction(Plan("a", "plain", yaw_deg=yaw, pitch_deg=pitch)) == pytest.approx(exact, abs=1e-12)


def test_plain_turns_left_down_and_rolls_right() -> None:
    assert direction(Plan("a", "plain", yaw_deg=90.0)) == pytest.approx((-1.0, 0.0, 0.0), abs=1e-12)
    assert direction(Plan("a", "plain", pitch_deg=90.0)) == pytest.approx((0.0, 0.0, -1.0), abs=1e-12)
    rolled = attitude(Plan("a", "plain", roll_deg=90.0))
    assert rotate(rolled, (0.0, 0.0, 1.0)) == pytest.approx((1.0, 0.0, 0.0), abs=1e-12)  # the box's top: to the right


def test_plain_direction_of_another_tool_axis() -> None:
    up = Plan("a", "plain", yaw_deg=0.0, pitch_deg=20.0, roll_deg=15.0)
    r20, r15 = math.radians(20), math.radians(15)
    local = (math.cos(r15) * math.sin(r20), -math.sin(r15), math.cos(r15) * math.cos(r20))
    assert local == pytest.approx((0.3304, -0.2588, 0.9077), abs=6e-5)  # TV-B
    assert direction(up, (0.0, 0.0, 1.0)) == pytest.approx((-local[1], local[0], local[2]), abs=1e-12)


@given(UNIT, st.sampled_from(["left", "right", ""]))
def test_basis_is_square_everywhere(p: tuple[float, float, float], side: str) -> None:
    p = np.array(p) / np.linalg.norm(p)
    medial, cranial = target_basis(p, side)
    frame = np.stack((medial, cranial, p))
    assert frame @ frame.T == pytest.approx(np.eye(3), abs=1e-9)
    assert cranial @ CRANIAL >= -1e-6
    assert np.linalg.det(frame) == pytest.approx(1.0 if side == "right" else -1.0, abs=1e-9)


@given(STEEP, STEEP, st.sampled_from(["left", "right"]))
def test_basis_points_medial_and_cranial(axial: float, sagittal: float, side: str) -> None:
    p = direction(projected(axial, sagittal, side))
    medial, cranial = target_basis(p, side)
    assert medial @ MEDIAL[side] > 0.0
    assert cranial @ CRANIAL > 0.0
    assert (plane_angles(p + 1e-7 * medial, side) - plane_angles(p, side))[0] > 0.0
    assert abs(medial[2]) < 1e-12  # what is more medial is no more cranial


@pytest.mark.parametrize("p", [(0.0, 0.0, 1.0), (0.0, 0.0, -1.0), (1.0, 0.0, 0.0), (0.0, -1.0, 0.0), (1e-9, 0.0, 1.0)])
def test_basis_at_the_poles(p: tuple[float, float, float]) -> None:
    medial, cranial = target_basis(p, "left")
    assert np.stack((medial, cranial, p)) @ np.stack((medial, cranial, p)).T == pytest.approx(np.eye(3), abs=1e-9)
    if abs(p[2]) == 1.0:
        assert cranial == pytest.approx((0.0, -p[2], 0.0), abs=1e-8)
        assert medial == pytest.approx((1.0, 0.0, 0.0), abs=1e-8)


def test_words() -> None:
    assert plan_words(LEFT) == "12° medial, 5° caudal"
    assert plan_words(replace(LEFT, axial_deg=-2.5, sagittal_deg=3.0)) == "2.5° lateral, 3° cranial"
    assert plan_words(PLAIN) == "yaw 45° left, pitch 34° down"
    assert plan_words(replace(PLAIN, yaw_deg=-45.0, pitch_deg=-12.6, roll_deg=10.0)) == (
        "yaw 45° right, pitch 12.6° up, roll 10° right"
    )
    assert (title(LEFT), title(PLAIN)) == ("L4 left", "tilt")


@pytest.mark.parametrize("plan", [LEFT, PLAIN, replace(LEFT, depth_mm=40.0), replace(PLAIN, side="left", roll_deg=0.0)])
def test_a_right_plan_has_no_problem(plan: Plan) -> None:
    assert problems(plan) == {}


@pytest.mark.parametrize(
    ("plan", "changes", "field", "said"),
    [
        (LEFT, {"axial_deg": 90.0}, "axial_deg", "Axial is 90°: it must lie between -89.9 and 89.9°."),
        (LEFT, {"sagittal_deg": -95.5}, "sagittal_deg", "Sagittal is -95.5°"),
        (LEFT, {"axial_deg": math.nan}, "axial_deg", "not a number"),
        (LEFT, {"axial_deg": math.inf}, "axial_deg", "must lie between"),
        (LEFT, {"axial_deg": "12"}, "axial_deg", "must be a number"),
        (LEFT, {"axial_deg": True}, "axial_deg", "must be a number"),
        (LEFT, {"side": ""}, "side", "say left or right"),
        (LEFT, {"side": "middle"}, "side", "it must be left, right or empty"),
        (LEFT, {"kind": "other"}, "kind", "it must be projected or plain"),
        (LEFT, {"kind": 3}, "kind", "must be text"),
        (LEFT, {"name": "  "}, "name", "Level is empty"),
        (LEFT, {"name": "L4\n"}, "name", "plain text"),
        (LEFT, {"name": "x" * 41}, "name", "41 characters"),
        (LEFT, {"name": "=1+1"}, "name", "formula"),
        (LEFT, {"name": None}, "name", "must be text"),
        (LEFT, {"depth_mm": -4.0}, "depth_mm", "Depth is -4 mm"),
        (LEFT, {"tolerance_deg": 0.0}, "tolerance_deg", "must lie between"),
        (LEFT, {"amber_deg": 1.0}, "amber_deg", "inside green"),
        (LEFT, {"reference": "skin"}, "reference", "superior end-plate or table normal"),
        (PLAIN, {"yaw_deg": 181.0}, "yaw_deg", "must lie between"),
        (PLAIN, {"pitch_deg": -90.5}, "pitch_deg", "must lie between"),
        (PLAIN, {"roll_deg": 200.0}, "roll_deg", "must lie between"),
        (PLAIN, {"yaw_deg": math.nan}, "yaw_deg", "not a number"),
    ],
)
def test_each_wrong_field_says_what_is_wrong(plan: Plan, changes: dict[str, Any], field: str, said: str) -> None:
    found = problems(replace(plan, **changes))
    assert list(found) == [field]
    assert said in found[field]


def test_all_wrong_fields_are_named_at_once() -> None:
    assert set(problems(Plan("", "projected", "", 100.0, 100.0))) == {"name", "side", "axial_deg", "sagittal_deg"}


def test_unused_angles_are_not_looked_at() -> None:
    assert problems(replace(LEFT, yaw_deg=math.nan, pitch_deg=1e9)) == {}
    assert problems(replace(PLAIN, axial_deg=120.0)) == {}


def test_duplicates_are_named() -> None:
    found = list_problems([LEFT, replace(LEFT, side="right"), replace(LEFT, name="l4"), replace(LEFT, name="L5")])
    assert found == [{}, {}, {"name": "l4 left is already there, in row 1."}, {}]


@pytest.mark.parametrize(
    "plan", [replace(LEFT, axial_deg=95.0), replace(LEFT, side=""), replace(PLAIN, pitch_deg=math.nan)]
)
def test_a_wrong_plan_has_no_direction(plan: Plan) -> None:
    with pytest.raises(ValueError, match=r"\.$"):
        direction(plan)


def test_a_projected_plan_has_no_attitude() -> None:
    with pytest.raises(ValueError, match="no attitude"):
        attitude(LEFT)
