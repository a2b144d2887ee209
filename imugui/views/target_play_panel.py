"""The column of the Play tab: what is played, how the hand steers, which keys do it."""

from __future__ import annotations

import dataclasses
from dataclasses import replace

from PySide6.QtCore import Signal, Slot
from PySide6.QtWidgets import QVBoxLayout, QWidget

from imugui.targeting import settings, tasks
from imugui.targeting.play_again import Setup
from imugui.targeting.tally import Labels
from imugui.views.form import Form
from imugui.views.guide_parts import Card, column_of
from imugui.views.target_cards import KeysCard, PresetCard
from imugui.views.target_file import Kept
from imugui.views.target_history import HistoryCard
from imugui.views.target_words import control_name, control_words, task_words

FREE = "free-play"
"""The code of who plays outside of a study."""


class PlayPanel(QWidget):
    """Holds the settings of free play; they are off while a run is on."""

    changed = Signal()

    def __init__(self, kept: Kept) -> None:
        super().__init__()
        self.task = PresetCard("Task", kept.task, tasks.PRESETS, task_words)
        self.control = PresetCard("Mapping", kept.control, settings.PRESETS, control_words)
        self.play = Form(kept.play)
        self.keys, self.history = KeysCard(), HistoryCard()
        self._runs = 0
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        area = column_of(self.task, self.control, self.keys, Card("This run").add(self.play), self.history)
        column.addWidget(area)
        for part in (self.task, self.control, self.play):
            part.changed.connect(self._take)
        self._take()

    def kept(self, study: str) -> Kept:
        """What is to be remembered; ``study``: folder of the study that is open."""
        return Kept(self.task.value(), self.control.value(), self.play.value(), study)

    def setup(self) -> Setup:
        """The next run, with a number of its own."""
        self._runs += 1
        control, play = self.control.value(), self.play.value()
        labels = Labels("", FREE, control_name(control), 0, play.practice, self._runs)
        return Setup(self.task.value(), control, play.seed, labels=labels)

    def next_list(self) -> None:
        """A run is over: go on to another list of targets, if that is wanted."""
        play = self.play.value()
        if play.another:
            last = next(item for item in dataclasses.fields(play) if item.name == "seed").metadata["high"]
            self.play.set_value(replace(play, seed=(play.seed + 1) % (last + 1)))
            self.changed.emit()

    def problems(self) -> list[str]:
        """Why the next run cannot be played, one sentence each."""
        return tasks.problems(self.task.value())

    def set_open(self, on: bool) -> None:
        """Whether settings can be changed."""
        for part in (self.task, self.control, self.play):
            part.setEnabled(on)

    @Slot()
    def _take(self) -> None:
        wrong = self.problems()
        self.task.trouble.show_wrong(f"{wrong[0][:1].upper()}{wrong[0][1:]}." if wrong else "")
        self.changed.emit()
