"""Welch's spectrum against what is known: a sine, white noise, the variance."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from imugui.signals.spectrum import LONGEST, SEGMENTS, SHORTEST, Spectrum, segment_length, stretches, welch

RATE_HZ = 200.0
N = 20_000


def spectrum_of(values: np.ndarray, rate_hz: float = RATE_HZ) -> Spectrum:
    found = welch([values], rate_hz)
    assert found is not None
    return found


@given(st.floats(0.05, 0.45), st.floats(0.1, 100.0), st.floats(0.0, 6.0), st.floats(10.0, 2000.0))
def test_a_sine_stands_at_its_frequency_with_its_rms(
    share: float, amplitude: float, phase: float, rate_hz: float
) -> None:
    t = np.arange(4000) / rate_hz
    found = spectrum_of(7.0 + amplitude * np.sin(2 * np.pi * share * rate_hz * t + phase), rate_hz)
    frequency, rms = found.line()
    assert frequency == pytest.approx(share * rate_hz, abs=0.1 * found.resolution_hz)
    assert rms == pytest.approx(amplitude / math.sqrt(2.0), rel=0.01)


@pytest.mark.parametrize("sigma", [0.01, 3.0])
def test_white_noise_is_flat_at_its_level(sigma: float) -> None:
    found = spectrum_of(np.random.default_rng(1).normal(0.0, sigma, N))
    level = sigma**2 / (0.5 * RATE_HZ)  # the variance, spread from zero to half the rate
    assert found.density[2:-2].mean() == pytest.approx(level, rel=0.03)
    assert found.floor() == pytest.approx(math.sqrt(level), rel=0.05)
    assert found.segments >= SEGMENTS


def test_the_integral_is_the_variance() -> None:
    random = np.random.default_rng(2)
    values = random.normal(size=N) + 5.0 * np.sin(np.arange(N) * 0.3)
    found = spectrum_of(values)
    assert found.density.sum() * found.resolution_hz == pytest.approx(values.var(), rel=0.03)


def test_a_line_does_not_raise_the_floor() -> None:
    noise = np.random.default_rng(3).normal(0.0, 1.0, N)
    with_line = noise + 100.0 * np.sin(np.arange(N) * 1.0)
    assert spectrum_of(with_line).floor() == pytest.approx(spectrum_of(noise).floor(), rel=0.1)


def test_no_segment_reaches_over_a_gap() -> None:
    t = np.arange(N) / RATE_HZ
    values = np.sin(2 * np.pi * 20.0 * t)
    broken = values.copy()
    broken[N // 2] = math.nan
    broken[N // 2 + 1 :] *= -1.0  # out of step: a segment across would smear the line
    parts = stretches(broken)
    assert [len(part) for part in parts] == [N // 2, N // 2 - 1]
    found = welch(parts, RATE_HZ)
    assert found is not None
    assert found.line() == pytest.approx((20.0, math.sqrt(0.5)), rel=1e-3)


def test_stretches_of_nothing_but_nan() -> None:
    assert stretches(np.full(5, math.nan)) == []
    assert stretches(np.empty(0)) == []
    assert [part.tolist() for part in stretches(np.array([1.0, 2.0]))] == [[1.0, 2.0]]


def test_too_little_gives_no_spectrum() -> None:
    assert welch([], RATE_HZ) is None
    assert welch([np.zeros(SHORTEST - 1)], RATE_HZ) is None
    assert welch([np.zeros(SHORTEST)], RATE_HZ) is not None


@pytest.mark.parametrize("rate_hz", [0.0, -1.0, math.nan])
def test_a_rate_must_be_above_zero(rate_hz: float) -> None:
    with pytest.raises(ValueError, match="rate"):
        welch([np.zeros(100)], rate_hz)


def test_neither_noise_nor_slow_movement_is_a_line() -> None:
    random = np.random.default_rng(4)
    noise = random.normal(0.0, 1.0, N)
    assert math.isnan(spectrum_of(noise).line()[0])
    slow = 1e3 * np.sin(2 * np.pi * np.arange(N) / N)
    assert math.isnan(spectrum_of(noise + slow).line()[0])


def test_a_still_channel_has_no_line() -> None:
    found = spectrum_of(np.full(1000, 3.0))
    assert found.floor() == 0.0
    assert all(math.isnan(one) for one in found.line())


@given(st.integers(0, 1 << 20))
def test_segments_are_powers_of_two_that_fit(n: int) -> None:
    length = segment_length(n)
    assert length == 0 if n < SHORTEST else SHORTEST <= length <= min(n, LONGEST)
    assert length & (length - 1) == 0
