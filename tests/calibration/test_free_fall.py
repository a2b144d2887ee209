"""Falls give the bias, spinning falls are not used, and the poorer accuracy is said."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from imugui.calibration.free_fall import FreeFallFlow
from imugui.calibration.gravity_fit import MG
from imugui.samples import GRAVITY, Rows

BIAS = np.array([0.3, -0.4, 0.6])
FALL = 40  # rows: 0.2 s


def thrown(make_rows: Callable[..., Rows], falls: int, spin: float = 0.0) -> Rows:
    """A board of 200 Hz that is let fall some times, with a hard landing each time."""
    rng = np.random.default_rng(7)
    acc = np.tile([0.0, 0.0, GRAVITY], (falls * 200, 1))
    gyr = rng.normal(size=acc.shape) * 0.01
    for k in range(falls):
        start = k * 200 + 100
        acc[start : start + FALL] = 0.0
        acc[start + FALL : start + FALL + 6] = [5.0, -8.0, 60.0]
        gyr[start : start + FALL, 1] += spin
    return make_rows(np.arange(len(acc)) / 200, gyr, acc + BIAS + rng.normal(size=acc.shape) * 0.04)


def test_three_falls_give_the_bias(make_rows: Callable[..., Rows]) -> None:
    flow = FreeFallFlow()
    flow.feed(thrown(make_rows, 3))
    assert flow.done
    result = flow.result()
    assert np.abs(np.array(result.bias) - BIAS).max() < 5 * MG
    assert result.tilt_deg == pytest.approx(2.5)
    assert "better" in result.reason


def test_it_waits_for_the_third(make_rows: Callable[..., Rows]) -> None:
    flow = FreeFallFlow()
    flow.feed(thrown(make_rows, 2))
    assert not flow.done
    assert flow.missing == ("1 more fall",)
    assert not flow.result().accepted


def test_spinning_falls_are_not_used(make_rows: Callable[..., Rows]) -> None:
    flow = FreeFallFlow()
    flow.feed(thrown(make_rows, 3, spin=8.0))
    assert not flow.done
    assert flow.spinning == 3
    assert "spinning" in flow.result().reason
