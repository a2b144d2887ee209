"""A filter that says how far its heading may be off: its figure alone counts, and what happens when it falls silent."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from datetime import UTC, datetime
from typing import Any

import numpy as np
import pytest

from imugui.fusion.mahony import Mahony
from imugui.fusion.self_calibrating_params import ImuguiParams
from imugui.guidance.facts import Facts
from imugui.guidance.guide import Guide
from imugui.guidance.reading import Reading, reading_from
from imugui.guidance.registration import from_axes
from imugui.guidance.sigma import COVER, axis_sigma, heading_sigma, heading_source, seconds_left
from imugui.guidance.trust import LIMITS, judge
from imugui.guidance.trust_profile import RAW_TURN_SHARE, TURN_SHARE, prior_holds, profile_facts
from imugui.simulation.tool_user import ToolUser, random_plans

DEGREE = math.pi / 180
DOWN, NORTH = (0.0, 0.0, -1.0), (0.0, 1.0, 0.0)
Pose = Callable[..., np.ndarray]

STATED = Facts(
    now=100.0,
    arrival=99.98,
    streaming=True,
    registration=from_axes(DOWN, NORTH),
    registered_at=70.0,
    side_confirmed=True,
    calibrated=True,
    base_tilt=0.2 * DEGREE,
    drift=0.01 * DEGREE,
    turn_share=0.002,
    turning=1.0,
    tilt_from_vertical=30 * DEGREE,
    sigma_tilt=0.1 * DEGREE,
    sigma_heading=0.5 * DEGREE,
    heading_growth=0.01 * DEGREE,
)
SILENT = replace(STATED, sigma_heading=math.nan)
FORMULA = math.hypot(0.3 * DEGREE, 0.002)


def test_the_filters_own_figure_counts_alone() -> None:
    assert heading_source(STATED) == "filter"
    for changes in ({}, {"drift": 1.0}, {"turning": 500.0}, {"turn_share": math.nan}, {"registered_at": -9000.0}):
        assert heading_sigma(replace(STATED, **changes)) == 0.5 * DEGREE


def test_without_it_drift_and_turning_count_but_no_less_than_was_said_before() -> None:
    assert heading_source(SILENT) == "drift"
    assert heading_sigma(SILENT) == pytest.approx(FORMULA, rel=1e-12)
    assert heading_sigma(replace(SILENT, heading_before=0.5 * DEGREE)) == 0.5 * DEGREE
    assert heading_sigma(replace(SILENT, heading_before=0.1 * DEGREE)) == pytest.approx(FORMULA, rel=1e-12)
    assert math.isnan(heading_sigma(replace(SILENT, heading_before=0.5 * DEGREE, drift=math.nan)))


def test_a_filter_that_takes_the_gyroscope_for_too_good_is_not_believed_alone() -> None:
    facts = replace(STATED, prior_holds=False, heading_before=0.5 * DEGREE)
    assert heading_source(facts) == "drift"
    assert heading_sigma(facts) == 0.5 * DEGREE
    assert heading_sigma(replace(facts, turning=40.0)) > 2 * DEGREE
    assert heading_source(replace(facts, use_mag=True)) == "filter"
    doubting, sure = ImuguiParams(matrix_worst=0.02), ImuguiParams(matrix_worst=0.0)
    found = [prior_holds(share, params) for params in (doubting, sure) for share in (RAW_TURN_SHARE, TURN_SHARE)]
    assert found == [True, True, False, True]
    assert prior_holds(RAW_TURN_SHARE, Mahony.Params())


def test_with_the_magnetometer_it_is_the_calibration_or_the_filter() -> None:
    facts = replace(SILENT, use_mag=True, base_heading=2 * DEGREE, heading_before=3 * DEGREE)
    assert (heading_source(facts), heading_sigma(facts)) == ("calibration", 2 * DEGREE)
    assert heading_sigma(replace(facts, sigma_heading=0.7 * DEGREE)) == 0.7 * DEGREE


def test_the_time_left_is_when_the_stated_figure_has_grown_to_the_limit() -> None:
    left = seconds_left(STATED, LIMITS.sigma)
    then = replace(STATED, sigma_heading=STATED.sigma_heading + STATED.heading_growth * left)
    assert axis_sigma(then) == pytest.approx(LIMITS.sigma, rel=1e-9)
    assert seconds_left(replace(then, sigma_heading=1.01 * then.sigma_heading), LIMITS.sigma) == 0.0
    assert seconds_left(replace(STATED, tilt_from_vertical=0.0), LIMITS.sigma) == math.inf
    assert math.isnan(seconds_left(replace(STATED, heading_growth=math.nan), LIMITS.sigma))


def test_the_time_left_of_a_silent_filter_ends_where_its_last_word_does() -> None:
    allowed = math.sqrt((LIMITS.sigma / COVER) ** 2 - (0.2**2 + 0.2**2 + 0.1**2) * DEGREE**2) / 0.5
    assert seconds_left(replace(SILENT, heading_before=0.99 * allowed), LIMITS.sigma) > 0.0
    assert seconds_left(replace(SILENT, heading_before=1.01 * allowed), LIMITS.sigma) == 0.0


def test_doubt_of_the_tilt_of_a_moved_tool_asks_for_stillness_not_for_a_registration() -> None:
    moved = replace(STATED, sigma_tilt=0.8 * DEGREE, held_tilt=0.1 * DEGREE)
    (reason,) = judge(moved).reasons
    assert "Hold the tool still" in reason
    assert seconds_left(moved, LIMITS.sigma) == seconds_left(STATED, LIMITS.sigma)
    aged = replace(moved, sigma_heading=2 * DEGREE)
    assert "heading has aged: register again" in judge(aged).reasons[0]


# through the guide


def stated(desk: Any, seconds: float, heading_deg: Any, way: Any = None, pose: Any = None) -> Any:
    """The tool is held for so long, and the filter states these sigmas of the heading (a number, or first and last)."""
    quats = desk.guide.recent(0.0)["quat"][-1:] if pose is None else pose(way)[None]
    rows = desk.rows(np.repeat(quats, round(100 * seconds), axis=0))
    rows["sigma_heading"] = np.radians(np.linspace(*np.broadcast_to(heading_deg, 2), len(rows)))
    rows["sigma_tilt"] = np.where(np.isnan(rows["sigma_heading"]), np.nan, 0.1 * DEGREE)
    return desk.step(rows)


def test_the_figure_from_before_the_registration_is_too_large_and_the_one_after_it_is_used(armed: Any) -> None:
    assert stated(armed, 0.1, 3.0).colour == "hatched"
    assert armed.guide.look.heading_sigma_deg == pytest.approx(3.0)
    assert stated(armed, 0.1, 0.01).colour == "green"
    assert armed.guide.look.heading_sigma_deg == pytest.approx(0.01)


def test_a_filter_that_falls_silent_is_no_surer_than_it_was(armed: Any) -> None:
    stated(armed, 1.0, 1.0)
    before = armed.guide.look.sigma_deg
    look = stated(armed, 1.0, math.nan)
    assert look.heading_sigma_deg == pytest.approx(1.0)
    assert look.sigma_deg == pytest.approx(before, rel=1e-12)
    armed.register()
    assert stated(armed, 0.1, math.nan).sigma_deg < 0.8 * before


def test_the_growth_is_that_of_a_held_tool(armed: Any, pose: Pose) -> None:
    way = armed.to_plan()
    stated(armed, 2.5, (0.0, 0.1), way, pose)
    slow = armed.guide.look.reference_due_s
    assert slow < 60.0
    turned = armed.to_plan(9.0)
    stated(armed, 1.0, (0.1, 0.5), turned, pose)  # what it costs to turn is no growth that goes on
    assert armed.guide.look.reference_due_s == pytest.approx(slow - 10.0, rel=0.02)
    stated(armed, 2.5, (0.5, 0.6), turned, pose)
    assert armed.guide.look.reference_due_s == pytest.approx(slow - 12.5, rel=0.02)
    stated(armed, 2.5, 0.6, turned, pose)
    assert armed.guide.look.reference_due_s == pytest.approx(4.0 * (slow - 15.0) + 10.0, rel=0.05)


def test_a_reading_says_what_the_heading_was_reckoned_with(armed: Any) -> None:
    stated(armed, 1.2, 0.25)
    reading = armed.guide.capture(armed.now)
    assert isinstance(reading, Reading)
    assert (reading.heading_from, reading.heading_sigma_deg) == ("filter", pytest.approx(0.25))
    assert reading_from(reading.to_dict()).to_dict() == reading.to_dict()
    old = {key: value for key, value in reading.to_dict().items() if not key.startswith("heading_")}
    assert (reading_from(old).heading_from, math.isnan(reading_from(old).heading_sigma_deg)) == ("", True)


def test_guided_by_imuguis_own_filter() -> None:
    """A whole guided session: the filter's figure is used, the errors stay within what is stated."""
    worth = profile_facts(None, datetime(2026, 5, 1, tzinfo=UTC), use_mag=False, factory=True)
    told = ImuguiParams(matrix_worst=TURN_SHARE)  # of a calibrated gyroscope

    def facts(now: float) -> Facts:
        return Facts(now=now, streaming=True, prior_holds=prior_holds(TURN_SHARE, told), **worth)

    user = ToolUser(Guide(), facts, 4, "mark", rate_hz=50.0, filter_name="imugui", params=told)
    taken = list(user.run(random_plans(3, 40.0, 4)))
    assert len(taken) == 3
    assert {one.reading.heading_from for one in taken} == {"filter"}
    assert all(one.true_error_deg <= one.reading.sigma_deg <= 1.0 for one in taken)
    assert user.registrations <= 3
