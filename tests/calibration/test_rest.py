"""The gyroscope's bias is taken from boards at rest, and from no others."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from imugui.calibration.rest import RestFlow, auto_bias
from imugui.calibration.stillness import resolution, still_spans
from imugui.samples import GRAVITY, Rows
from imugui.simulation.board import VirtualBoard
from imugui.simulation.errors import PRESETS

DEGREE = np.pi / 180
LEVEL = np.array([0.0, 0.0, GRAVITY])


def noisy(n: int, seed: int = 0, dps: float = 0.1) -> tuple[np.ndarray, np.ndarray]:
    """Rates and forces of a board at rest with ordinary noise."""
    rng = np.random.default_rng(seed)
    return rng.normal(size=(n, 3)) * dps * DEGREE, LEVEL + rng.normal(size=(n, 3)) * 0.03


@pytest.mark.parametrize("seed", range(8))
def test_the_bias_of_a_datasheet_board_is_found(seed: int) -> None:
    board = VirtualBoard("rest", 100.0, PRESETS["mpu9250"], seed)
    flow = RestFlow()
    while not flow.done:
        flow.feed(board.rows(12))
        assert board.count < 1500
    error = np.array(flow.result().bias) - board.sensors.gyr.bias
    assert np.abs(error).max() <= 0.02 * DEGREE
    assert flow.result().seconds >= 1.99
    assert flow.progress == 1.0


def test_it_is_not_done_before_two_seconds() -> None:
    board = VirtualBoard("rest", 100.0, PRESETS["mpu9250"], 1)
    flow = RestFlow()
    flow.feed(board.rows(190))
    assert not flow.done
    assert not flow.result().accepted
    assert 0.0 < flow.progress < 1.0


@pytest.mark.parametrize("name", ["startup1", "startup3"])
def test_boards_in_the_hand_are_refused_with_the_reason(name: str, load_real: Callable[[str], Rows]) -> None:
    result = auto_bias(load_real(name))
    assert not result.accepted
    assert "handled" in result.reason
    assert result.bias == (0.0, 0.0, 0.0)


def test_a_handled_board_stays_refused_however_long_it_is_handled(load_real: Callable[[str], Rows]) -> None:
    rows = load_real("startup1")
    flow = RestFlow()
    for k in range(10):
        later = rows.copy()
        later["t"] += k * (rows["t"][-1] + 1 / 140)
        flow.feed(later)
    assert not flow.done
    assert "handled" in flow.result().reason
    assert flow.missing == (flow.result().reason,)


@pytest.mark.parametrize(("name", "seconds"), [("mpu6050", 36.0), ("xsens", 50.0), ("static", 650.0)])
def test_real_boards_at_rest_are_accepted(name: str, seconds: float, load_real: Callable[[str], Rows]) -> None:
    result = auto_bias(load_real(name))
    assert result.accepted, result.reason
    assert result.seconds >= seconds
    assert result.sigma_dps < 0.01


def test_the_still_part_of_a_session_is_found_by_itself(make_rows: Callable[..., Rows]) -> None:
    gyr, acc = noisy(1000)
    gyr[:600] += np.random.default_rng(1).normal(size=(12, 3)).repeat(50, axis=0)  # waved about
    gyr[600:] += np.array([1.0, -2.0, 3.0]) * DEGREE
    result = auto_bias(make_rows(np.arange(1000) / 100, gyr, acc))
    assert result.accepted, result.reason
    assert np.array(result.bias) / DEGREE == pytest.approx([1.0, -2.0, 3.0], abs=0.02)


def test_coarse_steps_that_hide_the_noise_are_said(make_rows: Callable[..., Rows]) -> None:
    step = 0.5 * DEGREE
    gyr, acc = noisy(600)
    gyr = np.full_like(gyr, 2 * step)
    gyr[:100, 0] = 3 * step  # before it came to rest it read something else
    result = auto_bias(make_rows(np.arange(600) / 100, gyr, acc))
    assert result.accepted, result.reason
    assert result.sigma[1] == pytest.approx(step / np.sqrt(12))
    assert "hide its noise" in result.reason


def test_a_gyroscope_that_never_changes_is_not_trusted(make_rows: Callable[..., Rows]) -> None:
    gyr, acc = noisy(600)
    flat = make_rows(np.arange(600) / 100, np.full_like(gyr, 0.01), acc)
    frozen = make_rows(np.arange(600) / 100, np.full_like(gyr, 0.01), np.broadcast_to(LEVEL, (600, 3)))
    assert "resolution is not known" in auto_bias(flat).reason
    assert "frozen" in auto_bias(frozen).reason
    assert not auto_bias(flat).accepted
    assert not auto_bias(frozen).accepted


def test_a_slow_even_turn_is_not_rest(make_rows: Callable[..., Rows]) -> None:
    gyr, acc = noisy(600)
    angle = np.arange(600) / 100 * 1.0 * DEGREE
    acc += GRAVITY * np.column_stack((np.zeros(600), np.sin(angle), np.cos(angle) - 1))
    gyr[:, 0] += 1.0 * DEGREE
    result = auto_bias(make_rows(np.arange(600) / 100, gyr, acc))
    assert not result.accepted
    assert "turning slowly" in result.reason


def test_an_impossible_bias_is_refused(make_rows: Callable[..., Rows]) -> None:
    gyr, acc = noisy(600)
    result = auto_bias(make_rows(np.arange(600) / 100, gyr + 1.0, acc))
    assert not result.accepted
    assert "no bias" in result.reason


def test_nothing_and_wild_values_are_refused_without_an_exception(make_rows: Callable[..., Rows]) -> None:
    gyr, acc = noisy(600)
    gyr[::7], acc[::5], t = np.nan, np.inf, np.arange(600) / 100
    t[::11] = np.nan
    assert not auto_bias(make_rows(t, gyr, acc)[:0]).accepted
    assert auto_bias(make_rows(t, np.full((600, 3), np.nan), acc)).reason == "No gyroscope values came yet."
    assert auto_bias(make_rows(t, gyr, acc)).accepted  # what is left of it is still a board at rest


def test_a_gap_ends_a_still_span(make_rows: Callable[..., Rows]) -> None:
    gyr, acc = noisy(600)
    t = np.arange(600) / 100
    t[300:] += 5.0
    spans = still_spans(make_rows(t, gyr, acc))
    assert len(spans) == 2
    assert spans[0].stop == spans[1].start == 300


def test_a_few_samples_around_a_long_gap_are_too_short() -> None:
    rows = VirtualBoard("turns", 100.0, PRESETS["mpu9250"], 1).rows(40)
    rows["t"][20:] += 30.0
    found = auto_bias(rows)
    assert not found.accepted
    assert "s came so far" in found.reason


def test_the_resolution_is_the_smallest_step() -> None:
    counts = np.random.default_rng(0).integers(-50, 50, size=(500, 3))
    assert resolution(counts * 0.01 * GRAVITY) == pytest.approx(0.01 * GRAVITY)
    assert resolution(np.ones((10, 3))) == 0.0
