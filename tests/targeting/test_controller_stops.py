"""What stops the controller: useless and stale input, the emergency stop (T2, T10 and T11 of E.2)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import inf, isfinite, nan
from typing import Any

import pytest

from imugui.targeting.activation import Input
from imugui.targeting.controller import Controller
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


BROKEN = {
    "an attitude that is not a number": {"quat": (nan, nan, nan, nan)},
    "a quaternion that is not of unit length": {"quat": (1.02, 0.0, 0.0, 0.0)},
    "the gyroscope is saturated": {"gyr": (0.0, 34.9, 0.0)},
}


@both
@pytest.mark.parametrize("cause", BROKEN)
def test_t2_a_useless_row_holds_the_view(new_hand: NewHand, control: Control, cause: str) -> None:
    hand = new_hand(control)
    hand.engage()
    view = hand.turn(z=-10.0)
    assert hand.row(**BROKEN[cause]) == view
    assert hand.causes()[-1] == ("HOLD", cause)
    assert not hand.controller.valid
    assert hand.turn(z=-20.0) == view
    assert hand.controller.state is State.HOLD
    assert hand.controller.valid


@pytest.mark.parametrize(("t_after_s", "cause"), [(nan, "a time that is not a number"), (-0.5, "time went back")])
def test_t2_a_broken_time_holds_the_view(new_hand: NewHand, t_after_s: float, cause: str) -> None:
    hand = new_hand(DIRECT_SPEED)
    hand.engage()
    view = hand.turn(z=-10.0)
    hand.t += t_after_s - hand.dt
    assert hand.row() == view
    assert hand.causes()[-1] == ("HOLD", cause)
    hand.row(Input("stop"))
    assert hand.causes()[-1] == ("FAULT", "emergency stop")
    assert all(isfinite(line.t) for line in hand.controller.log)


def test_t2_a_press_begun_before_a_useless_row_is_forgotten(new_hand: NewHand) -> None:
    hand = new_hand(replace(DIRECT, latch="toggle"))
    hand.row(Input("confirm"))
    hand.row(press(""))
    hand.row(quat=(nan, 0.0, 0.0, 0.0))
    hand.row(release(""))
    hand.wait(1.0)
    assert hand.controller.state is State.READY


@both
def test_t2_a_gap_holds_the_view_and_only_a_new_press_goes_on(new_hand: NewHand, control: Control) -> None:
    hand = new_hand(control)
    hand.engage()
    view = hand.turn(z=-10.0)
    last_t = hand.t
    hand.t += 0.095
    assert hand.row() == view  # 105 ms later
    line = hand.controller.log[-1]
    assert (line.target, line.cause, line.t) == (State.HOLD, "no sample for 100 ms", last_t)
    assert hand.turn(z=-10.0) == view  # the button is still held
    hand.row(release())
    assert hand.controller.state is State.READY
    hand.row(press())
    assert hand.wait(0.5) == view
    assert hand.turn(z=-10.0).x > view.x


def test_t2_a_late_row_is_no_gap_yet(new_hand: NewHand) -> None:
    hand = new_hand(DIRECT)
    hand.engage()
    hand.t += 0.085
    hand.row()
    assert hand.controller.state is State.ENGAGED


def test_t2_a_press_that_comes_with_a_useless_row_is_refused(new_hand: NewHand) -> None:
    hand = new_hand(DIRECT)
    hand.row(Input("confirm"))
    hand.row(press(), quat=(nan, 0.0, 0.0, 0.0))
    hand.wait(0.1)
    assert hand.causes()[1:] == [("READY", "pan button pressed: refused, the input is not valid")]


def test_t10_between_rows_the_view_is_declared_held_in_time(new_hand: NewHand) -> None:
    hand = new_hand(DIRECT)
    hand.engage()
    assert hand.controller.tick(0.1) == ()
    assert hand.controller.state is State.ENGAGED
    assert hand.controller.tick(0.101) == (Input("stale"),)
    assert (hand.controller.state, hand.controller.valid) == (State.HOLD, False)
    assert hand.controller.tick(0.2) == ()
    view = hand.controller.view
    assert hand.turn(z=-10.0) == view  # a backlog without gaps: held all the same


@pytest.mark.parametrize("gap_s", [0.0, 0.3], ids=["backlog", "gap"])
def test_t10_a_replay_without_ticks_comes_out_the_same(new_hand: NewHand, gap_s: float) -> None:
    hand = new_hand(PRESETS["speed"])
    hand.engage()
    hand.turn(z=-10.0)
    pending = hand.controller.tick(0.05)
    pending = hand.controller.tick(0.15, (*pending, release()))
    pending = hand.controller.tick(0.25, (*pending, press()))
    hand.t += gap_s
    hand.row(*pending)
    hand.turn(z=-10.0)
    hand.row(release(), press())
    hand.turn(z=-10.0)
    again = Controller(PRESETS["speed"], View(10.0, -20.0, 200.0))
    for row in hand.rows:
        again.step(*row)
    assert again.log == hand.controller.log
    assert again.view == hand.controller.view
    assert ("HOLD", "no sample for 100 ms") in hand.causes()


def test_t10_a_press_from_before_the_stall_counts_no_longer(new_hand: NewHand) -> None:
    hand = new_hand(DIRECT)
    hand.engage()
    hand.row(release())
    pending = hand.controller.tick(0.05, (press(),))
    hand.row(*hand.controller.tick(0.15, pending))
    hand.wait(0.1)
    assert hand.controller.state is State.HOLD


@pytest.mark.parametrize("between_rows", [False, True])
def test_t11_the_emergency_stop_is_latched(new_hand: NewHand, between_rows: bool) -> None:
    hand = new_hand(DIRECT_SPEED)
    hand.engage()
    view = hand.turn(z=-10.0)
    stop: tuple[Input, ...] = (Input("stop"),)
    if between_rows:
        assert hand.controller.tick(0.01, stop) == stop
        assert hand.controller.state is State.FAULT
    assert hand.row(*stop) == view
    assert hand.causes()[-1] == ("FAULT", "emergency stop")
    hand.row(release(), press())
    assert hand.turn(z=-10.0) == view
    hand.row(Input("confirm"))
    assert hand.controller.state is State.FAULT
    hand.row(Input("reset"))
    assert hand.controller.state is State.DISARMED
    hand.row(Input("confirm"))
    assert hand.controller.state is State.READY
    hand.row(release(), press())
    assert hand.wait(0.1) == view
    assert hand.controller.state is State.ENGAGED


@pytest.mark.parametrize("others", [(press(),), (Input("reset"), Input("confirm"), press()), (Input("disarm"),)])
def test_t11_the_emergency_stop_wins_over_what_came_before_it(new_hand: NewHand, others: tuple[Input, ...]) -> None:
    hand = new_hand(DIRECT)
    hand.row(Input("confirm"))
    hand.row(*others, Input("stop"))
    assert hand.controller.state is State.FAULT


def test_nothing_a_row_may_hold_raises(new_hand: NewHand) -> None:
    hand = new_hand(DIRECT_SPEED)
    hand.engage()
    for worst in (nan, inf, -inf, 1e308):
        hand.row(Input("", ""), quat=(worst,) * 4, gyr=(worst,) * 3)
        view = hand.controller.step(worst, hand.quat, (worst,) * 3, -32768)
        assert view == View(10.0, -20.0, 200.0)
    assert hand.controller.state is State.HOLD
