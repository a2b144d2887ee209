"""A study that runs: what each person does next, and the folder that keeps it.

How a page uses it::

    study = Study.create(folder, plan)          # after showing study_plan.before_it_starts(plan)
    study = Study.open(folder)                  # later; study.problems: sentences to show
    step = study.next_step("P01")               # None: this person is through
    study_steps.what_next(study.plan, step)     # the words for it

    step.played            game = study.begin(step); play it; study.add(trial) for each trial that it yields.
                           After the last one next_step is the one after. study.interrupt() when the run is left:
                           its block begins again.
    step.kind == REST      count down plan.rest_s, then study.rested(step); it may be cut short
    step.asked             study.answer(step, values) for TLX and SUS (in the order of questionnaires.TLX and SUS; ()
                           when the person does not want to), study.answer(step, liked=name) for the preference
                           ("" for none)

    study_report.write_report(study.folder, now)    # at any time

Every call that changes something has it on the disk when it returns. Each of them may raise OSError: what was to be
written is kept and is written with the next call, or with ``save``.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence
from pathlib import Path

from imugui.targeting import study_plan, study_store
from imugui.targeting.game import Game
from imugui.targeting.questionnaires import Answer, raw_tlx, sus
from imugui.targeting.study_plan import StudyPlan
from imugui.targeting.study_progress import Progress, RunKey, Sorted, complete, key_of, key_of_step, sort_trials
from imugui.targeting.study_steps import PREFERENCE, REST, SUS, TLX, Step, game_of, steps_of, targets_in_run
from imugui.targeting.study_store import Stored, StudyError
from imugui.targeting.trials import Trial


class Study:
    """A study in its folder. Made with ``Study.create`` or ``Study.open``."""

    def __init__(self, folder: Path, stored: Stored) -> None:
        self.folder, self.plan = folder, stored.plan
        self.problems = list(stored.problems)  # sentences about what was found in the folder
        self.running: Step | None = None  # the run that is played
        self._targets = targets_in_run(stored.plan)
        self._steps = {person: steps_of(stored.plan, person) for person in stored.plan.participants}
        self._places: dict[RunKey, list[int]] = {}  # of the targets of each run
        for trial in stored.trials:
            self._places.setdefault(key_of(trial), []).append(trial.index)
        self._said = {_answer_key(answer) for answer in stored.answers}
        self._unsaved: list[Trial] = []

    @classmethod
    def create(cls, folder: Path, plan: StudyPlan) -> Study:
        """Begin a study in a new or an empty folder. Raises StudyError, with words for the person, and OSError."""
        if wrong := study_plan.problems(plan):
            raise StudyError(" ".join(wrong))
        study_store.create(folder, plan)
        return cls(folder, Stored(plan))

    @classmethod
    def open(cls, folder: Path) -> Study:
        """Go on with a study. Blocks that were left in the middle begin again. Raises StudyError and OSError."""
        stored = study_store.load(folder)
        repaired = study_store.repair(folder, stored)
        found = sort_trials(stored.plan, stored.trials)
        if found.partial:
            study_store.mark(folder, found.partial)
        said = [*stored.problems, *repaired, *_left_in_the_middle(stored, found)]
        return cls(folder, dataclasses.replace(stored, trials=found.whole, problems=tuple(said)))

    @property
    def people(self) -> tuple[str, ...]:
        """The codes of those who take part."""
        return self.plan.participants

    def steps(self, participant: str) -> tuple[Step, ...]:
        """All that a person does, in order."""
        return self._steps[participant]

    def done(self, step: Step) -> bool:
        """Whether a step has been done."""
        if step.played:
            return complete(self._places.get(key_of_step(step), ()), self._targets)
        return _step_key(step) in self._said

    def next_step(self, participant: str) -> Step | None:
        """What this person does next; None when that was all. A rest that was passed over is not made up for."""
        steps = self._steps[participant]
        played = max((step.number for step in steps if step.played and self.done(step)), default=-1)
        return next((one for one in steps if not (self.done(one) or (one.kind == REST and one.number < played))), None)

    def next_person(self) -> str | None:
        """The first who is not through; None when the study is."""
        return next((person for person in self.people if self.next_step(person)), None)

    def progress(self, participant: str = "") -> Progress:
        """How far this person is, or without one the whole study."""
        people = (participant,) if participant else self.people
        steps = [step for person in people for step in self._steps[person]]
        return Progress(sum(map(self.done, steps)), len(steps))

    def begin(self, step: Step) -> Game:
        """Begin a run, which must be the person's next step. Raises ValueError for another one, and OSError."""
        self.interrupt()
        if not step.played or step != self.next_step(step.participant):
            raise ValueError(f"{step.participant} does something else next")
        self.running = step
        return game_of(self.plan, step)

    def add(self, trial: Trial) -> bool:
        """Keep a target of the run that is played; False for one that is not its next. Raises OSError."""
        step, places = self.running, self._places.setdefault(key_of(trial), [])
        if step is None or key_of(trial) != key_of_step(step) or trial.index != len(places):
            return False
        places.append(trial.index)
        self._unsaved.append(trial)
        if done := self.done(step):
            self.running = None
        self.save(safe=done)
        return True

    def save(self, safe: bool = False) -> None:
        """Write the targets that could not be written before; ``safe``: wait for the disk. Raises OSError."""
        while self._unsaved:
            study_store.add_trials(self.folder, self.plan, self._unsaved[:1], safe)
            del self._unsaved[0]

    def interrupt(self) -> None:
        """The run that is played is left: its block begins again, and what was played of it does not count."""
        self.save()
        step = self.running
        if step is None:
            return
        own = [key for key in self._places if key[:3] == step.block_key and self._places[key]]
        if own:
            study_store.mark(self.folder, {step.block_key})
        for key in own:
            del self._places[key]
        self.running = None

    def rested(self, step: Step) -> None:
        """A rest is over. Raises OSError."""
        self._keep(step, Answer(step.participant, "", REST, (step.number,)))

    def answer(self, step: Step, values: Sequence[float] = (), liked: str = "") -> None:
        """Keep what the person said: the ratings of a form, or the condition that was liked better.

        Neither: the person does not want to answer, or has no preference. Raises ValueError and OSError.
        """
        if values:
            SCORERS[step.kind](values)
        if liked not in ("", *self.plan.conditions):
            raise ValueError(f"there is no condition {liked}")
        self._keep(step, Answer(step.participant, step.condition or liked, step.kind, tuple(values)))

    def _keep(self, step: Step, answer: Answer) -> None:
        self.save()
        study_store.add_answer(self.folder, self.plan, answer)
        self._said.add(_step_key(step))


SCORERS: dict[str, Callable[[Sequence[float]], float]] = {TLX: raw_tlx, SUS: sus}
"""What checks the ratings of a form."""


def _step_key(step: Step) -> tuple[str, str, str]:
    return step.participant, step.kind, str(step.number) if step.kind == REST else step.condition


def _answer_key(answer: Answer) -> tuple[str, str, str]:
    place = {REST: f"{(*answer.values, 0.0)[0]:g}", PREFERENCE: ""}.get(answer.kind, answer.condition)
    return answer.participant, answer.kind, place


def _left_in_the_middle(stored: Stored, found: Sorted) -> list[str]:
    said = [
        f"{person} was interrupted in block {block} with “{condition}”: it begins again."
        if block
        else f"{person} was interrupted in the practice with “{condition}”: it begins again."
        for person, condition, block in sorted(found.partial)
    ]
    if found.strangers:
        said.append(f"Rows of {study_store.TRIALS} that belong to no run of this study: {found.strangers}.")
    return said
