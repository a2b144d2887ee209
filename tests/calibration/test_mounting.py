"""The mounting of the sensor in its box, from two still attitudes of the box."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from imugui.calibration.mounting import MountingFlow
from imugui.fusion import quaternion
from imugui.fusion.attitude import gravity
from imugui.fusion.correction import Correction
from imugui.samples import GRAVITY, Rows

DEGREE = np.pi / 180


def session(make_rows: Callable[..., Rows], mounting: np.ndarray, rise_deg: float, bias: np.ndarray) -> Rows:
    """The box level for 2 s, then its nose raised, as the sensor inside sees it (sensor = mounting^-1 box)."""
    rng = np.random.default_rng(5)
    angle = np.interp(np.arange(600) / 100, [0, 2, 4, 6], [0, 0, rise_deg, rise_deg]) * DEGREE
    box = quaternion.from_rotation_vector(angle[:, None] * np.array([0.0, -1.0, 0.0]))  # nose up: up goes toward x
    up = quaternion.rotate(quaternion.conjugate(mounting), gravity(box))
    noise = rng.normal(size=(2, 600, 3)) * 0.01
    return make_rows(np.arange(600) / 100, noise[0] * 0.1, up + bias + noise[1])


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("rise_deg", [30.0, 90.0])
def test_any_mounting_is_found(make_rows: Callable[..., Rows], seed: int, rise_deg: float) -> None:
    rng = np.random.default_rng(seed)
    true = quaternion.normalise(rng.normal(size=4))
    bias = rng.normal(size=3) * 0.3
    flow = MountingFlow(Correction(acc_bias=tuple(bias)))
    flow.feed(session(make_rows, true, rise_deg, bias))
    assert flow.done
    result = flow.result()
    assert np.degrees(quaternion.angle_between(result.quat, true)) < 0.3
    assert result.error_deg == pytest.approx(1.0 / np.sin(rise_deg * DEGREE), abs=0.05)
    # as the pipeline applies it: level again
    rows = Correction(acc_bias=tuple(bias), mounting=result.quat).apply(session(make_rows, true, rise_deg, bias))
    assert rows["acc"][:150].mean(axis=0) == pytest.approx([0, 0, GRAVITY], abs=0.02)


def test_level_alone_is_not_enough(make_rows: Callable[..., Rows]) -> None:
    flow = MountingFlow()
    assert flow.sentence.startswith("Put the box level")
    flow.feed(session(make_rows, np.array([1.0, 0, 0, 0]), 5.0, np.zeros(3)))
    assert not flow.done
    assert flow.progress == 0.5
    assert flow.missing == ("the box with its nose up",)
    assert not flow.result().accepted
