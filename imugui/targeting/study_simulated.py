"""A study that simulated people play, through the same game, the same folder and the same report as real ones."""

from __future__ import annotations

import zlib
from collections.abc import Callable, Mapping
from pathlib import Path

from imugui.targeting.operator import LONGEST_S, Operator
from imugui.targeting.person import Person, one_of_many, practised
from imugui.targeting.study import Study
from imugui.targeting.study_plan import StudyPlan
from imugui.targeting.study_steps import REST, Step
from imugui.targeting.study_store import StudyError

RATE_HZ = 100.0

Tell = Callable[[Study, Step], None]
"""Told after each step."""


def simulate_study(plan: StudyPlan, out: Path, people: Mapping[str, Person] | None = None) -> Study:
    """Let simulated people play a whole study into a new or an empty folder.

    ``people``: who plays as which participant; by default each is drawn from the seed of the plan. Raises StudyError
    and OSError.
    """
    study = Study.create(out, plan)
    play_on(study, people)
    return study


def play_on(study: Study, people: Mapping[str, Person] | None = None, tell: Tell = lambda study, step: None) -> None:
    """Let simulated people play what is left of a study. The same seed gives the same targets, digit for digit.

    They do not tire, so they pass over rests, and they have no opinion. Raises StudyError and OSError.
    """
    people = people or {code: one_of_many(seed_of(study.plan, code)) for code in study.people}
    for code in study.people:
        while step := study.next_step(code):
            if step.played:
                _play(study, step, people[code])
            elif step.kind == REST:
                study.rested(step)
            else:
                study.answer(step)
            tell(study, step)


def seed_of(plan: StudyPlan, *what: object) -> int:
    """A seed of its own for each person and run of a plan."""
    return zlib.crc32(repr((plan.seed, *what)).encode())


def _play(study: Study, step: Step, person: Person) -> None:
    plan, game = study.plan, study.begin(step)
    # block 0 is practice, where there is one: then people have learned before block 1
    block = step.block + (plan.practice_runs > 0)
    seed = seed_of(plan, step.participant, step.condition, step.block, step.run)
    operator = Operator(game, practised(person, block), seed, RATE_HZ)
    for _ in range(round(LONGEST_S * RATE_HZ)):
        t, quat, gyr, status = operator.act()
        for trial in game.step(t, quat, gyr, status, operator.inputs):
            study.add(trial)
        if game.done:
            return
    study.interrupt()
    raise StudyError(f"{step.participant} did not get through a run with {step.condition} in {LONGEST_S:g} s")
