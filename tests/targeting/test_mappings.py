"""The two mappings: gains, limits that give way at once, the ramp."""

from __future__ import annotations

from dataclasses import replace
from math import hypot

import pytest
from hypothesis import given
from hypothesis import strategies as st

from imugui.targeting.mappings import MAPPINGS, Mapping
from imugui.targeting.settings import PRESETS, Control
from imugui.targeting.view_pose import Pair

DT = 0.01
turns = st.tuples(st.floats(-80, 80), st.floats(-80, 80))
lags = st.sampled_from((0.0, 0.25, 2.0))
both = pytest.mark.parametrize("name", ["position", "speed"])


def start(name: str, mode: str = "pan", place: Pair = (0.0, 0.0), **changes: float) -> Mapping:
    """A mapping at ``place``; a hand in these tests may jump."""
    control = replace(PRESETS[name], **{"v_max": 1e5, "a_max": 1e8, **changes})
    return MAPPINGS[control.mapping](control, mode, place)


def sweep(mapping: Mapping, first: float, last: float, rows: int = 50) -> Pair:
    """Turn right from one angle to another, deg."""
    for k in range(rows):
        place = mapping.step((first + (last - first) * (k + 1) / rows, 0.0), 1.0, DT)
    return place


def test_position_moves_by_gain_times_angle_and_back_exactly() -> None:
    mapping = start("position", place=(10.0, -20.0))
    assert mapping.step((5.0, 2.5), 1.0, DT) == (50.0, 0.0)
    assert mapping.step((0.0, 0.0), 1.0, DT) == (10.0, -20.0)


def test_speed_moves_by_gain_times_angle_times_time() -> None:
    mapping = start("speed", dead_zone_deg=0.0)
    for _ in range(100):
        place = mapping.step((5.0, -2.5), 1.0, DT)
    assert place == pytest.approx((40.0, -20.0))


@both
def test_zoom_has_its_own_gain_and_limits(name: str) -> None:
    mapping = start(name, "zoom", (100.0, 0.0), zoom_gain=4.0, dead_zone_deg=0.0)
    assert mapping.step((10.0, 0.0), 1.0, DT) == pytest.approx((140.0 if name == "position" else 100.4, 0.0))
    for _ in range(1000):
        place = mapping.step((-40.0, 0.0), 1.0, DT)
    assert place == ((20.0, 0.0) if name == "speed" else pytest.approx((20.0, 0.0)))


@pytest.mark.parametrize(
    "changes",
    [
        {"saturation_deg": 30.0},  # the curve is saturated
        {"half_width": 200.0, "saturation_deg": 90.0},  # the view is at the edge of the workspace
        {"v_max": 100.0, "saturation_deg": 90.0},  # the hand is faster than the view may be
        {"half_width": 200.0, "saturation_deg": 90.0, "a_max": 5000.0},  # it runs into the edge
        {"saturation_deg": 30.0, "half_width": 200.0, "exponent": 2.0, "dead_zone_deg": 2.0},
    ],
)
def test_a_limited_position_gives_way_at_once_when_reversed(changes: dict[str, float]) -> None:
    mapping = start("position", **changes)
    furthest, _ = sweep(mapping, 0.0, 60.0)
    assert sweep(mapping, 60.0, 75.0)[0] >= furthest > 0.0
    before, _ = sweep(mapping, 75.0, 75.0, rows=1)
    after, _ = mapping.step((74.9, 0.0), 1.0, DT)
    assert after < before - 0.1  # 0.1 deg is 0.8 px


@pytest.mark.parametrize("lag_s", [0.0, 0.25, 2.0])
def test_a_speed_into_the_wall_is_forgotten(lag_s: float) -> None:
    mapping = start("speed", lag_s=lag_s, a_max=500.0)
    for _ in range(2000):
        at_wall, _ = mapping.step((40.0, 0.0), 1.0, DT)
    assert at_wall == 300.0
    assert mapping.step((-10.0, 0.0), 1.0, DT)[0] < 300.0


def test_along_a_wall_the_view_slides() -> None:
    mapping = start("speed", dead_zone_deg=0.0)
    for _ in range(500):
        place = mapping.step((40.0, 5.0), 1.0, DT)
    assert place == (300.0, pytest.approx(200.0))


@given(st.sampled_from(("position", "speed")), lags, st.lists(turns, min_size=1, max_size=40))
def test_no_hand_breaks_the_limits(name: str, lag_s: float, path: list[Pair]) -> None:
    mapping = start(name, lag_s=lag_s, v_max=400.0, half_width=100.0)
    last = (0.0, 0.0)
    for turn in path:
        place = mapping.step(turn, 1.0, DT)
        assert max(map(abs, place)) <= 100.0 + 1e-9
        assert hypot(place[0] - last[0], place[1] - last[1]) <= 400.0 * DT * (1 + 1e-9)
        last = place


@given(st.lists(turns, min_size=1, max_size=40))
def test_no_hand_breaks_the_acceleration_in_the_open(path: list[Pair]) -> None:
    mapping = start("position", v_max=300.0, a_max=2000.0, half_width=3000.0)
    last, speed = (0.0, 0.0), (0.0, 0.0)
    for turn in path:
        place = mapping.step(turn, 1.0, DT)
        now = (place[0] - last[0]) / DT, (place[1] - last[1]) / DT
        assert hypot(now[0] - speed[0], now[1] - speed[1]) <= 2000.0 * DT * (1 + 1e-6)
        last, speed = place, now


def test_in_the_ramp_a_hand_at_rest_moves_nothing() -> None:
    mapping = start("position")
    place = mapping.step((10.0, 0.0), 0.25, DT)
    assert place == pytest.approx((20.0, 0.0))
    assert mapping.step((10.0, 0.0), 0.75, DT) == mapping.step((10.0, 0.0), 1.0, DT) == place
    assert mapping.step((11.0, 0.0), 1.0, DT)[0] == pytest.approx(28.0)


def test_the_ramp_leaves_the_neutral_of_speed_where_it_was() -> None:
    mapping = start("speed", dead_zone_deg=0.0)
    assert mapping.step((10.0, 0.0), 0.25, DT) == pytest.approx((0.2, 0.0))
    place = mapping.step((0.0, 0.0), 1.0, DT)
    assert mapping.step((0.0, 0.0), 1.0, DT) == place


def test_drift_inside_the_dead_zone_does_not_creep() -> None:
    mapping = start("speed", place=(7.0, 7.0))
    assert {mapping.step((1.0, -1.0), 1.0, DT) for _ in range(6000)} == {(7.0, 7.0)}  # a minute


def test_the_lag_reaches_the_same_place() -> None:
    mapping = start("position", lag_s=0.25)
    assert mapping.step((10.0, 0.0), 1.0, DT)[0] < 10.0
    for _ in range(1000):
        place = mapping.step((10.0, 0.0), 1.0, DT)
    assert place == pytest.approx((80.0, 0.0))


def test_every_mapping_choice_has_a_class() -> None:
    choices = Control.__dataclass_fields__["mapping"].metadata["choices"]
    assert set(MAPPINGS) == set(choices)
