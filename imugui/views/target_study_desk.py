"""StudyDesk: the study that is open, between its folder and the game; no picture of its own."""

from __future__ import annotations

import datetime
import math
import time
from collections.abc import Callable
from pathlib import Path

from PySide6.QtCore import QObject, Signal, Slot

from imugui.targeting.study import Study
from imugui.targeting.study_plan import StudyPlan
from imugui.targeting.study_steps import REST, Step
from imugui.targeting.study_store import StudyError
from imugui.targeting.trials import Trial
from imugui.views.record_words import recording_path
from imugui.views.target_desk import TargetDesk
from imugui.workers.session import Session

RECORDING_S = 1.0
"""A run waits no longer for its recording."""
KEPT = "It is kept in memory, and written as soon as that works."


class StudyDesk(QObject):
    """Who plays, and what comes next. Whatever is done is in the folder at once."""

    changed = Signal()
    said = Signal(str, str)  # tone, sentence

    def __init__(self, session: Session, desk: TargetDesk) -> None:
        super().__init__()
        self.study: Study | None = None
        self.person = ""
        self.record_runs = True
        """Each run gets a recording in the folder of the study, unless one runs already."""
        self._session, self._desk = session, desk
        self._recording: Path | None = None  # ours
        self._waiting: Step | None = None  # for its recording
        self._waited_since = 0.0
        self._resting: Step | None = None
        self._rest_began = 0.0
        desk.target_done.connect(self._target_done)
        desk.run_done.connect(self._run_done)

    @property
    def step(self) -> Step | None:
        """What this person does next; None when that was all, and without a study."""
        return self.study.next_step(self.person) if self.study is not None else None

    @property
    def playing(self) -> bool:
        """Whether a run of the study is on."""
        return self.study is not None and self.study.running is not None

    @property
    def rest_left_s(self) -> float:
        """How much of the rest is left, s; NaN when there is none."""
        if self.study is None or self._resting is None:
            return math.nan
        return max(0.0, self.study.plan.rest_s - (time.perf_counter() - self._rest_began))

    # the folder

    def create(self, folder: Path, plan: StudyPlan) -> bool:
        """Begin a study; False, and why, when it cannot be."""
        return self._take(lambda: Study.create(folder, plan))

    def open_folder(self, folder: Path) -> bool:
        """Go on with a study; False, and why, when it cannot be."""
        return self._take(lambda: Study.open(folder))

    def close(self) -> None:
        """Leave the study; it can be opened again."""
        self.leave()
        self.study, self.person, self._resting = None, "", None
        self.changed.emit()

    # what the person does

    @Slot(str)
    def choose(self, person: str) -> None:
        """Go on with another person."""
        if self.study is not None and person in self.study.people and person != self.person:
            self.leave()
            self.person = person
            self._tell()

    def start(self) -> None:
        """Play the next run, or end the rest."""
        step, study = self.step, self.study
        if study is None:
            return
        if step is None:
            self.choose(study.next_person() or "")
        elif step.kind == REST:
            self.end_rest()
        elif step.played and self._safely(study.save):  # what could not be written before comes first
            self._record(study, step)
            self._waiting, self._waited_since = step, time.perf_counter()
            self.pull()

    def pull(self) -> None:
        """Begin the run that waits, as soon as its recording has its first row: it must know how the run began."""
        study, step, running = self.study, self._waiting, self._session.recording
        late = time.perf_counter() - self._waited_since > RECORDING_S
        if study is None or step is None or (running is not None and not running.rows and not late):
            return
        self._waiting = None
        self._desk.begin(study.begin(step))
        self.changed.emit()

    def leave(self) -> None:
        """The run ends here, and its block begins again."""
        study, self._waiting = self.study, None
        self._end_recording()
        if study is not None and study.running is not None:
            self._desk.leave()
            self._safely(study.interrupt)
            self.changed.emit()

    def end_rest(self) -> None:
        """The rest is over, or cut short."""
        step, study = self.step, self.study
        if study is not None and step is not None and step.kind == REST:
            self._safely(lambda: study.rested(step))
            self._tell()

    def answer(self, values: tuple[float, ...] = (), liked: str = "") -> None:
        """Keep what the person said; neither: the person does not want to answer."""
        step, study = self.step, self.study
        if study is not None and step is not None and step.asked:
            self._safely(lambda: study.answer(step, values, liked))
            self._tell()

    def tick(self) -> None:
        """A rest ends by itself."""
        if self.rest_left_s == 0.0:
            self.end_rest()

    # inside

    def _take(self, make: Callable[[], Study]) -> bool:
        """Have another study open, from its first person who is not through."""
        try:
            study = make()
        except StudyError as error:
            self.said.emit("error", str(error))
            return False
        except OSError as error:
            self.said.emit("error", f"The folder of the study cannot be used: {error.strerror or error}.")
            return False
        self.leave()
        self.study = study
        self.person = study.next_person() or study.people[0]
        for words in study.problems:
            self.said.emit("warn", words)
        self._tell()
        return True

    def _tell(self) -> None:
        """The step may have changed: a rest begins to count when it comes."""
        step = self.step
        if step is None or step.kind != REST:
            self._resting = None
        elif step != self._resting:
            self._resting, self._rest_began = step, time.perf_counter()
        self.changed.emit()

    def _safely(self, write: Callable[[], object]) -> bool:
        """Write to the folder; False, and why, when the disk refuses."""
        try:
            write()
        except OSError as error:
            self.said.emit("error", f"The study could not be written: {error.strerror or error}. {KEPT}")
            return False
        return True

    def _record(self, study: Study, step: Step) -> None:
        """Begin a recording of this run, unless one runs."""
        if self.record_runs and self._session.recording is None:
            label = f"{step.participant}-{step.condition}-block{step.block}-run{step.run}"
            path = recording_path(study.folder, label, datetime.datetime.now())
            if self._session.record(path, label, f"study {study.plan.name}"):
                self._recording = path

    def _end_recording(self) -> None:
        running = self._session.recording
        if running is not None and running.path == self._recording:
            self._session.stop_recording()
        self._recording = None

    @Slot(object)
    def _target_done(self, trial: Trial) -> None:
        study = self.study
        if study is not None and study.running is not None:
            self._safely(lambda: study.add(trial))

    @Slot()
    def _run_done(self) -> None:
        if self.study is not None and self._recording is not None:
            self._end_recording()
        self._tell()
