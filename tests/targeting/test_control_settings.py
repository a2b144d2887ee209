"""The settings: defaults, presets, what a file may hold."""

from __future__ import annotations

import dataclasses

import pytest

from imugui import fields
from imugui.targeting.settings import PRESETS, Control


@pytest.mark.parametrize("name", PRESETS)
def test_every_preset_is_within_its_ranges(name: str) -> None:
    values = dataclasses.asdict(PRESETS[name])
    assert [fields.problem(item, values[item.name]) for item in dataclasses.fields(Control)] == [None] * len(values)
    assert fields.from_mapping(Control, values) == (PRESETS[name], [])


def test_every_field_can_be_edited() -> None:
    assert all(item.metadata["label"] for item in dataclasses.fields(Control))


def test_the_defaults_of_the_two_mappings() -> None:
    position, speed = PRESETS["position"], PRESETS["speed"]
    assert position == Control()
    assert dataclasses.replace(position, mapping="speed", dead_zone_deg=1.5) == speed
    assert (position.gain, position.dead_zone_deg, position.latch, position.mask_s) == (8.0, 0.0, "hold", 0.020)


def test_the_thesis_differs_in_the_mapping_alone() -> None:
    position, speed = PRESETS["thesis position"], PRESETS["thesis speed"]
    assert dataclasses.replace(position, mapping="speed") == speed
    assert (speed.gain, speed.zoom_gain, speed.lag_s, speed.latch) == (8.0, 8.0, 0.25, "toggle")


def test_a_bad_file_falls_back_field_by_field() -> None:
    control, problems = fields.from_mapping(Control, {"mapping": "telepathy", "gain": 4, "lag_s": 99.0, "x_axis": "+w"})
    assert control == Control(gain=4.0)
    assert len(problems) == 3
