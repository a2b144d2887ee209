"""Simulated people play studies of every shape through the folder that real ones use."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from imugui.targeting import study_simulated
from imugui.targeting.person import Person
from imugui.targeting.settings import PRESETS
from imugui.targeting.study import Study
from imugui.targeting.study_plan import SIMULATED, WILLIAMS, StudyPlan, codes, orders
from imugui.targeting.study_report import study_results
from imugui.targeting.study_simulated import play_on, simulate_study
from imugui.targeting.study_steps import SUS, TLX, Step
from imugui.targeting.study_store import StudyError, load
from imugui.targeting.tasks import BUTTON, Task

SHORT = StudyPlan(
    codes(2), task=Task(targets=1), simulated=True, name="short", practice_runs=0, blocks=1, tlx=True, sus=True
)


def test_three_conditions_in_williams_order_with_every_kind_of_step(tmp_path: Path) -> None:
    names = ("position", "speed", "thesis position")
    conditions = {name: PRESETS[name] for name in names}
    plan = replace(SHORT, conditions=conditions, order=WILLIAMS, same_targets=False, participants=codes(3))
    study = simulate_study(plan, tmp_path / "s")
    assert study.next_person() is None
    assert study.progress().done == study.progress().total
    stored = load(study.folder)
    met: dict[str, list[str]] = {}
    for trial in stored.trials:
        met.setdefault(trial.participant, []).append(trial.condition)
    assert met == orders(plan)
    found = study_results(stored)
    assert [(one.a, one.b) for one in found.comparisons[:3]] == [
        (names[0], names[1]), (names[0], names[2]), (names[1], names[2]),
    ]  # fmt: skip
    assert all(answer.values == () for answer in found.answers)  # simulated people have no opinion
    assert SIMULATED in found.notes


def test_the_people_may_be_given(tmp_path: Path) -> None:
    slow = replace(Person(), think_s=5.0)
    study = simulate_study(SHORT, tmp_path / "s", {"P01": Person(), "P02": slow})
    times = dict.fromkeys(study.people, 0.0)
    for trial in load(study.folder).trials:
        times[trial.participant] += trial.movement_time_s
    assert times["P02"] > times["P01"] + 4.0


def test_people_select_by_button_too(tmp_path: Path) -> None:
    plan = replace(SHORT, task=Task(targets=3, selection=BUTTON), participants=codes(1))
    study = simulate_study(plan, tmp_path / "s")
    assert {trial.selection for trial in load(study.folder).trials} == {"button"}


def test_a_run_that_nobody_finishes_ends_the_study_with_a_sentence(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(study_simulated, "LONGEST_S", 4.0)
    plan = replace(SHORT, task=Task(targets=5))
    study = Study.create(tmp_path / "s", plan)
    with pytest.raises(StudyError, match="P01 did not get through a run with position in 4 s"):
        play_on(study)
    assert study.next_step("P01") == study.steps("P01")[0]
    assert load(study.folder).trials == ()


def test_both_forms_are_kept_with_their_scores(tmp_path: Path) -> None:
    study = Study.create(tmp_path / "s", SHORT)
    forms = {step.kind: step for step in reversed(study.steps("P02")) if step.asked}
    study.answer(forms[TLX], (0.0, 0.0, 0.0, 0.0, 0.0, 30.0))
    study.answer(forms[SUS], (4.0, 2.0) * 5)
    said = [(one.kind, one.condition, one.score) for one in study_results(load(study.folder)).answers]
    assert said == [(TLX, "speed", 5.0), (SUS, "speed", 75.0)]


def test_the_progress_is_told_after_each_step(tmp_path: Path) -> None:
    study = Study.create(tmp_path / "s", replace(SHORT, participants=codes(1)))
    told: list[tuple[int, Step]] = []
    play_on(study, tell=lambda study, step: told.append((study.progress().done, step)))
    assert told == list(enumerate(study.steps("P01"), 1))
