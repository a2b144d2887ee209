"""Bias against temperature: as much of a curve as the data support (calibration-position.md 2.3)."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from imugui.calibration.temperature import TemperatureFlow, temperature_fit
from imugui.samples import GRAVITY, Rows

DEGREE = np.pi / 180


def points(low: float, high: float, kind: str, seed: int = 0) -> np.ndarray:
    """Bias points while a board warms from ``low`` to ``high``: linear 0.065 deg/s/K, curved, or erratic."""
    rng = np.random.default_rng(seed)
    temperature = np.linspace(low, high, 120)
    d = temperature - 25
    bias = {
        "linear": 0.065 * d,
        "curved": 0.02 * d + 0.003 * d**2,
        "erratic": np.cumsum(rng.normal(size=120)) * 0.1,
    }[kind]
    noisy = bias[:, None] * [1.0, -0.5, 0.2] + 0.5 + rng.normal(size=(120, 3)) * 0.005
    return np.column_stack((temperature, noisy * DEGREE))


@pytest.mark.parametrize(
    ("low", "high", "kind", "order"),
    [(24, 27, "linear", 0), (22, 32, "linear", 1), (18, 38, "linear", 1), (18, 38, "curved", 2), (22, 29, "curved", 1)],
)
def test_the_order_follows_the_span_and_the_data(low: float, high: float, kind: str, order: int) -> None:
    result = temperature_fit(points(low, high, kind))
    assert result.model is not None
    assert result.model.order == order
    assert result.accepted == (order > 0), result.reason


@pytest.mark.parametrize(("kind", "limit"), [("linear", 0.02), ("curved", 0.03)])
def test_the_bias_is_predicted_inside_the_range(kind: str, limit: float) -> None:
    model = temperature_fit(points(18, 38, kind)).model
    assert model is not None
    for temp_c in (19, 25, 37):
        exact = 0.065 * (temp_c - 25) if kind == "linear" else 0.02 * (temp_c - 25) + 0.003 * (temp_c - 25) ** 2
        assert model.bias(temp_c)[0] / DEGREE == pytest.approx(exact + 0.5, abs=limit)


def test_outside_the_range_it_stays_at_the_edge() -> None:
    model = temperature_fit(points(18, 38, "curved")).model
    assert model is not None
    assert model.bias(60.0) == pytest.approx(model.bias(38.0))
    assert model.bias(-10.0) == pytest.approx(model.bias(18.0))


@pytest.mark.parametrize("seed", range(4))
def test_an_erratic_bias_is_said_not_to_fit(seed: int) -> None:
    result = temperature_fit(points(18, 38, "erratic", seed))
    assert not result.accepted
    assert "does not follow" in result.reason


def test_the_real_static_file_spans_too_little(load_real: Callable[[str], Rows]) -> None:
    flow = TemperatureFlow()
    for part in np.array_split(load_real("static"), 40):
        flow.feed(part)
    assert not flow.done
    result = flow.result()
    assert not result.accepted
    assert result.span_k < 1.0
    assert result.samples > 50_000
    assert "taken as constant" in result.reason


def test_the_flow_sees_a_board_warm_up(make_rows: Callable[..., Rows]) -> None:
    rng = np.random.default_rng(2)
    t = np.arange(0, 200, 0.02)
    warm = 20 + 12 * t / 200
    gyr = (0.05 * (warm - 20))[:, None] * DEGREE + rng.normal(size=(len(t), 3)) * 0.05 * DEGREE
    rows = make_rows(t, gyr, [0, 0, GRAVITY] + rng.normal(size=(len(t), 3)) * 0.02)
    rows["temp_c"] = warm
    flow = TemperatureFlow()
    assert flow.missing
    for part in np.array_split(rows, 50):
        flow.feed(part)
    result = flow.result()
    assert result.accepted, result.reason
    assert result.model is not None
    assert np.array(result.model.coefficients[1]) / DEGREE == pytest.approx([0.05] * 3, abs=0.005)


def test_without_a_thermometer_there_is_nothing_to_say(make_rows: Callable[..., Rows]) -> None:
    flow = TemperatureFlow()
    rng = np.random.default_rng(2)
    noise = rng.normal(size=(2, 400, 3)) * 0.001
    flow.feed(make_rows(np.arange(400) / 100, noise[0], [0, 0, GRAVITY] + noise[1]))
    assert flow.result().reason == "No temperature came while the board lay still."
