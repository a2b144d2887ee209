"""What of a study is done, as its targets tell: which runs are complete, and which blocks were left in the middle."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from imugui.targeting.study_plan import StudyPlan
from imugui.targeting.study_steps import Step, steps_of, targets_in_run
from imugui.targeting.study_store import BlockKey
from imugui.targeting.trials import Trial

RunKey = tuple[str, str, int, int]
"""Participant, condition, block, run."""


@dataclass(frozen=True)
class Sorted:
    """The targets of a study, by what became of their blocks."""

    whole: tuple[Trial, ...]  # of blocks that are complete
    partial: frozenset[BlockKey]  # blocks that were left in the middle
    strangers: int  # targets that belong to no run of the plan


@dataclass(frozen=True)
class Progress:
    """How far a person is, or a study."""

    done: int
    total: int

    @property
    def words(self) -> str:
        """For the screen."""
        return f"{self.done} of {self.total} steps done"


def key_of_step(step: Step) -> RunKey:
    """The run of a step that is played."""
    return step.participant, step.condition, step.block, step.run


def key_of(trial: Trial) -> RunKey:
    """The run of a target."""
    return trial.participant, trial.condition, trial.block, trial.run


def all_runs(plan: StudyPlan) -> dict[RunKey, Step]:
    """Every run of a study."""
    steps = (step for person in plan.participants for step in steps_of(plan, person))
    return {key_of_step(step): step for step in steps if step.played}


def complete(places: Iterable[int], targets: int) -> bool:
    """Whether these places of targets in a run are all of them, each once."""
    return sorted(places) == list(range(targets))


def sort_trials(plan: StudyPlan, trials: Iterable[Trial]) -> Sorted:
    """Find the blocks that are complete, and those that were left in the middle."""
    runs, targets, strangers = all_runs(plan), targets_in_run(plan), 0
    found: dict[BlockKey, list[Trial]] = {}
    for trial in trials:
        if (step := runs.get(key_of(trial))) is None:
            strangers += 1
        else:
            found.setdefault(step.block_key, []).append(trial)
    wanted: dict[BlockKey, list[RunKey]] = {}
    for key, step in runs.items():
        wanted.setdefault(step.block_key, []).append(key)
    partial = {
        block
        for block, own in found.items()
        if not all(complete((one.index for one in own if key_of(one) == key), targets) for key in wanted[block])
    }
    whole = (trial for block, own in found.items() if block not in partial for trial in own)
    return Sorted(tuple(whole), frozenset(partial), strangers)
