"""Dead zone, exponent and saturation."""

from __future__ import annotations

from dataclasses import replace
from math import hypot

import pytest
from hypothesis import given
from hypothesis import strategies as st

from imugui.targeting.curve import Curve
from imugui.targeting.settings import PRESETS, Control

angles = st.floats(-120.0, 120.0)


def curve(dead: float = 0.0, exponent: float = 1.0, saturation: float = 45.0) -> Curve:
    return Curve(Control(dead_zone_deg=dead, exponent=exponent, saturation_deg=saturation))


def test_the_dead_zone_is_taken_off() -> None:
    """T5: sign(e) * max(0, |e| - d)."""
    shape = Curve(PRESETS["speed"]).shape
    assert shape((1.5, 0.0)) == shape((-1.4, 0.0)) == (0.0, 0.0)
    assert shape((2.0, 0.0)) == pytest.approx((0.5, 0.0))
    assert shape((0.0, -11.5)) == pytest.approx((0.0, -10.0))


def test_without_dead_zone_and_exponent_nothing_changes() -> None:
    assert curve().shape((3.1, -7.7)) == (3.1, -7.7)
    assert curve().shape((0.0, 0.0)) == (0.0, 0.0)


@given(angles, angles, st.floats(0.0, 20.0), st.floats(1.0, 3.0))
def test_direction_is_kept_and_the_reach_bounded(a: float, b: float, dead: float, exponent: float) -> None:
    x, y = curve(dead, exponent).shape((a, b))
    assert abs(x * b - y * a) <= 1e-9 * (1.0 + a * a + b * b)
    assert x * a + y * b >= 0.0
    assert hypot(x, y) <= min(max(hypot(a, b) - dead, 0.0), 45.0 - dead) + 1e-9


@given(st.floats(0.0, 60.0), st.floats(0.0, 20.0), st.floats(1.0, 3.0))
def test_nothing_jumps_and_more_is_never_less(e: float, dead: float, exponent: float) -> None:
    shape = curve(dead, exponent).shape
    less, more = shape((e, 0.0))[0], shape((e + 1e-6, 0.0))[0]
    assert -1e-12 <= more - less <= 4e-6  # a slope of at most the exponent


def test_an_exponent_is_finer_in_the_middle_and_reaches_as_far() -> None:
    straight, fine = curve(5.0).shape, curve(5.0, exponent=2.0).shape
    assert fine((25.0, 0.0))[0] == pytest.approx(40.0 * 0.25)
    assert fine((45.0, 0.0))[0] == straight((45.0, 0.0))[0] == straight((80.0, 0.0))[0] == pytest.approx(40.0)


def test_excess_is_what_saturation_cuts_off() -> None:
    assert curve().excess((30.0, 30.0)) == (0.0, 0.0)
    assert curve().excess((36.0, 48.0)) == pytest.approx((9.0, 12.0))


def test_a_dead_zone_as_wide_as_saturation_blocks_all() -> None:
    narrow = Curve(replace(Control(), dead_zone_deg=10.0, saturation_deg=10.0))
    assert narrow.shape((50.0, 0.0)) == (0.0, 0.0)
