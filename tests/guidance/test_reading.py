"""Reading: everything is kept, comes back exactly, and is refused when it was changed."""

from __future__ import annotations

import dataclasses
import json
import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from imugui.guidance.plan import Plan
from imugui.guidance.reading import Reading, mean_direction, plan_from, reading_from, recompute
from imugui.guidance.registration import from_axes


def through_json(reading: Reading) -> dict[str, Any]:
    values: dict[str, Any] = json.loads(json.dumps(reading.to_dict(), allow_nan=False))
    return values


def test_a_reading_comes_back_to_the_last_digit(reading: Reading) -> None:
    again = reading_from(through_json(reading))
    # NaN is equal to nothing, so the texts are compared
    assert repr(again) == repr(reading)
    assert again.registration == reading.registration


def test_unknown_keys_are_ignored_and_open_values_may_be_missing(reading: Reading) -> None:
    values = through_json(reading)
    values["mood"] = "good"
    for key in ("twist_deg", "overshoots", "profile", "utc"):
        del values[key]
    again = reading_from(values)
    assert math.isnan(again.twist_deg)
    assert (again.overshoots, again.profile) == (0, "")


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"direction": [0.0, 2.0, 0.0]}, "length is not 1"),
        ({"direction": [0.0, 1.0]}, "three numbers"),
        ({"direction": [0.0, 1.0, 0.0]}, "directions are"),
        ({"error_deg": 0.1}, "directions are"),
        ({"error_deg": None}, "error_deg must be a number"),
        ({"cranial_deg": 1e200}, "cranial_deg must be a number"),
        ({"number": -1}, "whole number"),
        ({"number": True}, "whole number"),
        ({"rows": [9, 4]}, "first and the last"),
        ({"rows": [1.5, 4]}, "first and the last"),
        ({"use_mag": "yes"}, "true or false"),
        ({"filter": "v" * 500}, "400 characters"),
        ({"frame": "LPS"}, "not in RAS"),
        ({"plan": {"name": "L4", "side": "middle"}}, "Side"),
        ({"plan": 3}, "table"),
        ({"registration": None}, "table"),
    ],
)
def test_what_is_wrong_is_said(reading: Reading, change: dict[str, Any], words: str) -> None:
    with pytest.raises(ValueError, match=words):
        reading_from({**through_json(reading), **change})


def test_a_changed_registration_is_noticed(reading: Reading) -> None:
    values = through_json(reading)
    values["registration"]["residual_deg"] = 0.0123
    with pytest.raises(ValueError, match="changed"):
        reading_from(values)


@pytest.mark.parametrize("missing", ["plan", "direction", "registration", "rows", "sigma_deg"])
def test_what_is_needed_must_be_there(reading: Reading, missing: str) -> None:
    values = through_json(reading)
    del values[missing]
    with pytest.raises(ValueError, match=missing):
        reading_from(values)


JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False) | st.text(max_size=8),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=8), inner, max_size=3),
    max_leaves=6,
)
FIELDS = [item.name for item in dataclasses.fields(Reading)]


@given(key=st.sampled_from(FIELDS), value=JSON)
def test_no_value_of_a_file_does_worse_than_a_sentence(key: str, value: Any) -> None:
    values = {**EXAMPLE, key: value}
    try:
        found = reading_from(values)
    except ValueError as error:
        assert str(error)
    else:
        assert isinstance(found, Reading)


def example() -> dict[str, Any]:
    registration = from_axes((0.0, 0.0, -1.0), (0.0, 1.0, 0.0), 3.0, ((0, 9), (20, 29)))
    way = (0.0, 1.0, 0.0)
    plan = Plan(name="L4", side="left")
    made = Reading(1, plan, way, way, 0.0, 0.0, 0.0, 0.5, 4.0, (40, 90), registration, (1.0, 0.0, 0.0))
    return through_json(made)


EXAMPLE = example()


def test_the_plan_of_a_file_is_checked() -> None:
    assert plan_from({"name": "L4", "side": "left", "axial_deg": 12, "depth_mm": None}).axial_deg == 12.0
    with pytest.raises(ValueError, match="Axial"):
        plan_from({"name": "L4", "side": "left", "axial_deg": "steep"})
    with pytest.raises(ValueError, match="table"):
        plan_from([1, 2])
    with pytest.raises(ValueError, match="cannot be -inf"):
        plan_from({"name": "L4", "side": "left", "yaw_deg": -math.inf})


def test_the_mean_direction_is_a_unit_vector_in_the_patients_frame() -> None:
    registration = from_axes((0.0, 0.0, -1.0), (0.0, 1.0, 0.0))
    down = np.array((math.sqrt(0.5), 0.0, math.sqrt(0.5), 0.0))  # turns x to -z
    assert mean_direction(registration, [down, down], (1.0, 0.0, 0.0)) == pytest.approx((0.0, 1.0, 0.0))


def test_a_recording_without_those_rows_cannot_confirm() -> None:
    assert math.isnan(recompute(reading_from(EXAMPLE), np.zeros((0, 4))))
