"""The hand with a tool, and the person who is guided: true courses that the accuracy figures stand on."""

from __future__ import annotations

import math

import numpy as np
import pytest

from imugui.fusion import quaternion
from imugui.guidance.aiming import axis_error
from imugui.guidance.facts import Facts
from imugui.guidance.guide import Guide
from imugui.guidance.plan import direction, problems
from imugui.simulation.board import VirtualBoard
from imugui.simulation.errors import PRESETS
from imugui.simulation.tool_hand import LEVER_M, ToolHand
from imugui.simulation.tool_user import ToolUser, random_plans

DEGREE = math.pi / 180
RATE_HZ = 200.0


def moved(hand: ToolHand, seconds: float, start: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """Attitudes and accelerations of so many seconds, asked for in blocks of four rows."""
    quats, accelerations = [], []
    for k in range(start, start + round(seconds * RATE_HZ), 4):
        t = np.arange(k, k + 4) / RATE_HZ
        quats.append(hand.quats(t))
        accelerations.append(hand.acceleration(t))
    return np.concatenate(quats), np.concatenate(accelerations)


def test_it_rests_first_and_trembles_then() -> None:
    hand = ToolHand(1)
    quats, acceleration = moved(hand, 12.0)
    still = round(hand.still_s * RATE_HZ)
    assert np.ptp(quats[:still], axis=0).max() == 0.0
    assert np.abs(acceleration[:still]).max() == 0.0
    ways = quaternion.rotate(quats[still + 400 :], hand.axis)
    shake = np.degrees(axis_error(ways, (1.0, 0.0, 0.0)))
    assert 0.1 < np.sqrt(np.mean(shake**2)) < 0.7


def test_the_twirl_leaves_the_tool_where_it_is() -> None:
    twirled, calm = (moved(ToolHand(2, twirl=twirl), 12.0)[0] for twirl in (1.0, 0.0))
    assert np.degrees(quaternion.angle_between(twirled, calm)).max() > 60.0
    ways = [quaternion.rotate(quats, (1.0, 0.0, 0.0)) for quats in (twirled, calm)]
    # the tremor turns with the hand, so the two differ by no more than it
    assert np.degrees(axis_error(*ways)).max() < 2.0


def test_a_spin_turns_about_the_axis_and_goes_on_from_the_last() -> None:
    hand = ToolHand(3, twirl=0.0)
    moved(hand, 1.0)
    for turn in (1.0, 0.5):
        hand.spin(turn, 0.5)
        quats, _ = moved(hand, 1.0, round(hand._t * RATE_HZ) + 1)
    assert quats[-1] == pytest.approx(quaternion.from_rotation_vector(np.array((1.5, 0.0, 0.0))), abs=1e-9)


def test_the_sensor_feels_the_acceleration_of_its_lever() -> None:
    hand = ToolHand(4)
    quats, acceleration = moved(hand, 8.0)
    places = quaternion.rotate(quats, LEVER_M * hand.axis)
    expected = np.diff(places, 2, axis=0) * RATE_HZ**2
    assert acceleration[2:] == pytest.approx(expected, abs=1e-6)
    assert 0.3 < np.sqrt(np.mean(acceleration[-400:] ** 2)) < 3.0


def test_equal_seeds_give_equal_boards() -> None:
    boards = [VirtualBoard(ToolHand(5), 100.0, PRESETS["mpu9250-calibrated"], 5) for _ in range(2)]
    rows = [board.rows(700) for board in boards]
    assert np.array_equal(rows[0]["acc"], rows[1]["acc"])
    assert np.array_equal(rows[0]["gyr"], rows[1]["gyr"])


def test_random_plans_can_be_used_and_fill_the_cap() -> None:
    plans = random_plans(40, 45.0, 2)
    assert not any(problems(plan) for plan in plans)
    tilts = np.degrees([axis_error(direction(plan), (0.0, 1.0, 0.0)) for plan in plans])
    assert tilts.max() == pytest.approx(45.0, abs=0.2)
    assert np.percentile(tilts, 25) > 15.0


def test_without_errors_the_person_hits_exactly() -> None:
    def facts(now: float) -> Facts:
        said = {"streaming": True, "calibrated": True, "base_tilt": 0.0, "drift": 0.0, "turn_share": 0.0}
        return Facts(now=now, **said)

    user = ToolUser(Guide(), facts, 1, "mark", PRESETS["ideal"], filter_name="mahony")
    (taken,) = user.run(random_plans(1, 20.0))
    # what is left is the tremor while the tool was laid to the head, and the filter's own
    assert taken.true_error_deg < 0.15
    assert abs(taken.reading.error_deg) < 2.0
