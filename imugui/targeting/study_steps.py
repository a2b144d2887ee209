"""The steps of a study: what each person does, one thing after the other; and what comes next, in words."""

from __future__ import annotations

from dataclasses import dataclass, replace

from imugui.targeting.design import Turn
from imugui.targeting.game import Game
from imugui.targeting.play_again import Setup
from imugui.targeting.study_plan import StudyPlan, turns
from imugui.targeting.tally import Labels
from imugui.targeting.tasks import target_list

PRACTICE, RUN, REST, TLX, SUS, PREFERENCE = "practice", "run", "rest", "tlx", "sus", "preference"
PLAYED = (PRACTICE, RUN)
ASKED = (TLX, SUS, PREFERENCE)

TITLES = {
    PRACTICE: "Practice",
    RUN: "Run",
    REST: "Rest",
    TLX: "Questions about the work load",
    SUS: "Questions about the usability",
    PREFERENCE: "Which one was better?",
}


@dataclass(frozen=True)
class Step:
    """One thing that one person does. The kinds are the keys of TITLES."""

    kind: str
    participant: str
    number: int = 0  # place among this person's steps, from 0
    condition: str = ""  # empty for rests and for the preference
    block: int = 0  # 0 is practice; of a rest the block it stands before
    run: int = 0  # within the block, from 1
    variant: int = 0  # of the target list

    @property
    def played(self) -> bool:
        """It is a run of the game."""
        return self.kind in PLAYED

    @property
    def asked(self) -> bool:
        """It is a form or a question."""
        return self.kind in ASKED

    @property
    def block_key(self) -> tuple[str, str, int]:
        """What begins again when it was interrupted: the block of this person in this condition."""
        return self.participant, self.condition, self.block


def steps_of(plan: StudyPlan, participant: str) -> tuple[Step, ...]:
    """Everything one person does, in order; a rest stands between two blocks. Empty for somebody unknown."""
    own = sorted((turn for turn in turns(plan) if turn.participant == participant), key=lambda turn: turn.place)
    found = [step for turn in own for step in _of_condition(plan, turn)]
    if own and plan.preference and len(plan.conditions) > 1:
        found.append(Step(PREFERENCE, participant))
    # nobody rests before the first block
    found = found[1:] if found and found[0].kind == REST else found
    return tuple(replace(step, number=number) for number, step in enumerate(found))


def _of_condition(plan: StudyPlan, turn: Turn) -> list[Step]:
    """Rests, blocks and forms of one person's turn with one condition."""
    person, condition, found = turn.participant, plan.condition_names[turn.condition], []
    for block in range(0 if plan.practice_runs else 1, plan.blocks + 1):
        if plan.rest_s > 0.0:
            found.append(Step(REST, person, block=block))
        kind, runs = (RUN, plan.runs) if block else (PRACTICE, plan.practice_runs)
        found += [Step(kind, person, 0, condition, block, run, turn.targets) for run in range(1, runs + 1)]
    return found + [Step(kind, person, 0, condition) for kind in (TLX,) * plan.tlx + (SUS,) * plan.sus]


def setup_of(plan: StudyPlan, step: Step) -> Setup:
    """All that the run of a step is made from. Every condition has the same lists, or mirrored ones: see the plan."""
    seed = (plan.seed * 100 + step.block) * 100 + step.run
    labels = Labels(plan.name, step.participant, step.condition, step.block, step.kind == PRACTICE, step.run)
    return Setup(plan.task, plan.conditions[step.condition], seed, step.variant, labels)


def game_of(plan: StudyPlan, step: Step) -> Game:
    """The run of a step, with its labels and targets. Raises KeyError for a step that is not played."""
    return setup_of(plan, step).game()


def targets_in_run(plan: StudyPlan) -> int:
    """How many targets of a run count: the one that starts a ring's clock does not."""
    return sum(not target.start for target in target_list(plan.task, 0))


def what_next(plan: StudyPlan, step: Step | None) -> str:
    """What the person does next, in one or two sentences."""
    if step is None:
        return "That was all. Thank you."
    return _WORDS[step.kind](plan, step)


def place_words(plan: StudyPlan, step: Step) -> str:
    """Where a step stands, short, for a heading: like "Block 2 of 3, run 1 of 2"."""
    if not step.played:
        return TITLES[step.kind]
    place = f"Block {step.block} of {plan.blocks}" if step.block else TITLES[PRACTICE]
    runs = plan.runs if step.block else plan.practice_runs
    return f"{place}, run {step.run} of {runs}" if runs > 1 else place


def _play_words(plan: StudyPlan, step: Step) -> str:
    count = targets_in_run(plan)
    counts = "" if step.block else " It does not count: find out how it works."
    words = f"{place_words(plan, step)} with “{step.condition}”: {count} target{'s' * (count != 1)}."
    return words + counts


def _rest_words(plan: StudyPlan, step: Step) -> str:
    then = f"block {step.block} of {plan.blocks}" if step.block else "practice with the next condition"
    return f"Rest for {plan.rest_s:g} s. Then comes {then}."


def _preference_words(plan: StudyPlan, step: Step) -> str:
    *most, last = (f"“{name}”" for name in plan.condition_names)
    return f"One last question: did you prefer {', '.join(most)} or {last}?"


_WORDS = {
    PRACTICE: _play_words,
    RUN: _play_words,
    REST: _rest_words,
    TLX: lambda plan, step: f"Six questions about the work load with “{step.condition}”.",
    SUS: lambda plan, step: f"Ten sentences about “{step.condition}”: how far do you agree?",
    PREFERENCE: _preference_words,
}
