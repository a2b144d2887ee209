"""Where a study is planned: people, conditions, order, blocks; and what it can show, before it begins."""

from __future__ import annotations

import dataclasses
from pathlib import Path

from PySide6.QtCore import Qt, Signal, Slot
from PySide6.QtWidgets import QFileDialog, QGridLayout, QHBoxLayout, QScrollArea, QWidget

from imugui import paths
from imugui.targeting import tasks
from imugui.targeting.settings import Control
from imugui.targeting.study_plan import StudyPlan, before_it_starts, codes, problems
from imugui.targeting.study_steps import steps_of
from imugui.views.controls import Button
from imugui.views.form import Form
from imugui.views.guide_parts import Card, Complaint, column_of, row_of
from imugui.views.labels import ElidedLabel, muted
from imugui.views.record_words import file_label
from imugui.views.target_cards import PresetCard
from imugui.views.target_plan_cards import ConditionsCard, PeopleCard
from imugui.views.target_simulation import SimulationCard
from imugui.views.target_words import task_words

FIRST_PEOPLE = 6
LEADS = "A study compares mappings fairly: every person meets every condition, in balanced order, with equal targets."


class StudySetup(QWidget):
    """Emits ``create_wanted`` for a plan that nothing is wrong with."""

    create_wanted = Signal(object, object)  # Path, StudyPlan
    open_wanted = Signal(object)  # Path

    def __init__(self) -> None:
        super().__init__()
        first = StudyPlan(codes(FIRST_PEOPLE), task=tasks.PRESETS["confirmed by hand"])
        self.form = Form(first)
        self.people = PeopleCard(first.participants)
        self.conditions = ConditionsCard(first.conditions)
        self.task = PresetCard("Task", first.task, tasks.PRESETS, task_words)
        self.honest, self.trouble = muted(), Complaint("What is wrong with the plan")
        self.amount = muted()
        self.simulation = SimulationCard()
        self.folder_line = ElidedLabel()
        self.create_button = Button("Create the study", "Make its folder and begin", role="primary")
        self.folder_button = Button("Folder…", "Where the folder of the study is made", small=True)
        self.open_button = Button("Open a study…", "Go on with a study that was begun", icon="open")
        self.resume_button = Button("Resume the last one", "Go on with the study that was open last")
        self._parent = paths.documents_folder() / "studies"
        self._last = Path()
        self._lay_out()
        self._connect_parts()
        self.show_last("")
        self._tell()

    def plan(self) -> StudyPlan:
        """The plan as it is set."""
        plan: StudyPlan = dataclasses.replace(
            self.form.value(),
            participants=self.people.people(),
            conditions=self.conditions.conditions(),
            task=self.task.value(),
        )
        return plan

    @property
    def folder(self) -> Path:
        """Where the study will be kept: a folder that does not exist yet."""
        stem = file_label(self.plan().name) or "study"
        names = (stem, *(f"{stem}-{number}" for number in range(2, 1000)))
        return next(path for name in names if not (path := self._parent / name).exists())

    def set_parent(self, folder: Path) -> None:
        """Where the folder of the study is made."""
        self._parent = folder
        self._tell()

    def set_played(self, control: Control) -> None:
        """The mapping that is set in the Play tab."""
        self.conditions.set_played(control)

    def show_last(self, folder: str) -> None:
        """Offer to go on with this study; empty: there is none."""
        self._last = Path(folder)
        self.resume_button.setVisible(bool(folder))
        self.resume_button.setText(f"Resume {self._last.name}" if folder else "Resume")

    @Slot()
    def begin(self) -> None:
        """Begin the study that is planned."""
        self.create_wanted.emit(self.folder, self.plan())

    @Slot()
    def ask_study(self) -> None:
        """Ask for the folder of a study."""
        chosen = QFileDialog.getExistingDirectory(self, "Open a study", str(self._parent))
        if chosen:
            self.open_wanted.emit(Path(chosen))

    @Slot()
    def ask_folder(self) -> None:
        """Ask where the folder of the study shall be."""
        chosen = QFileDialog.getExistingDirectory(self, "Folder for the study", str(self._parent.parent))
        if chosen:
            self.set_parent(Path(chosen))

    @Slot()
    def _simulate(self) -> None:
        self.simulation.begin(self.folder, self.plan())

    @Slot()
    def _tell(self) -> None:
        """What the plan can show, or what is wrong with it."""
        plan = self.plan()
        twice = self.conditions.twice
        wrong = [f"The condition {twice} is there twice."] if twice else problems(plan)
        self.trouble.show_wrong("\n".join(wrong))
        for part in (self.create_button, self.simulation):
            part.setEnabled(not wrong)
        self.honest.setText("" if wrong else "\n\n".join(before_it_starts(plan)))
        self.amount.setText("" if wrong else size_words(plan))
        self.folder_line.show_line(f"In {self.folder}")

    def _connect_parts(self) -> None:
        for part in (self.form, self.people, self.conditions, self.task):
            part.changed.connect(self._tell)
        self.create_button.clicked.connect(self.begin)
        self.simulation.wanted.connect(self._simulate)
        self.folder_button.clicked.connect(self.ask_folder)
        self.open_button.clicked.connect(self.ask_study)
        self.resume_button.clicked.connect(lambda: self.open_wanted.emit(self._last))

    def _lay_out(self) -> None:
        grid = QGridLayout()
        grid.setContentsMargins(16, 12, 8, 12)
        grid.setSpacing(10)
        grid.addWidget(muted(LEADS), 0, 0, 1, 2)
        grid.addWidget(Card("Plan").add(self.form), 1, 0, 3, 1, Qt.AlignmentFlag.AlignTop)
        for row, card in enumerate((self.people, self.conditions, self.task), 1):
            grid.addWidget(card, row, 1, Qt.AlignmentFlag.AlignTop)
        grid.setColumnStretch(0, 1)
        grid.setColumnStretch(1, 1)
        grid.setRowStretch(3, 1)
        inside = QWidget()
        inside.setLayout(grid)
        area = QScrollArea()
        area.setWidget(inside)
        area.setWidgetResizable(True)
        area.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        shows = Card("What it can show").add(self.honest, self.amount, self.trouble)
        begin = Card("Begin").add(self.folder_line, row_of(self.create_button, self.folder_button))
        again = Card("Go on").add(row_of(self.open_button), self.resume_button)
        whole = QHBoxLayout(self)
        whole.setContentsMargins(0, 0, 0, 0)
        whole.setSpacing(0)
        whole.addWidget(area, 1)
        whole.addWidget(column_of(shows, begin, self.simulation, again))


def size_words(plan: StudyPlan) -> str:
    """How much one person does."""
    steps = steps_of(plan, plan.participants[0])
    played = sum(step.played for step in steps)
    return f"Each person plays {played} runs; with rests and questions these are {len(steps)} steps."
