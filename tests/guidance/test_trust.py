"""Trust: what takes it away, in which words, and the error it expects."""

from __future__ import annotations

import math
from dataclasses import replace
from datetime import UTC, datetime, timedelta

import numpy as np
import pytest

from imugui.calibration.learnt import METHOD
from imugui.calibration.parts import AccelerometerPart, GyroscopePart, MagnetometerPart, NoisePart
from imugui.calibration.profile import Board, Profile
from imugui.fusion.quaternion import conjugate, from_rotation_vector, multiply, to_rotation_vector
from imugui.guidance.facts import Facts
from imugui.guidance.registration import from_axes, from_mark
from imugui.guidance.sigma import COVER, axis_sigma, seconds_left
from imugui.guidance.trust import LIMITS, judge
from imugui.guidance.trust_profile import (
    DRIFT_DEG_S,
    RAW_TURN_SHARE,
    TILT_DEG,
    TURN_SHARE,
    WARM_SHARE,
    profile_facts,
)
from imugui.guidance.turning import Turning

NOW = datetime(2026, 5, 1, 12, 0, tzinfo=UTC)
DOWN, NORTH = (0.0, 0.0, -1.0), (0.0, 1.0, 0.0)
DEGREE = math.pi / 180

GOOD = Facts(
    now=100.0,
    arrival=99.98,
    streaming=True,
    registration=from_axes(DOWN, NORTH),
    registered_at=70.0,
    side_confirmed=True,
    calibrated=True,
    base_tilt=0.2 * DEGREE,
    drift=0.01 * DEGREE,
    turn_share=0.002,
    turning=1.0,
    tilt_from_vertical=30 * DEGREE,
)

WRONG = {
    "not streaming": ({"streaming": False}, "No board is sending"),
    "late": ({"arrival": 99.85}, "150 ms old"),
    "never": ({"arrival": math.nan}, "No attitude has come"),
    "in the future": ({"arrival": 101.0}, "No attitude has come"),
    "plan": ({"plan_problem": "Axial is 95."}, "Axial is 95."),
    "no registration": ({"registration": None}, "no registration"),
    "begun anew": ({"epoch_same": False}, "begun anew"),
    "lost": ({"epoch_words": "Samples are missing."}, "Samples are missing."),
    "side": ({"side_confirmed": False}, "side is not confirmed"),
    "not calibrated": ({"calibrated": False}, "not calibrated"),
    "expired": ({"profile_expired": True, "profile_warning": "It is 400 days old."}, "400 days old. Calibrate again"),
    "field": ({"use_mag": True, "mag_disturbed": True, "base_heading": 0.01}, "magnetic field is disturbed"),
    "shaken": ({"shaken": True}, "pushed or shaken"),
    "heading": ({"registered_at": -200.0}, "heading has aged: register again"),
    "turned": ({"turning": 40.0}, "heading has aged: register again"),
    "tilt": ({"base_tilt": 2 * DEGREE}, "Calibrate the accelerometer"),
    "residual": ({"registration": from_axes(DOWN, (0.0, 1.0, 0.08))}, "Register again, more exactly"),
    "unknown": ({"base_tilt": math.nan}, "not known"),
    "no heading": ({"use_mag": True}, "not known"),
}


def test_what_is_good_is_trusted() -> None:
    trust = judge(GOOD)
    assert trust.ok
    assert trust.reasons == ()
    assert not trust.blank
    assert trust.age_s == pytest.approx(0.02)
    assert trust.heading_age_s == 30.0
    assert 0.0 < trust.sigma < LIMITS.sigma


@pytest.mark.parametrize("name", WRONG)
def test_each_single_fault_is_named_alone(name: str) -> None:
    changes, words = WRONG[name]
    trust = judge(replace(GOOD, **changes))
    assert not trust.ok
    assert len(trust.reasons) == 1, trust.reasons
    assert words in trust.reasons[0]


def test_nothing_known_is_nothing_trusted() -> None:
    trust = judge(Facts())
    assert not trust.ok
    assert trust.blank
    assert trust.reasons[0].startswith("No board")
    assert math.isnan(trust.sigma)


def test_a_disturbed_field_does_not_matter_without_the_magnetometer() -> None:
    assert judge(replace(GOOD, mag_disturbed=True)).ok


@pytest.mark.parametrize(("age", "ok", "blank"), [(0.1, True, False), (0.101, False, False), (0.201, False, True)])
def test_old_samples_lose_trust_first_and_then_their_numbers(age: float, ok: bool, blank: bool) -> None:
    trust = judge(replace(GOOD, now=0.0, arrival=-age, registered_at=-1.0))
    assert (trust.ok, trust.blank) == (ok, blank)


def test_a_sample_stamped_while_the_clock_was_read_is_fresh() -> None:
    assert judge(replace(GOOD, arrival=100.01)).age_s == 0.0


# formula B.4: heading error 5 degrees at tilts 10 to 90 degrees
@pytest.mark.parametrize(("tilt", "error"), [(10, 0.87), (20, 1.71), (30, 2.50), (45, 3.54), (90, 5.0)])
def test_a_heading_error_counts_with_the_sine_of_the_tilt(tilt: float, error: float) -> None:
    facts = replace(GOOD, base_tilt=0.0, turning=0.0, drift=5 * DEGREE / 30.0, tilt_from_vertical=tilt * DEGREE)
    assert axis_sigma(facts) / COVER / DEGREE == pytest.approx(error, abs=0.005)


def test_parts_add_as_squares() -> None:
    facts = replace(GOOD, sigma_tilt=0.1 * DEGREE, axis_error=0.3 * DEGREE)
    heading = math.hypot(0.01 * 30.0, 0.002 / DEGREE)
    parts = (0.2, 0.1, 0.2, 0.3, 0.5 * heading)
    assert axis_sigma(facts) / DEGREE == pytest.approx(COVER * math.hypot(*parts), rel=1e-9)


def test_gravity_with_a_mark_has_no_tilt_error_of_its_own() -> None:
    mark = replace(GOOD, registration=from_mark(NORTH), turning=0.0, drift=0.0)
    assert axis_sigma(mark) / DEGREE == pytest.approx(COVER * 0.2 * math.sqrt(1.5), rel=1e-9)


def test_with_the_magnetometer_the_heading_does_not_age() -> None:
    facts = replace(GOOD, use_mag=True, base_heading=1.0 * DEGREE, registered_at=-9000.0)
    assert judge(facts).ok
    assert judge(facts).reference_due_s == math.inf
    assert axis_sigma(replace(facts, sigma_heading=0.0)) < axis_sigma(facts)


def test_an_unknown_lean_counts_as_the_worst() -> None:
    level = axis_sigma(replace(GOOD, tilt_from_vertical=math.pi / 2))
    assert axis_sigma(replace(GOOD, tilt_from_vertical=math.nan)) == level


def test_the_time_left_is_when_sigma_reaches_its_limit() -> None:
    left = seconds_left(GOOD, LIMITS.sigma)
    assert 10.0 < left < 1000.0
    assert axis_sigma(replace(GOOD, now=GOOD.now + left)) == pytest.approx(LIMITS.sigma, rel=1e-9)
    assert seconds_left(replace(GOOD, now=GOOD.now + left + 1.0), LIMITS.sigma) == 0.0
    assert seconds_left(replace(GOOD, tilt_from_vertical=0.0), LIMITS.sigma) == math.inf
    assert math.isnan(seconds_left(replace(GOOD, registration=None), LIMITS.sigma))


def test_nine_of_ten_errors_of_two_components_lie_within_cover() -> None:
    errors = np.random.default_rng(1).normal(size=(200_000, 2))
    radius = np.hypot(errors[:, 0], errors[:, 1])
    assert np.mean(radius < COVER * np.sqrt(np.mean(radius**2))) == pytest.approx(0.9, abs=0.003)


# turning


def spun(axis: np.ndarray, angles: np.ndarray) -> np.ndarray:
    return from_rotation_vector(angles[:, None] * axis)


def test_turning_to_and_fro_costs_nothing_and_turning_on_costs_all() -> None:
    turning = Turning()
    turning.step(spun(np.array((0.0, 0.0, 1.0)), np.linspace(0.0, 4 * math.pi, 200)))
    assert turning.size == pytest.approx(4 * math.pi)
    turning.step(spun(np.array((0.0, 0.0, 1.0)), np.linspace(4 * math.pi, 0.0, 200)))
    assert turning.size == pytest.approx(0.0, abs=1e-9)


def test_tilting_does_not_turn_the_heading() -> None:
    turning = Turning()
    turning.step(spun(np.array((1.0, 0.0, 0.0)), np.linspace(0.0, 3.0, 400)))
    # the axis is level all the time: what it costs is what a cross-axis term turns about the vertical
    assert turning.size < math.hypot(2.0, math.sin(3.0)) + 0.05


def test_the_blocks_do_not_matter() -> None:
    quats = spun(np.array((0.6, 0.0, 0.8)), np.linspace(0.0, 9.0, 300))
    whole, cut = Turning(), Turning()
    whole.step(quats)
    for part in np.array_split(quats, 17):
        cut.step(part)
    assert cut.size == pytest.approx(whole.size, rel=1e-12)


def test_turning_predicts_the_heading_error_of_wrong_scales() -> None:
    """A gyroscope with random scale and cross-axis errors is integrated along a random course."""
    rng = np.random.default_rng(3)
    rates = np.cumsum(rng.normal(size=(300, 3)), axis=0) * 0.002
    true = [np.array((1.0, 0.0, 0.0, 0.0))]
    for rate in rates:
        true.append(multiply(true[-1], from_rotation_vector(rate)))
    course = np.array(true)
    turning = Turning()
    turning.step(course)
    share = 1e-4
    errors = []
    for _ in range(400):
        read = rates @ (np.eye(3) + share * rng.normal(size=(3, 3))).T
        off = multiply(multiply(course[:-1], from_rotation_vector(read)), conjugate(course[1:]))
        errors.append(float(to_rotation_vector(off)[:, 2].sum()))
    assert np.std(errors) == pytest.approx(share * turning.size, rel=0.15)


# what a profile is worth


def profile(days: float = 1.0, **parts: object) -> Profile:
    date = (NOW - timedelta(days=days)).isoformat()
    kept = {
        "gyroscope": GyroscopePart("at rest", date, 25.0),
        "accelerometer": AccelerometerPart("many", date, 25.0, tilt_deg=0.1),
        **parts,
    }
    return Profile(Board("serial", "A1", "bench board"), **kept)  # type: ignore[arg-type]


def test_a_profile_gives_figures_and_words() -> None:
    found = profile_facts(profile(), NOW, use_mag=False, temp_c=26.0)
    assert found["calibrated"]
    assert not found["profile_expired"]
    assert found["profile_words"].startswith("bench board, calibrated 2026-04-30")
    assert found["base_tilt"] == pytest.approx(math.hypot(TILT_DEG, 0.1) * DEGREE)
    assert found["drift"] == pytest.approx(DRIFT_DEG_S * DEGREE)
    assert found["turn_share"] == RAW_TURN_SHARE
    assert Facts(now=0.0, **found).temp_c == 26.0


def test_without_a_profile_nothing_is_calibrated_unless_the_factory_did() -> None:
    nothing = profile_facts(None, NOW, use_mag=False)
    assert not nothing["calibrated"]
    assert nothing["base_tilt"] > 2 * DEGREE
    factory = profile_facts(None, NOW, use_mag=False, factory=True)
    assert factory["calibrated"]
    assert factory["base_tilt"] == pytest.approx(TILT_DEG * DEGREE)
    assert factory["turn_share"] == TURN_SHARE


def test_a_gyroscope_matrix_and_a_noise_part_are_used() -> None:
    date = NOW.isoformat()
    turned = GyroscopePart("at rest", date, 25.0, matrix_method="turns", turn_error_deg=0.9)
    noise = NoisePart("allan", date, gyr_instability=(0.001, 0.02, 0.003))
    found = profile_facts(profile(gyroscope=turned, noise=noise), NOW, use_mag=False)
    assert found["turn_share"] == pytest.approx(math.hypot(TURN_SHARE, 0.01))
    assert found["drift"] == pytest.approx(math.hypot(DRIFT_DEG_S, 0.02) * DEGREE)


def test_a_learnt_matrix_carries_its_own_sigma_and_grows_with_the_distance_in_temperature() -> None:
    date, later = (NOW - timedelta(hours=2)).isoformat(), NOW.isoformat()
    facts = {"matrix_method": METHOD, "matrix_sigma": 0.003, "matrix_date": later, "matrix_temp_c": 25.0}
    learnt = GyroscopePart("at rest", date, 25.0, **facts)  # type: ignore[arg-type]
    here = profile_facts(profile(gyroscope=learnt), NOW, use_mag=False, temp_c=25.0)
    assert here["turn_share"] == pytest.approx(0.003)
    assert here["profile_words"].endswith(f"calibrated {later}")  # other words: other corrections
    warm = profile_facts(profile(gyroscope=learnt), NOW, use_mag=False, temp_c=34.0)
    assert warm["turn_share"] == pytest.approx(math.hypot(0.003, 9.0 * WARM_SHARE))
    assert not warm["profile_expired"]
    unknown = profile_facts(profile(gyroscope=learnt), NOW, use_mag=False)
    assert 0.003 < unknown["turn_share"] < warm["turn_share"] < RAW_TURN_SHARE
    hot = profile_facts(profile(gyroscope=learnt), NOW, use_mag=False, temp_c=200.0)
    assert hot["turn_share"] == RAW_TURN_SHARE


@pytest.mark.parametrize(
    ("days", "temp_c", "words"), [(40.0, 25.0, "gyroscope"), (400.0, 25.0, "400 days"), (1.0, 60.0, "35 K")]
)
def test_an_old_or_warm_profile_says_why(days: float, temp_c: float, words: str) -> None:
    found = profile_facts(profile(days), NOW, use_mag=False, temp_c=temp_c)
    assert found["profile_expired"]
    assert words in found["profile_warning"]
    assert not judge(replace(GOOD, **{k: found[k] for k in ("profile_expired", "profile_warning")})).ok


def test_an_old_magnetometer_part_matters_only_when_it_is_used() -> None:
    old = (NOW - timedelta(days=99)).isoformat()
    mag = MagnetometerPart("ellipsoid", old, predicted_deg=0.5, dip_deg=65.0)
    assert not profile_facts(profile(magnetometer=mag), NOW, use_mag=False)["profile_expired"]
    assert "magnetometer" in profile_facts(profile(magnetometer=mag), NOW, use_mag=True)["profile_warning"]
