"""The column of a study that is open: who plays, how far, what comes next."""

from __future__ import annotations

import math

from PySide6.QtCore import Signal, Slot
from PySide6.QtWidgets import QCheckBox, QProgressBar, QVBoxLayout, QWidget

from imugui.targeting.study import Study
from imugui.targeting.study_steps import REST, TITLES, Step, place_words, what_next
from imugui.views import theme
from imugui.views.controls import Button, StillBox
from imugui.views.game_words import Plate
from imugui.views.guide_parts import Card, column_of, row_of
from imugui.views.labels import heading, muted
from imugui.views.target_cards import KeysCard
from imugui.views.target_study_desk import StudyDesk

THROUGH = "Through"


class StudyPanel(QWidget):
    """The column of a study that is open."""

    close_wanted = Signal()
    results_wanted = Signal()

    def __init__(self, desk: StudyDesk) -> None:
        super().__init__()
        self._desk = desk
        self._people: tuple[str, ...] = ()
        self.person = StillBox("Participant", "Whose turn it is")
        self.name, self.next, self.words = heading(""), heading(""), muted()
        self.next.setWordWrap(True)
        self.bar = QProgressBar()
        self.bar.setTextVisible(False)
        self.bar.setFixedHeight(8)
        self.bar.setAccessibleName("Progress of this person")
        self.done, self.all_done = muted(), muted()
        self.record = QCheckBox("Record every run")
        self.record.setChecked(True)
        self.record.setAccessibleName("Record every run")
        self.record.setToolTip("Into the folder of the study: with it every run can be computed again")
        self.results_button = Button("Results", "What the study has shown so far", small=True)
        self.close_button = Button("Close study", "It can be opened again at any time", small=True)
        self.keys = KeysCard()
        self._lay_out()
        self.person.activated.connect(self._chosen)
        self.record.toggled.connect(self._record_toggled)
        self.results_button.clicked.connect(self.results_wanted)
        self.close_button.clicked.connect(self.close_wanted)
        desk.changed.connect(self.refresh)

    @Slot()
    def refresh(self) -> None:
        """Follow the study."""
        study, step = self._desk.study, self._desk.step
        if study is None:
            return
        self.name.setText(study.plan.name)
        self._list_people(study)
        self.person.setEnabled(not self._desk.playing)
        self.next.setText(f"Next: {next_words(study, step)}" if step is not None else "Nothing is left to do.")
        self.words.setText(what_next(study.plan, step))
        own, all_ = study.progress(self._desk.person), study.progress()
        self.bar.setRange(0, max(1, own.total))
        self.bar.setValue(own.done)
        self.done.setText(own.words)
        self.all_done.setText(f"All together: {all_.words}")

    def _list_people(self, study: Study) -> None:
        """Every person with a sign for how far they are."""
        if study.people != self._people:
            self._people = study.people
            self.person.clear()
            for person in study.people:
                self.person.add(person, person)
        for row, person in enumerate(study.people):
            own = study.progress(person)
            sign = theme.tone_glyph("good") if own.done == own.total else "▶" if own.done else "○"
            self.person.setItemText(row, f"{sign}  {person}   {own.done} of {own.total}")
        self.person.choose(self._desk.person)

    @Slot()
    def _chosen(self) -> None:
        self._desk.choose(self.person.currentData())

    @Slot(bool)
    def _record_toggled(self, on: bool) -> None:
        self._desk.record_runs = on

    def _lay_out(self) -> None:
        who = Card().add(self.name, self.person, self.bar, self.done, self.all_done)
        what = Card().add(self.next, self.words, self.record)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.addWidget(column_of(what, who, self.keys, _box(self.results_button, self.close_button)))


def _box(*buttons: Button) -> QWidget:
    box = QWidget()
    row = row_of(*buttons)
    row.setContentsMargins(0, 0, 0, 0)
    box.setLayout(row)
    return box


def next_words(study: Study, step: Step) -> str:
    """A step as a heading."""
    if not step.played:
        return TITLES[step.kind]
    return f"{place_words(study.plan, step)}, “{step.condition}”"


def start_words(study: Study, step: Step | None) -> str:
    """What the start button says."""
    if step is None:
        person = study.next_person()
        return f"Go on with {person}" if person else THROUGH
    if step.asked:
        return "Answer the questions"
    return "End the rest now" if step.kind == REST else f"Start {'run' if step.block else 'practice'}"


def invitation(study: Study, step: Step | None, rest_left_s: float) -> Plate:
    """What stands on the picture before a step."""
    words = what_next(study.plan, step)
    if step is None:
        person = study.next_person()
        return Plate("good", THROUGH, (words, f"Next is {person}: Enter" if person else "Everybody is through."))
    if step.kind == REST:
        left = 0.0 if math.isnan(rest_left_s) else math.ceil(rest_left_s)
        return Plate("neutral", f"Rest: {left:.0f} s", (words,))
    return Plate("neutral", next_words(study, step), (words, "Enter: start"))
