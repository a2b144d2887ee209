"""What speaks for a column map and against it."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import pytest

from imugui.formats.column_map import ColumnMap
from imugui.formats.guess import belonging_files, guess_files
from imugui.formats.layout import Layout
from imugui.formats.preview import Preview, preview

SAMPLES = Path(__file__).resolve().parent.parent / "data"


def tables(file: str) -> list[tuple[Layout, ColumnMap]]:
    return [(table.layout, table.column_map) for table in guess_files(belonging_files(SAMPLES / file)).used]


def changed(old: str, new: str) -> Preview:
    """The MATLAB sample with other words in its columns."""
    ((layout, column_map),) = tables("matlab-writetable.csv")
    columns = tuple(name.replace(old, new) for name in column_map.columns)
    return preview([(layout, dataclasses.replace(column_map, columns=columns))])


def tones(found: Preview) -> dict[str, str]:
    return {one.about: one.tone for one in found.findings}


@pytest.mark.parametrize(
    "file", ["matlab-writetable.csv", "phyphox", "sensor-logger-combined.csv", "x-imu3/Inertial.csv"]
)
def test_a_right_map_has_everything_for_it(file: str) -> None:
    found = preview(tables(file))
    assert tones(found) == {"rate": "good", "gravity": "good", "turning": "good", "field": "good"}
    assert "50 rows a second" in found.findings[0].text
    assert not found.contradicts
    assert len(found.rows) == 200


@pytest.mark.parametrize(
    ("old", "new", "about", "words"),
    [
        ("_g", "_mg", "gravity", "it should be 9.81"),
        ("deg/s", "rad/s", "turning", "times too fast"),
        ("deg/s", "dps/131", "turning", "times too slow"),
        ("deg/s", "deg/s*-1", "turning", "the other way"),
        ("uT", "mG", "field", "not the earth's"),
    ],
)
def test_a_wrong_unit_has_something_against_it(old: str, new: str, about: str, words: str) -> None:
    found = changed(old, new)
    against = [one for one in found.findings if one.tone == "warn"]
    assert {about} <= {one.about for one in against} <= {about, "lines"}  # too fast a turn makes a line impossible
    assert words in against[0].text
    assert found.contradicts is (about != "field")


def test_what_is_missing_is_said() -> None:
    assert tones(changed("m", "-"))["missing"] == "neutral"
    ((layout, column_map),) = tables("matlab-writetable.csv")
    columns = (*column_map.columns[:4], "-", "-", "-", *column_map.columns[7:])
    found = preview([(layout, dataclasses.replace(column_map, columns=columns))])
    assert "no gyroscope: signals to look at, but no attitude" in [one.text for one in found.findings]


def test_what_cannot_be_read_is_a_problem() -> None:
    ((layout, column_map),) = tables("matlab-writetable.csv")
    linear = tuple(name.replace("a", "lin", 1) if name[0] == "a" else name for name in column_map.columns)
    without_gravity = preview([(layout, dataclasses.replace(column_map, columns=linear))])
    assert preview([]).problem == "no column is used"
    assert "no column for az" in changed("az_g", "-").problem
    assert "impossible acceleration" in changed("_g", "_g*99").problem
    assert "without gravity" in without_gravity.problem
    assert changed("_g", "_g*99").contradicts
