"""Column maps as plain JSON, whatever a settings file holds."""

from __future__ import annotations

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from imugui.formats.column_map import ColumnMap, from_json

SIX = ("ax_g", "ay_g", "az_g", "gx_dps", "gy_dps", "gz_dps")
FULL = ColumnMap(("-", "t_ms", *SIX), ";", ",", 3, 0, 2.0, 104.0, "Inertial.csv")

JSON = st.recursive(
    st.none() | st.booleans() | st.floats() | st.integers() | st.text(max_size=8),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=8), inner, max_size=4),
    max_leaves=10,
)


def test_what_was_said_comes_back() -> None:
    assert from_json(json.loads(json.dumps(FULL.to_json()))) == FULL


@pytest.mark.parametrize(
    "changes",
    [
        {"columns": []},
        {"columns": "ax"},
        {"columns": [1, 2, 3]},
        {"columns": ["t_ms"]},
        {"columns": ["ax_furlong", "ay", "az"]},
        {"columns": ["x" * 1000] * 3},
        {"columns": list(SIX) * 1000},
        {"delimiter": ":"},
        {"decimal": ""},
        {"skip_lines": -1},
        {"skip_lines": 2.5},
        {"keep_column": 99},
        {"rate_hz": -1.0},
        {"rate_hz": float("nan")},
        {"rate_hz": "fast"},
        {"file": "../../etc/passwd"},
        {"file": "/etc/passwd"},
        {"file": 3},
    ],
)
def test_nonsense_is_refused(changes: dict[str, object]) -> None:
    assert from_json(FULL.to_json() | changes) is None


@given(JSON)
def test_no_json_raises(values: object) -> None:
    assert from_json(values) is None or isinstance(values, dict)


@given(st.dictionaries(st.sampled_from(sorted(FULL.to_json())), JSON))
def test_no_values_raise(values: dict[str, object]) -> None:
    column_map = from_json(FULL.to_json() | values)
    assert column_map is None or column_map.problem == ""


@pytest.mark.parametrize(
    ("columns", "said"),
    [
        (SIX, ""),
        (SIX[:3], ""),
        (("t_s", "mx_uT", "my_uT", "mz_uT"), ""),
        (("t_s", "lat", "lon"), ""),
        (("linx", "liny", "linz", "gravx", "gravy", "gravz"), ""),
        (("ax", "ay"), "no column for az"),
        (("t_s", "-"), "no column with measurements"),
        (("ax_counts", "ay_counts", "az_counts"), "unknown unit"),
    ],
)
def test_one_sensor_is_enough_but_a_whole_one(columns: tuple[str, ...], said: str) -> None:
    problem = ColumnMap(columns).problem
    assert said in problem if said else problem == ""
