"""Session file: nothing is lost, whatever happens to the program or to the file."""

from __future__ import annotations

import dataclasses
import json
import math
import os
from pathlib import Path
from typing import Any

import pytest

from imugui.guidance.plan import Plan
from imugui.guidance.reading import Reading
from imugui.guidance.session_file import Kept, from_text, load, save, to_text

AXIS = (0.6, 0.0, 0.8)


@pytest.fixture
def kept(reading: Reading) -> Kept:
    plans = (Plan(name="L4", side="left", axial_deg=12.5), Plan(name="box", kind="plain", yaw_deg=30.0))
    return Kept(plans, reading.registration, AXIS, 0.25, (reading, dataclasses.replace(reading, number=2)))


def test_it_comes_back_whole(tmp_path: Path, kept: Kept) -> None:
    path = tmp_path / "new" / "guidance.json"
    save(path, kept)
    again, problems = load(path)
    assert problems == []
    assert repr(again) == repr(kept)
    assert [file.name for file in path.parent.iterdir()] == ["guidance.json"]


def test_without_a_file_nothing_is_there(tmp_path: Path) -> None:
    assert load(tmp_path / "none.json") == (Kept(), [])


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (b'{"imugui_guidance": 1, "plans": [', "not valid JSON"),
        (b"\xff\xfe\x00", "not a text file"),
        (b"[]", "no guidance session"),
        (b'{"imugui_guidance": 99}', "newer imugui"),
        (b"[" * 100_000, "not valid JSON"),
    ],
)
def test_a_broken_file_is_set_aside_with_a_sentence(tmp_path: Path, data: bytes, words: str) -> None:
    path = tmp_path / "guidance.json"
    for number in (1, 2):
        path.write_bytes(data)
        found, problems = load(path)
        assert found == Kept()
        assert words in problems[0]
        assert problems[1] == f"The old file is kept as guidance.broken-{number}.json."
        assert (tmp_path / f"guidance.broken-{number}.json").read_bytes() == data
        assert not path.exists()


def damaged(kept: Kept) -> dict[str, Any]:
    values: dict[str, Any] = json.loads(to_text(kept))
    values["plans"][0]["side"] = "middle"
    values["readings"][1]["direction"] = [1, 2, 3]
    values["registration"]["matrix"][0][0] = 0.5
    values["tool_axis"] = "ahead"
    values["tool_axis_quality_deg"] = -1
    return values


def test_what_is_good_of_a_damaged_file_is_kept(tmp_path: Path, kept: Kept) -> None:
    path = tmp_path / "guidance.json"
    path.write_text(json.dumps(damaged(kept)))
    found, problems = load(path)
    assert [plan.name for plan in found.plans] == ["box"]
    assert [one.number for one in found.readings] == [1]
    assert (found.registration, found.tool_axis, found.tool_axis_quality_deg) == (None, Kept.tool_axis, 0.0)
    assert len(problems) == 6
    assert "plans" in problems[0]
    assert problems[-1].endswith("guidance.broken-1.json.")
    assert json.loads((tmp_path / "guidance.broken-1.json").read_text())["plans"][0]["side"] == "middle"
    # and it is saved, so that the next start finds it without a word
    again, silent = load(path)
    assert repr(again) == repr(found)
    assert silent == []


def test_lists_that_are_none_are_left_out() -> None:
    found, problems = from_text('{"imugui_guidance": 1, "plans": 3, "readings": {"a": 1}}')
    assert found == Kept()
    assert len(problems) == 2


def test_a_write_that_fails_leaves_the_old_file(tmp_path: Path, kept: Kept, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "guidance.json"
    save(path, kept)

    def full(_: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(OSError, match="No space"):
        save(path, Kept())
    monkeypatch.undo()
    assert repr(load(path)[0]) == repr(kept)
    assert [file.name for file in tmp_path.iterdir()] == ["guidance.json"]


def test_numbers_that_are_not_known_are_null(kept: Kept) -> None:
    assert "NaN" not in to_text(kept)
    assert math.isnan(from_text(to_text(kept))[0].plans[0].depth_mm)
