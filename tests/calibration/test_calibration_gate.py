"""The gate: what it accepts, what it refuses, and the cause it tells."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from imugui.calibration.coverage import fibonacci
from imugui.calibration.gate import LIGHTS, heading_error_deg, judge, plausible

BENCHMARK = Path(__file__).resolve().parents[2] / "benchmarks" / "calibration_gate.py"
FIELD = 48.0


@pytest.fixture(scope="module")
def bench() -> ModuleType:
    """benchmarks/calibration_gate.py, which makes the clouds."""
    spec = importlib.util.spec_from_file_location("calibration_gate_benchmark", BENCHMARK)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


def full(count: int = 500, noise: float = 0.2, seed: int = 0) -> np.ndarray:
    points = FIELD * fibonacci(count) + (10.0, -30.0, 20.0)
    return points + noise * np.random.default_rng(seed).normal(size=points.shape)


@pytest.mark.parametrize("with_field", [False, True])
def test_no_bad_fit_passes_and_few_good_ones_are_refused(bench: ModuleType, with_field: bool) -> None:
    found = bench.summary(5, with_field, seed=1000)
    assert found["bad"] > 20
    assert found["bad_accepted"] == 0
    assert found["good_refused_share"] <= 0.25


@pytest.mark.parametrize("run", range(5))
def test_a_full_sphere_with_noise_and_outliers_is_right_to_a_tenth_of_a_degree(bench: ModuleType, run: int) -> None:
    made = bench.cloud("full, 2 % outliers", 0.05, run)
    verdict = judge(made.points)
    assert verdict.light == "green"
    assert verdict.word == "clean"
    assert verdict.fit is not None
    assert bench.direction_error_deg(verdict.fit, made) <= 0.1
    assert 0.01 < verdict.outliers < 0.04


def test_the_residual_alone_would_let_bad_fits_pass(bench: ModuleType) -> None:
    """Why the gate is not the residual."""
    found = [(v, error) for _, v, error in bench.trials(2, False) if v.fit is not None and error > 5.0]
    assert sum(v.residual < 0.02 for v, _ in found) > len(found) / 2
    assert not any(v.accepted for v, _ in found)


def test_a_good_verdict_tells_degrees() -> None:
    verdict = judge(full(), FIELD, 65.0)
    assert verdict.accepted
    assert "°" in verdict.sentence
    assert verdict.sentence.startswith("Clean")
    assert verdict.reasons == ()
    assert 0.0 < verdict.error_deg < 0.5
    assert verdict.coverage == 1.0
    assert verdict.gap_deg < 15
    assert verdict.planarity > 0.9


def test_held_still() -> None:
    points = np.array([20.0, 5.0, -40.0]) + 0.3 * np.random.default_rng(0).normal(size=(500, 3))
    assert "held still" in judge(points).sentence


def test_turned_about_one_axis_only() -> None:
    t = np.linspace(0, 6 * np.pi, 500)
    ring = np.column_stack((20 * np.cos(t), np.full(500, 40.0), 20 * np.sin(t)))
    ring += 0.3 * np.random.default_rng(0).normal(size=(500, 3))
    assert "one axis only (y)" in judge(ring).sentence


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_a_stuck_axis(axis: int) -> None:
    points = full()
    points[:, axis] = 12.3
    verdict = judge(points)
    assert f"{'xyz'[axis]} axis is stuck" in verdict.sentence
    assert not verdict.accepted


def test_beside_a_magnet_the_field_is_too_strong_or_uneven() -> None:
    strong = judge(4.0 * full())
    assert "magnet" in strong.sentence
    assert strong.word == "contaminated"
    uneven = full() * (1.0 + 0.12 * np.sin(np.arange(500) / 20.0))[:, None]
    verdict = judge(uneven)
    assert not verdict.accepted
    assert verdict.word == "contaminated"
    assert "magnet" in " ".join(verdict.reasons)


def test_two_fields_mixed_are_contaminated() -> None:
    points = full(600)
    points[::3] += (15.0, 0.0, 0.0)
    verdict = judge(points)
    assert not verdict.accepted
    assert verdict.word == "contaminated"


def test_too_little_coverage() -> None:
    points = full(2000)
    verdict = judge(points[points[:, 2] > 20.0 + 0.6 * FIELD])
    assert not verdict.accepted
    assert "go on turning" in " ".join(verdict.reasons)
    assert verdict.word != "contaminated"


def test_an_expected_field_decides_what_is_plausible() -> None:
    assert plausible(48.0, None)
    assert not plausible(90.0, None)
    assert not plausible(20.0, 48.0)
    assert judge(full(), 120.0).light == "red"


def test_heading_error_grows_with_the_dip() -> None:
    level, steep = heading_error_deg(1.0, 0.01, 0.0), heading_error_deg(1.0, 0.01, 65.0)
    assert level == pytest.approx(np.hypot(1 / np.sqrt(2), 0.573), abs=1e-3)
    assert steep == pytest.approx(level / np.cos(np.radians(65)))
    assert heading_error_deg(90.0, 1.0, 90.0) == 180.0


@pytest.mark.parametrize("count", [0, 1, 5, 11])
def test_a_few_samples_are_no_cloud(count: int) -> None:
    verdict = judge(full()[:count])
    assert not verdict.accepted
    assert verdict.light in LIGHTS
    assert "too few" in verdict.sentence


def test_many_equal_samples_are_refused() -> None:
    assert not judge(np.full((50, 3), 7.0)).accepted
