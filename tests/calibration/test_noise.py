"""Allan deviation against published values, and the figures read off it against the reference's."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from imugui.calibration.noise import NoiseFlow, allan_deviation, noise_of, sensor_noise
from imugui.samples import Rows

NBS14 = np.array([892, 809, 823, 798, 671, 644, 883, 903, 677], float)[:, None]


def test_nbs14() -> None:
    found = allan_deviation(NBS14, np.array([1, 2, 5]))[:, 0]
    assert found[:2] == pytest.approx([91.22945, 85.95287], rel=1e-6)
    assert np.isnan(found[2])


def test_the_thousand_points() -> None:
    x, values = 1234567890, []
    for _ in range(1000):
        values.append(x / (2**31 - 1))
        x = 16807 * x % (2**31 - 1)
    found = allan_deviation(np.array(values)[:, None], np.array([1, 10, 100]))[:, 0]
    assert found == pytest.approx([0.2922319, 0.09159953, 0.03241343], rel=1e-6)


def test_ten_minutes_of_an_mpu6050(load_real: Callable[[str], Rows]) -> None:
    result = noise_of(load_real("static"))
    assert result.accepted
    assert result.rate_hz == pytest.approx(99.3, abs=0.1)
    assert result.gyr is not None
    assert result.acc is not None
    assert result.gyr.white == pytest.approx([0.0127, 0.0091, 0.0095], rel=0.1)
    assert result.acc.white == pytest.approx([0.31, 0.31, 0.49], rel=0.1)
    assert result.gyr.is_white
    assert result.gyr.instability[0] == pytest.approx(0.004, abs=0.0015)
    assert 34 <= result.acc.instability_tau[0] <= 131
    assert result.gyr.tau[-1] <= 131.2  # a fifth of the record


def test_white_noise_reads_as_white() -> None:
    values = np.random.default_rng(3).normal(size=(60_000, 3))
    found = sensor_noise(values, 100.0)
    assert found.white == pytest.approx([0.1, 0.1, 0.1], rel=0.05)
    assert found.slope == pytest.approx([-0.5, -0.5, -0.5], abs=0.05)
    assert found.is_white
    assert np.isnan(found.walk).all()


def test_a_random_walk_shows_k_and_is_not_called_white() -> None:
    rng = np.random.default_rng(4)
    values = np.cumsum(rng.normal(size=(60_000, 3)), axis=0) * 0.1
    found = sensor_noise(values, 100.0)
    assert not found.is_white
    assert found.walk == pytest.approx([1.0, 1.0, 1.0], rel=0.3)  # 0.1 a sample at 100 Hz is 1 per root second


def test_a_falling_curve_shows_no_bias_instability() -> None:
    blue = np.diff(np.random.default_rng(6).normal(size=(60_001, 3)), axis=0)
    assert np.isnan(sensor_noise(blue, 100.0).instability).any()


@pytest.mark.parametrize("values", [np.ones((6000, 3)), np.tile([[1.0], [-1.0]], (3000, 3))])
def test_what_never_changes_or_only_flips_has_no_made_up_figures(values: np.ndarray) -> None:
    found = sensor_noise(values, 100.0)
    assert not found.is_white
    assert np.isnan(found.walk).all()


def test_too_short_a_rest_is_refused(load_real: Callable[[str], Rows]) -> None:
    flow = NoiseFlow()
    flow.feed(load_real("static")[:3000])
    assert not flow.done
    assert 0.4 < flow.progress < 0.6
    assert not flow.result().accepted
    assert "60 s are needed" in flow.result().reason
