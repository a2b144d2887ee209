"""Blocks of numbers as text: the bytes that formatting one by one gives."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from imugui.recording.fixed_point import table

DECIMALS = (6, 9, 4, 0)


def one_by_one(columns: list[np.ndarray]) -> bytes:
    pattern = ",".join(f"%.{places}f" for places in DECIMALS) + "\n"
    return "".join(pattern % row for row in zip(*(column.tolist() for column in columns), strict=True)).encode()


def check(columns: list[np.ndarray]) -> None:
    assert table(columns, DECIMALS) == one_by_one(columns)


def test_usual_numbers() -> None:
    random = np.random.default_rng(1)
    n = 3000
    check(
        [np.arange(n) / 200.0, random.uniform(-1, 1, n), random.uniform(-180, 180, n), random.integers(0, 2, n) * 1.0]
    )


@pytest.mark.parametrize(
    "value", [0.0, -0.0, -1e-9, 0.5, 1.5, 2.5, 1e-4, 0.99999999999, 1e9, 1e15, 1e22, np.nan, np.inf, -np.inf, 5e-324]
)
def test_awkward_numbers(value: float) -> None:
    check([np.array([value, 1.25]), np.array([1.0, value]), np.array([value, -value]), np.array([value, 3.0])])


@given(st.lists(st.floats(-1e12, 1e12), min_size=1, max_size=20))
def test_any_numbers(values: list[float]) -> None:
    column = np.array(values)
    check([column, column[::-1], 1e-3 * column, column])


def test_nothing() -> None:
    assert table([np.empty(0)] * 4, DECIMALS) == b""
