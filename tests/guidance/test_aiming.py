"""The aiming error and its picture, against exact formulas and the vectors of guidance-teleop.md B.4 and TV-B."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from imugui.fusion.attitude import euler, from_euler
from imugui.fusion.quaternion import conjugate, from_rotation_vector, multiply, normalise, rotate
from imugui.guidance.aiming import (
    Aim,
    aim,
    aim_many,
    axis_error,
    band,
    seed001_accepts,
    swing_angle,
    swing_twist,
    twist_angle,
    within,
    words,
)
from imugui.guidance.plan import Plan, attitude, direction, target_basis

NAN = math.nan
ROUND = math.radians(1e-9)
TURN = st.floats(-math.pi, math.pi)
VECTOR = st.tuples(*[st.floats(-1, 1)] * 3).filter(lambda v: math.hypot(*v) > 1e-3)
QUAT = st.tuples(*[st.floats(-1, 1)] * 4).filter(lambda v: math.hypot(*v) > 1e-3)
# the places where Euler angles or a basis break: along every axis, and nearly so
POLES = st.sampled_from([tuple(sign * row) for row in np.eye(3) for sign in (1.0, -1.0)])
PLACES = st.one_of(VECTOR, POLES)


def unit(v: tuple[float, ...]) -> np.ndarray:
    return np.array(v) / np.linalg.norm(v)


@pytest.mark.parametrize(("tilt", "error"), [(10, 0.87), (20, 1.71), (30, 2.50), (45, 3.54), (90, 5.0)])
def test_what_a_heading_error_of_five_degrees_costs(tilt: float, error: float) -> None:
    p = rotate(from_euler(0.0, math.radians(tilt), 0.0), (0.0, 0.0, 1.0))
    d = rotate(from_euler(math.radians(5), 0.0, 0.0), p)
    s, c = math.sin(math.radians(tilt)), math.cos(math.radians(tilt))
    exact = 2 * math.asin(s * math.sin(math.radians(2.5)))  # the same as cos eps = cos^2 + sin^2 cos psi
    assert math.cos(exact) == pytest.approx(c * c + s * s * math.cos(math.radians(5)), abs=1e-15)
    assert float(axis_error(d, p)) == pytest.approx(exact, abs=ROUND)
    assert math.degrees(exact) == pytest.approx(error, abs=6e-3)


@pytest.mark.parametrize("angle", [1e-12, 1e-8, 1e-3, 1.0, math.pi - 1e-8, math.pi])
def test_small_and_great_angles_keep_their_digits(angle: float) -> None:
    d = rotate(from_rotation_vector((0.0, 0.0, angle)), (1.0, 0.0, 0.0))
    assert float(axis_error(d, (1.0, 0.0, 0.0))) == pytest.approx(angle, rel=1e-12, abs=1e-15)


@given(QUAT, QUAT)
def test_swing_about_z_is_the_printed_formula(plan: tuple[float, ...], tool: tuple[float, ...]) -> None:
    q_plan, q_tool = normalise(plan), normalise(tool)
    w, x, y, z = multiply(conjugate(q_plan), q_tool)
    exact = 2 * math.atan2(math.hypot(x, y), math.hypot(w, z))
    up = (0.0, 0.0, 1.0)
    assert float(swing_angle((w, x, y, z), up)) == pytest.approx(exact, abs=ROUND)
    assert float(axis_error(rotate(q_tool, up), rotate(q_plan, up))) == pytest.approx(exact, abs=ROUND)


@given(QUAT, VECTOR)
def test_swing_and_twist_make_the_whole(q: tuple[float, ...], axis: tuple[float, ...]) -> None:
    whole, along = normalise(q), unit(axis)
    swing, twist = swing_twist(whole, along)
    assert multiply(swing, twist) == pytest.approx(whole, abs=1e-12)
    assert rotate(twist, along) == pytest.approx(along, abs=1e-12)
    assert float(swing_angle(swing, along)) == pytest.approx(float(swing_angle(whole, along)), abs=1e-9)
    if swing_angle(whole, along) < 3.0:
        assert abs(swing[1:] @ along) < 1e-9  # a swing has no part about the axis


def test_swing_of_a_half_turn_has_no_twist() -> None:
    swing, twist = swing_twist((0.0, 1.0, 0.0, 0.0), (0.0, 0.0, 1.0))
    assert twist.tolist() == [1.0, 0.0, 0.0, 0.0]
    assert swing.tolist() == [0.0, 1.0, 0.0, 0.0]
    assert float(swing_angle(swing, (0.0, 0.0, 1.0))) == pytest.approx(math.pi, abs=1e-15)


@given(QUAT, PLACES, PLACES, st.lists(TURN, min_size=1, max_size=20))
def test_a_spin_changes_no_aiming_error(
    q: tuple[float, ...], axis: tuple[float, ...], plan: tuple[float, ...], spins: list[float]
) -> None:
    start, along, p = normalise(q), unit(axis), unit(plan)
    spun = multiply(start, from_rotation_vector(np.array(spins)[:, None] * along))
    errors = axis_error(rotate(spun, along), p)
    assert errors == pytest.approx(np.full(len(spins), float(axis_error(rotate(start, along), p))), abs=ROUND)


def test_spin_vector() -> None:
    """TV-B: body z at ZYX (0, 20, 15), spun by 90 degrees, goes to other angles and the same axis."""
    start = from_euler(*np.radians((0.0, 20.0, 15.0)))
    spun = multiply(start, from_rotation_vector((0.0, 0.0, math.pi / 2)))
    r20, r15 = math.radians(20), math.radians(15)
    exact = (math.cos(r15) * math.sin(r20), -math.sin(r15), math.cos(r15) * math.cos(r20))
    for quat in (start, spun):
        assert rotate(quat, (0.0, 0.0, 1.0)) == pytest.approx(exact, abs=1e-12)
    assert exact == pytest.approx((0.3304, -0.2588, 0.9077), abs=6e-5)
    assert np.degrees(euler(spun)) == pytest.approx((84.8, -14.1, 20.7), abs=0.06)
    assert not seed001_accepts(*np.degrees(euler(spun))[:2], 0.0, 20.0)


@given(PLACES, st.sampled_from(["left", "right", ""]), st.floats(0.0, math.radians(179.98)), TURN)
def test_the_picture_is_the_log_map(p: tuple[float, ...], side: str, error: float, bearing: float) -> None:
    """Out from the plan by the exponential map, and back: rings are true degrees at any tilt."""
    plan = unit(p)
    medial, cranial = target_basis(plan, side)
    away = math.cos(bearing) * medial + math.sin(bearing) * cranial
    seen = aim(math.cos(error) * plan + math.sin(error) * away, plan, (medial, cranial))
    assert seen.error == pytest.approx(error, abs=ROUND)
    # rounding of d moves the bearing by 1e-16 / sin(error)
    slack = ROUND + 4e-16 * error / max(math.sin(error), 1e-12)
    assert seen.offset == pytest.approx((error * math.cos(bearing), error * math.sin(bearing)), abs=slack)
    assert not seen.backwards


@given(PLACES, PLACES, VECTOR, st.floats(0.0, 0.02))
def test_no_wrap_and_no_pole(p: tuple[float, ...], d: tuple[float, ...], about: tuple[float, ...], step: float) -> None:
    """A small step of the tool never changes the error by more, nor the picture by more than the map stretches."""
    plan, first = unit(p), unit(d)
    second = rotate(from_rotation_vector(step * unit(about)), first)
    errors, offsets = aim_many(np.array((first, second)), plan, target_basis(plan, ""))
    moved = float(axis_error(first, second))
    assert abs(errors[1] - errors[0]) <= moved + 1e-12
    if errors.max() < math.radians(170):
        # across the radius the log map stretches by error / sin(error)
        stretch = max(math.pi / 2, 1.0 / np.sinc(errors.max() / math.pi))
        assert np.hypot(*(offsets[1] - offsets[0])) <= 1.01 * stretch * moved + 1e-9
    assert np.isfinite(errors).all()


@given(PLACES)
def test_exactly_backwards_says_so(p: tuple[float, ...]) -> None:
    plan = unit(p)
    basis = target_basis(plan, "left")
    seen = aim(-plan, plan, basis)
    assert seen.backwards
    assert seen.error == pytest.approx(math.pi, abs=ROUND)
    assert all(math.isnan(part) for part in seen.offset)
    assert words(seen, "left") == ("the tool points backwards: turn it round",)
    near = aim(rotate(from_rotation_vector(math.radians(0.02) * basis[0]), -plan), plan, basis)
    assert not near.backwards
    assert math.hypot(*near.offset) == pytest.approx(math.radians(179.98), abs=1e-9)


def test_on_the_plan() -> None:
    plan = direction(Plan("L4", "projected", "left", 30.0, 20.0))
    seen = aim(plan, plan, target_basis(plan, "left"))
    assert (seen.error, seen.offset, seen.backwards) == (0.0, (0.0, 0.0), False)
    assert words(seen, "left") == ("on the plan",)


def test_a_missing_direction_is_no_aim() -> None:
    seen = aim((NAN, NAN, NAN), (0.0, 1.0, 0.0), target_basis((0.0, 1.0, 0.0), "left"))
    plan = Plan("L4", "projected", "left")
    assert math.isnan(seen.error)
    assert (words(seen, "left"), within(seen, plan), band(seen, plan), seen.backwards) == ((), False, "red", False)


@pytest.mark.parametrize(
    ("offset_deg", "side", "plain", "digits", "said"),
    [
        ((-3.0, 0.0), "left", False, 0, ("tilt 3° more medial",)),
        ((3.0, 0.2), "right", False, 0, ("tilt 3° more lateral",)),
        ((1.0, -4.0), "left", False, 0, ("tilt 4° more cranial", "tilt 1° more lateral")),
        ((0.0, 2.34), "left", False, 1, ("tilt 2.3° more caudal",)),
        ((0.3, -0.4), "left", False, 0, ("on the plan",)),
        ((3.0, -1.0), "", True, 0, ("turn 3° left", "turn 1° up")),
        ((3.0, 1.0), "right", True, 0, ("turn 3° right", "turn 1° down")),
    ],
)
def test_words_say_what_to_do_next(
    offset_deg: tuple[float, float], side: str, plain: bool, digits: int, said: tuple[str, ...]
) -> None:
    right, up = np.radians(offset_deg).tolist()
    assert words(Aim(math.hypot(right, up), (right, up)), side, plain, digits) == said


@pytest.mark.parametrize("side", ["left", "right"])
@pytest.mark.parametrize(("axial", "sagittal"), [(0.0, 0.0), (30.0, 20.0), (-40.0, -45.0), (80.0, 0.0)])
def test_a_tool_of_too_little_tilt_is_told_to_tilt_more_medial(side: str, axial: float, sagittal: float) -> None:
    plan = direction(Plan("L4", "projected", side, axial, sagittal))
    tool = direction(Plan("L4", "projected", side, axial - 4.0, sagittal))
    assert "more medial" in words(aim(tool, plan, target_basis(plan, side)), side, digits=1)[0]


def test_bands() -> None:
    plan = Plan("L4", "projected", "left")
    seen = [band(Aim(math.radians(error), (0.0, 0.0)), plan) for error in (0.0, 2.0, 2.01, 5.0, 5.01, 180.0)]
    assert seen == ["green", "green", "amber", "amber", "red", "red"]
    assert within(Aim(math.radians(2.0), (0.0, 0.0)), plan)


def test_the_seeds_own_example() -> None:
    """Yaw 28.7, pitch -12.6 against 45 and 34: error and bearing by spherical trigonometry."""
    plan = direction(Plan("seed", "plain", yaw_deg=45.0, pitch_deg=34.0))
    tool = direction(Plan("seed", "plain", yaw_deg=28.7, pitch_deg=-12.6))
    seen = aim(tool, plan, target_basis(plan, ""))
    lat, lat_plan, east = (math.radians(angle) for angle in (12.6, -34.0, 45.0 - 28.7))  # up is north, right is east
    cosine = math.sin(lat) * math.sin(lat_plan) + math.cos(lat) * math.cos(lat_plan) * math.cos(east)
    bearing = math.atan2(
        math.sin(east) * math.cos(lat),
        math.cos(lat_plan) * math.sin(lat) - math.sin(lat_plan) * math.cos(lat) * math.cos(east),
    )
    error = math.acos(cosine)
    assert seen.error == pytest.approx(error, abs=1e-12)
    assert seen.offset == pytest.approx((error * math.sin(bearing), error * math.cos(bearing)), abs=1e-12)
    assert math.degrees(seen.error) == pytest.approx(49.11, abs=0.006)


def test_the_old_rule_does_not_wrap_and_takes_the_corner() -> None:
    assert seed001_accepts(1.99, -1.99, 0.0, 0.0)
    assert not seed001_accepts(2.0, 0.0, 0.0, 0.0)
    assert not seed001_accepts(-179.9, 0.0, 179.9, 0.0)


@given(TURN, st.floats(-3.1, 3.1))
def test_twist_is_the_spin(start: float, spin: float) -> None:
    plan = attitude(Plan("a", "plain", yaw_deg=45.0, pitch_deg=34.0, roll_deg=math.degrees(start)))
    axis = unit((1.0, 0.2, -0.3))
    tool = multiply(plan, from_rotation_vector(spin * axis))
    assert float(twist_angle(plan, tool, axis)) == pytest.approx(spin, abs=1e-9)
    assert float(twist_angle(plan, -tool, axis)) == pytest.approx(spin, abs=1e-9)
