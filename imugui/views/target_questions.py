"""The questions of a study: work load, usability, preference. Nothing is answered beforehand."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal, Slot
from PySide6.QtWidgets import QLabel, QScrollArea, QVBoxLayout, QWidget

from imugui.targeting import questionnaires
from imugui.targeting.study_plan import StudyPlan
from imugui.targeting.study_steps import PREFERENCE, SUS, TLX, Step, what_next
from imugui.views.controls import Button, clear
from imugui.views.guide_parts import Card, row_of
from imugui.views.labels import heading, muted
from imugui.views.scale_bar import ScaleBar

WIDTH = 620  # at most
NONE = "No preference"
_TLX_VALUES = tuple(float(value) for value in range(0, 101, questionnaires.TLX_STEP))
_SUS_VALUES = (1.0, 2.0, 3.0, 4.0, 5.0)


def scales_of(kind: str) -> list[tuple[str, str, ScaleBar]]:
    """Title, question and scale of each question of a form."""
    if kind == TLX:
        return [
            (one.title, one.question, ScaleBar(one.title, one.low, one.high, _TLX_VALUES))
            for one in questionnaires.TLX.values()
        ]
    low, high = questionnaires.SUS_ENDS
    return [
        (f"{number}. {words}", "", ScaleBar(words, low, high, _SUS_VALUES))
        for number, words in enumerate(questionnaires.SUS, 1)
    ]


class QuestionPage(QWidget):
    """Asks what a step asks. The person may pass over a form, but not over a part of it."""

    answered = Signal(tuple)  # the ratings in their order; empty: the person does not want to
    liked = Signal(str)  # a condition; "" for none

    def __init__(self) -> None:
        super().__init__()
        self.scales: list[ScaleBar] = []
        self.choices: list[Button] = []
        self.title, self.left = heading(""), muted()
        self.title.setWordWrap(True)
        self.save_button = Button("Save the answers", "Keep them in the folder of the study", role="primary")
        self.skip_button = Button("Do not answer", "Go on without answers; that is kept too")
        self.save_button.clicked.connect(self._save)
        self.skip_button.clicked.connect(lambda: self.answered.emit(()))
        self._shown: Step | None = None
        self._lay_out()

    def ask(self, plan: StudyPlan, step: Step) -> None:
        """Show the questions of a step, once."""
        if step == self._shown:
            return
        self._shown = step
        self.title.setText(what_next(plan, step))
        clear(self._list)
        self.scales, self.choices = [], []
        if step.kind in (TLX, SUS):
            self._add_form(step.kind)
        elif step.kind == PREFERENCE:
            self._add_choices(plan)
        for button in (self.save_button, self.skip_button, self.left):
            button.setVisible(step.kind != PREFERENCE)
        self._count()

    def forget(self) -> None:
        """Another person, or another study, may be asked the same."""
        self._shown = None

    def _add_form(self, kind: str) -> None:
        for title, question, scale in scales_of(kind):
            words = [QLabel(title)]
            words[0].setWordWrap(True)
            if question:
                words.append(muted(question))
            self._list.addWidget(Card().add(*words, scale))
            self.scales.append(scale)
            scale.changed.connect(self._count)
        self.scales[0].setFocus()

    def _add_choices(self, plan: StudyPlan) -> None:
        for name in (*plan.condition_names, NONE):
            button = Button(name, f"Answer: {name}")
            button.setMinimumHeight(48)
            button.clicked.connect(lambda _=False, name=name: self.liked.emit("" if name == NONE else name))
            self._list.addWidget(button)
            self.choices.append(button)

    @Slot()
    def _count(self) -> None:
        open_ = sum(scale.value is None for scale in self.scales)
        self.left.setText(f"{open_} of {len(self.scales)} are not answered yet." if open_ else "All are answered.")
        self.save_button.setEnabled(bool(self.scales) and not open_)

    @Slot()
    def _save(self) -> None:
        self.answered.emit(tuple(scale.value for scale in self.scales))

    def _lay_out(self) -> None:
        inside = QWidget()
        inside.setMaximumWidth(WIDTH)
        whole = QVBoxLayout(inside)
        whole.setSpacing(10)
        self._list = QVBoxLayout()
        self._list.setSpacing(8)
        whole.addWidget(self.title)
        whole.addLayout(self._list)
        whole.addWidget(self.left)
        whole.addLayout(row_of(self.save_button, self.skip_button))
        whole.addStretch(1)
        area = QScrollArea()
        area.setWidget(inside)
        area.setWidgetResizable(True)
        area.setAlignment(Qt.AlignmentFlag.AlignHCenter)
        area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        area.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        column = QVBoxLayout(self)
        column.setContentsMargins(8, 8, 0, 0)
        column.addWidget(area)
