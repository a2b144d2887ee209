"""The table of trials: exact digits there and back, and whatever can be read of a damaged one."""

from __future__ import annotations

import dataclasses
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from imugui.targeting.trials import (
    COLUMNS,
    FIELDS,
    LARGEST,
    SELECTIONS,
    TASKS,
    Trial,
    read_trials,
    trial_line,
    trials_csv,
)

numbers = st.floats(allow_infinity=False)
counts = st.integers(-LARGEST, LARGEST)
vectors = st.tuples(numbers, numbers, numbers)
words = st.text(st.characters(exclude_characters="\r\n", exclude_categories=["Cs"]), max_size=12)
KINDS = {"str": words, "int": counts, "float": numbers, "bool": st.booleans(), "Vector": vectors}
SPECIAL = {
    "task": st.sampled_from(TASKS),
    "selection": st.sampled_from(SELECTIONS),
    "max_rotation_deg": st.lists(st.floats(allow_infinity=False, allow_nan=False), max_size=4).map(tuple),
}
trials = st.builds(
    Trial,
    **{
        one.name: (SPECIAL[one.name] if one.name in SPECIAL else KINDS[str(one.type)])
        for one in dataclasses.fields(Trial)
    },
)
ONE = Trial("study", "P1", "speed", 2, False, 3, 4, movement_time_s=1.5, max_rotation_deg=(1.0, 2.5), error=True)


def same(a: Trial, b: Trial) -> bool:
    """Equal in every digit, NaN with NaN."""
    return repr(a) == repr(b)


@given(st.lists(trials, max_size=3))
def test_every_digit_comes_back(given_trials: list[Trial]) -> None:
    back, problems = read_trials(trials_csv(given_trials, {"study": "one\ntwo"}))
    assert problems == []
    assert len(back) == len(given_trials)
    assert all(map(same, back, given_trials))


def test_columns_are_one_for_each_field_and_axis() -> None:
    assert len(COLUMNS) == len(FIELDS) + 4
    assert {"min_x_deg", "max_z_deg", "max_rotation_deg"} <= set(COLUMNS)
    assert COLUMNS[-1] == "error"


def test_a_name_with_line_ends_stays_one_row() -> None:
    text = trials_csv([dataclasses.replace(ONE, study='a\r\n"b", c')])
    assert text.count("\n") == 2
    assert read_trials(text)[0][0].study == 'a "b", c'


@given(st.integers(1, 200))
def test_a_row_cut_anywhere_is_told_and_the_rest_is_read(cut: int) -> None:
    line = trial_line(dataclasses.replace(ONE, study='quoted, "name"'))
    broken = line[: max(0, len(line) - 1 - cut)]
    text = trials_csv([ONE]) + broken + "\n" + trial_line(ONE)
    back, problems = read_trials(text)
    assert len(back) == 2
    assert all(same(one, ONE) for one in back)
    assert len(problems) == (1 if broken.strip() else 0)


def test_a_table_that_ends_without_a_line_end_lost_nothing() -> None:
    assert len(read_trials(trials_csv([ONE, ONE])[:-1])[0]) == 2


@pytest.mark.parametrize(
    ("column", "value", "said"),
    [
        ("block", "two", "block: 'two'"),
        ("movement_time_s", "1.5.2", "movement_time_s: '1.5.2'"),
        ("to_x", "inf", "to_x: 'inf'"),
        ("error", "maybe", "error: 'maybe'"),
        ("task", "golf", "none of fov, ring"),
        ("max_rotation_deg", "1 x", "max_rotation_deg: '1 x'"),
        ("min_y_deg", "-", "min_y_deg: '-'"),
    ],
)
def test_a_bad_cell_is_named_with_its_line(column: str, value: str, said: str) -> None:
    cells = trial_line(ONE).rstrip("\n").split(",")
    cells[COLUMNS.index(column)] = value
    back, problems = read_trials(trials_csv([ONE], {"a": 1}) + ",".join(cells) + "\n")
    assert len(back) == 1
    assert len(problems) == 1
    assert problems[0].startswith("line 4: ")
    assert said in problems[0]


def test_other_tables_are_read_as_far_as_they_go() -> None:
    head = "\ufeff# a: b\r\n\r\nmovement_time_s, condition ,colour,participant\r\n"
    text = head + " 2.5 ,speed,red,P1\r\n\r\n,speed,red,P2\r\n"
    back, problems = read_trials(text)
    assert problems == []
    assert [(one.participant, one.condition) for one in back] == [("P1", "speed"), ("P2", "speed")]
    assert back[0].movement_time_s == 2.5
    assert math.isnan(back[1].movement_time_s)
    assert math.isnan(back[0].to_x)


@pytest.mark.parametrize("text", ["", "\n\n", "t,ax,ay\n1,2,3\n", "# only: this\n", "\x00\x01,\xff"])
def test_what_is_no_table_of_trials_says_so(text: str) -> None:
    back, problems = read_trials(text)
    assert back == []
    assert len(problems) == 1
    assert "no column participant" in problems[0]


@given(st.text(max_size=300))
def test_no_text_is_an_exception(text: str) -> None:
    read_trials(text)
    back, problems = read_trials(trials_csv([ONE]) + text)
    assert same(back[0], ONE)
    assert len(back) + len(problems) >= 1


def test_a_huge_cell_is_one_bad_row() -> None:
    back, problems = read_trials(trials_csv([ONE]) + "x" * 200_000 + "\n" + trial_line(ONE))
    assert (len(back), len(problems)) == (2, 1)


def test_widths_and_selections() -> None:
    assert Trial(task="fov", tolerance_px=9.0).target_width_px == 18.0
    assert Trial(task="ring", width_px=40.0).target_width_px == 40.0
    assert [Trial(selection=one).automatic for one in SELECTIONS] == [True, False, True, True]
