"""Correction: matrix * (raw - bias), mounting last; nothing by default."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from imugui.fusion.correction import Correction
from imugui.fusion.quaternion import from_rotation_vector, rotate
from imugui.samples import SAMPLE, Rows, empty_rows


def some_rows(n: int = 20) -> Rows:
    rng = np.random.default_rng(3)
    rows = empty_rows(SAMPLE, n)
    for name in ("gyr", "acc", "mag"):
        rows[name] = rng.normal(size=(n, 3))
    rows["t"] = np.arange(n)
    return rows


def test_the_default_changes_nothing_and_copies() -> None:
    rows = some_rows()
    corrected = Correction().apply(rows)
    assert corrected.tobytes() == rows.tobytes()
    corrected["acc"] = 0.0
    assert rows["acc"].any()


@pytest.mark.parametrize("sensor", ["gyr", "acc", "mag"])
def test_each_sensor_has_its_own_bias_and_matrix(sensor: str) -> None:
    rows = some_rows()
    bias, matrix = np.array((0.1, -0.2, 0.3)), np.array(((1.1, 0.02, 0), (0.01, 0.9, -0.03), (0, 0.05, 1.02)))
    corrected = Correction(**{f"{sensor}_bias": bias, f"{sensor}_matrix": matrix}).apply(rows)
    assert np.allclose(corrected[sensor], (rows[sensor] - bias) @ matrix.T, atol=1e-15)
    for other in {"gyr", "acc", "mag"} - {sensor}:
        assert corrected[other].tobytes() == rows[other].tobytes()


def test_mounting_turns_all_three_after_the_matrix() -> None:
    rows = some_rows()
    mounting = from_rotation_vector((0.3, -0.2, 1.0))
    matrix = np.diag((2.0, 1.0, 1.0))
    corrected = Correction(mounting=mounting, acc_matrix=matrix).apply(rows)
    assert np.allclose(corrected["gyr"], rotate(mounting, rows["gyr"]))
    assert np.allclose(corrected["acc"], rotate(mounting, rows["acc"] * (2.0, 1.0, 1.0)))


def test_one_row_and_many_rows_give_the_same_bits() -> None:
    rows = some_rows(31)
    correction = Correction(gyr_bias=(0.1, 0.2, 0.3), mag_matrix=np.eye(3) + 0.01, mounting=(0.5, 0.5, 0.5, 0.5))
    one_by_one = np.concatenate([correction.apply(rows[i : i + 1]) for i in range(len(rows))])
    assert correction.apply(rows).tobytes() == one_by_one.tobytes()


def test_arrays_and_tuples_make_equal_corrections() -> None:
    assert Correction(acc_bias=np.array((1.0, 2.0, 3.0))) == Correction(acc_bias=(1.0, 2.0, 3.0))
    assert Correction(acc_bias=(1.0, 2.0, 3.0)) != Correction()
    assert hash(Correction(mag_matrix=np.eye(3))) == hash(Correction())
    with pytest.raises(dataclasses.FrozenInstanceError):
        Correction().acc_bias = (0.0, 0.0, 0.0)  # type: ignore[misc]


@pytest.mark.parametrize(
    "wrong", [{"gyr_bias": (1.0, 2.0)}, {"acc_matrix": (1.0, 2.0, 3.0)}, {"mag_bias": (1.0, 2.0, np.nan)}]
)
def test_wrong_shapes_and_values_are_refused(wrong: dict[str, object]) -> None:
    with pytest.raises(ValueError, match="expected finite numbers"):
        Correction(**wrong)  # type: ignore[arg-type]
