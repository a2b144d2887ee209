"""Feed: both rings into histories, caught up after absences, bounded for ever."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from imugui.fusion.attitude import from_euler
from imugui.ring import Ring
from imugui.samples import ATTITUDE, GRAVITY, SAMPLE, empty_rows
from imugui.signals.feed import PIECE, Feed

Push = Callable[..., Any]


@pytest.fixture
def feed(rings: tuple[Ring, Ring]) -> Feed:
    return Feed(*rings, "ENU", 2000)


def test_rows_of_both_rings_arrive(feed: Feed, push: Push) -> None:
    assert not feed.refresh()
    push(np.arange(10) * 0.01)
    assert feed.refresh()
    assert not feed.refresh()
    for history in (feed.raw, feed.corrected):
        assert history.t.tolist() == pytest.approx((np.arange(10) * 0.01).tolist())
        assert history.newest("acc.z") == GRAVITY
    assert feed.corrected.newest("linear.norm") == pytest.approx(0.0, abs=1e-9)
    assert feed.raw.values("interval.s")[1:] == pytest.approx(0.01)


def test_intervals_go_on_from_block_to_block(feed: Feed, push: Push) -> None:
    for start in range(5):
        push((start * 3 + np.arange(3)) * 0.01)
        feed.refresh()
    assert feed.raw.values("interval.s")[1:] == pytest.approx(0.01)


def test_after_a_short_absence_nothing_is_missing(feed: Feed, push: Push) -> None:
    push(np.arange(100) * 0.01)
    feed.refresh()
    for start in range(100, 1900, 300):
        push((start + np.arange(300)) * 0.01)
    feed.refresh()
    assert len(feed.raw) == len(feed.corrected) == 1900
    assert feed.raw.values("interval.s")[1:] == pytest.approx(0.01)


def test_rows_lost_to_the_ring_are_a_gap(push: Push, rings: tuple[Ring, Ring]) -> None:
    feed = Feed(*rings, "ENU", 10_000)
    push(np.arange(100) * 0.01)
    feed.refresh()
    lost = rings[0].capacity
    push((100 + np.arange(lost + 700)) * 0.01)
    feed.refresh()
    assert feed.raw.gaps(0.0, 1e3) == pytest.approx(np.array([[0.99, 8.0]]))
    assert math.isnan(feed.raw.at("interval.s", 8.0))


def test_much_is_taken_in_pieces(push: Push) -> None:
    samples, attitude = Ring(SAMPLE, 3 * PIECE), Ring(ATTITUDE, 3 * PIECE)
    feed = Feed(samples, attitude, "ENU", 3 * PIECE)
    rows = empty_rows(SAMPLE, 2 * PIECE + 10)
    rows["t"] = np.arange(len(rows)) * 1e-3
    samples.push(rows)
    taken = []
    while feed.refresh():
        taken.append(len(feed.raw))
        assert feed.behind is (len(taken) < 3)
    assert taken == [PIECE, 2 * PIECE, 2 * PIECE + 10]
    assert not feed.behind


def test_a_seek_starts_both_anew(feed: Feed, push: Push) -> None:
    push(50.0 + np.arange(20) * 0.01)
    feed.refresh()
    push(10.0 + np.arange(5) * 0.01)
    feed.refresh()
    for history in (feed.raw, feed.corrected):
        assert history.first_t == 10.0
        assert history.restarts == 1


def test_another_convention_computes_the_angles_again(feed: Feed, push: Push) -> None:
    quat = from_euler(0.5, 0.0, 0.0)
    push(np.arange(5) * 0.01, quat=quat, local=quat)
    feed.refresh()
    assert feed.corrected.newest("euler.yaw") == pytest.approx(0.5)
    feed.restart("NED")
    feed.refresh()
    assert feed.convention == "NED"
    assert feed.corrected.newest("euler.yaw") == pytest.approx(math.pi / 2 - 0.5)


def test_memory_stays_the_same_over_an_hour(rings: tuple[Ring, Ring], push: Push) -> None:
    feed = Feed(*rings, "ENU", 12_000)
    held = []
    for minute in range(60):
        for part in range(2):
            push(minute * 60.0 + part * 30.0 + np.arange(3000) * 0.01)
            feed.refresh()
        held.append(feed.nbytes)
    assert held[0] == held[-1]
    assert 12_000 <= len(feed.raw) <= 15_001
    assert feed.raw.last_t == pytest.approx(3600.0 - 0.01)
