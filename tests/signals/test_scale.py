"""Scales: round, whole, and quiet."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from imugui.signals.scale import ANGLE_STEPS, AutoScale, nice_step, round_range, tick_words, ticks

NUMBERS = st.floats(-1e6, 1e6)
SPANS = st.floats(1e-3, 1e6)


@given(st.floats(1e-9, 1e9))
def test_steps_are_one_two_or_five(rough: float) -> None:
    step = nice_step(rough)
    assert rough * (1 - 1e-6) <= step <= 2.5 * rough * (1 + 1e-6)
    digit = step / 10.0 ** math.floor(math.log10(step) + 1e-9)
    assert min(abs(digit - nice) for nice in (1.0, 2.0, 5.0)) < 1e-6


@given(NUMBERS, SPANS, st.integers(1, 12))
def test_ticks_are_round_inside_and_not_too_many(low: float, span: float, most: int) -> None:
    values, step = ticks(low, low + span, most)
    assert len(values) <= most + 1
    assert all(low - 0.01 * step <= value <= low + span + 0.01 * step for value in values)
    assert all(abs(value / step - round(value / step)) < 1e-6 for value in values)


def test_angles_are_told_in_parts_of_a_circle() -> None:
    values, step = ticks(-180.0, 180.0, 5, angles=True)
    assert values.tolist() == [-180.0, -90.0, 0.0, 90.0, 180.0]
    assert step == 90.0
    assert ticks(-180.0, 180.0, 1, angles=True)[1] == ANGLE_STEPS[-1]
    assert ticks(0.0, 8.0, 4, angles=True)[1] == 2.0


@pytest.mark.parametrize(
    ("value", "step", "words"),
    [(0.0, 1.0, "0"), (-0.0, 0.5, "0.0"), (-12.5, 0.5, "−12.5"), (0.3, 0.1, "0.3"), (200.0, 50.0, "200")],
)
def test_words_of_ticks(value: float, step: float, words: str) -> None:
    assert tick_words(value, step) == words


@given(NUMBERS, st.floats(0.0, 1e6), st.floats(1e-3, 10.0))
def test_a_round_range_holds_the_data(low: float, span: float, least: float) -> None:
    bottom, top = round_range(low, low + span, least)
    assert bottom <= low
    assert top >= low + span
    assert top - bottom >= least * (1 - 1e-9)
    assert top - bottom <= 2.0 * max(span, least)


@given(st.lists(st.tuples(NUMBERS, st.floats(0.0, 1e6)), min_size=1, max_size=20))
def test_an_automatic_scale_always_holds_the_data(stretches: list[tuple[float, float]]) -> None:
    scale = AutoScale()
    for low, span in stretches:
        bottom, top = scale.follow(low, low + span, 1.0)
        assert bottom <= low
        assert top >= low + span


def test_an_automatic_scale_does_not_fidget() -> None:
    scale = AutoScale()
    first = scale.follow(-10.0, 10.0, 0.5)
    assert scale.follow(-8.0, 9.0, 0.5) == first
    assert scale.follow(-7.0, 7.0, 0.5) == first
    wider = scale.follow(-8.0, 30.0, 0.5)
    assert wider[0] <= first[0]
    assert wider[1] > 30.0
    assert scale.follow(-1.0, 1.0, 0.5)[1] < 2.0


def test_data_at_the_edge_widen_the_scale() -> None:
    scale = AutoScale()
    top = scale.follow(0.0, 9.0, 1.0)[1]
    assert scale.follow(0.0, top - 0.01, 1.0)[1] > top


def test_without_data_the_scale_stays() -> None:
    scale = AutoScale()
    assert scale.follow(math.nan, math.nan, 2.0) == (-1.0, 1.0)
    first = scale.follow(0.0, 5.0, 2.0)
    assert scale.follow(math.nan, math.nan, 2.0) == first
    assert scale.follow(0.0, math.inf, 2.0) == first
