"""Columns and strokes: no extreme is hidden, no gap is bridged."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as some

from imugui.signals.columns import Columns, Grid, joined, segments
from imugui.signals.history import History
from imugui.signals.strokes import DENSE, make_strokes

VALUES = some.arrays(np.float64, st.integers(1, 400), elements=st.floats(-1e6, 1e6))


def history_of(t: np.ndarray, values: np.ndarray) -> History:
    history = History(("a",), len(t) + 10)
    history.push(t, values[None])
    return history


@given(st.integers(0, 19_999), st.integers(2, 1500), st.floats(0.002, 30.0), st.floats(0.0, 1.0))
def test_a_spike_of_one_sample_is_seen_at_every_zoom(place: int, count: int, window_s: float, where: float) -> None:
    t = np.arange(20_000) * 1e-3
    values = np.zeros(20_000)
    values[place] = 100.0
    start = t[place] - where * window_s * 0.999
    grid = Grid(start, window_s / count, count)
    strokes = make_strokes(history_of(t, values), grid, [("a", 0.0)])["a"]
    assert strokes.extremes()[1] == 100.0
    marks = strokes.marks
    tops = ((0, 2),) if strokes.dense else ((0, 1), (2, 3))
    x = np.concatenate([marks[marks[:, y] == 100.0, x] for x, y in tops])
    assert abs(x - (t[place] - start) / grid.step).min() <= 1.0


@given(VALUES, st.integers(1, 50), st.floats(-5.0, 5.0), st.floats(0.01, 1.0))
def test_extents_are_the_extremes_of_each_column(values: np.ndarray, count: int, start: float, step: float) -> None:
    x = np.arange(len(values)) * 0.1
    grid = Grid(start, step, count)
    columns = Columns(grid, x)
    low, high = columns.extent(values)
    for column in range(count):
        inside = values[(x >= grid.edges[column]) & (x < grid.edges[column + 1])]
        if len(inside):
            assert low[column] <= inside.min()
            assert high[column] >= inside.max()
    seen = values[(x >= grid.edges[0]) & (x < grid.edges[-1])]
    assert columns.rows == len(seen)
    if len(seen):
        assert (np.nanmin(low), np.nanmax(high)) == (seen.min(), seen.max())
    else:
        assert np.isnan(low).all()


@given(VALUES, VALUES)
def test_joined_extents_touch_and_stay_within_the_extremes(a: np.ndarray, b: np.ndarray) -> None:
    n = min(len(a), len(b))
    low, high = np.minimum(a[:n], b[:n]), np.maximum(a[:n], b[:n])
    new_low, new_high = joined(low, high)
    assert (new_low <= low).all()
    assert (new_high >= high).all()
    assert (new_low[1:] <= new_high[:-1]).all()
    assert (new_low[:-1] <= new_high[1:]).all()
    assert (new_low.min(), new_high.max()) == (low.min(), high.max())


def test_a_column_without_rows_is_bridged_but_a_gap_is_not() -> None:
    x = np.array([0.0, 0.1, 0.2, 0.5, 0.6, 3.0, 3.1])
    values = np.array([0.0, 0.0, 0.0, 3.0, 3.0, 9.0, 9.0])
    low, _ = Columns(Grid(-0.05, 0.1, 40), x, [(0.6, 3.0)]).extent(values)
    assert low[3:5].tolist() == pytest.approx([0.5, 1.5])  # half-way down to the neighbour on the left
    assert np.isnan(low[8:30]).all()
    assert np.isfinite(low[30:32]).all()


def test_rows_of_nan_leave_a_hole() -> None:
    values = np.ones(100)
    values[40:60] = math.nan
    low, high = Columns(Grid(0.0, 0.1, 100), np.arange(100) * 0.1 + 0.05).extent(values)
    assert np.flatnonzero(np.isnan(low)).tolist() == list(range(40, 60))
    assert np.flatnonzero(np.isnan(high)).tolist() == list(range(40, 60))


def test_segments_leave_out_nan_and_keep_what_stands_alone() -> None:
    x = np.arange(6.0)
    lines = segments(x, np.array([1.0, 2.0, math.nan, 4.0, math.nan, math.nan]))
    assert lines.tolist() == [[0.0, 1.0, 1.0, 2.0], [3.0, 4.0, 3.0, 4.0]]
    assert segments(np.empty(0), np.empty(0)).shape == (0, 4)
    assert segments(np.zeros(1), np.ones(1)).tolist() == [[0.0, 1.0, 0.0, 1.0]]


@pytest.mark.parametrize("count", [20, 2000])
def test_gaps_are_not_drawn_dense_or_not(count: int) -> None:
    t = np.concatenate((np.arange(300) * 0.01, 6.0 + np.arange(300) * 0.01))
    history = history_of(t, np.sin(t))
    strokes = make_strokes(history, Grid(0.0, 9.0 / count, count), [("a", 0.0)])["a"]
    assert strokes.dense is (DENSE * count < 600)
    edges = np.array((3.0, 6.0)) / 9.0 * count
    for mark in strokes.marks:
        x0, x1 = (mark[0], mark[0] + 1.0) if strokes.dense else (mark[0], mark[2])
        assert x1 <= edges[0] + 1.0 or x0 >= edges[1] - 1.0


def test_lines_come_from_beyond_the_edges() -> None:
    history = history_of(np.arange(10) * 1.0, np.arange(10) * 1.0)
    lines = make_strokes(history, Grid(2.5, 0.01, 300), [("a", 0.0)])["a"].marks
    assert (lines[0, 0], lines[-1, 2]) == pytest.approx((-50.0, 350.0))


def test_strokes_of_nothing() -> None:
    strokes = make_strokes(History(("a",), 10), Grid(0.0, 1.0, 10), [("a", 0.0)])["a"]
    assert len(strokes.marks) == 0
    assert all(math.isnan(end) for end in strokes.extremes())


def test_scaling_changes_values_only() -> None:
    history = history_of(np.arange(100) * 0.01, np.arange(100.0))
    for count in (10, 1000):
        strokes = make_strokes(history, Grid(0.0, 1.0 / count, count), [("a", 0.0)])["a"]
        twice = strokes.scaled(2.0)
        assert twice.extremes() == tuple(2.0 * end for end in strokes.extremes())
        assert twice.marks[:, 0].tolist() == strokes.marks[:, 0].tolist()
