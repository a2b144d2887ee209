"""The cards of the Aim step: which trajectory, which side, the numbers, the reading."""

from __future__ import annotations

import math
from collections.abc import Sequence

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QGridLayout, QLabel

from imugui.guidance.look import Look
from imugui.guidance.plan import Plan, identity, plan_words, title
from imugui.guidance.reading import Reading
from imugui.views import theme
from imugui.views.controls import Button, StillBox
from imugui.views.guide_aim_words import component_words, due_words, reading_words
from imugui.views.guide_parts import Card, note, row_of
from imugui.views.labels import Chip, ToneLabel, muted
from imugui.views.polar_words import clock
from imugui.views.readout import Readout, number_text
from imugui.views.side_picture import SidePicture

HALF_PROOF = "Measured against the reference: one board's recording cannot give it again."
NO_PROOF = "Nothing is recorded, so it cannot be computed again: press R to record."


class TrajectoryCard(Card):
    """The plan in use, and the ways to another one."""

    selected = Signal(int)

    def __init__(self) -> None:
        super().__init__()
        self._shown: object = None
        self.box = StillBox("Trajectory", "The trajectory to aim at")
        self.box.setFont(theme.font("heading"))
        self.box.activated.connect(self.selected)
        self.words = QLabel()
        self.words.setWordWrap(True)
        self.back = Button("Previous", "The trajectory before", "previous_plan", small=True)
        self.on = Button("Next", "The next trajectory", "next_plan", small=True)
        self.count = note()
        self.back.clicked.connect(lambda: self.selected.emit(self.box.currentIndex() - 1))
        self.on.clicked.connect(lambda: self.selected.emit(self.box.currentIndex() + 1))
        foot = row_of(self.back, self.on)
        foot.addWidget(self.count)
        self.add(self.box, self.words, foot)

    def show_plans(self, plans: Sequence[Plan], index: int, readings: Sequence[Reading]) -> None:
        """Show which plan is in use, and which have been taken."""
        shown = (tuple(plans), index, len(readings))
        if shown == self._shown:
            return
        self._shown = shown
        taken = {identity(reading.plan) for reading in readings}
        self.box.clear()
        for number, plan in enumerate(plans):
            mark = theme.tone_glyph("good") if identity(plan) in taken else "○"
            self.box.add(f"{mark}  {title(plan)}", number)
        self.box.setCurrentIndex(index)
        self.words.setText(plan_words(plans[index]) if 0 <= index < len(plans) else "No trajectory is planned.")
        self.count.setText(f"{index + 1} of {len(plans)}, {len(readings)} taken" if plans else "")
        self.back.setEnabled(index > 0)
        self.on.setEnabled(0 <= index < len(plans) - 1)


class SideCard(Card):
    """Asks to look at the patient when the side changes; hidden otherwise."""

    confirmed = Signal(str)

    def __init__(self) -> None:
        super().__init__("Which side?")
        self._side = ""
        self.words = QLabel()
        self.words.setWordWrap(True)
        self.picture = SidePicture(editable=False)
        self.picture.setFixedHeight(120)
        self.button = Button("Confirm", "I have looked at the patient: this is the side", role="primary")
        self.button.clicked.connect(lambda: self.confirmed.emit(self._side))
        self.add(self.words, self.picture, self.button)
        self.hide()

    def ask(self, plan: Plan | None, confirmed: str) -> None:
        """Ask if the plan's side is not the one that was confirmed last."""
        side = plan.side if plan is not None else ""
        self.setVisible(side not in ("", confirmed))
        if side != self._side and side:
            self._side = side
            self.words.setText(f"This entry is on the patient's {side.upper()} side. Look at the patient.")
            self.picture.show_side(side)
            self.button.setText(f"Confirm: {side} side")
            self.button.setAccessibleName(f"Confirm the {side} side")


class NumberCard(Card):
    """The error and its parts; numbers that are too old are blank."""

    def __init__(self) -> None:
        super().__init__()
        self.error = Readout("Error", decimals=1, limit=180.0, signed=False, font="huge")
        self.sigma = QLabel()
        self.sigma.setFont(theme.font("heading"))
        self.sigma.setToolTip("9 of 10 errors stay within this, by what is known of board, zero and heading")
        self.across, self.along = QLabel(), QLabel()
        for label in (self.across, self.along):
            label.setFont(theme.font("heading"))
        self.due = ToneLabel("Register again within 88:88")
        self.twist = note()
        self.twist.setToolTip("Turned about its own axis against the plan; not scored")
        grid = QGridLayout()
        grid.setHorizontalSpacing(10)
        grid.setVerticalSpacing(4)
        grid.addWidget(self.error, 0, 0, 2, 1)
        grid.addWidget(self.sigma, 0, 1, Qt.AlignmentFlag.AlignBottom)
        grid.addWidget(self.twist, 1, 1, Qt.AlignmentFlag.AlignTop)
        grid.addWidget(self.across, 2, 0, 1, 2)
        grid.addWidget(self.along, 3, 0, 1, 2)
        grid.addWidget(self.due, 4, 0, 1, 2)
        grid.setColumnStretch(1, 1)
        self.add(grid)

    def show_look(self, look: Look) -> None:
        """Show the numbers of this moment."""
        blank = look.colour == "blank"
        doubt = "" if look.trusted else "not trusted"
        self.error.setToolTip("Angle between the tool and the plan")
        self.error.set_value(None if blank else look.error_deg, "" if blank or look.aim is None else doubt)
        known = math.isfinite(look.sigma_deg) and not blank
        self.sigma.setText(f"± {look.sigma_deg:.1f}°" if known else "±  –")
        turned = math.isfinite(look.twist_deg) and not blank
        self.twist.setText(f"twist {number_text(look.twist_deg, 0, signed=True)}°, not scored" if turned else "")
        for label, words in zip((self.across, self.along), component_words(look.aim, look.plan), strict=True):
            label.setText(words)

    def show_due(self, look: Look) -> None:
        """How old the zero is, and how long it is good."""
        tone, words = due_words(look)
        self.due.show_phrase(tone, words)
        self.due.setToolTip(f"Registered {clock(look.heading_age_s)} ago" if math.isfinite(look.heading_age_s) else "")


class CaptureCard(Card):
    """The button that takes a reading, and what became of it."""

    wanted = Signal()
    again = Signal()  # register again

    def __init__(self) -> None:
        super().__init__()
        self.button = Button("Take reading", "Take a reading once the tool was held on the plan", "take")
        self.button.setMinimumHeight(38)
        self.button.clicked.connect(self.wanted)
        self.register_button = Button("Register again", "Back to the registration", "register", small=True)
        self.register_button.clicked.connect(self.again)
        self.chip = Chip(("Ready", "Hold", "No reading now"), "Reading")
        self.said = muted()
        self.said.setMinimumHeight(3 * self.said.fontMetrics().lineSpacing())
        self.said.setAlignment(Qt.AlignmentFlag.AlignTop)
        self.add(self.button, row_of(self.chip, self.register_button), self.said)

    def show_look(self, look: Look) -> None:
        """Whether a reading could be taken now."""
        state = ("good", "Ready") if look.armed else ("neutral", "Hold") if look.trusted else ("warn", "No reading now")
        self.chip.show_state(*state)
        self.button.set_role("primary" if look.armed else "")

    def show_result(self, tone: str, words: str) -> None:
        """What became of the last press."""
        self.said.setText(f"{theme.tone_glyph(tone)} {words}")
        self.said.setAccessibleName(words)

    def show_reading(self, reading: Reading, recorded: bool) -> None:
        """A reading was taken."""
        proof = HALF_PROOF if reading.relative else "" if recorded else NO_PROOF
        self.show_result("warn" if proof else "good", f"Taken: {reading_words(reading)}. {proof}".strip())
