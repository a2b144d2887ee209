"""Buttons, keys and the board's status byte become commands."""

from __future__ import annotations

from imugui.samples import NO_STATUS
from imugui.targeting.activation import Activation, Command, Input
from imugui.targeting.settings import Control

HOLD = Control()
TOGGLE = Control(latch="toggle")


def events(commands: list[Command]) -> list[tuple[str, str]]:
    """Event and mode of each command that is not about the jolt."""
    return [(event, mode) for event, mode, _ in commands if event != "jolt"]


def press(activation: Activation, t: float, button: str = "") -> list[tuple[str, str]]:
    return events(activation.take(t, Input("press", button)))


def release(activation: Activation, t: float, button: str = "") -> list[tuple[str, str]]:
    return events(activation.take(t, Input("release", button)))


def status(activation: Activation, t: float, value: int) -> list[tuple[str, str]]:
    return events(activation.take_status(t, value))


def test_hold_to_run_lasts_as_long_as_the_button_is_held() -> None:
    for button, mode in (("", "pan"), ("pan", "pan"), ("zoom", "zoom")):
        activation = Activation(HOLD)
        assert press(activation, 1.0, button) == [("press", mode)]
        assert events(activation.elapse(500.0)) == []  # no timeout while it is held
        assert release(activation, 500.0, button) == [("release", "")]


def test_a_key_that_repeats_itself_is_one_press() -> None:
    for control in (HOLD, TOGGLE):
        activation = Activation(control)
        assert press(activation, 1.0, "zoom") == [("press", "zoom")]
        assert press(activation, 1.5, "zoom") == press(activation, 1.53, "zoom") == []


def test_while_one_button_steers_another_means_nothing() -> None:
    activation = Activation(HOLD)
    press(activation, 1.0, "pan")
    assert press(activation, 1.1, "zoom") == release(activation, 1.2, "zoom") == []
    assert release(activation, 1.3, "pan") == [("release", "")]


def test_latched_a_short_press_pans_and_a_long_one_zooms() -> None:
    short, long = Activation(TOGGLE), Activation(TOGGLE)
    assert press(short, 1.0) == events(short.elapse(1.49)) == []
    assert release(short, 1.499) == [("press", "pan")]
    assert press(long, 1.0) == events(long.elapse(1.49)) == []
    assert events(long.elapse(1.5)) == [("press", "zoom")]
    assert release(long, 2.0) == events(long.elapse(2.1)) == []


def test_a_long_press_between_two_rows_is_long_too() -> None:
    activation = Activation(TOGGLE)
    press(activation, 1.0)
    assert release(activation, 1.6) == [("press", "zoom")]


def test_latched_the_next_press_stops_at_once() -> None:
    activation = Activation(TOGGLE)
    press(activation, 1.0)
    release(activation, 1.1)
    assert press(activation, 5.0) == [("release", "")]
    assert release(activation, 5.1) == [("release", "")]  # the table does not know it when ready
    assert events(activation.elapse(6.0)) == []
    assert press(activation, 7.0) == []
    assert release(activation, 7.1) == [("press", "pan")]


def test_latched_buttons_of_their_own_need_no_length() -> None:
    activation = Activation(TOGGLE)
    assert press(activation, 1.0, "zoom") == [("press", "zoom")]
    assert release(activation, 1.1, "zoom") == []
    assert press(activation, 3.0, "pan") == [("release", "")]


def test_a_latch_ends_by_itself() -> None:
    activation = Activation(Control(latch="toggle", latch_timeout_s=60.0))
    press(activation, 1.0, "pan")
    assert activation.elapse(60.99) == []
    assert activation.elapse(61.0) == [Command("release", "", "latched for 60 s")]
    assert activation.elapse(61.1) == []


def test_the_boards_status_pans_zooms_and_stops() -> None:
    activation = Activation(HOLD)
    assert status(activation, 0.0, 0) == []
    assert status(activation, 1.0, 1) == [("press", "pan")]
    assert status(activation, 1.1, 1) == []
    assert status(activation, 2.0, 0) == [("release", "")]
    assert status(activation, 3.0, 2) == [("press", "zoom")]
    assert status(activation, 4.0, 1) == [("release", ""), ("press", "pan")]
    assert activation.elapse(64.0)[0].cause == "latched for 60 s"
    assert status(activation, 65.0, 0) == [("release", "")]


def test_a_status_that_was_on_from_the_start_is_no_press() -> None:
    activation = Activation(HOLD)
    assert status(activation, 0.0, 1) == status(activation, 0.1, 1) == []
    assert status(activation, 0.2, 0) == [("release", "")]
    assert status(activation, 0.3, 1) == [("press", "pan")]


def test_rows_without_status_say_nothing_and_unknown_ones_let_go() -> None:
    activation = Activation(HOLD)
    status(activation, 0.0, 0)
    status(activation, 1.0, 1)
    assert status(activation, 1.1, NO_STATUS) == status(activation, 1.2, 1) == []
    assert status(activation, 1.3, 77) == [("release", "")]


def test_every_status_edge_is_a_jolt() -> None:
    activation = Activation(HOLD)
    press(activation, 0.0, "pan")
    activation.take_status(0.0, 0)
    assert activation.take_status(1.0, 1) == [Command("jolt", "", "board status 0 to 1")]
    assert activation.take_status(2.0, 0) == [Command("jolt", "", "board status 1 to 0")]


def test_what_was_dropped_needs_a_new_press() -> None:
    activation = Activation(HOLD)
    press(activation, 1.0, "pan")
    activation.drop()
    assert press(activation, 1.1, "pan") == events(activation.elapse(1.2)) == []
    assert release(activation, 1.3, "pan") == [("release", "")]  # leaves HOLD
    assert press(activation, 1.4, "pan") == [("press", "pan")]


def test_a_dropped_press_does_not_become_a_long_one() -> None:
    activation = Activation(TOGGLE)
    press(activation, 1.0)
    activation.drop()
    assert activation.elapse(2.0) == []


def test_the_clutch_and_its_causes() -> None:
    activation = Activation(TOGGLE)
    press(activation, 1.0, "pan")
    assert activation.take(2.0, Input("press", "clutch")) == [Command("clutch", "", "clutch button pressed")]
    assert activation.take(3.0, Input("release", "clutch")) == [Command("unclutch", "", "clutch button released")]


def test_nonsense_means_nothing() -> None:
    activation = Activation(HOLD)
    assert press(activation, 1.0, "self-destruct") == release(activation, 1.1, "pan") == []
    assert activation.take(1.2, Input("dance", "pan")) == []
