"""StudyPlan: who plays what, how often and in which order; and what such a study can show, before it starts."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

from imugui.fields import field as editable
from imugui.fields import from_mapping, problem
from imugui.targeting import tasks
from imugui.targeting.design import SYMMETRIES, Turn, honesty, people_for_balance
from imugui.targeting.design import plan as williams_turns
from imugui.targeting.settings import PRESETS, Control
from imugui.targeting.tasks import Task

AB_BA, WILLIAMS, SAME = "AB/BA", "Williams", "same"
ORDERS = (AB_BA, WILLIAMS, SAME)

CODE = re.compile(r"[A-Za-z0-9][A-Za-z0-9_-]{0,19}")
LONGEST_NAME, MOST_PEOPLE = 60, 500
SIMULATED = "Nobody took part: these people are simulated."
ONE_ORDER = "All meet the conditions in the same order: practice and tiredness look like effects of the conditions."


def _two_mappings() -> dict[str, Control]:
    return {name: PRESETS[name] for name in ("position", "speed")}


@dataclass(frozen=True)
class StudyPlan:
    """A study that has not begun. Everything else follows from it: see ``study_steps.steps_of``.

    ``participants`` are codes, never names; ``conditions`` any settings of the controller by their name on screen.
    """

    participants: tuple[str, ...] = ()
    conditions: Mapping[str, Control] = field(default_factory=_two_mappings)
    task: Task = field(default_factory=Task)
    simulated: bool = False  # nobody takes part
    name: str = editable("study", "Name of the study", tip="It stands in every row of the results.")
    order: str = editable(
        AB_BA, "Order of the conditions", choices=ORDERS,
        tip="AB/BA: every second person begins with the second condition. Williams: balanced, for more than two. "
        "same: everybody as listed.",
    )  # fmt: skip
    practice_runs: int = editable(
        1, "Practice runs", low=0, high=20, step=1, tip="Before the blocks of each condition. They do not count."
    )  # fmt: skip
    blocks: int = editable(
        3, "Blocks", low=1, high=50, step=1, tip="Of each condition. Three or more show whether people still learn."
    )  # fmt: skip
    runs: int = editable(1, "Runs in a block", low=1, high=50, step=1)
    rest_s: float = editable(
        30.0, "Rest", unit="s", low=0.0, high=3600.0, step=10.0, tip="Between two blocks. 0: no rests."
    )  # fmt: skip
    same_targets: bool = editable(
        True, "Same targets in each condition",
        tip="Else each condition has a list of its own, of equal difficulty, and they change places between people.",
    )  # fmt: skip
    preference: bool = editable(True, "Ask for the preference", tip="At the end: which condition was better?")
    tlx: bool = editable(False, "Ask for the work load", tip="Raw NASA TLX after each condition: six scales.")
    sus: bool = editable(False, "Ask for the usability", tip="SUS after each condition: ten sentences.")
    seed: int = editable(1, "Seed", low=0, high=99999, step=1, tip="The same seed gives the same targets.")

    @property
    def condition_names(self) -> tuple[str, ...]:
        """In the order in which they are listed: A, B, ..."""
        return tuple(self.conditions)


def codes(count: int) -> tuple[str, ...]:
    """P01, P02, ...: the codes of so many people."""
    return tuple(f"P{k:02d}" for k in range(1, count + 1))


def problems(plan: StudyPlan) -> list[str]:
    """What is wrong with a plan, one sentence each; a study can begin when there is none."""
    found = [problem(item, getattr(plan, item.name)) for item in dataclasses.fields(plan) if item.metadata]
    return [*(f"{one}." for one in found if one), *_people_problems(plan), *_condition_problems(plan), *_task(plan)]


def _people_problems(plan: StudyPlan) -> list[str]:
    people = plan.participants
    said = [] if plan.name.strip() and len(plan.name) <= LONGEST_NAME else [f"A name of 1 to {LONGEST_NAME} letters."]
    if not 1 <= len(people) <= MOST_PEOPLE:
        said.append(f"A study has 1 to {MOST_PEOPLE} participants.")
    said += [f"{one!r} is no code: letters, digits, - and _, at most 20." for one in people if not CODE.fullmatch(one)]
    twice = sorted({one for one in people if people.count(one) > 1})
    return said + [f"The code {one} is there twice." for one in twice]


def _condition_problems(plan: StudyPlan) -> list[str]:
    names, said = plan.condition_names, []
    if not names:
        said.append("A study needs a condition.")
    if any(not name.strip() or len(name) > LONGEST_NAME or not name.isprintable() for name in names):
        said.append(f"Each condition has a name of 1 to {LONGEST_NAME} letters.")
    if plan.order == AB_BA and len(names) != 2:
        said.append(f"AB/BA is for two conditions, and there are {len(names)}: choose Williams.")
    if not plan.same_targets and len(names) > len(SYMMETRIES):
        said.append(f"At most {len(SYMMETRIES)} conditions can have lists of their own: choose the same targets.")
    for name, control in plan.conditions.items():
        wrong = (problem(item, getattr(control, item.name)) for item in dataclasses.fields(control))
        said += [f"{name}: {one}." for one in wrong if one]
    return said


def _task(plan: StudyPlan) -> list[str]:
    wrong = [problem(item, getattr(plan.task, item.name)) for item in dataclasses.fields(plan.task)]
    said = [f"{one}." for one in wrong if one]
    return said or [f"{one}." for one in tasks.problems(plan.task)]


def turns(plan: StudyPlan) -> tuple[Turn, ...]:
    """Who meets which condition at which place, with which variant of the target lists."""
    k = len(plan.conditions)
    if plan.order != SAME:
        return williams_turns(plan.participants, k, plan.same_targets)
    return tuple(
        Turn(person, place, place, 0 if plan.same_targets else (place + number) % k)
        for number, person in enumerate(plan.participants)
        for place in range(k)
    )


def orders(plan: StudyPlan) -> dict[str, list[str]]:
    """Which conditions each person meets, in their order."""
    names, met = plan.condition_names, {person: [""] * len(plan.conditions) for person in plan.participants}
    for turn in turns(plan):
        met[turn.participant][turn.place] = names[turn.condition]
    return met


def before_it_starts(plan: StudyPlan) -> tuple[str, ...]:
    """What this number of people can show, one sentence each: smallest p, effect needed for 80 % power, balance.

    To be shown before the study begins; only for a plan without problems.
    """
    people, conditions = len(plan.participants), len(plan.conditions)
    said = honesty(people, conditions, plan.same_targets)
    if plan.order == SAME and conditions > 1:
        # the last sentence counts who is over in orders that this study does not have
        unbalanced = people > 1 and people % people_for_balance(conditions, plan.same_targets)
        said = (*(said[:-1] if unbalanced else said), ONE_ORDER)
    return (SIMULATED, *said) if plan.simulated else said


def as_mapping(plan: StudyPlan) -> dict[str, Any]:
    """Plain values, for JSON."""
    return {**asdict(dataclasses.replace(plan, conditions=dict(plan.conditions))), "participants": [*plan.participants]}


def plan_from(values: Mapping[str, Any]) -> StudyPlan:
    """The plan in plain values. Raises ValueError where it is not whole: a study must not go on with other settings."""
    people, conditions, simulated = (values.get(key) for key in ("participants", "conditions", "simulated"))
    if not isinstance(people, list) or not all(isinstance(one, str) for one in people):
        raise ValueError("participants: expected a list of codes")
    if not isinstance(conditions, dict) or not all(isinstance(one, dict) for one in conditions.values()):
        raise ValueError("conditions: expected settings by name")
    task, wrong = from_mapping(Task, values["task"] if isinstance(values.get("task"), dict) else {"kind": None})
    controls = {name: from_mapping(Control, one) for name, one in conditions.items()}
    wrong += [f"{name}: {one}" for name, (_, said) in controls.items() for one in said]
    names = {item.name for item in dataclasses.fields(StudyPlan) if item.metadata}
    settings, more = from_mapping(StudyPlan, {key: value for key, value in values.items() if key in names})
    plan: StudyPlan = dataclasses.replace(
        settings,
        participants=tuple(people),
        conditions={name: control for name, (control, _) in controls.items()},
        task=task,
        simulated=simulated is True,
    )
    if said := [*wrong, *more] or [one.rstrip(".") for one in problems(plan)]:
        raise ValueError("; ".join(said))
    return plan
