"""The controller as a whole: the requirements T1 and T4 to T9 of the reference notes (E.2), one after another."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest

from imugui.targeting.activation import Input
from imugui.targeting.settings import PRESETS, Control
from imugui.targeting.states import State
from imugui.targeting.view_pose import View

NewHand = Callable[..., Any]

DIRECT = replace(PRESETS["position"], smoothing=False)
DIRECT_SPEED = replace(PRESETS["speed"], smoothing=False)
both = pytest.mark.parametrize("control", [DIRECT, DIRECT_SPEED], ids=["position", "speed"])


def press(button: str = "pan") -> Input:
    return Input("press", button)


def release(button: str = "pan") -> Input:
    return Input("release", button)


def test_it_begins_disarmed_and_says_why_it_does_not_follow(new_hand: NewHand) -> None:
    hand = new_hand(DIRECT)
    hand.row(press())
    hand.row(release())
    assert hand.turn(z=-20.0) == View(10.0, -20.0, 200.0)
    assert hand.causes() == [("DISARMED", "pan button pressed: refused, disarmed")]


def test_position_follows_the_hand(new_hand: NewHand) -> None:
    hand = new_hand(DIRECT)
    assert hand.engage() == View(10.0, -20.0, 200.0)
    assert (hand.controller.state, hand.controller.mode, hand.controller.valid) == (State.ENGAGED, "pan", True)
    view = hand.turn(z=-5.0)
    assert view == pytest.approx((50.0, -20.0, 200.0))
    assert hand.controller.displacement_deg == pytest.approx((0.0, 0.0, -5.0))
    assert hand.controller.stages.steer == hand.controller.stages.delayed == pytest.approx((5.0, 0.0))
    assert hand.turn(z=5.0) == pytest.approx((10.0, -20.0, 200.0))


def test_speed_integrates_the_hand_in_measured_time(new_hand: NewHand) -> None:
    for dt in (0.01, 0.004):
        hand = new_hand(DIRECT_SPEED, dt=dt)
        hand.engage()
        hand.turn(x=6.5, rows=1)
        view = hand.controller.view
        assert hand.wait(2.0) == pytest.approx((view.x, view.y + 2.0 * 8.0 * 5.0, 200.0))


def test_zoom_changes_the_size_only(new_hand: NewHand) -> None:
    hand = new_hand(DIRECT)
    hand.engage("zoom")
    assert hand.controller.mode == "zoom"
    assert hand.turn(x=5.0, z=-3.0) == pytest.approx((10.0, -20.0, 240.0), abs=0.5)
    assert hand.controller.view[:2] == (10.0, -20.0)


@both
def test_t1_hold_to_run(new_hand: NewHand, control: Control) -> None:
    hand = new_hand(control)
    hand.engage()
    hand.turn(z=-20.0)
    view = hand.row(release())
    assert (hand.controller.state, hand.controller.mode) == (State.READY, "")
    assert hand.controller.displacement_deg == (0.0, 0.0, 0.0)
    assert hand.turn(z=30.0, x=20.0) == view


def test_t1_latched_with_timeout(new_hand: NewHand) -> None:
    hand = new_hand(replace(DIRECT, latch="toggle"))
    hand.row(Input("confirm"))
    hand.row(press(""))
    hand.row(release(""))
    hand.wait(59.9)
    assert hand.controller.state is State.ENGAGED
    hand.wait(0.2)
    assert hand.causes()[-1] == ("READY", "latched for 60 s")


def test_t1_the_motion_card_pans_zooms_and_stops(new_hand: NewHand) -> None:
    hand = new_hand(replace(PRESETS["thesis position"], lag_s=0.0))
    hand.status = 0
    hand.row(Input("confirm"))
    hand.status = 1
    hand.wait(0.1)
    assert hand.turn(x=5.0) == pytest.approx((50.0, -20.0, 200.0))
    hand.status = 0
    assert hand.turn(x=5.0) == pytest.approx((50.0, -20.0, 200.0))
    hand.status = 2
    hand.wait(0.1)
    assert hand.turn(x=-5.0) == pytest.approx((50.0, -20.0, 160.0))
    assert [state for state, _ in hand.causes()] == ["READY", "ALIGNING", "ENGAGED", "READY", "ALIGNING", "ENGAGED"]
    assert [line.mode for line in hand.controller.log[1:]] == ["pan"] * 3 + ["zoom"] * 2


def test_t4_the_buttons_jolt_does_not_move_the_view(new_hand: NewHand) -> None:
    hand = new_hand(replace(DIRECT, gain_ramp_s=0.0))
    hand.row(Input("confirm"))
    hand.row(press())
    assert hand.controller.state is State.ALIGNING
    assert hand.turn(z=-2.0, x=1.0, rows=2) == View(10.0, -20.0, 200.0)
    assert hand.wait(0.1) == View(10.0, -20.0, 200.0)
    assert hand.controller.state is State.ENGAGED
    assert hand.controller.displacement_deg == (0.0, 0.0, 0.0)


def test_t4_while_masked_the_gyroscope_carries_the_attitude(new_hand: NewHand) -> None:
    """The board's own button is touched while a key steers: attitudes are ignored, the movement is not."""
    hand, same = (new_hand(replace(DIRECT, mask_s=0.025)) for _ in range(2))
    for each in (hand, same):
        each.status = 0
        each.engage()
    hand.status = 1
    moved = same.turn(z=-1.0, rows=1)
    rate = same.rows[-1][2]
    hand.quat = same.quat
    assert hand.row(quat=(0.0, 1.0, 0.0, 0.0), gyr=rate) == pytest.approx(moved)
    assert hand.row(quat=(0.0, 0.0, 1.0, 0.0)) == pytest.approx(moved)
    assert hand.wait(0.1) == pytest.approx(moved)
    assert hand.controller.state is State.ENGAGED


def test_t4_the_gain_ramps_up(new_hand: NewHand) -> None:
    hand = new_hand(DIRECT)
    hand.engage(settle_s=0.02)
    assert hand.controller.state is State.ENGAGED
    part = hand.turn(z=-15.0, rows=15).x - 10.0
    assert part == pytest.approx(0.5 * 15.0 * 8.0, rel=0.1)  # the mean of a ramp
    assert hand.turn(z=-1.0, rows=1).x - 10.0 - part == pytest.approx(8.0)


def test_t5_drift_does_not_creep_in_speed(new_hand: NewHand) -> None:
    hand = new_hand(PRESETS["speed"])
    view = hand.engage()
    assert hand.turn(z=1.0, x=-1.0, rows=6000) == view  # 1 deg in a minute


@both
def test_t6_at_the_edge_a_hand_that_turns_back_acts_at_once(new_hand: NewHand, control: Control) -> None:
    hand = new_hand(control)
    hand.engage()
    hand.turn(z=-40.0, rows=20)
    hand.turn(z=-20.0, rows=20)
    assert hand.wait(1.0).x == 300.0
    if control is DIRECT_SPEED:  # back through the neutral attitude: nothing is left to unwind
        hand.turn(z=58.0, rows=20)
        assert hand.wait(1.0).x == 300.0
        assert hand.turn(z=3.6, rows=20).x < 300.0
    else:
        assert hand.turn(z=1.0, rows=1).x == pytest.approx(292.0)


def test_t6_a_hand_turned_too_far_lets_go(new_hand: NewHand) -> None:
    hand = new_hand(DIRECT)
    hand.engage()
    hand.turn(y=89.0, rows=50)
    assert hand.controller.state is State.ENGAGED
    view = hand.turn(y=2.0)
    assert hand.causes()[-1] == ("READY", "turned by more than 90°")
    assert hand.turn(y=-60.0, z=20.0) == view  # it is still pressed


def test_t6_a_view_outside_the_workspace_may_come_in(new_hand: NewHand) -> None:
    hand = new_hand(DIRECT, view=View(400.0, 0.0, 200.0))
    hand.engage()
    assert hand.turn(z=-10.0).x == 400.0
    assert hand.turn(z=5.0).x == pytest.approx(360.0)


def test_t7_dead_time_is_pure_and_lag_is_slow(new_hand: NewHand) -> None:
    late, slow = new_hand(replace(DIRECT, dead_time_s=0.3)), new_hand(replace(DIRECT, lag_s=1.0))
    for hand in (late, slow):
        hand.engage(settle_s=1.0)
        hand.turn(z=-10.0, rows=10)
    assert late.controller.view.x == 10.0
    assert late.wait(0.2).x == pytest.approx(10.0, abs=1e-9)
    assert late.wait(0.1).x == pytest.approx(90.0)
    assert 12.0 < slow.controller.view.x < 20.0
    assert slow.wait(0.95).x == pytest.approx(10.0 + 80.0 * 0.632, abs=2.0)


def test_t8_a_rolled_board_steers_in_view_axes(new_hand: NewHand) -> None:
    half = 0.5**0.5
    hand = new_hand(DIRECT, quat=(half, 0.0, half, 0.0))  # rolled right by 90 degrees about its y, which points north
    hand.engage()
    assert hand.turn(x=5.0) == pytest.approx((50.0, -20.0, 200.0))  # its x points down: a turn to the right


@pytest.mark.parametrize("quat", [(0.0, 0.0, 0.0, 1.0), (0.5, 0.5, -0.5, 0.5), (0.0, 0.6, 0.8, 0.0)])
def test_t9_no_attitude_is_special(new_hand: NewHand, quat: tuple[float, ...]) -> None:
    """Heading 180 degrees, pitch 90, upside down: with the board's own axes all are alike."""
    own = replace(DIRECT, roll_corrected=False)
    hand, level = new_hand(own, quat=quat), new_hand(own)
    for each in (hand, level):
        each.engage()
        each.turn(x=3.0, z=-4.0)
        each.turn(x=-8.0, y=10.0)
    assert hand.controller.view == pytest.approx(level.controller.view)


def test_the_clutch_lets_the_hand_go_back(new_hand: NewHand) -> None:
    hand = new_hand(replace(DIRECT, latch="toggle"))
    hand.engage()
    view = hand.turn(z=-20.0, rows=20)
    hand.row(press("clutch"))
    assert (hand.controller.state, hand.controller.mode) == (State.CLUTCHED, "pan")
    assert hand.turn(z=20.0) == view
    hand.row(release("clutch"))
    assert hand.wait(0.3) == view
    assert hand.turn(z=-10.0).x == pytest.approx(view.x + 80.0)


def test_the_view_can_be_placed_between_runs(new_hand: NewHand) -> None:
    hand = new_hand(DIRECT)
    hand.engage()
    hand.controller.place(View(1.0, 2.0, 30.0))
    assert hand.turn(z=-10.0) == View(1.0, 2.0, 30.0)
    assert hand.causes()[-1] == ("READY", "view placed")


def test_a_row_that_comes_twice_moves_nothing(new_hand: NewHand) -> None:
    hand = new_hand(DIRECT)
    hand.engage()
    view = hand.turn(z=-10.0)
    hand.t -= hand.dt
    assert hand.row() == view
    assert hand.controller.state is State.ENGAGED
