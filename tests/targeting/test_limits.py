"""Workspace, speed and acceleration."""

from __future__ import annotations

from math import hypot

import pytest
from hypothesis import given
from hypothesis import strategies as st

from imugui.targeting.limits import Box, RateLimit, box_around, stopped
from imugui.targeting.settings import Control
from imugui.targeting.view_pose import View

velocities = st.tuples(st.floats(-1e4, 1e4), st.floats(-1e4, 1e4))


def test_the_box_of_each_mode() -> None:
    control = Control(half_width=250.0, size_min=30.0, size_max=500.0)
    view = View(0.0, 10.0, 100.0)
    assert box_around(control, "pan", view.part("pan")) == Box((-250.0, -250.0), (250.0, 250.0))
    assert box_around(control, "zoom", view.part("zoom")) == Box((30.0, 0.0), (500.0, 0.0))


def test_the_box_holds_a_view_that_starts_outside() -> None:
    box = box_around(Control(), "pan", (-400.0, 310.0))
    assert box.clamp((-400.0, 310.0)) == (-400.0, 310.0)
    assert box.clamp((-500.0, 500.0)) == (-400.0, 310.0)
    assert box.clamp((500.0, -500.0)) == (300.0, -300.0)


def test_sizes_in_the_wrong_order_still_are_a_box() -> None:
    box = box_around(Control(size_min=600.0, size_max=20.0), "zoom", (100.0, 0.0))
    assert box.clamp((5.0, 0.0)) == (20.0, 0.0)


@given(st.lists(st.tuples(velocities, st.floats(1e-4, 0.1)), max_size=30))
def test_speed_and_acceleration_stay_within_bounds(steps: list[tuple[tuple[float, float], float]]) -> None:
    rate, last = RateLimit(v_max=500.0, a_max=4000.0), (0.0, 0.0)
    for wanted, dt in steps:
        a, b = rate.limit(wanted, dt)
        assert hypot(a, b) <= 500.0 * (1 + 1e-12)
        assert hypot(a - last[0], b - last[1]) <= 4000.0 * dt + 1e-9
        last = a, b


def test_what_is_allowed_passes_untouched() -> None:
    wanted = (0.1, -0.2)
    assert RateLimit(500.0, 4000.0).limit(wanted, 0.01) is wanted


def test_the_wanted_velocity_is_reached() -> None:
    rate = RateLimit(500.0, 4000.0)
    seen = [rate.limit((300.0, -400.0), 0.01) for _ in range(13)]
    assert seen[0] == pytest.approx((24.0, -32.0))
    assert seen[-1] == (300.0, -400.0)
    rate.reset()
    assert rate.limit((0.0, 0.0), 0.01) == (0.0, 0.0)


def test_a_wall_stops_only_its_own_part() -> None:
    assert stopped((5.0, -6.0), (310.0, 20.0), (300.0, 20.0)) == (0.0, -6.0)
    assert stopped((5.0, -6.0), (31.0, -320.0), (31.0, -300.0)) == (5.0, 0.0)
