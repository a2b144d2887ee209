"""Hold and progress: half a second without a break, and how the plan was reached."""

from __future__ import annotations

import math

import numpy as np
import pytest

from imugui.guidance.hold import HOLD_S, STEADY, Hold
from imugui.guidance.look import FASTEST_HZ, SLOWEST_HZ, beep_hz
from imugui.guidance.progress import Progress

DEGREE = math.pi / 180
DT = 0.01


def held(steps: int, hold: Hold | None = None, start: float = 5.0, **said: object) -> Hold:
    """A hold told of so many good samples, except for what is said."""
    hold = hold or Hold()
    good = {"inside": True, "rate": 0.5 * STEADY, "trusted": True, **said}
    for k in range(steps):
        hold.step(start + k * DT, **good)  # type: ignore[arg-type]
    return hold


def test_it_arms_after_half_a_second_and_not_before() -> None:
    assert not held(50).armed
    assert held(51).armed
    assert held(26).progress == pytest.approx(0.5)


@pytest.mark.parametrize("said", [{"inside": False}, {"rate": STEADY}, {"rate": math.nan}, {"trusted": False}])
def test_nothing_else_arms_it(said: dict[str, object]) -> None:
    hold = held(200, **said)
    assert not hold.armed
    assert hold.progress == 0.0


@pytest.mark.parametrize("said", [{"inside": False}, {"rate": 2 * STEADY}, {"trusted": False}])
def test_one_bad_sample_begins_it_again(said: dict[str, object]) -> None:
    hold = held(60)
    held(1, hold, 5.6, **said)
    assert not hold.armed
    held(50, hold, 5.61)
    assert not hold.armed
    held(1, hold, 6.11)
    assert hold.armed


@pytest.mark.parametrize("start", [5.6, 4.0])
def test_a_gap_or_a_time_that_goes_back_is_a_break(start: float) -> None:
    hold = held(45)
    held(10, hold, start)
    assert not hold.armed
    assert hold.progress < 0.3


def test_reset_begins_again() -> None:
    hold = held(60)
    hold.reset()
    assert not hold.armed
    held(2, hold, 5.6)
    assert hold.progress == pytest.approx(DT / HOLD_S)


def test_a_slow_board_that_leaves_gaps_never_arms() -> None:
    hold = Hold()
    assert not any(hold.step(k * 0.2, True, 0.0, True) for k in range(50))


# progress


def followed(errors_deg: list[float]) -> Progress:
    progress = Progress()
    for k, error in enumerate(errors_deg):
        progress.step(10.0 + k * DT, error * DEGREE, 2.0 * DEGREE)
    return progress


def test_times_and_overshoots_are_counted() -> None:
    course = [9.0] * 30 + [1.0] * 20 + [3.0] * 10 + [1.5] * 20
    progress = followed(course)
    assert progress.time_to_green == pytest.approx(0.30)
    assert progress.in_green == pytest.approx(0.40)
    assert progress.overshoots == 1
    assert progress.duration == pytest.approx(0.79)


def test_trembling_on_the_edge_is_no_overshoot() -> None:
    assert followed([1.9, 2.1] * 40).overshoots == 0


def test_never_green_has_no_time_to_green() -> None:
    progress = followed([5.0] * 40)
    assert math.isnan(progress.time_to_green)
    assert progress.in_green == 0.0


def test_what_nobody_saw_is_not_counted() -> None:
    progress = Progress()
    progress.step(0.0, 0.0, 1.0)
    progress.step(60.0, 0.0, 1.0)
    assert progress.in_green == 0.0


# sound


def test_the_tone_quickens_towards_the_plan() -> None:
    rates = [beep_hz(error * DEGREE, 2.0 * DEGREE) for error in np.linspace(60.0, 0.0, 50)]
    assert rates == sorted(rates)
    assert (rates[0], rates[-1]) == (SLOWEST_HZ, FASTEST_HZ)
    assert beep_hz(math.nan, 1.0) == 0.0
