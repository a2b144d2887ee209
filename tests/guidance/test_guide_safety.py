"""What takes green away, in time and with its reason (item 4 of the issue). The clock is simulated."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from imugui.fusion.pipeline import Pipeline
from imugui.fusion.quaternion import conjugate, rotate
from imugui.guidance.plan import Plan
from imugui.guidance.registration import from_axes, mean_axis
from imugui.samples import GRAVITY, SAMPLE, empty_rows

DEGREE = math.pi / 180
DOWN = (0.0, 0.0, -1.0)
IN_TIME = 0.2  # s
Pose = Callable[..., np.ndarray]


def refused(desk: Any, words: str) -> None:
    """Nothing is captured, and the reason is said."""
    before = len(desk.guide.readings)
    said = desk.guide.capture(desk.now)
    assert isinstance(said, str)
    assert words in said
    assert len(desk.guide.readings) == before


def left_within(desk: Any, act: Callable[[], Any]) -> float:
    """Seconds until the target leaves green when ``act`` is done for every 20 ms; at most 1."""
    begin = desk.now
    while desk.now < begin + 1.0:
        act()
        if desk.guide.look.colour != "green":
            break
    return float(desk.now - begin)


def test_a_frozen_stream_leaves_green_and_then_blanks(armed: Any) -> None:
    assert left_within(armed, lambda: armed.wait(0.02)) <= IN_TIME
    assert armed.guide.look.colour == "hatched"
    assert not armed.guide.look.armed
    refused(armed, "ms old")
    armed.wait(0.1)
    look = armed.guide.look
    assert look.colour == "blank"
    assert look.aim is None
    assert look.beep_hz == 0.0
    assert len(look.trail) == 0
    refused(armed, "ms old")


def test_a_capture_sees_that_the_stream_stands_still_without_a_step(armed: Any) -> None:
    assert "150 ms old" in armed.guide.capture(armed.now + 0.15)


def test_a_disturbed_field_leaves_green_when_the_magnetometer_is_in_use(desk: Any) -> None:
    desk.said |= {"use_mag": True, "base_heading": 1.0 * DEGREE}
    desk.begin()
    assert desk.hold(desk.to_plan()).armed

    def disturbed() -> None:
        rows = desk.rows(np.repeat(desk.guide.recent(0.0)["quat"], 2, axis=0))
        rows["disturbed"] = True
        desk.step(rows)

    assert left_within(desk, disturbed) <= IN_TIME
    assert desk.guide.look.colour == "hatched"
    refused(desk, "magnetic field is disturbed")


def test_a_disturbed_field_does_nothing_in_6_axis(armed: Any) -> None:
    rows = armed.rows(np.repeat(armed.guide.recent(0.0)["quat"], 2, axis=0))
    rows["disturbed"] = True
    assert armed.step(rows).colour == "green"


def test_a_heading_that_ages_leaves_green(armed: Any, pose: Pose) -> None:
    """The tool lies at rest, so that nothing but time goes by."""
    due = armed.guide.look.reference_due_s
    assert 20.0 < due < 1000.0
    quat = pose(armed.to_plan())
    armed.step(armed.rows(np.repeat(quat[None], round(100 * (due - 1.0)), axis=0)))
    armed.hold(armed.to_plan(), 0.9)
    assert armed.guide.look.armed
    assert armed.guide.look.reference_due_s == pytest.approx(0.1, abs=0.02)
    assert armed.guide.look.sigma_deg == pytest.approx(1.0, abs=0.01)
    assert left_within(armed, lambda: armed.hold(armed.to_plan(), 0.02)) <= 0.1 + IN_TIME
    assert armed.guide.look.colour == "hatched"
    refused(armed, "heading has aged: register again")
    armed.register()
    assert armed.hold(armed.to_plan()).colour == "green"


def test_removing_the_registration_leaves_green(armed: Any) -> None:
    armed.guide.clear_registration()
    refused(armed, "no registration")
    assert left_within(armed, lambda: armed.hold(DOWN, 0.02)) <= IN_TIME
    assert armed.guide.look.colour == "hatched"
    assert armed.guide.look.aim is None
    refused(armed, "no registration")


@pytest.mark.parametrize("how", ["select", "edit"])
def test_swapping_the_side_leaves_green_until_it_is_confirmed(armed: Any, how: str) -> None:
    if how == "select":
        armed.guide.select(1)
    else:
        armed.guide.set_plans([dataclasses.replace(plan, side="right") for plan in armed.guide.plans[::2]])
    refused(armed, "side is not confirmed")
    assert left_within(armed, lambda: armed.hold(armed.to_plan(), 0.02)) <= IN_TIME
    assert armed.guide.look.colour == "hatched"
    refused(armed, "side is not confirmed")
    armed.guide.confirm_side("right")
    assert armed.hold(armed.to_plan()).armed


# and the rest of what takes trust away


def test_samples_that_are_missing_end_the_registration(armed: Any) -> None:
    armed.wait(0.4)
    look = armed.hold(armed.to_plan())
    assert look.colour == "hatched"
    assert "0.4 s are missing since the registration" in look.reasons[0]
    refused(armed, "Register again")
    armed.register()
    assert armed.hold(armed.to_plan()).armed


def test_rows_that_the_page_missed_are_no_gap_in_the_stream(armed: Any, pose: Pose) -> None:
    rows = armed.rows(np.repeat(pose(armed.to_plan())[None], 60, axis=0))
    armed.number += 58
    look = armed.step(rows[-2:])
    assert look.colour == "green"
    assert not look.armed  # nobody saw what the tool did in between


def test_a_stream_that_begins_anew_ends_the_registration(armed: Any) -> None:
    armed.number = 0
    look = armed.hold(armed.to_plan(), 0.2)
    assert "begun anew" in look.reasons[0]


def test_a_filter_that_begins_anew_ends_the_registration(armed: Any) -> None:
    armed.said["epoch_same"] = False
    armed.hold(armed.to_plan(), 0.02)
    refused(armed, "filter has begun anew")


@pytest.mark.parametrize("change", [{"filter": "madgwick"}, {"use_mag": True}, {"profile_words": "another"}])
def test_another_basis_ends_the_registration(armed: Any, change: dict[str, Any]) -> None:
    armed.said |= {**change, "base_heading": 0.01}
    assert armed.hold(armed.to_plan(), 0.02).colour == "hatched"
    refused(armed, "changed since the registration")


def test_bad_rows_are_no_samples(armed: Any, pose: Pose) -> None:
    """A board that sends nothing but nonsense is a board that sends nothing."""

    def nonsense() -> None:
        rows = armed.rows(np.repeat(pose(armed.to_plan())[None], 2, axis=0))
        rows["quat"][0], rows["acc"][1] = np.nan, np.nan
        armed.step(rows)

    assert left_within(armed, nonsense) <= IN_TIME
    refused(armed, "ms old")


def test_one_bad_row_breaks_the_hold(armed: Any, pose: Pose) -> None:
    rows = armed.rows(np.repeat(pose(armed.to_plan())[None], 6, axis=0))
    rows["quat"][3] *= 1.1
    look = armed.step(rows)
    assert look.colour == "green"
    assert not look.armed


def test_pushing_the_tool_takes_trust_away(armed: Any, pose: Pose) -> None:
    def pushed() -> None:
        rows = armed.rows(np.repeat(pose(armed.to_plan())[None], 2, axis=0))
        rows["acc"][:, 0] += 6.0
        armed.step(rows)

    assert left_within(armed, pushed) <= IN_TIME
    refused(armed, "pushed or shaken")


def test_another_tool_axis_ends_the_registration(armed: Any) -> None:
    armed.guide.set_tool_axis(armed.guide.tool_axis, 0.1)
    assert armed.guide.registration is not None
    armed.guide.set_tool_axis((0.0, 0.0, 2.0), 0.2)
    assert armed.guide.tool_axis == (0.0, 0.0, 1.0)
    refused(armed, "no registration")
    with pytest.raises(ValueError, match="no direction"):
        armed.guide.set_tool_axis((0.0, 0.0, 0.0))


def test_a_tool_axis_that_is_known_badly_costs_trust(armed: Any) -> None:
    before = armed.guide.look.sigma_deg
    armed.guide.set_tool_axis(armed.guide.tool_axis, 0.5)
    assert armed.hold(armed.to_plan(), 0.02).sigma_deg > before
    armed.guide.set_tool_axis(armed.guide.tool_axis, 2.0)
    assert armed.hold(armed.to_plan(), 0.02).colour == "hatched"


def test_wrong_plans_are_said_and_not_aimed_at(armed: Any) -> None:
    plan = armed.guide.plans[0]
    armed.guide.set_plans([dataclasses.replace(plan, axial_deg=95.0)])
    look = armed.hold(DOWN, 0.1)
    assert look.colour == "hatched"
    assert "Axial" in look.reasons[0]
    refused(armed, "Axial")
    armed.guide.set_plans([])
    refused(armed, "no plan")


def test_a_plan_stays_in_use_when_the_list_changes(armed: Any) -> None:
    armed.guide.select(2)
    armed.guide.set_plans([armed.guide.plans[2], *armed.guide.plans[:2]])
    assert (armed.guide.index, armed.guide.plan.name) == (0, "L5")


def test_a_filter_that_never_saw_rest_has_a_heading_that_ages_fast(new_desk: Callable[[], Any], pose: Pose) -> None:
    dues = []
    for rested in (True, False):
        desk = new_desk()
        desk.guide.set_plans([Plan(name="L4", side="left", axial_deg=20.0)])
        rows = desk.rows(np.repeat(pose(DOWN)[None], 60, axis=0))
        rows["rest"] = rested
        desk.step(rows)
        desk.register()
        rows = desk.rows(np.repeat(pose(DOWN)[None], 2, axis=0))
        rows["rest"] = rested
        dues.append(desk.step(rows).reference_due_s)
    assert dues[1] < dues[0] / 5


@pytest.mark.parametrize("thermometer", [True, False])
def test_warming_up_since_the_last_rest_ages_the_heading(desk: Any, pose: Pose, thermometer: bool) -> None:
    desk.said["temp_c"] = 25.0 if thermometer else math.nan
    desk.begin()
    desk.hold(desk.to_plan())
    before = desk.guide.look.reference_due_s
    desk.said["temp_c"] += 3.0
    rows = desk.rows(np.repeat(pose(desk.to_plan())[None], 9000, axis=0))
    rows["rest"] = False
    assert desk.step(rows).reference_due_s + 90.0 < before / 1.5


def test_turning_on_and_on_costs_trust(armed: Any, pose: Pose) -> None:
    """Ten turns of a tool that leans by 22 degrees, at 0.2 % of scale error."""
    way = armed.to_plan()
    before = armed.guide.look.sigma_deg
    for k in range(0, 1000, 20):
        armed.step(armed.rows(pose(way, (k + np.arange(20)) * 2 * math.pi / 100)))
    assert armed.guide.look.sigma_deg > before + 0.3
    for k in range(1000, 0, -20):
        armed.step(armed.rows(pose(way, (k - np.arange(20)) * 2 * math.pi / 100)))
    # back again: what is left is the age
    assert armed.guide.look.sigma_deg < before + 0.1


# the chain with a real filter


def test_a_magnet_leaves_green_in_time_through_the_pipeline(desk: Any, pose: Pose) -> None:
    """Samples at rest through VQF with the magnetometer; then a field of 60 uT is added."""
    to_box = conjugate(pose((0.3, 0.2, -0.9)))
    field = np.array((0.0, 20.0, -43.0))
    pipeline = Pipeline("vqf", use_mag=True)
    rng = np.random.default_rng(0)
    desk.said |= {"use_mag": True, "base_heading": 0.5 * DEGREE}

    def samples(seconds: float, magnet: tuple[float, float, float]) -> None:
        rows = empty_rows(SAMPLE, round(seconds * 100))
        rows["t"] = rows["t_arrival"] = desk.now + np.arange(1, len(rows) + 1) / 100.0
        rows["gyr"] = rng.normal(0.0, 1e-3, (len(rows), 3))
        rows["acc"] = rotate(to_box, (0.0, 0.0, GRAVITY)) + rng.normal(0.0, 0.02, (len(rows), 3))
        rows["mag"] = rotate(to_box, field + np.array(magnet)) + rng.normal(0.0, 0.2, (len(rows), 3))
        desk.now += seconds
        desk.step(pipeline.step(rows))

    for _ in range(50):
        samples(0.1, (0.0, 0.0, 0.0))
    tip, _ = mean_axis(desk.guide.recent(1.0)["quat"], desk.guide.tool_axis)
    across = np.cross(tip, (1.0, 0.0, 0.0))
    desk.guide.register(from_axes(tip, across))
    desk.guide.set_plans([Plan(name="L4", side="left")])
    desk.guide.confirm_side("left")
    for _ in range(60):
        samples(0.02, (0.0, 0.0, 0.0))
    assert desk.guide.look.armed
    assert left_within(desk, lambda: samples(0.02, (60.0, 0.0, 0.0))) <= IN_TIME
    refused(desk, "magnetic field is disturbed")
