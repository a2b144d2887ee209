"""History: nothing lost, gaps kept, memory bounded."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from imugui.signals.history import LONGEST_WINDOW_S, History

TURN = 2.0 * math.pi


def filled(t: list[float], values: list[float] | None = None, capacity: int = 1000, period: float = 0.0) -> History:
    history = History(("a",), capacity, {"a": period} if period else None)
    history.push(np.array(t), np.array([values if values is not None else t]))
    return history


def real(history: History) -> list[float]:
    values = history.values("a")
    return values[np.isfinite(values)].tolist()


@given(st.lists(st.integers(1, 40), min_size=1, max_size=30), st.integers(1, 100))
def test_the_newest_rows_are_kept_however_they_come(blocks: list[int], capacity: int) -> None:
    history = History(("a", "b"), capacity)
    t = np.arange(sum(blocks)) * 0.01
    for first, last in pairwise(np.cumsum([0, *blocks]).tolist()):
        history.push(t[first:last], np.stack((t[first:last], -t[first:last])))
    kept = len(history)
    assert kept >= min(len(t), capacity)
    assert history.t.tolist() == t[-kept:].tolist()
    assert history.values("a").tolist() == t[-kept:].tolist()
    assert history.values("b").tolist() == (-t[-kept:]).tolist()
    assert history.newest("b") == -t[-1]


def test_memory_is_bounded_over_an_hour_of_rows_and_gaps() -> None:
    history = History(("a", "b"), 2000, {"a": TURN})
    first = history.nbytes
    t = np.arange(1000) * 1e-3
    for second in range(3600):
        history.push(t + second, np.stack((t + second, t)))
        if second % 10 == 0:  # a gap each ten seconds
            history.push(t[:1] + second + 1.5, np.zeros((2, 1)))
    assert history.nbytes <= first + 64 * 8 + 16 * 2000
    assert len(history) <= 2501
    assert len(history.gaps(0.0, 4000.0)) < 10


def test_a_gap_stands_as_a_row_of_nan() -> None:
    history = filled([0.0, 0.1, 0.2, 0.3, 1.3, 1.4])
    assert history.t.tolist() == [0.0, 0.1, 0.2, 0.3, 0.3, 1.3, 1.4]
    assert np.flatnonzero(np.isnan(history.values("a"))).tolist() == [4]
    assert history.gaps(0.0, 2.0).tolist() == [[0.3, 1.3]]
    assert history.gaps(1.35, 2.0).tolist() == []


def test_a_gap_between_two_blocks_is_seen() -> None:
    history = filled([0.0, 0.1, 0.2, 0.3])
    history.push(np.array([2.0, 2.1]), np.array([[1.0, 2.0]]))
    assert history.gaps(0.0, 3.0).tolist() == [[0.3, 2.0]]


def test_few_missing_samples_are_no_gap() -> None:
    assert filled([0.0, 0.1, 0.2, 0.3, 0.6, 0.7]).gaps(0.0, 1.0).tolist() == []


@pytest.mark.parametrize("t", [5.0, -3.0, 100.3 + LONGEST_WINDOW_S])
def test_a_jump_in_time_starts_anew(t: float) -> None:
    history = filled([100.0, 100.1, 100.2])
    history.push(np.array([t, t + 0.1]), np.array([[7.0, 8.0]]))
    assert history.restarts == 1
    assert history.t.tolist() == [t, t + 0.1]
    assert history.gaps(-1e9, 1e9).tolist() == []


def test_the_last_of_two_jumps_in_one_block_counts() -> None:
    history = filled([10.0, 10.1, 3.0, 3.1, 1.0, 1.1])
    assert history.t.tolist() == [1.0, 1.1]


def test_a_small_step_back_stands_still() -> None:
    history = filled([1.0, 1.1, 1.05, 1.2], [1.0, 2.0, 3.0, 4.0])
    assert history.t.tolist() == [1.0, 1.1, 1.1, 1.2]
    assert history.restarts == 0
    assert real(history) == [1.0, 2.0, 3.0, 4.0]


def test_rows_without_a_time_are_left_out() -> None:
    history = filled([1.0, math.nan, 1.1, math.inf], [1.0, 2.0, 3.0, 4.0])
    assert history.t.tolist() == [1.0, 1.1]
    history.push(np.array([math.nan]), np.array([[5.0]]))
    assert real(history) == [1.0, 3.0]


@given(st.lists(st.floats(-3.0, 3.0), min_size=1, max_size=60), st.integers(1, 20))
def test_whole_turns_are_counted_on(steps: list[float], block: int) -> None:
    way = np.cumsum(steps)
    shown = np.angle(np.exp(1j * way))  # as an attitude gives it: within half a turn
    history = History(("a",), 1000, {"a": TURN})
    t = np.arange(len(way)) * 0.01
    for start in range(0, len(way), block):
        history.push(t[start : start + block], shown[None, start : start + block])
    assert history.values("a") - history.values("a")[0] == pytest.approx(way - way[0], abs=1e-9)


def test_turns_are_counted_on_over_nan_and_the_callers_rows_stay() -> None:
    values = np.array([[3.0, math.nan, -3.0]])
    history = History(("a",), 10, {"a": TURN})
    history.push(np.array([0.0, 0.1, 0.2]), values)
    assert history.values("a")[2] == pytest.approx(TURN - 3.0)
    assert values[0, 2] == -3.0


def test_reading_single_rows() -> None:
    history = filled([1.0, 1.1, 1.2, 1.3, 3.0], [10.0, 11.0, 12.0, 13.0, 30.0])
    assert [history.nearest_t(t) for t in (-5.0, 1.04, 1.06, 9.0)] == [1.0, 1.0, 1.1, 3.0]
    assert [history.at("a", t) for t in (0.0, 1.12, 1.3, 2.9)] == [10.0, 11.0, 13.0, 30.0]
    assert [history.stepped_t(1.3, n) for n in (-1, 1, 2, -9)] == [1.2, 3.0, 3.0, 1.0]
    assert history.span(1.1, 1.3) == slice(1, 5)  # with the row that marks the gap


def test_an_empty_history_answers() -> None:
    history = History(("a",), 10)
    history.push(np.empty(0), np.empty((1, 0)))
    assert len(history) == 0
    for answer in (history.first_t, history.last_t, history.nearest_t(1.0), history.at("a", 1.0), history.newest("a")):
        assert math.isnan(answer)
    assert math.isnan(history.stepped_t(1.0, 1))
    assert history.span(0.0, 1.0) == slice(0, 0)
    assert history.gaps(0.0, 1.0).shape == (0, 2)
