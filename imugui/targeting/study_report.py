"""The report of a study from its folder: what counts, what does not and why, and the two files that say it."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable
from datetime import datetime
from pathlib import Path

from imugui.paths import replace_file
from imugui.targeting.design import honesty
from imugui.targeting.measures import runs_csv
from imugui.targeting.questionnaires import Answer
from imugui.targeting.results import Results, results
from imugui.targeting.results_report import report_html
from imugui.targeting.settings import Control
from imugui.targeting.study_plan import StudyPlan, before_it_starts, orders
from imugui.targeting.study_progress import Sorted, all_runs, sort_trials
from imugui.targeting.study_store import REST, TRIALS, Stored, load
from imugui.targeting.trials import Trial

REPORT, RUNS = "report.html", "runs.csv"


def write_report(folder: Path, now: datetime) -> Results:
    """Write report.html and runs.csv into the folder of a study, which may still be going on.

    ``now`` with its time zone. Raises StudyError and OSError.
    """
    found = study_results(load(folder))
    replace_file(folder / REPORT, report_html(found, now))
    replace_file(folder / RUNS, runs_csv(found.runs))
    return found


def study_results(stored: Stored) -> Results:
    """Compare the conditions of a study as far as it has come.

    Only complete blocks count, and of each person only those that were played in every condition: otherwise what
    people learn over the blocks would look like a difference of the conditions.
    """
    plan, found = stored.plan, sort_trials(stored.plan, stored.trials)
    fair = comparable(plan, found.whole)
    answers = last_answers(answer for answer in stored.answers if answer.kind != REST)
    one = results(fair, plan.condition_names, orders(plan), answers, plan.same_targets)
    known = len(honesty(len(one.people), len(one.conditions), plan.same_targets))
    honest = before_it_starts(dataclasses.replace(plan, participants=one.people))
    notes = (*design_words(plan), *honest, *_left_out(stored, found, len(fair)), *one.notes[known:])
    title = f"{plan.name} (simulated people)" if plan.simulated else plan.name
    return dataclasses.replace(one, study=title, notes=notes)


def comparable(plan: StudyPlan, trials: Iterable[Trial]) -> list[Trial]:
    """The targets of those blocks that their person has played in every condition."""
    trials = list(trials)
    played: dict[tuple[str, int], set[str]] = {}
    for trial in trials:
        played.setdefault((trial.participant, trial.block), set()).add(trial.condition)
    return [one for one in trials if len(played[one.participant, one.block]) == len(plan.conditions)]


def last_answers(answers: Iterable[Answer]) -> list[Answer]:
    """What each person said last to each question."""
    said = {(one.participant, one.kind, one.kind == "preference" or one.condition): one for one in answers}
    return list(said.values())


def design_words(plan: StudyPlan) -> list[str]:
    """How the study is made, one sentence each."""
    practice = f"{counted(plan.practice_runs, 'practice run')}, then " if plan.practice_runs else ""
    lists = "The target lists are the same" if plan.same_targets else "Target lists of equal difficulty"
    return [
        f"Everybody meets every condition (order: {plan.order}); in each {practice}{counted(plan.blocks, 'block')} of "
        f"{counted(plan.runs, 'run')}. {lists} in each condition (seed {plan.seed}).",
        differences(plan),
    ]


def differences(plan: StudyPlan) -> str:
    """The settings in which the conditions are not the same, with their values in the order of the conditions."""
    said = []
    for item in dataclasses.fields(Control):
        values = [getattr(control, item.name) for control in plan.conditions.values()]
        if len(set(values)) > 1:
            label, unit = item.metadata["label"], item.metadata["unit"]
            each = ", ".join(f"{value:g}" if isinstance(value, float) else str(value) for value in values)
            said.append(f"{label[0].lower()}{label[1:]} ({f'{each} {unit}'.rstrip()})")
    names = " and ".join(plan.conditions)
    return f"{names} differ in {'; '.join(said)}." if said else f"{names}: the same settings."


def counted(count: int, word: str) -> str:
    """Like "1 block" and "3 blocks"."""
    return f"{count} {word}{'s' * (count != 1)}"


def _left_out(stored: Stored, found: Sorted, fair: int) -> list[str]:
    """What is in the folder and does not count."""
    said = list(stored.problems)
    begun = len(stored.trials) - len(found.whole) - found.strangers
    alone = len(found.whole) - fair
    counts = {
        f"of blocks that were interrupted and began again ({TRIALS} keeps them, marked)": stored.interrupted,
        "of blocks that are not complete": begun,
        "that belong to no run of this study": found.strangers,
        "of blocks that their person has not yet played in every condition": alone,
    }
    said += [f"Left out: {counted(count, 'target')} {words}." for words, count in counts.items() if count]
    return said + _not_through(stored.plan, found)


def _not_through(plan: StudyPlan, found: Sorted) -> list[str]:
    played = {(one.participant, one.condition, one.block) for one in found.whole}
    blocks = {step.block_key for step in all_runs(plan).values()}
    lacking = dict.fromkeys(key[0] for key in blocks - played)
    people = [person for person in plan.participants if person in lacking]
    return [f"Not through with the study: {', '.join(people)}."] if people else []
