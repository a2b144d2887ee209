"""Row types and editable fields."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass

import numpy as np
import pytest

from imugui.fields import field, from_mapping
from imugui.samples import ATTITUDE, NO_STATUS, SAMPLE, empty_rows


@dataclass(frozen=True)
class Params:
    gain: float = field(0.5, "Gain", low=0.0, high=1.0)
    count: int = field(3, "Count", low=1)
    mode: str = field("a", "Mode", choices=("a", "b"))
    on: bool = field(True, "On")


def test_empty_rows_say_that_nothing_is_known() -> None:
    for dtype in (SAMPLE, ATTITUDE):
        rows = empty_rows(dtype, 3)
        assert np.isnan(rows["gyr"]).all()
        assert (rows["status"] == NO_STATUS).all()
    assert not empty_rows(ATTITUDE, 2)["rest"].any()


@pytest.mark.parametrize(
    ("values", "expected", "problems"),
    [
        ({}, Params(), 0),
        ({"gain": 1, "count": 2, "mode": "b", "on": False, "later": 1}, Params(1.0, 2, "b", False), 0),
        ({"gain": 2.0, "count": 2}, Params(count=2), 1),
        ({"gain": math.nan, "mode": "c", "on": 1, "count": "3"}, Params(), 4),
        ({"count": True}, Params(), 1),
    ],
)
def test_from_mapping_takes_what_is_good(values: dict, expected: Params, problems: int) -> None:
    made, wrong = from_mapping(Params, values)
    assert made == expected
    assert len(wrong) == problems
    assert type(made.gain) is float


def test_metadata_is_complete() -> None:
    keys = {"label", "unit", "low", "high", "step", "choices", "tip"}
    assert all(set(item.metadata) == keys for item in dataclasses.fields(Params))
