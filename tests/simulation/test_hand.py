"""The board that a mouse turns: goes where it is asked, smoothly, never faster than a gyroscope can follow."""

from __future__ import annotations

import threading

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from imugui.fusion import quaternion
from imugui.simulation.hand import HandTurned
from imugui.simulation.path import Floats

DEGREE = np.pi / 180


def follow(hand: HandTurned, seconds: float, start_t: float, rate_hz: float = 200.0, block: int = 4) -> Floats:
    """Attitudes (n, 4) of the hand from ``start_t`` on, asked for in blocks."""
    count = round(seconds * rate_hz)
    t = start_t + np.arange(1, count + 1) / rate_hz
    return np.concatenate([hand.quats(t[k : k + block]) for k in range(0, count, block)])


@pytest.mark.parametrize(
    ("drag", "axis"),
    [((0.6, 0.0, 0.0), (0, 0, 1)), ((0.0, 0.6, 0.0), (1, 0, 0)), ((0.0, 0.0, 0.6), (0, -1, 0))],
    ids=["right", "down", "roll"],
)
def test_a_drag_turns_the_board_as_the_viewer_sees_it(
    drag: tuple[float, float, float], axis: tuple[float, float, float]
) -> None:
    """The viewer stands in the south: right is east, up is up."""
    hand = HandTurned()
    hand.turn(*drag)
    end = follow(hand, 2.0, 0.0)[-1]
    assert quaternion.to_rotation_vector(end) == pytest.approx(0.6 * np.array(axis, float), abs=1e-6)


def test_another_viewer_drags_about_other_axes() -> None:
    hand = HandTurned()
    hand.viewer = np.array([1.0, 0.0, 0.0, 0.0])  # looks down from above: right is east, up is north
    hand.turn(0.5, 0.0)
    assert quaternion.to_rotation_vector(follow(hand, 2.0, 0.0)[-1]) == pytest.approx([0, 0.5, 0], abs=1e-6)


@settings(max_examples=25, deadline=None)
@given(st.lists(st.tuples(*[st.floats(-0.5, 0.5)] * 3, st.integers(1, 60)), min_size=1, max_size=8))
def test_any_drags_are_followed_smoothly_and_not_too_fast(drags: list[tuple[float, float, float, int]]) -> None:
    hand = HandTurned()
    quats, t = [hand.quats(np.array([0.0]))], 0.0
    for dx, dy, roll, blocks in drags:
        hand.turn(dx, dy, roll)
        quats.append(follow(hand, blocks / 50, t))
        t += blocks / 50
    path = np.concatenate(quats)
    rate = quaternion.to_rotation_vector(quaternion.multiply(quaternion.conjugate(path[:-1]), path[1:])) * 200
    assert np.linalg.norm(rate, axis=1).max() < 230 * DEGREE
    # the pull is at most STIFFNESS^2 * LEAD plus the damping, 256 rad/s2; a stepped rate would show thousands
    assert np.abs(np.diff(rate, axis=0)).max(initial=0.0) * 200 < 300
    wanted = hand.wanted
    assert quaternion.angle_between(follow(hand, 3.0, t)[-1], wanted) < 1e-4


def test_a_pulled_mouse_does_not_flip_the_board_the_other_way_round() -> None:
    hand = HandTurned()
    for _ in range(40):
        hand.turn(0.2, 0.0)
    path = np.concatenate([[[1.0, 0.0, 0.0, 0.0]], follow(hand, 4.0, 0.0)])
    rate = quaternion.to_rotation_vector(quaternion.multiply(quaternion.conjugate(path[:-1]), path[1:]))
    assert (rate[:, 2] > -1e-12).all()
    assert rate[:, 2].sum() == pytest.approx(2.5, abs=1e-3)


def test_it_can_be_sent_to_an_attitude() -> None:
    hand = HandTurned()
    hand.turn_to(np.array([0.0, 0.0, 2.0, 2.0]))  # half a turn away, not a unit quaternion
    for k in range(4):
        follow(hand, 1.0, float(k))
        hand.turn_to(np.array([0.0, 0.0, 1.0, 1.0]))
    end = follow(hand, 2.0, 4.0)[-1]
    assert quaternion.angle_between(end, np.array([0.0, 0.0, np.sqrt(0.5), np.sqrt(0.5)])) < 1e-6


def test_equal_inputs_give_equal_attitudes() -> None:
    def played() -> Floats:
        hand = HandTurned()
        hand.turn(0.4, -0.2)
        first = follow(hand, 0.3, 0.0)
        hand.turn(-0.9, 0.1)
        return np.concatenate([first, follow(hand, 0.3, 0.3)])

    assert np.array_equal(played(), played())


def test_one_thread_turns_while_another_reads() -> None:
    hand, turned = HandTurned(), threading.Event()

    def drag() -> None:
        for _ in range(200):
            hand.turn(0.005, 0.0)
        turned.set()

    thread = threading.Thread(target=drag)
    thread.start()
    t = 0.0
    while not turned.is_set():
        assert np.isfinite(follow(hand, 0.02, t)).all()
        t += 0.02
    thread.join()
    end = follow(hand, 3.0, t)[-1]
    assert quaternion.to_rotation_vector(end) == pytest.approx([0, 0, 1.0], abs=1e-6)
