"""The command ``imugui study``: a study played by simulated people, and the report of any study."""

from __future__ import annotations

from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path

from imugui.targeting.results import PRIMARY, Results, sentence
from imugui.targeting.study import Study
from imugui.targeting.study_plan import SIMULATED, StudyPlan, before_it_starts, codes
from imugui.targeting.study_report import REPORT, write_report
from imugui.targeting.study_simulated import play_on
from imugui.targeting.study_steps import Step
from imugui.targeting.study_store import StudyError

Say = Callable[[str], None]
"""Told the progress, one line at a time."""


def simulate(out: Path, participants: int, blocks: int, runs: int, seed: int, resume: bool, say: Say) -> str:
    """Let simulated people play position against speed; the summary. Raises StudyError and OSError.

    ``resume``: go on with a study of simulated people that was interrupted; the plan is then the one in the folder.
    """
    if resume:
        study = Study.open(out)
        if not study.plan.simulated:
            raise StudyError(f"{out} is a study with people: only they can go on with it")
    else:
        plan = StudyPlan(
            codes(participants),
            simulated=True,
            name="position against speed",
            blocks=blocks,
            runs=runs,
            preference=False,
            seed=seed,
        )
        study = Study.create(out, plan)
    for line in (*study.problems, *before_it_starts(study.plan)):
        say(line)
    play_on(study, tell=lambda study, step: _tell(study, step, say))
    return report(out)


def report(folder: Path) -> str:
    """Write the report of a study into its folder; the summary. Raises StudyError and OSError."""
    return summary(write_report(folder, datetime.now(UTC)), folder / REPORT)


def summary(found: Results, path: Path) -> str:
    """The result of a study in one line."""
    first = [one for one in found.comparisons if one.measure == PRIMARY and one.people]
    words = " ".join(map(sentence, first)) or "Nobody has met two conditions yet: there is nothing to compare."
    simulated = "Simulated people: " if SIMULATED in found.notes else ""
    return f"{simulated}{words} Report: {path}"


def _tell(study: Study, step: Step, say: Say) -> None:
    if study.next_step(step.participant) is None:
        say(f"{step.participant} is through: {study.progress().words}.")
