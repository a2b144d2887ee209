"""Scope, viewport, cursors, choice: what is looked at, held, moved, measured."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from imugui.fusion.attitude import from_euler
from imugui.ring import Ring
from imugui.signals.channels import QUANTITIES
from imugui.signals.choice import Choice
from imugui.signals.scope import Scope
from imugui.signals.viewport import WINDOWS, Viewport

Push = Callable[..., Any]


@pytest.fixture
def scope(rings: tuple[Ring, Ring], push: Push) -> Scope:
    """A minute at 50 Hz; x acceleration counts seconds."""
    one = Scope(*rings, "ENU")
    t = np.arange(3001) * 0.02
    push(t, acc=np.column_stack((t, 0.0 * t, 0.0 * t)))
    one.refresh()
    return one


@given(st.floats(0.0, 1e6), st.integers(10, 4000), st.sampled_from(WINDOWS))
def test_the_newest_sample_is_in_the_last_column(t: float, count: int, window_s: float) -> None:
    view = Viewport()
    view.window_s = window_s
    grid = view.grid(t, count)
    assert grid.end > t
    assert grid.end - t <= grid.step * 1.001
    assert grid.count * grid.step == pytest.approx(window_s)


def test_rows_keep_their_column_while_the_window_moves() -> None:
    view = Viewport()
    before, after = view.grid(1000.0, 700), view.grid(1000.003, 700)
    shift = (after.start - before.start) / before.step
    assert shift == pytest.approx(round(shift), abs=1e-6)


def test_holding_stops_the_feed_and_puts_cursors(scope: Scope, push: Push) -> None:
    scope.hold()
    assert scope.held
    assert scope.window == (50.0, 60.0)
    assert scope.cursors.times == pytest.approx([53.0, 57.0])
    push(np.array([60.02]))
    assert not scope.refresh()
    assert scope.last_t == 60.0
    scope.resume()
    assert scope.refresh()
    assert scope.last_t == 60.02
    assert not scope.cursors.shown


def test_nothing_can_be_held_without_data(rings: tuple[Ring, Ring]) -> None:
    empty = Scope(*rings, "ENU")
    empty.hold()
    empty.pan(-1.0)
    empty.step_cursor(1)
    empty.place_cursor(0.5)
    empty.zoom(1, 0.5)
    assert not empty.held
    assert math.isnan(empty.window[0])


def test_panning_holds_and_stays_within_the_data(scope: Scope) -> None:
    scope.pan(-0.5)
    assert scope.held
    assert scope.window == (45.0, 55.0)
    scope.pan(-100.0)
    assert scope.window == (-5.0, 5.0)
    scope.pan(100.0)
    assert scope.window == (50.0, 60.0)


def test_zooming_keeps_the_time_at_its_place(scope: Scope) -> None:
    scope.pan(-2.0)
    t = scope.time_at(0.25)
    scope.zoom(-1, 0.25)
    assert scope.viewport.window_s == 5.0
    assert scope.time_at(0.25) == pytest.approx(t)
    for _ in range(20):
        scope.zoom(-1, 0.25)
    assert scope.viewport.window_s == WINDOWS[0]
    for _ in range(20):
        scope.zoom(1, 0.5)
    assert scope.viewport.window_s == WINDOWS[-1]


def test_zooming_while_following_keeps_the_right_edge(scope: Scope) -> None:
    scope.zoom(1, 0.5)
    assert scope.window == (40.0, 60.0)
    scope.set_window(1.0)
    assert scope.window == (59.0, 60.0)


def test_a_chosen_window_keeps_the_middle_while_held(scope: Scope) -> None:
    scope.pan(-1.0)
    middle = scope.time_at(0.5)
    scope.set_window(2.0)
    assert scope.time_at(0.5) == pytest.approx(middle)


def test_cursors_measure(scope: Scope) -> None:
    scope.hold()
    scope.place_cursor(0.1)
    assert scope.cursors.times[0] == pytest.approx(51.0)
    reading = scope.cursors.read(scope.feed.raw, "acc.x")
    assert (reading.a, reading.b, reading.delta, reading.slope) == pytest.approx((51.0, 57.0, 6.0, 1.0))
    assert scope.cursors.delta_s == pytest.approx(6.0)


def test_a_cursor_moves_by_samples_and_takes_the_window_along(scope: Scope) -> None:
    scope.hold()
    scope.step_cursor(-1)
    assert scope.cursors.times == pytest.approx([52.98, 57.0])
    scope.cursors.active = 1
    scope.step_cursor(10)
    assert scope.cursors.times[1] == pytest.approx(57.2)
    scope.step_cursor(10_000)
    assert scope.cursors.times[1] == 60.0
    scope.cursors.active = 0
    scope.step_cursor(-500)
    assert scope.window[0] == pytest.approx(scope.cursors.times[0])


def test_both_cursors_at_one_place_have_no_slope(scope: Scope) -> None:
    scope.hold()
    scope.place_cursor(0.7)
    reading = scope.cursors.read(scope.feed.raw, "acc.x")
    assert reading.delta == 0.0
    assert math.isnan(reading.slope)


def test_angles_between_cursors_count_whole_turns(rings: tuple[Ring, Ring], push: Push) -> None:
    scope = Scope(*rings, "ENU")
    t = np.arange(1001) * 0.01
    quat = from_euler(4.0 * t, 0.0 * t, 0.0 * t)
    push(t, quat=quat, local=quat)
    scope.refresh()
    scope.hold()
    reading = scope.cursors.read(scope.feed.corrected, "euler.yaw")
    assert (reading.delta, reading.slope) == pytest.approx((16.0, 4.0))


def test_another_convention_lets_go(scope: Scope) -> None:
    scope.hold()
    scope.restart("NED")
    assert not scope.held
    assert scope.refresh()
    assert scope.feed.convention == "NED"


def test_the_choice_at_first_is_the_three_sensors() -> None:
    shown = Choice().shown()
    assert {key: [one.label for one in channels] for key, channels in shown.items()} == {
        "acc": ["x", "y", "z"],
        "gyr": ["x", "y", "z"],
        "mag": ["x", "y", "z"],
    }


def test_raw_and_corrected_come_from_their_rows(scope: Scope) -> None:
    choice, feed = scope.choice, scope.feed
    assert choice.history(QUANTITIES["acc"], feed) is feed.corrected
    assert choice.title("acc") == "Accelerometer, corrected"
    choice.raw = True
    assert choice.history(QUANTITIES["acc"], feed) is feed.raw
    assert choice.title("acc") == "Accelerometer, raw"
    for key in ("euler", "gravity", "linear", "quat"):
        assert choice.history(QUANTITIES[key], feed) is feed.corrected
        assert choice.title(key) == QUANTITIES[key].title
    assert choice.history(QUANTITIES["temp"], feed) is feed.raw


def test_units_go_round_for_all_of_a_kind() -> None:
    choice = Choice()
    names = []
    for _ in range(3):
        names.append((choice.unit(QUANTITIES["acc"]).name, choice.unit(QUANTITIES["linear"]).name))
        choice.next_unit("acc")
    assert names == [("m/s²", "m/s²"), ("g", "g"), ("m/s²", "m/s²")]
    assert choice.unit(QUANTITIES["gyr"]).name == "°/s"


def test_a_fixed_scale_stays_until_it_is_moved_or_fitted(scope: Scope) -> None:
    choice = scope.choice
    auto = choice.range_of("acc", -10.0, 10.0)
    scope.set_fixed(True)
    assert choice.range_of("acc", -10.0, 10.0) == auto
    assert choice.range_of("acc", -99.0, 99.0) == auto
    scope.fix_scale("acc", -1.0, 2.0)
    scope.fix_scale("acc", 5.0, 5.0)
    assert choice.range_of("acc", -99.0, 99.0) == (-1.0, 2.0)
    choice.fit("acc")
    assert choice.range_of("acc", -99.0, 99.0)[1] >= 99.0
    scope.set_fixed(False)
    assert choice.range_of("acc", -1.0, 1.0)[1] < 99.0


def test_angles_are_never_scaled_beyond_the_circle() -> None:
    assert Choice().range_of("euler", -179.0, 180.0) == (-180.0, 180.0)
