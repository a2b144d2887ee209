"""What the own filter has learnt goes into the profile, if it was well observed, and every filter profits."""

from __future__ import annotations

import dataclasses
from datetime import UTC, datetime, timedelta
from functools import cache

import numpy as np
import pytest

from imugui.calibration.learnt import METHOD, Clipping, Learnt, folded, kept_part, refusal
from imugui.calibration.parts import AccelerometerPart, GyroscopePart
from imugui.calibration.profile import Profile, now_utc
from imugui.fusion import quaternion as qt
from imugui.fusion.correction import Correction
from imugui.fusion.imugui_filter import Imugui
from imugui.fusion.pipeline import Pipeline
from imugui.samples import SAMPLE, empty_rows
from imugui.simulation.board import VirtualBoard
from imugui.simulation.errors import PRESETS

OFF = dataclasses.replace(
    PRESETS["mpu9250-calibrated"], gyr_scale_percent=3.0, gyr_cross_percent=1.75, gyr_bias_dps=1.0
)
DEGREE = np.pi / 180
MOUNTING = tuple(qt.from_rotation_vector(np.array([0.4, -1.1, 0.7])).tolist())
NOW = "2026-05-01T12:00:00+00:00"
GOOD = Learnt(
    matrix=((1.02, 0.004, 0.0), (0.0, 0.99, -0.006), (0.001, 0.0, 1.0)),
    bias=(0.01, -0.02, 0.005),
    matrix_sigma=0.0035,
    first_sigma=0.016,
    bias_sigma=(3e-4, 4e-4, 5e-4),
    seconds=90.0,
    rest_s=3.0,
    samples=9000,
    temp_c=25.0,
)
LEVELLED = Profile(accelerometer=AccelerometerPart("still positions", NOW, tilt_deg=0.05))


@cache
def taught() -> tuple[VirtualBoard, Learnt, Profile]:
    """A board, what the filter knew after 90 s of free rotation, and the profile with that in it."""
    board = VirtualBoard("free", 100.0, OFF, 1)
    pipeline = Pipeline("imugui", correction=Correction(mounting=MOUNTING))
    rows = pipeline.step(board.rows(9000))
    known = pipeline.filter
    assert isinstance(known, Imugui)
    first, second, third = (tuple(row) for row in known.matrix.tolist())
    learnt = dataclasses.replace(
        GOOD,
        correction=pipeline.correction,
        matrix=(first, second, third),
        bias=known.bias,
        matrix_sigma=known.matrix_sigma,
        rest_s=0.01 * float(rows["rest"].sum()),
    )
    return board, learnt, LEVELLED.with_part(kept_part(learnt, date=NOW))


def test_what_is_folded_turns_every_sample_as_the_filter_did() -> None:
    rng = np.random.default_rng(1)
    before = Correction(
        gyr_bias=(0.02, -0.01, 0.03),
        gyr_matrix=((1.01, 0.002, 0.0), (0.0, 0.98, 0.01), (-0.004, 0.0, 1.03)),
        mounting=MOUNTING,
    )
    learnt = dataclasses.replace(GOOD, correction=before)
    matrix, bias = folded(learnt)
    after = dataclasses.replace(before, gyr_matrix=matrix, gyr_bias=bias)
    rows = empty_rows(SAMPLE, 50)
    rows["gyr"] = rng.normal(0.0, 2.0, (50, 3))
    turned = before.apply(rows)["gyr"] @ np.array(learnt.matrix).T - learnt.bias
    assert after.apply(rows)["gyr"] == pytest.approx(turned, abs=1e-12)


def test_a_minute_and_a_half_of_turning_is_kept_and_true() -> None:
    board, learnt, profile = taught()
    assert refusal(learnt, LEVELLED) == ""
    assert profile.gyroscope is not None
    truth = board.sensors.gyr.matrix
    left = np.array(profile.gyroscope.matrix) @ truth - np.eye(3)
    assert np.abs(truth - np.eye(3)).max() > 0.01
    assert np.abs(left).max() < 0.005
    assert np.abs(np.array(profile.gyroscope.bias) - board.sensors.gyr.bias).max() < 0.05 * DEGREE


@pytest.mark.parametrize("name", ["vqf", "imugui"])
def test_every_filter_is_better_on_what_comes_next(name: str) -> None:
    _, _, profile = taught()
    rested = Profile(gyroscope=GyroscopePart("at rest", NOW, bias=profile.correction().gyr_bias))
    again = VirtualBoard("free", 100.0, OFF, 1)
    again.rows(12000)
    rows, truth = again.rows(2000), again.truth
    errors = []
    for known in (rested, profile):
        quats = Pipeline(name, correction=known.correction()).step(rows)["quat"]
        errors.append(float(np.sqrt((qt.angle_between(quats, truth)[500:] ** 2).mean())))
    assert errors[1] < (0.7 if name == "vqf" else 0.9) * errors[0]


@pytest.mark.parametrize("motion", ["rest", "aiming"])
def test_what_was_hardly_seen_is_refused(motion: str) -> None:
    pipeline = Pipeline("imugui")
    pipeline.step(VirtualBoard(motion, 50.0, OFF, 3).rows(1500))
    known = pipeline.filter
    assert isinstance(known, Imugui)
    learnt = dataclasses.replace(GOOD, matrix_sigma=known.matrix_sigma, first_sigma=0.004)
    assert "Not seen well enough yet" in refusal(learnt, LEVELLED)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"note": "VQF has taken over for now"}, "Another filter has taken over"),
        ({"clipped": True}, "end of its range"),
        ({"seconds": 12.4}, "12 of 20 s"),
        ({"matrix_sigma": 0.0047}, "known to 0.47 %, 0.40 % is needed"),
        ({"matrix_sigma": 0.0035, "first_sigma": 0.004}, "known to 0.35 %, 0.30 % is needed"),
        ({"matrix_sigma": float("nan")}, "Not seen well enough"),
        ({"matrix_sigma": 0.0028, "first_sigma": 0.004}, "more is wrong than was expected"),
        ({"matrix": ((1.2, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))}, "No gyroscope is that far off"),
        ({"bias": (0.5, 0.0, 0.0)}, "No gyroscope is that far off"),
        ({"bias": (float("nan"), 0.0, 0.0)}, "numbers have failed"),
        ({"bias_sigma": (2e-3, 0.0, 0.0), "rest_s": 0.0}, "let the board lie still"),
    ],
)
def test_the_reason_of_a_refusal(change: dict[str, object], words: str) -> None:
    assert refusal(GOOD, LEVELLED) == ""
    assert words in refusal(dataclasses.replace(GOOD, **change), LEVELLED)


def test_the_accelerometer_comes_first() -> None:
    assert "Calibrate the accelerometer first" in refusal(GOOD, Profile())
    assert refusal(GOOD, Profile(), factory=True) == ""
    rough = Profile(accelerometer=AccelerometerPart("six faces", NOW, tilt_deg=0.8))
    assert "its 0.8 deg" in refusal(GOOD, rough)


def test_a_scale_that_is_as_well_known_stays_unless_it_is_old_elsewhere_or_wrong() -> None:
    date = datetime.fromisoformat(NOW)
    near = dataclasses.replace(GOOD, matrix=((1.001, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 0.999)))
    part = dataclasses.replace(kept_part(GOOD, date=NOW), matrix_sigma=0.003)
    profile = LEVELLED.with_part(part)
    assert "as well known: to 0.30 %" in refusal(near, profile, now=date)
    assert refusal(dataclasses.replace(near, matrix_sigma=0.0028), profile, now=date) == ""
    assert refusal(near, profile, now=date + timedelta(days=400)) == ""
    assert refusal(dataclasses.replace(near, temp_c=40.0), profile, now=date) == ""
    assert refusal(GOOD, profile, now=date) == ""  # 2 % away is no chance
    guided = dataclasses.replace(part, matrix_method="turns", matrix_sigma=float("nan"), turn_error_deg=0.2)
    assert "to 0.22 %" in refusal(near, LEVELLED.with_part(guided), now=date)


def test_the_part_says_where_it_came_from() -> None:
    part = kept_part(GOOD, date=NOW)
    assert (part.method, part.matrix_method) == (METHOD, METHOD)
    assert (part.matrix_date, part.matrix_sigma, part.matrix_temp_c) == (NOW, 0.0035, 25.0)
    assert part.sigma == GOOD.bias_sigma
    assert part.quality == "usable"


def test_a_fresh_bias_at_rest_that_is_better_stays_with_its_date() -> None:
    at_rest = GyroscopePart(
        "at rest", "2026-05-01T11:50:00+00:00", 24.0, 800, "good", "still", (0.1, 0.0, 0.0), (1e-5,) * 3
    )
    part = kept_part(GOOD, at_rest, NOW)
    assert (part.bias, part.date, part.method, part.sigma) == (at_rest.bias, at_rest.date, "at rest", at_rest.sigma)
    assert part.matrix == folded(GOOD)[0]
    assert part.matrix_date == NOW


@pytest.mark.parametrize(
    "change",
    [{"date": "2026-04-20T12:00:00+00:00"}, {"temp_c": 35.0}, {"sigma": (9e-4, 9e-4, 9e-4)}],
)
def test_an_older_warmer_or_worse_bias_gives_way(change: dict[str, object]) -> None:
    at_rest = GyroscopePart("at rest", "2026-05-01T11:50:00+00:00", 24.0, 800, "good", "", (0.1, 0.0, 0.0), (1e-5,) * 3)
    part = kept_part(GOOD, dataclasses.replace(at_rest, **change), NOW)
    assert part.bias == folded(GOOD)[1]
    assert part.date == NOW


def test_a_bias_that_was_not_learnt_well_leaves_even_an_old_one() -> None:
    unsure = dataclasses.replace(GOOD, rest_s=0.0, bias_sigma=(2e-3, 2e-3, 2e-3))
    old = GyroscopePart("at rest", "2026-04-01T12:00:00+00:00", bias=(0.1, 0.0, 0.0))
    assert refusal(unsure, LEVELLED.with_part(old)) == ""
    assert kept_part(unsure, old, NOW).bias == old.bias


def test_scale_and_bias_age_by_themselves() -> None:
    now = datetime.now(UTC)
    part = dataclasses.replace(kept_part(GOOD, date=now_utc()), matrix_date=(now - timedelta(days=380)).isoformat())
    (warning,) = Profile(gyroscope=part).warnings(now)
    assert warning == "The gyroscope's scale calibration is 380 days old; 365 is its life."
    fresh = Profile(gyroscope=kept_part(GOOD, date=now_utc()))
    assert fresh.warnings(now) == []
    assert fresh.good_until == fresh.gyroscope.when() + timedelta(days=30)  # type: ignore[union-attr]


@pytest.mark.parametrize(
    ("gyr", "clipped"),
    [
        ([(4.0, 0.1, 0.2), (4.36, 0.2, 0.1), (4.36, 0.3, 0.0)], True),
        ([(4.0, 0.1, 0.2), (4.36, 0.2, 0.1), (4.2, 0.3, 0.0)], False),
        ([(4.36, 0.1, 0.2), (4.36, 0.1, 0.2), (4.2, 0.3, 0.0)], False),  # the same sample twice
        ([(2.0, 0.1, 0.2), (2.0, 0.2, 0.1), (1.0, 0.3, 0.0)], False),  # slow
        ([(4.36, 0.1, 0.2), (4.36, 0.2, 0.1), (float("nan"), 0.3, 0.0)], True),
    ],
)
def test_clipping(gyr: list[tuple[float, float, float]], clipped: bool) -> None:
    rows = empty_rows(SAMPLE, 3)
    rows["gyr"], rows["acc"] = gyr, (0.0, 0.0, 9.8)
    watch = Clipping()
    watch.feed(rows)
    watch.feed(rows[:0])
    assert watch.seen is clipped
