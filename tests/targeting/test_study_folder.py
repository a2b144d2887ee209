"""A study in its folder: what comes next, what is kept, and what a killed program or a broken file does to it."""

from __future__ import annotations

import csv
import errno
import os
import shutil
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from imugui.targeting.study import Study
from imugui.targeting.study_plan import StudyPlan, codes
from imugui.targeting.study_report import comparable, study_results
from imugui.targeting.study_steps import PRACTICE, PREFERENCE, REST, RUN, TLX, Step
from imugui.targeting.study_store import StudyError, add_trials, load
from imugui.targeting.trials import Trial

PLAN = StudyPlan(codes(2), name="pilot", blocks=2, runs=2, tlx=True)
TARGETS = 5


def trials_of(study: Study, step: Step, count: int = TARGETS) -> Iterator[Trial]:
    """The first targets of a run, as the game would give them; each takes a time of its own."""
    for index in range(count):
        seconds = 2.0 + step.block / 10 + index / 100 + (step.condition == "speed")
        yield Trial(
            study.plan.name, step.participant, step.condition, step.block, step.kind == PRACTICE, step.run, index,
            t_start=10.0, t_end=10.0 + seconds, movement_time_s=seconds,
        )  # fmt: skip


def do(study: Study, step: Step, count: int = TARGETS) -> None:
    """Do one step, or the first targets of it."""
    if step.played:
        study.begin(step)
        for trial in trials_of(study, step, count):
            assert study.add(trial)
    elif step.kind == REST:
        study.rested(step)
    else:
        study.answer(step)


def do_all(study: Study, person: str, until: int = 10**6) -> None:
    """Do the steps of a person up to a number."""
    while (step := study.next_step(person)) and step.number < until:
        do(study, step)


def rows_of(folder: Path) -> list[dict[str, str]]:
    lines = [line for line in (folder / "trials.csv").read_text().splitlines() if not line.startswith("#")]
    return list(csv.DictReader(lines))


@pytest.fixture
def study(tmp_path: Path) -> Study:
    return Study.create(tmp_path / "pilot", PLAN)


def test_a_person_goes_through_all_steps_in_order_and_is_through(study: Study) -> None:
    met = []
    while step := study.next_step("P01"):
        met.append(step)
        do(study, step)
    assert tuple(met) == study.steps("P01")
    assert study.next_person() == "P02"
    assert study.progress("P01").words == f"{len(met)} of {len(met)} steps done"
    assert study.progress().done == len(met)
    do_all(study, "P02")
    assert study.next_person() is None


def test_every_target_is_in_the_file_as_soon_as_it_is_done(study: Study) -> None:
    step = study.next_step("P01")
    assert step is not None
    study.begin(step)
    for count, trial in enumerate(trials_of(study, step), 1):
        study.add(trial)
        rows = rows_of(study.folder)
        assert len(rows) == count
        assert (rows[-1]["index"], rows[-1]["interrupted"]) == (str(trial.index), "0")
        assert float(rows[-1]["movement_time_s"]) == trial.movement_time_s


@pytest.mark.parametrize("until", range(18))
def test_opened_again_it_goes_on_with_the_same_step(study: Study, until: int) -> None:
    do_all(study, "P01", until)
    again = Study.open(study.folder)
    step, before = again.next_step("P01"), study.next_step("P01")
    assert before is not None
    # a block whose first run alone is done begins again
    within = before.kind == RUN and before.run == 2
    assert step == study.steps("P01")[before.number - within]
    assert again.next_step("P02") == study.steps("P02")[0]
    assert (
        again.problems
        == [f"P01 was interrupted in block {before.block} with “{before.condition}”: it begins again."] * within
    )


def test_an_interrupted_block_begins_again_and_its_targets_stay_marked(study: Study) -> None:
    do_all(study, "P01", 6)
    step = study.next_step("P01")
    assert step is not None
    assert (step.block, step.run) == (2, 2)
    do(study, step, 3)
    before = rows_of(study.folder)

    again = Study.open(study.folder)
    first = again.next_step("P01")
    assert first is not None
    assert (first.block, first.run, first.condition) == (2, 1, "position")
    rows = rows_of(study.folder)
    assert [row | {"interrupted": "0"} for row in rows] == before
    marked = [row for row in rows if row["interrupted"] == "1"]
    assert [(row["block"], row["run"], row["index"]) for row in marked] == [
        *(("2", "1", str(k)) for k in range(5)), ("2", "2", "0"), ("2", "2", "1"), ("2", "2", "2"),
    ]  # fmt: skip

    do_all(again, "P01")
    do_all(again, "P02")
    found = study_results(load(study.folder))
    assert sum(run.targets for run in found.runs) == 2 * 2 * 5 * TARGETS
    assert any("Left out: 8 targets of blocks that were interrupted" in note for note in found.notes)


def test_a_run_that_is_left_begins_its_block_again_at_once(study: Study) -> None:
    do_all(study, "P01", 3)
    step = study.next_step("P01")
    assert step is not None
    do(study, step, 2)
    study.interrupt()
    first = study.next_step("P01")
    assert first is not None
    assert (first.block, first.run) == (1, 1)
    assert study.running is None
    do_all(study, "P01")
    assert len(rows_of(study.folder)) == 2 * 5 * TARGETS + TARGETS + 2
    assert Study.open(study.folder).next_step("P01") is None


def test_leaving_a_run_before_its_first_target_marks_nothing(study: Study) -> None:
    step = study.next_step("P01")
    assert step is not None
    study.begin(step)
    table = (study.folder / "trials.csv").read_bytes()
    study.interrupt()
    assert (study.folder / "trials.csv").read_bytes() == table
    assert study.next_step("P01") == step


def test_only_the_next_step_can_begin(study: Study) -> None:
    for number in (1, 2):
        with pytest.raises(ValueError, match="something else next"):
            study.begin(study.steps("P01")[number])


def test_a_target_of_another_run_is_not_taken(study: Study) -> None:
    step = study.next_step("P01")
    assert step is not None
    first, second = trials_of(study, step, 2)
    assert not study.add(first)  # nothing has begun
    study.begin(step)
    assert not study.add(replace(first, participant="P02"))
    assert not study.add(replace(first, block=1))
    assert not study.add(second)
    assert study.add(first)
    assert not study.add(first)
    assert len(rows_of(study.folder)) == 1


def test_answers_are_kept_and_bad_ones_refused(study: Study) -> None:
    do_all(study, "P01")
    tlx = [step for step in study.steps("P02") if step.kind == TLX]
    with pytest.raises(ValueError, match="TLX needs 6"):
        study.answer(tlx[0], (10.0, 20.0))
    with pytest.raises(ValueError, match="no condition maze"):
        study.answer(study.steps("P02")[-1], liked="maze")
    study.answer(tlx[0], (10.0, 20.0, 30.0, 40.0, 50.0, 60.0))
    study.answer(tlx[0], (0.0, 0.0, 0.0, 0.0, 0.0, 30.0))
    study.answer(study.steps("P02")[-1], liked="speed")
    again = Study.open(study.folder)
    assert again.done(tlx[0])
    assert not again.done(tlx[1])
    answers = {(one.participant, one.kind, one.condition): one for one in study_results(load(study.folder)).answers}
    assert answers["P02", TLX, "speed"].score == 5.0  # the last word counts
    assert ("P02", PREFERENCE, "speed") in answers
    assert ("P01", PREFERENCE, "") in answers  # without a preference
    assert not any(kind == REST for _, kind, _ in answers)


def test_a_full_disk_loses_nothing(study: Study, monkeypatch: pytest.MonkeyPatch) -> None:
    step = study.next_step("P01")
    assert step is not None
    study.begin(step)
    trials = list(trials_of(study, step))
    study.add(trials[0])
    table = study.folder / "trials.csv"
    kept = table.read_bytes()
    # a folder in its place cannot be written to, even by root
    table.unlink()
    table.mkdir()
    for trial in trials[1:3]:
        with pytest.raises(OSError, match=os.strerror(errno.EISDIR)):
            study.add(trial)
    table.rmdir()
    table.write_bytes(kept)
    study.add(trials[3])
    assert [row["index"] for row in rows_of(study.folder)] == ["0", "1", "2", "3"]
    kept = table.read_bytes()
    table.unlink()
    table.mkdir()
    with pytest.raises(OSError, match=os.strerror(errno.EISDIR)):
        study.add(trials[4])
    table.rmdir()
    table.write_bytes(kept)
    rest = study.next_step("P01")
    assert rest == study.steps("P01")[1]
    study.rested(rest)
    assert len(rows_of(study.folder)) == TARGETS


def test_a_study_needs_a_folder_of_its_own_and_a_whole_plan(tmp_path: Path) -> None:
    (tmp_path / "note.txt").write_text("mine")
    with pytest.raises(StudyError, match="is not empty"):
        Study.create(tmp_path, PLAN)
    with pytest.raises(StudyError, match="is not empty"):
        Study.create(tmp_path / "note.txt", PLAN)
    with pytest.raises(StudyError, match="1 to 500 participants"):
        Study.create(tmp_path / "new", replace(PLAN, participants=()))
    assert not (tmp_path / "new").exists()
    with pytest.raises(StudyError, match=r"holds no study: there is no study\.json"):
        Study.open(tmp_path)


def test_a_broken_plan_is_set_aside_and_its_copy_used(study: Study) -> None:
    do_all(study, "P01")
    plan = study.folder / "study.json"
    for content in (
        b"",
        b'{"imugui_study": 1, "plan": {',
        b"\xff\xfe",
        plan.read_bytes().replace(b'"blocks": 2', b'"blocks": 3'),
    ):
        plan.write_bytes(content)
        again = Study.open(study.folder)
        assert again.plan == PLAN
        assert again.next_person() == "P02"
        assert again.problems[0].startswith("study.json is not used: ")
        assert again.problems[1] == "The copy of the plan is used."
        assert again.problems[2].startswith("The old study.json is kept as study.broken-")
        assert Study.open(study.folder).problems == []
    assert len(list(study.folder.glob("study.broken-*.json"))) == 4


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('"plan": {', '"plan": [', "holds no study that can go on: study.json is not used: it is no valid JSON"),
        ('"imugui_study": 1', '"imugui_study": 99', r"made by a newer imugui \(version 99"),
    ],
)
def test_without_a_plan_nothing_is_touched(study: Study, old: str, new: str, words: str) -> None:
    texts = {name: (study.folder / name).read_text().replace(old, new) for name in ("study.json", "study.copy.json")}
    for name, text in texts.items():
        (study.folder / name).write_text(text)
    with pytest.raises(StudyError, match=words):
        Study.open(study.folder)
    assert {name: (study.folder / name).read_text() for name in texts} == texts


def test_tables_that_are_none_are_set_aside(study: Study) -> None:
    do_all(study, "P01")
    (study.folder / "trials.csv").write_bytes(b"\x00\x01\xff" * 100)
    (study.folder / "answers.csv").unlink()
    again = Study.open(study.folder)
    assert again.problems == [
        "trials.csv is not used: it is no table of ours.",
        "answers.csv is not used: it is missing.",
        "The old trials.csv is kept as trials.broken-1.csv.",
    ]
    assert again.next_step("P01") == again.steps("P01")[0]
    assert (study.folder / "trials.broken-1.csv").read_bytes() == b"\x00\x01\xff" * 100
    do_all(again, "P01")
    assert Study.open(study.folder).problems == []


def test_a_row_that_was_cut_short_costs_its_block_only(study: Study) -> None:
    do_all(study, "P01", 6)
    table = study.folder / "trials.csv"
    table.write_bytes(table.read_bytes()[:-40])
    again = Study.open(study.folder)
    assert again.problems[0].startswith("trials.csv: 1 row is not read; the first is line 24: ")
    step = again.next_step("P01")
    assert step is not None
    assert (step.block, step.run) == (2, 1)
    do_all(again, "P01")
    # the cut row has not spoiled the one after it
    assert Study.open(study.folder).next_step("P01") is None


@pytest.mark.parametrize("cut", range(1, 27))
def test_an_answer_that_was_cut_short_is_asked_again(study: Study, cut: int) -> None:
    step = next(step for step in study.steps("P01") if step.kind == TLX)
    study.answer(step, (5.0,) * 6)
    table = study.folder / "answers.csv"
    content = table.read_bytes()
    assert content.endswith(b"P01,position,5 5 5 5 5 5,tlx\n")
    table.write_bytes(content[:-cut])
    again = Study.open(study.folder)
    assert again.done(step) == (cut == 1)  # only the end of the line is missing
    again.answer(step, (10.0,) * 6)
    assert [one.score for one in study_results(load(study.folder)).answers] == [10.0]


@pytest.fixture(scope="module")
def half_done(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A short study in the middle of its second condition."""
    plan = replace(PLAN, participants=codes(1), blocks=1, runs=1)
    study = Study.create(tmp_path_factory.mktemp("half") / "done", plan)
    do_all(study, "P01", 6)
    step = study.next_step("P01")
    assert step is not None
    do(study, step, 2)
    return study.folder


@settings(max_examples=25, deadline=None)
@given(
    st.sampled_from(["study.json", "trials.csv", "answers.csv"]),
    st.floats(0.0, 1.0),
    st.integers(0, 300),
    st.binary(max_size=12),
)
def test_whatever_the_files_hold_it_opens_goes_on_and_keeps_them(
    half_done: Path, name: str, place: float, length: int, junk: bytes
) -> None:
    with TemporaryDirectory() as home:
        folder = Path(shutil.copytree(half_done, Path(home) / "study"))
        content = (folder / name).read_bytes()
        start = round(place * len(content))
        (folder / name).write_bytes(content[:start] + junk + content[start + length :])
        study = Study.open(folder)
        do_all(study, "P01")
        assert study.next_step("P01") is None
        assert Study.open(folder).next_step("P01") is None
        found = study_results(load(folder))
        assert sum(run.targets for run in found.runs) == 2 * 2 * TARGETS


def test_targets_of_no_run_are_said_and_left_out(study: Study) -> None:
    do_all(study, "P01")
    add_trials(study.folder, PLAN, [Trial("pilot", "P99", "position", 1, run=1, movement_time_s=1.0)])
    again = Study.open(study.folder)
    assert again.problems == ["Rows of trials.csv that belong to no run of this study: 1."]
    assert "P99" not in study_results(load(study.folder)).people


def test_a_report_may_be_made_while_the_study_goes_on(study: Study) -> None:
    do_all(study, "P01")
    do_all(study, "P02", 4)
    step = study.next_step("P02")
    assert step is not None
    do(study, step, 0)
    table = (study.folder / "trials.csv").read_bytes()
    found = study_results(load(study.folder))
    assert found.people == ("P01",)
    assert "Not through with the study: P02." in found.notes
    assert (study.folder / "trials.csv").read_bytes() == table


def test_only_blocks_played_in_every_condition_are_compared(study: Study) -> None:
    do_all(study, "P01", 14)  # both blocks of the first condition, practice and one block of the second
    assert study.next_step("P01") is not None
    stored = load(study.folder)
    found = study_results(stored)
    assert {(run.condition, run.block) for run in found.runs} == {
        (condition, block) for condition in ("position", "speed") for block in (0, 1)
    }
    assert "Left out: 10 targets of blocks that their person has not yet played in every condition." in found.notes
    assert len(comparable(PLAN, stored.trials)) == len(stored.trials) - 10


def test_a_study_without_any_target_has_a_report_that_says_how_it_is_made(study: Study) -> None:
    found = study_results(load(study.folder))
    assert found.people == ()
    notes = found.notes
    assert "Not through with the study: P01, P02." in notes
    assert notes[1] == "position and speed differ in mapping (position, speed); dead zone (0, 1.5 °)."
    assert notes[0] == (
        "Everybody meets every condition (order: AB/BA); in each 1 practice run, then 2 blocks of 2 runs. The target "
        "lists are the same in each condition (seed 1)."
    )
