"""RunCard: start, emergency stop, the two steps out of it, and how the run stands."""

from __future__ import annotations

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QGridLayout, QLabel, QStackedWidget

from imugui.targeting.game_look import DONE, PHASES, GameLook
from imugui.targeting.states import State
from imugui.views import theme
from imugui.views.controls import Button
from imugui.views.guide_parts import Card, note, row_of
from imugui.views.labels import Chip, ToneLabel
from imugui.views.stop_button import HEIGHT, StopButton
from imugui.views.target_words import trial_words

BLANK = "–"
NUMBERS = {"left": "Left", "time": "Time", "missed": "Missed", "this": "Target"}
"""The figures of a run, in rows of two."""


class RunCard(Card):
    """Follows a GameLook; emits what the person wants."""

    start_wanted = Signal()
    stop_wanted = Signal()
    reset_wanted = Signal()
    confirm_wanted = Signal()
    leave_wanted = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.start_button = Button("Start run", "Start a run (Enter, in the picture)", icon="play", role="primary")
        self.start_button.setFixedHeight(HEIGHT)
        self.stop_button = StopButton()
        self.reset_button = Button("1. Reset", "After an emergency stop (Backspace)", small=True)
        self.confirm_button = Button("2. Confirm", "Let the view follow again (Enter)", small=True)
        self.leave_button = Button("Leave run", "End this run; it does not count", small=True)
        self.chip = Chip(tuple(word for word, _ in PHASES.values()), "State")
        self.last = ToneLabel()
        self.last.setAccessibleName("The last target")
        self.numbers = {name: self._number(title) for name, title in NUMBERS.items()}
        self._lay_out()
        for button, signal in (
            (self.start_button, self.start_wanted),
            (self.stop_button, self.stop_wanted),
            (self.reset_button, self.reset_wanted),
            (self.confirm_button, self.confirm_wanted),
            (self.leave_button, self.leave_wanted),
        ):
            button.clicked.connect(signal)
        self.show_run(None, playing=False)

    def show_run(self, look: GameLook | None, playing: bool) -> None:
        """How the run stands; None before its first row, and without one."""
        state = look.state if look is not None and playing else None
        self._front.setCurrentWidget(self.stop_button if playing else self.start_button)
        self.stop_button.setEnabled(playing and state is not State.FAULT)
        self.reset_button.setEnabled(state is State.FAULT)
        self.confirm_button.setEnabled(state is State.DISARMED)
        self.leave_button.setEnabled(playing)
        if look is None:
            self.chip.show_state("neutral", "Starting" if playing else "No run")
            self._write({})
            self.last.show_phrase("neutral", "")
            return
        self.chip.show_state(look.tone, look.phase_word)
        over = look.phase == DONE
        self._write({
            "left": f"{look.remaining} of {look.total}",
            "time": f"{look.elapsed_s:.1f} s",
            "this": BLANK if over else f"{look.target_s:.1f} s",
            "missed": str(look.errors),
        })  # fmt: skip
        if look.last is not None:
            tone, words = trial_words(look.last)
            self.last.show_phrase(tone, f"Last: {words}")
        else:
            self.last.show_phrase("neutral", "")

    def offer(self, words: str, why_not: str, tip: str = "") -> None:
        """What the start button says; ``why_not``: it is off, for this reason."""
        self.start_button.setText(words)
        self.start_button.setEnabled(not why_not)
        self.start_button.setToolTip(why_not or tip or "Start a run (Enter, in the picture)")

    def _write(self, words: dict[str, str]) -> None:
        for name, label in self.numbers.items():
            label.setText(words.get(name, BLANK))

    def _number(self, title: str) -> QLabel:
        label = QLabel()
        label.setFont(theme.font("heading"))
        label.setAccessibleName(title)
        return label

    def _lay_out(self) -> None:
        self._front = QStackedWidget()
        self._front.setFixedHeight(HEIGHT)
        for button in (self.start_button, self.stop_button):
            self._front.addWidget(button)
        grid = QGridLayout()
        grid.setVerticalSpacing(0)
        grid.setHorizontalSpacing(10)
        for place, (name, title) in enumerate(NUMBERS.items()):
            row, column = divmod(place, 2)
            grid.addWidget(note(title), row, 2 * column)
            grid.addWidget(self.numbers[name], row, 2 * column + 1)
            grid.setColumnStretch(2 * column + 1, 1)
        self.add(self._front, row_of(self.reset_button, self.confirm_button, self.leave_button))
        self.add(row_of(self.chip), grid, self.last)
