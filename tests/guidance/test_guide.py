"""The guide: what is seen, when it leaves green, and when a reading is refused. The clock is simulated."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from imugui.guidance.guide import Guide
from imugui.guidance.plan import Plan, direction
from imugui.guidance.reading import Reading, recompute

DEGREE = math.pi / 180
DOWN, NORTH = (0.0, 0.0, -1.0), (0.0, 1.0, 0.0)
IN_TIME = 0.2  # s
Pose = Callable[..., np.ndarray]


# what is seen


def test_before_anything_is_known_everything_is_blank(desk: Any) -> None:
    look = desk.wait(0.0)
    assert look.colour == "blank"
    assert look.aim is None
    assert look.reasons[0].startswith("No attitude")
    assert any("no plan" in reason for reason in look.reasons)
    assert isinstance(desk.guide.capture(desk.now), str)


def test_without_registration_there_is_no_guidance(desk: Any) -> None:
    desk.guide.set_plans([Plan(name="L4", side="left")])
    desk.guide.confirm_side("left")
    look = desk.hold(DOWN)
    assert look.colour == "hatched"
    assert look.aim is None
    assert len(look.reasons) == 1
    assert "registration" in look.reasons[0]


@pytest.mark.parametrize(("off_deg", "colour"), [(0.0, "green"), (1.8, "green"), (3.5, "amber"), (8.0, "red")])
def test_the_colour_tells_the_error(desk: Any, off_deg: float, colour: str) -> None:
    desk.begin()
    look = desk.hold(desk.to_plan(off_deg))
    assert look.colour == colour
    assert look.armed == (colour == "green")
    assert look.trusted


def test_cross_words_and_arrow_agree(desk: Any) -> None:
    desk.begin()
    look = desk.hold(desk.to_plan(6.0))
    assert look.aim.offset[0] > 5 * DEGREE
    assert look.aim_words[0] == "tilt 6° more lateral"
    assert look.arrow[0] == pytest.approx(-1.0, abs=0.05)
    assert look.error_deg == pytest.approx(math.degrees(math.hypot(*look.aim.offset)))
    assert look.trail[-1] == pytest.approx(look.aim.offset)
    assert desk.hold(desk.to_plan()).arrow == (0.0, 0.0)


def test_the_trail_is_what_was_seen_in_one_and_a_half_seconds(desk: Any) -> None:
    desk.begin()
    desk.hold(desk.to_plan(8.0))
    look = desk.hold(desk.to_plan(), 0.5)
    assert 40 < len(look.trail) <= 60
    assert look.trail[0, 0] == pytest.approx(7.0 * DEGREE, abs=1.5 * DEGREE)
    assert look.trail[-1] == pytest.approx((0.0, 0.0), abs=1e-9)


def test_backwards_is_said(desk: Any) -> None:
    desk.begin()
    look = desk.hold(-desk.to_plan())
    assert look.aim.backwards
    assert look.colour == "red"
    assert look.arrow == (0.0, 0.0)
    assert "backwards" in look.aim_words[0]


def test_spinning_the_tool_changes_neither_error_nor_hold(desk: Any) -> None:
    desk.begin()
    still = desk.hold(desk.to_plan(1.0))
    look = desk.hold(desk.to_plan(1.0), spin_rate=3.0)
    assert look.error_deg == pytest.approx(still.error_deg, abs=1e-9)
    assert look.armed


def test_a_planned_roll_shows_the_twist_apart(desk: Any, pose: Pose) -> None:
    plan = Plan(name="box", kind="plain", yaw_deg=30.0, pitch_deg=20.0, roll_deg=10.0)
    desk.begin()
    desk.guide.set_plans([plan])
    way = np.array(desk.guide.registration.matrix) @ direction(plan)
    twists = [desk.step(desk.rows(pose(way, np.full(2, spin)))).twist_deg for spin in (0.0, 0.5)]
    assert np.diff(twists) == pytest.approx([math.degrees(0.5)])
    assert desk.guide.look.error_deg == pytest.approx(0.0, abs=1e-9)
    desk.guide.set_plans([dataclasses.replace(plan, roll_deg=math.nan)])
    assert math.isnan(desk.hold(way).twist_deg)


def test_a_tool_that_moves_does_not_arm(desk: Any) -> None:
    """From 1.5 degrees on one side to the other in a second: inside all the time, but at 3 deg/s."""
    desk.begin()
    desk.hold(desk.to_plan(-1.5))
    armed = [desk.hold(desk.to_plan(-1.5 + 3.0 * k / 50), 0.02).armed for k in range(50)]
    assert not any(armed[30:])
    assert desk.guide.look.colour == "green"
    assert desk.guide.look.rate_deg_s == pytest.approx(2.7, abs=0.4)


def test_a_tremor_of_ten_hertz_averages_out(desk: Any) -> None:
    desk.begin()
    look = desk.guide.look
    for k in range(75):
        look = desk.hold(desk.to_plan(0.25 * math.sin(2 * math.pi * 10 * k * 0.02)), 0.02)
    assert look.armed
    assert look.rate_deg_s < 0.5


def test_the_blocks_do_not_matter(new_desk: Callable[[], Any], pose: Pose) -> None:
    courses = []
    for cut in (1, 7, 60):
        desk = new_desk()
        desk.begin()
        quats = np.repeat(pose(desk.to_plan(0.5))[None], 120, axis=0)
        rows = desk.rows(quats)
        for k in range(0, len(rows), cut):
            desk.now = rows["t"][k : k + cut][-1]
            desk.step(rows[k : k + cut])
        progress = desk.guide.progress
        courses.append((desk.guide.look.armed, desk.guide.look.hold_progress, round(progress.in_green, 9)))
    assert courses[0] == courses[1] == courses[2]
    assert courses[0][0]


# readings


def test_a_reading_holds_everything(armed: Any) -> None:
    reading = armed.guide.capture(armed.now)
    assert isinstance(reading, Reading)
    assert (reading.number, reading.name, reading.side) == (1, "L4", "left")
    assert reading.error_deg == pytest.approx(0.0, abs=1e-6)
    assert reading.direction == pytest.approx(reading.plan_direction)
    assert 0.0 < reading.sigma_deg < 1.0
    assert reading.rows[1] == armed.number - 1
    assert reading.rows[1] - reading.rows[0] == 50
    assert reading.registration == armed.guide.registration
    assert reading.registration_id == reading.registration.id != ""
    assert (reading.profile, reading.filter, reading.use_mag) == ("test board", "vqf", False)
    assert reading.time_to_green_s >= 0.0
    assert reading.time_in_green_s > 0.5
    assert reading.version
    assert reading.utc
    assert armed.guide.readings == [reading]


def test_a_reading_is_the_mean_of_its_rows_and_can_be_computed_again(desk: Any, pose: Pose) -> None:
    desk.begin()
    rng = np.random.default_rng(4)
    first, quats = desk.number, []
    for k in range(60):
        quats.append(pose(desk.to_plan(rng.normal(0.0, 0.15)), 0.1 * (2 * k + np.arange(2))))
        desk.step(desk.rows(quats[-1]))
    reading = desk.guide.capture(desk.now)
    assert isinstance(reading, Reading)
    used = np.concatenate(quats)[reading.rows[0] - first : reading.rows[1] - first + 1]
    assert recompute(reading, used) == 0.0
    assert recompute(reading, used[:20]) > 1e-3


def test_a_second_reading_needs_a_second_hold(armed: Any) -> None:
    assert isinstance(armed.guide.capture(armed.now), Reading)
    assert "Hold the tool within 2°" in armed.guide.capture(armed.now)
    armed.hold(armed.to_plan(), 0.6)
    assert armed.guide.capture(armed.now).number == 2
    armed.guide.discard(1)
    assert [reading.number for reading in armed.guide.readings] == [2]


def test_outside_the_tolerance_nothing_is_taken(desk: Any) -> None:
    desk.begin()
    desk.hold(desk.to_plan(4.0))
    assert "Hold the tool within" in desk.guide.capture(desk.now)
    assert desk.guide.readings == []


def test_progress_begins_anew_with_another_plan(desk: Any) -> None:
    desk.begin()
    desk.hold(desk.to_plan(6.0), 0.5)
    desk.hold(desk.to_plan(), 0.3)
    assert desk.guide.progress.time_to_green == pytest.approx(0.7, abs=0.03)  # with the 0.2 s after registering
    desk.guide.select(2)
    assert math.isnan(desk.guide.progress.time_to_green)
    with pytest.raises(IndexError):
        desk.guide.select(3)


# what outlives the program


def test_what_was_kept_is_there_again_but_the_registration_is_no_zero(armed: Any) -> None:
    armed.guide.set_tool_axis(armed.guide.tool_axis, 0.1)
    armed.hold(armed.to_plan())
    armed.guide.capture(armed.now)
    again = Guide()
    again.restore(armed.guide.kept)
    assert again.plans == armed.guide.plans
    assert again.readings == armed.guide.readings
    assert again.tool_axis_quality_deg == 0.1
    assert again.registration is None
    assert again.old_registration == armed.guide.registration
    assert again.kept == armed.guide.kept
    assert again.confirmed_side == ""


def test_registering_needs_what_the_stream_held(desk: Any) -> None:
    desk.hold(DOWN, 1.0)
    first, last = desk.guide.recent_numbers(0.5)
    assert (last - first, last) == (50, desk.number - 1)
    assert len(desk.guide.recent(0.5)) == 51


def test_nothing_was_held_yet(desk: Any) -> None:
    assert desk.guide.recent_numbers(1.0) == (0, -1)
