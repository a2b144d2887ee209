"""Folding angles: everything within half a turn, nothing lost, no line across the plot."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from imugui.signals.columns import Grid
from imugui.signals.folding import fold_bars, fold_segments
from imugui.signals.history import History
from imugui.signals.strokes import make_strokes

TURN = 2.0 * math.pi
NEARLY = 1e-9
PLACES = st.floats(-50.0, 50.0)


def inside(bars: np.ndarray, value: float) -> bool:
    folded = value - TURN * math.floor(value / TURN + 0.5)
    return any(low - NEARLY <= folded + shift <= high + NEARLY for _, low, high in bars for shift in (0.0, TURN, -TURN))


@given(PLACES, st.floats(0.0, 8.0), st.floats(0.0, 1.0))
def test_a_bar_keeps_every_angle_it_covers(low: float, length: float, share: float) -> None:
    bars = fold_bars(np.array([[5.0, low, low + length]]), TURN)
    assert (bars[:, 0] == 5.0).all()
    assert (bars[:, 1] >= -math.pi - NEARLY).all()
    assert (bars[:, 2] <= math.pi + NEARLY).all()
    assert (bars[:, 2] - bars[:, 1]).sum() == pytest.approx(min(length, TURN), abs=1e-6)
    assert inside(bars, low + share * length)


@given(PLACES, st.floats(-3.1, 3.1))
def test_a_line_across_the_fold_becomes_two(y: float, way: float) -> None:
    lines = fold_segments(np.array([[0.0, y, 1.0, y + way]]), TURN)
    assert (np.abs(lines[:, 1::2]) <= math.pi + NEARLY).all()
    assert len(lines) in (1, 2)
    assert lines[0, 0] == 0.0
    assert lines[-1, 2] == 1.0
    travelled = (lines[:, 3] - lines[:, 1]).sum()
    assert travelled == pytest.approx(way, abs=1e-6)
    if len(lines) == 2:
        assert lines[0, 2] == lines[1, 0]
        assert abs(lines[0, 3]) == pytest.approx(math.pi)
        assert lines[1, 1] == pytest.approx(-lines[0, 3])


def test_nothing_folded_is_nothing() -> None:
    assert fold_bars(np.empty((0, 3)), TURN).shape == (0, 3)
    assert fold_segments(np.empty((0, 4)), TURN).shape == (0, 4)


@pytest.mark.parametrize("count", [300, 6000])
def test_a_turning_board_draws_no_line_across_the_plot(count: int) -> None:
    t = np.arange(2000) * 0.005
    history = History(("yaw",), 3000, {"yaw": TURN})
    history.push(t, np.angle(np.exp(1j * 4.0 * t))[None])
    strokes = make_strokes(history, Grid(0.0, 10.0 / count, count), [("yaw", TURN)])["yaw"]
    ends = strokes.marks[:, 1:3] if strokes.dense else strokes.marks[:, 1::2]
    assert np.abs(np.diff(ends, axis=1)).max() < 1.0
    assert ends.max() == pytest.approx(math.pi, abs=0.1)
    assert ends.min() == pytest.approx(-math.pi, abs=0.1)
