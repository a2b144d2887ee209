"""The second attitude, and how far it is from the first."""

from __future__ import annotations

import numpy as np
import pytest

from imugui.fusion.attitude import from_euler
from imugui.fusion.pipeline import Pipeline
from imugui.recording.compare import (
    BLOCK,
    angle_difference_deg,
    figures,
    refuse,
    thinned,
    tilt_difference_deg,
)
from imugui.samples import SAMPLE, Rows, empty_rows


def rows_of(n: int) -> Rows:
    rows = empty_rows(SAMPLE, n)
    rows["t"] = np.arange(n) / 100.0
    rows["acc"] = (0.3, -0.2, 9.8)
    rows["gyr"] = (0.0, 0.1, 0.2)
    rows["mag"] = (0.0, 20.0, -43.0)
    return rows


def test_refusing_is_the_pipeline_over_everything() -> None:
    rows = rows_of(BLOCK + 500)
    settings = Pipeline("madgwick").settings()
    shares: list[float] = []
    again = refuse(rows, settings, shares.append)
    np.testing.assert_array_equal(again["quat"], Pipeline("madgwick").step(rows)["quat"])
    assert shares == sorted(shares)
    assert shares[-1] == 1.0


def test_refusing_ends_when_progress_raises() -> None:
    def stop(_: float) -> None:
        raise InterruptedError

    with pytest.raises(InterruptedError):
        refuse(rows_of(10), Pipeline("mahony").settings(), stop)


def test_settings_that_are_none_are_refused() -> None:
    with pytest.raises(KeyError):
        refuse(rows_of(10), {"filter": "nonsense", "params": {}}, lambda _: None)


def test_angles_between_known_attitudes() -> None:
    a = np.array([from_euler(0.3, 0.1, 0.2)] * 3)
    b = np.array([from_euler(0.3, 0.1, 0.2), from_euler(0.3 + np.radians(30), 0.1, 0.2), -a[0]])
    np.testing.assert_allclose(angle_difference_deg(a, b), [0.0, 30.0, 0.0], atol=1e-6)
    np.testing.assert_allclose(tilt_difference_deg(a, b), [0.0, 0.0, 0.0], atol=1e-6)  # heading alone differs
    tilted = np.array([from_euler(0.0, np.radians(20), 0.0)])
    level = np.array([from_euler(1.0, 0.0, 0.0)])
    np.testing.assert_allclose(tilt_difference_deg(level, tilted), [20.0], atol=1e-6)


def test_equal_digits_differ_by_exactly_nothing() -> None:
    quats = np.array([from_euler(yaw, 0.2, 0.1) for yaw in np.linspace(-3, 3, 100)])
    assert not angle_difference_deg(quats, quats).any()


def test_figures() -> None:
    found = figures(np.array([0.0, 1.0, 2.0, 3.0]), np.array([3.0, np.nan, 4.0, 0.0]))
    assert found.mean == pytest.approx(7 / 3)
    assert found.rms == pytest.approx(np.sqrt(25 / 3))
    assert (found.largest, found.largest_at_s) == (4.0, 2.0)
    assert np.isnan(figures(np.empty(0), np.empty(0)).mean)


def test_thinning_hides_no_spike() -> None:
    times = np.arange(100_000.0)
    values = np.zeros(100_000)
    values[43_210], values[77_777] = 5.0, -7.0
    x, y = thinned(times, values, 100)
    assert len(x) <= 300
    assert (y.max(), y.min()) == (5.0, -7.0)
    assert (np.diff(x) > 0).all()
    assert x[np.argmax(y)] == 43_210
    few, same = thinned(times[:50], values[:50], 100)
    assert len(few) == len(same) == 50
