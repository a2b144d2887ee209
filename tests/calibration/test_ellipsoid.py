"""Each fit on clouds whose truth is known."""

from __future__ import annotations

import numpy as np
import pytest

from imugui.calibration import ellipsoid
from imugui.calibration.coverage import fibonacci
from imugui.calibration.ellipsoid import METHODS, Ellipsoid, Floats
from imugui.calibration.geometric import Prior, covariance, direction_error_deg, linearise, moved, tukey, with_prior

BIAS = np.array([31.0, -12.0, 55.0])
SOFT = np.array([[1.08, 0.03, -0.02], [0.03, 0.95, 0.04], [-0.02, 0.04, 0.97]])
FIELD = 48.0


def cloud(soft: Floats, count: int = 400, noise: float = 0.0, seed: int = 1) -> Floats:
    """Raw points all over the ellipsoid."""
    points = FIELD * fibonacci(count) @ soft.T + BIAS
    return points + noise * np.random.default_rng(seed).normal(size=points.shape)


@pytest.mark.parametrize(
    ("name", "soft"),
    [
        ("sphere", np.eye(3)),
        ("robust sphere", np.eye(3)),
        ("axis ellipsoid", np.diag([1.2, 0.9, 1.0])),
        ("full ellipsoid", SOFT),
    ],
)
def test_a_closed_fit_is_exact_on_its_own_shape(name: str, soft: Floats) -> None:
    fit = METHODS[name](cloud(soft))
    assert fit is not None
    np.testing.assert_allclose(fit.bias, BIAS, atol=1e-6)
    assert fit.residual(cloud(soft)) < 1e-8
    assert np.trace(fit.matrix) == pytest.approx(3.0)


def test_min_max_finds_the_middle_of_each_axis() -> None:
    fit = ellipsoid.min_max([[-1.0, 2.0, 3.0], [3.0, 4.0, 9.0], [0.0, 3.0, 4.0]])
    np.testing.assert_allclose(fit.bias, (1.0, 3.0, 6.0))
    np.testing.assert_allclose(np.diag(fit.matrix) * (2.0, 1.0, 3.0), fit.radius)


def test_what_is_no_ellipsoid_has_no_fit() -> None:
    turn, up = np.meshgrid(np.linspace(0, 6, 20), np.linspace(-1, 1, 10))
    waist = np.sqrt(1 + up**2)
    hyperboloid = np.stack((waist * np.cos(turn), waist * np.sin(turn), up), axis=-1).reshape(-1, 3)
    assert ellipsoid.axis_aligned(hyperboloid) is None


def test_the_weighted_fit_leaves_outliers_out() -> None:
    points = cloud(SOFT, noise=0.2)
    points[::50] += 40.0
    found = tukey(points)
    plain = ellipsoid.li_griffiths(points)
    assert found is not None
    assert plain is not None
    assert np.linalg.norm(found.bias - BIAS) < 0.1
    assert np.linalg.norm(plain.bias - BIAS) > 1.0
    np.testing.assert_allclose(
        found.matrix / np.trace(found.matrix), np.linalg.inv(SOFT) / np.trace(np.linalg.inv(SOFT)), atol=2e-3
    )


def test_derivatives_are_those_of_the_distances() -> None:
    fit = Ellipsoid(BIAS + 1.0, np.linalg.inv(SOFT), 47.0, "")
    points = cloud(SOFT, 30)
    distances, design = linearise(fit, points)
    for k in range(9):
        changed = moved(fit, 1e-6 * np.eye(9)[k])
        assert changed is not None
        np.testing.assert_allclose((changed.distances(points) - distances) / 1e-6, design[:, k], atol=1e-3)


def test_a_step_to_no_ellipsoid_is_not_taken() -> None:
    fit = Ellipsoid(BIAS, np.eye(3), 48.0, "")
    assert moved(fit, np.array([0, 0, 0, 2.0, 0, 0, 0, 0, 0])) is None
    assert moved(fit, np.array([0, 0, 0, 0, 0, 0, 0, 0, -50.0])) is None


def test_a_flat_ring_keeps_the_prior_and_does_not_run_away() -> None:
    t = np.linspace(0, 2 * np.pi, 300)
    ring = np.column_stack((40 * np.cos(t), 40 * np.sin(t), 0.3 * np.random.default_rng(2).normal(size=300))) + BIAS
    fit = with_prior(ring, Prior(field=FIELD, effective=20))
    assert fit.axis_ratio < 1.8
    assert 20 < fit.radius < 100


def test_the_predicted_error_is_the_one_that_occurs() -> None:
    """On full spheres with the model's own noise, one sample per cell."""
    noise = 0.01 * FIELD
    errors, predicted = [], []
    for seed in range(30):
        points = cloud(np.eye(3), 100, noise, seed)
        fit = with_prior(points, Prior(effective=100))
        spread_of = covariance(fit, points, np.arange(100), Prior())
        predicted.append(direction_error_deg(fit, spread_of, fibonacci(100)))
        found = fit.apply(cloud(np.eye(3), 100))
        cosine = (found * fibonacci(100)).sum(axis=1) / np.linalg.norm(found, axis=1)
        errors.append(np.degrees(np.arccos(np.clip(cosine, -1, 1))) ** 2)
    assert np.mean(predicted) == pytest.approx(np.sqrt(np.mean(errors)), rel=0.25)
