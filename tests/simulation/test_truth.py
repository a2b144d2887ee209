"""Every filter against the truth of the virtual board, motion by motion."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from imugui.fusion import FILTERS, quaternion
from imugui.fusion.correction import Correction
from imugui.fusion.pipeline import Pipeline
from imugui.samples import Rows
from imugui.simulation.board import VirtualBoard
from imugui.simulation.errors import PRESETS, Errors
from imugui.simulation.hand import HandTurned
from imugui.simulation.motions import MOTIONS
from imugui.simulation.path import Floats

DEGREE = np.pi / 180
RATE_HZ = 100.0
PIECES = 60

WRONG_START = quaternion.from_rotation_vector(np.array([6.0, -5.0, 8.0]) * DEGREE)
"""11 deg away from the truth, in tilt and in heading."""

SETTLED_S = {"mahony": 390.0}
"""Mahony's integral forgets with the slow root of s2 + kp s + ki: kp / ki = 247 s with the default gains."""
WATCHED_S = 60.0  # how long it must then stay so


def recorded(motion: str, errors: Errors, seconds: float, seed: int = 1) -> tuple[VirtualBoard, Rows, Floats]:
    """A board, its rows and their true attitudes; one that waits for a hand is dragged about once a second."""
    board, rng, pieces = VirtualBoard(motion, RATE_HZ, errors, seed), np.random.default_rng(seed), []
    for k in range(PIECES):
        if isinstance(board.path, HandTurned) and k > 2:
            board.path.turn(*rng.uniform(-0.8, 0.8, 3))
        pieces.append((board.rows(round(seconds * RATE_HZ / PIECES)), board.truth))
    return board, np.concatenate([rows for rows, _ in pieces]), np.concatenate([truth for _, truth in pieces])


def errors_deg(pipeline: Pipeline, rows: Rows, truth: Floats) -> Floats:
    """Angle between attitude and truth, deg, for every row."""
    return quaternion.angle_between(pipeline.step(rows)["quat"], truth) / DEGREE


def rms(values: Floats) -> float:
    return float(np.sqrt((values**2).mean()))


@pytest.mark.parametrize("mag_rate_hz", [0.0, 8.0])
@pytest.mark.parametrize("motion", MOTIONS)
def test_without_errors_every_filter_is_within_a_fifth_of_a_degree(motion: str, mag_rate_hz: float) -> None:
    _, rows, truth = recorded(motion, Errors(mag_rate_hz=mag_rate_hz), 60.0)
    for name in FILTERS:
        assert errors_deg(Pipeline(name), rows, truth).max() < 0.2, name


@pytest.mark.parametrize("motion", ["turns", "aiming", "driving", "free"])
def test_a_wrong_start_settles_to_within_a_fifth_of_a_degree(motion: str) -> None:
    """VQF and Mahony also unlearn the bias that they mistook the wrong start for: SETTLED_S."""
    _, rows, truth = recorded(motion, PRESETS["ideal"], 450.0)
    for name in FILTERS:
        pipeline = Pipeline(name)
        pipeline.filter.start(quaternion.multiply(WRONG_START, truth[0]).tolist())
        settled = round(SETTLED_S.get(name, 120.0) * RATE_HZ)
        watched = settled + round(WATCHED_S * RATE_HZ)
        off = errors_deg(pipeline, rows[:watched], truth[:watched])
        assert off[0] > 5.0, name
        assert off[settled:].max() < 0.2, name


@pytest.mark.skipif("vqf" not in FILTERS, reason="the vqf library has no wheel here")
@pytest.mark.parametrize("mag_rate_hz", [100.0, 8.0])
@pytest.mark.parametrize("motion", MOTIONS)
def test_with_datasheet_errors_and_a_perfect_calibration_vqf_is_within_two_degrees(
    motion: str, mag_rate_hz: float
) -> None:
    """Linear acceleration included: the car's bends are short against the filter's time constant."""
    errors = dataclasses.replace(PRESETS["mpu9250"], mag_rate_hz=mag_rate_hz)
    assert errors.linear_acceleration
    board, rows, truth = recorded(motion, errors, 60.0)
    calibrated = Pipeline("vqf", correction=Correction(**board.perfect_correction()))
    assert rms(errors_deg(calibrated, rows, truth)[500:]) < 2.0
    assert rms(errors_deg(Pipeline("vqf"), rows, truth)[500:]) > 2.0


@pytest.mark.skipif("vqf" not in FILTERS, reason="the vqf library has no wheel here")
@pytest.mark.parametrize("motion", MOTIONS)
def test_what_a_good_calibration_leaves_keeps_vqf_within_two_degrees(motion: str) -> None:
    _, rows, truth = recorded(motion, PRESETS["mpu9250-calibrated"], 60.0, seed=2)
    assert rms(errors_deg(Pipeline("vqf"), rows, truth)[500:]) < 2.0


@pytest.mark.parametrize("name", FILTERS)
def test_a_passing_magnet_is_noticed_and_without_the_magnetometer_does_no_harm(name: str) -> None:
    errors = Errors(magnet_ut=120.0, magnet_at_s=20.0, magnet_lasts_s=6.0)
    _, rows, _ = recorded("aiming", errors, 40.0)
    with_mag, without = Pipeline(name), Pipeline(name, use_mag=False)
    said = with_mag.step(rows)
    # the strange field is the one above 70 uT
    assert said["disturbed"][2250:2350].all()
    assert not said["disturbed"][:2000].any()
    up = quaternion.rotate(without.step(rows)["quat"], rows["acc"])
    assert np.degrees(np.arctan2(np.hypot(up[:, 0], up[:, 1]), up[:, 2])).max() < 0.2
