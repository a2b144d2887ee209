"""SimulationCard: a planned study, played by simulated people, to see what its report will look like."""

from __future__ import annotations

import dataclasses
from pathlib import Path

from PySide6.QtCore import Signal, Slot
from PySide6.QtWidgets import QProgressBar

from imugui.targeting.study import Study
from imugui.targeting.study_plan import StudyPlan
from imugui.targeting.study_simulated import play_on
from imugui.targeting.study_steps import Step
from imugui.targeting.study_store import StudyError
from imugui.views.controls import Button
from imugui.views.guide_parts import Card, row_of
from imugui.views.job import Job, Jobs
from imugui.views.labels import muted

ABOUT = "Simulated people play the whole study through the same game. It shows the report, and proves nothing."


class SimulationCard(Card):
    """Plays in a thread of its own."""

    wanted = Signal()  # tell me the plan: ``begin``
    finished = Signal(object)  # Path of the folder
    said = Signal(str, str)  # tone, sentence

    def __init__(self) -> None:
        super().__init__("Try it")
        self.button = Button("Play it with simulated people", "Make its folder, and let simulated people play it")
        self.cancel_button = Button("Cancel", "Stop; what was played stays in the folder", small=True)
        self.bar = QProgressBar()
        self.bar.setRange(0, 1000)
        self.bar.setTextVisible(False)
        self.bar.setFixedHeight(8)
        self.bar.setAccessibleName("Progress of the simulated people")
        self._jobs = Jobs(self)
        self._job: Job | None = None
        self.add(muted(ABOUT), row_of(self.button), self.bar, row_of(self.cancel_button))
        self.button.clicked.connect(self.wanted)
        self.cancel_button.clicked.connect(self.cancel)
        self._show(False)

    def begin(self, folder: Path, plan: StudyPlan) -> None:
        """Let simulated people play this plan."""
        simulated = dataclasses.replace(plan, simulated=True)
        self._job = self._jobs.start(lambda job: played(folder, simulated, job), self._done, self._failed)
        self._job.progressed.connect(self._progressed)
        self._show(True)

    @Slot()
    def cancel(self) -> None:
        """Stop."""
        if self._job is not None:
            self._job.cancel()
        self._show(False)

    def stop(self) -> None:
        """The window closes."""
        self._jobs.stop()

    @Slot(float)
    def _progressed(self, share: float) -> None:
        self.bar.setValue(round(1000 * share))

    @Slot(object)
    def _done(self, folder: Path) -> None:
        self._show(False)
        self.finished.emit(folder)

    @Slot(str)
    def _failed(self, words: str) -> None:
        self._show(False)
        self.said.emit("error", f"The simulated people did not get through: {words}")

    def _show(self, running: bool) -> None:
        self.bar.setValue(0)
        self.bar.setVisible(running)
        self.cancel_button.setVisible(running)
        self.button.setEnabled(not running)


def played(folder: Path, plan: StudyPlan, job: Job) -> Path:
    """Play a plan into a folder, telling ``job`` how far it is. Raises OSError."""

    def tell(study: Study, step: Step) -> None:
        own = study.progress()
        job.progress(own.done / max(1, own.total))

    try:
        play_on(Study.create(folder, plan), tell=tell)
    except StudyError as error:
        raise OSError(str(error)) from error
    return folder
