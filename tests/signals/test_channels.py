"""Channels: their table, and their values from rows."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from imugui.fusion.attitude import CONVENTIONS, display_quat, euler, from_euler
from imugui.samples import ATTITUDE, GRAVITY, SAMPLE, Rows, empty_rows
from imugui.signals.channels import (
    ATTITUDE_KEYS,
    CHANNELS,
    QUANTITIES,
    SAMPLE_KEYS,
    TURN,
    UNITS,
    attitude_values,
    fold,
    sample_values,
)
from imugui.views.live_words import shown_quat


def attitudes(n: int, seed: int = 1) -> Rows:
    random = np.random.default_rng(seed)
    rows = empty_rows(ATTITUDE, n)
    for name in ("gyr", "acc", "mag"):
        rows[name] = random.normal(size=(n, 3))
    rows["quat"] = from_euler(*random.uniform(-1.5, 1.5, (3, n)))
    rows["local"] = rows["quat"]
    return rows


def value(rows: Rows, key: str, convention: str = "ENU") -> Any:
    return attitude_values(rows, convention)[ATTITUDE_KEYS.index(key)]


def test_the_table_is_whole() -> None:
    assert set(SAMPLE_KEYS) | set(ATTITUDE_KEYS) == set(CHANNELS)
    for key, quantity in QUANTITIES.items():
        assert quantity.kind in UNITS
        assert quantity.channels
        for channel in quantity.channels:
            assert channel.key.startswith(f"{key}.")
            assert (channel.key in SAMPLE_KEYS) is (quantity.raw or not quantity.corrected)
            assert (channel.key in ATTITUDE_KEYS) is quantity.corrected
    for units in UNITS.values():
        assert all(unit.scale > 0 and unit.least > 0 and unit.ascii.isascii() for unit in units)


def test_sample_values_are_the_rows_and_their_norms() -> None:
    rows = empty_rows(SAMPLE, 3)
    rows["t"] = (10.0, 10.5, 12.0)
    rows["acc"] = (3.0, 0.0, 4.0)
    rows["temp_c"] = 21.0
    values = dict(zip(SAMPLE_KEYS, sample_values(rows, 9.0), strict=True))
    assert values["acc.z"].tolist() == [4.0] * 3
    assert values["acc.norm"].tolist() == [5.0] * 3
    assert values["temp.c"].tolist() == [21.0] * 3
    assert values["interval.s"].tolist() == [1.0, 0.5, 1.5]
    assert np.isnan(values["mag.norm"]).all()


@pytest.mark.parametrize("last_t", [math.nan, 20.0, -1e3])
def test_there_is_no_interval_across_a_jump(last_t: float) -> None:
    rows = empty_rows(SAMPLE, 2)
    rows["t"] = (10.0, 10.5)
    interval = sample_values(rows, last_t)[SAMPLE_KEYS.index("interval.s")]
    assert np.isnan(interval[0])
    assert interval[1] == 0.5


def test_a_level_board_at_rest_has_gravity_and_no_linear_acceleration() -> None:
    rows = attitudes(1)
    rows["quat"] = (1.0, 0.0, 0.0, 0.0)
    rows["acc"] = (0.0, 0.0, GRAVITY)
    assert [float(value(rows, f"gravity.{axis}")[0]) for axis in "xyz"] == pytest.approx([0.0, 0.0, GRAVITY])
    assert float(value(rows, "linear.norm")[0]) == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("convention", CONVENTIONS)
def test_angles_follow_the_display_convention(convention: str) -> None:
    rows = attitudes(20)
    angles = np.stack([value(rows, f"euler.{name}", convention) for name in ("yaw", "pitch", "roll")], axis=-1)
    assert angles == pytest.approx(euler(display_quat(rows["quat"], convention)))


@pytest.mark.parametrize("convention", CONVENTIONS)
@pytest.mark.parametrize("has_origin", [True, False])
def test_angles_are_those_of_the_live_page(convention: str, has_origin: bool) -> None:
    rows = attitudes(5)
    if has_origin:
        rows["local"] = attitudes(5, seed=2)["quat"]
    for i in range(5):
        expected = euler(shown_quat(rows["local"][i], convention, has_origin))
        found = [value(rows, f"euler.{name}", convention)[i] for name in ("yaw", "pitch", "roll")]
        assert found == pytest.approx(expected.tolist())


@given(st.floats(-1e4, 1e4), st.integers(-5, 5))
def test_fold_takes_whole_turns_off(angle: float, turns: int) -> None:
    folded = fold(angle + turns * TURN, TURN)
    assert -math.pi - 1e-9 <= folded <= math.pi + 1e-9
    assert math.remainder(folded - angle, TURN) == pytest.approx(0.0, abs=1e-6)


def test_fold_leaves_what_has_no_period() -> None:
    assert fold(123.0, 0.0) == 123.0
    assert math.isnan(fold(math.nan, TURN))


def test_no_rows_give_no_values() -> None:
    assert sample_values(empty_rows(SAMPLE, 0), math.nan).shape == (len(SAMPLE_KEYS), 0)
    assert attitude_values(empty_rows(ATTITUDE, 0), "ENU").shape == (len(ATTITUDE_KEYS), 0)
