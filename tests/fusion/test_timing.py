"""The rebuilt sample clock: rate, smoothness, honest gaps."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
import pytest

from imugui.fusion.timing import ArrivalClock, DeviceClock
from imugui.samples import SAMPLE, Rows, empty_rows

Arrivals = Callable[[np.ndarray, np.random.Generator], np.ndarray]

# how bytes arrive: a USB adapter's 16 ms latency timer, an ordinary system, a slow radio link, a host that stalls
PATTERNS: dict[str, Arrivals] = {
    "usb": lambda t, rng: np.ceil(t / 0.016) * 0.016 + rng.exponential(0.0005, len(t)),
    "direct": lambda t, rng: t + rng.exponential(0.002, len(t)),
    "radio": lambda t, rng: np.ceil(t / 0.0375) * 0.0375,
    "stalls": lambda t, rng: np.where(t % 1.3 > 1.1, np.ceil(t / 1.3) * 1.3, t + rng.exponential(0.0003, len(t))),
}


def blocks(arrivals: np.ndarray) -> Iterator[Rows]:
    """Rows grouped as a reader gets them: everything that came within 0.2 ms is one chunk."""
    for chunk in np.split(arrivals, np.flatnonzero(np.diff(arrivals) > 2e-4) + 1):
        rows = empty_rows(SAMPLE, len(chunk))
        rows["t_arrival"] = chunk[-1]
        yield rows


def stamped(clock: ArrivalClock, arrivals: np.ndarray) -> np.ndarray:
    times = []
    for rows in blocks(np.maximum.accumulate(arrivals)):
        clock.stamp(rows)
        times.append(rows["t"].copy())
    return np.concatenate(times)


def sent(rate_hz: float, seconds: float, *lost: tuple[float, float]) -> np.ndarray:
    t = np.arange(int(seconds * rate_hz)) / rate_hz
    for start, end in lost:
        t = t[(t < start) | (t >= end)]
    return t


@pytest.mark.parametrize("pattern", PATTERNS)
@pytest.mark.parametrize("rate_hz", [100.0, 138.6, 200.0, 1000.0])
def test_rate_within_a_thousandth_and_smooth(rate_hz: float, pattern: str) -> None:
    true = sent(rate_hz, 12.0)
    clock = ArrivalClock()
    rates = []
    times = []
    for rows in blocks(np.maximum.accumulate(PATTERNS[pattern](true, np.random.default_rng(3)))):
        clock.stamp(rows)
        times.append(rows["t"].copy())
        rates.append((rows["t_arrival"][-1], 1.0 / clock.period))
    after = [rate for t, rate in rates if t >= 10.0]
    assert np.max(np.abs(np.array(after) / rate_hz - 1.0)) < 1e-3
    dt = np.diff(np.concatenate(times))
    assert dt.min() >= 0.0
    assert np.max(np.abs(dt[true[1:] > 2.0] * rate_hz - 1.0)) < 0.05
    assert clock.gaps == 0


@pytest.mark.parametrize("lost_s", [0.1, 0.3, 3.0])
def test_a_gap_is_counted_and_bridged(lost_s: float) -> None:
    true = sent(100.0, 16.0, (8.0, 8.0 + lost_s))
    clock = ArrivalClock()
    times = stamped(clock, PATTERNS["direct"](true, np.random.default_rng(1)))
    assert clock.gaps == 1
    assert clock.gap_s == pytest.approx(lost_s, abs=0.02)
    assert times[-1] - times[0] == pytest.approx(true[-1] - true[0], abs=0.02)
    assert np.diff(times).max() == pytest.approx(lost_s, abs=0.03)


def test_one_lost_sample_is_no_gap_but_no_time_is_lost() -> None:
    true = sent(10.0, 60.0, (30.0, 30.1))
    clock = ArrivalClock()
    times = stamped(clock, true.copy())
    assert clock.gaps == 0
    assert times[-1] - times[0] == pytest.approx(true[-1], abs=0.12)


@pytest.mark.parametrize(("before_hz", "after_hz"), [(100.0, 200.0), (200.0, 100.0), (100.0, 110.0)])
def test_a_changed_rate_is_followed(before_hz: float, after_hz: float) -> None:
    true = np.concatenate((np.arange(0, 8, 1 / before_hz), np.arange(8, 20, 1 / after_hz)))
    clock = ArrivalClock()
    times = stamped(clock, PATTERNS["direct"](true, np.random.default_rng(1)))
    assert 1.0 / clock.period == pytest.approx(after_hz, rel=1e-3)
    assert np.diff(times).min() > 0.0


def device_rows(raw: np.ndarray, arrivals: np.ndarray | None = None) -> Rows:
    rows = empty_rows(SAMPLE, len(raw))
    rows["t"] = raw
    rows["t_arrival"] = raw - raw[0] + 50.0 if arrivals is None else arrivals
    return rows


@pytest.mark.parametrize("wrap", [2**16 * 1e-3, 2**32 * 1e-6])
def test_a_counter_that_starts_again_is_unwrapped(wrap: float) -> None:
    true = wrap - 1.0 + np.arange(300) * 0.01
    rows = device_rows(np.mod(true, wrap), true)
    clock = DeviceClock()
    clock.stamp(rows)
    assert np.allclose(np.diff(rows["t"]), 0.01, atol=1e-9)
    assert clock.gaps == 0


def test_a_board_that_was_reset_goes_on_at_its_arrival() -> None:
    raw = np.concatenate((np.arange(100) * 0.01, np.arange(100) * 0.01))
    rows = device_rows(raw, np.concatenate((np.arange(100) * 0.01, 5.0 + np.arange(100) * 0.01)))
    clock = DeviceClock()
    clock.stamp(rows)
    assert np.diff(rows["t"]).min() > 0.0
    assert rows["t"][100] == pytest.approx(5.0)
    assert (clock.gaps, round(clock.gap_s, 1)) == (1, 4.0)


def test_device_time_in_a_file_is_kept() -> None:
    rows = device_rows(np.arange(50) / 256.0 + 3.0)
    rows["t_arrival"] = np.nan
    DeviceClock().stamp(rows)
    assert np.array_equal(rows["t"], np.arange(50) / 256.0 + 3.0)
