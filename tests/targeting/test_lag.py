"""The slow robot: first-order lag and pure delay."""

from __future__ import annotations

from itertools import accumulate, cycle, islice
from math import exp

import pytest
from hypothesis import given
from hypothesis import strategies as st

from imugui.targeting.lag import DeadTime, FirstOrderLag

ONE = 1.0 - exp(-1.0)  # 63.2 %


@pytest.mark.parametrize("tau", [0.1, 1.0, 2.0, 10.0])
@pytest.mark.parametrize("intervals", [(0.01,), (0.002, 0.013, 0.015)])
def test_step_response_reaches_63_percent_at_tau(tau: float, intervals: tuple[float, ...]) -> None:
    lag, t, value, crossed = FirstOrderLag(tau), 0.0, 0.0, 0.0
    for dt in cycle(intervals):
        before, (value, other) = value, lag.update((1.0, -2.0), dt)
        assert other == pytest.approx(-2.0 * value)
        if value >= ONE:
            crossed = t + dt * (ONE - before) / (value - before)
            break
        t += dt
    assert abs(crossed - tau) <= max(intervals)


def test_each_step_is_the_thesis_formula() -> None:
    lag, y, tau = FirstOrderLag(0.25), 0.0, 0.25
    for u, dt in zip((3.0, -1.0, 8.0, 8.0), (0.01, 0.02, 0.0, 0.4), strict=True):
        a = tau / (tau + dt)
        y = a * y + (1 - a) * u
        assert lag.update((u, 0.0), dt)[0] == pytest.approx(y, abs=1e-15)


@given(st.floats(-300, 300), st.lists(st.floats(1e-4, 1.0), max_size=20), st.sampled_from((0.0, 0.25, 10.0)))
def test_what_has_arrived_stays_exactly(place: float, intervals: list[float], tau: float) -> None:
    lag = FirstOrderLag(tau)
    lag.reset((place, -place))
    assert all(lag.update((place, -place), dt) == (place, -place) for dt in intervals)


def test_without_lag_the_input_passes_but_not_without_time() -> None:
    lag = FirstOrderLag(0.0)
    assert lag.update((1.0, 2.0), 0.0) == (0.0, 0.0)
    assert lag.update((1.0, 2.0), 0.01) == (1.0, 2.0)


@pytest.mark.parametrize("delay", [0.005, 0.033, 0.5])
def test_dead_time_is_exact_between_samples(delay: float) -> None:
    times = list(accumulate(islice(cycle((0.01, 0.0, 0.007, 0.021)), 200)))
    dead_time = DeadTime(delay)
    dead_time.reset(0.0)
    for t in times:
        a, b = dead_time.update(t, (3.0 * t, -t))  # straight lines: interpolation is exact
        late = max(t - delay, 0.0)
        assert (a, b) == pytest.approx((3.0 * late, -late), abs=1e-12)


def test_dead_time_starts_at_rest_and_forgets() -> None:
    dead_time = DeadTime(0.1)
    dead_time.reset(5.0)
    assert {dead_time.update(5.0 + 0.01 * k, (40.0, 40.0)) for k in range(1, 10)} == {(0.0, 0.0)}
    assert dead_time.update(5.2, (40.0, 40.0)) == (40.0, 40.0)
    dead_time.reset(6.0, (1.0, 2.0))
    assert dead_time.update(6.05, (9.0, 9.0)) == (1.0, 2.0)


def test_no_dead_time_passes_at_once() -> None:
    assert DeadTime(0.0).update(1.0, (7.0, 8.0)) == (7.0, 8.0)
