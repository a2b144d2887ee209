"""StepBar: the steps of the Guide page in their order, each with its state as shape and word."""

from __future__ import annotations

import math
from dataclasses import dataclass

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QFontMetrics
from PySide6.QtWidgets import QButtonGroup, QFrame, QHBoxLayout, QToolButton

from imugui.guidance.guide import Guide
from imugui.guidance.tool_axis import BOX_AXES
from imugui.views import theme

_AIR = 22  # px beside the text


@dataclass(frozen=True)
class StepLabel:
    """What a step is called, and what it is for."""

    title: str
    tip: str


STEPS = {
    "plan": StepLabel("Plan", "The trajectories"),
    "tool": StepLabel("Tool", "Which direction of the box the tool is"),
    "register": StepLabel("Register", "Where the patient lies"),
    "aim": StepLabel("Aim", "The target, and the readings"),
    "report": StepLabel("Report", "All readings, and files of them"),
}


def step_states(guide: Guide, drafts: int, void: str) -> dict[str, tuple[str, str]]:
    """Tone and word of each step; ``drafts``: plans that were begun, ``void``: why the registration has ended."""
    complete = len(guide.plans) == drafts
    box = next((name for name, way in BOX_AXES.items() if way == guide.tool_axis), "")
    registered = guide.registration is not None
    age = _minutes(guide.look.heading_age_s) if registered else ""
    taken = len(guide.readings)
    return {
        "plan": (("good" if complete else "warn") if drafts else "neutral", str(drafts or "")),
        "tool": ("neutral", box) if box else ("good", "measured"),
        "register": ("warn", "again") if void else ("good" if registered else "neutral", age),
        "aim": ("good" if registered and guide.look.trusted else "neutral", ""),
        "report": ("good" if taken else "neutral", str(taken or "")),
    }


def _minutes(seconds: float) -> str:
    """How long ago, in whole minutes."""
    if not math.isfinite(seconds):
        return ""
    return f"{seconds / 60.0:.0f} min" if seconds >= 60.0 else "< 1 min"


class StepBar(QFrame):
    """Buttons beside each other; the one in front is marked."""

    chosen = Signal(str)

    def __init__(self) -> None:
        super().__init__()
        self.setProperty("role", "bar")
        self.setAccessibleName("Steps")
        self._group = QButtonGroup(self)
        self._bold = theme.font("body")
        self._bold.setBold(True)
        row = QHBoxLayout(self)
        row.setContentsMargins(12, 4, 12, 4)
        row.setSpacing(4)
        self.buttons = {name: self._button(name, label) for name, label in STEPS.items()}
        for button in self.buttons.values():
            row.addWidget(button)
        row.addStretch(1)

    def select(self, name: str) -> None:
        """Mark the step in front; none for a name that is no step."""
        self._group.setExclusive(False)
        for key, button in self.buttons.items():
            button.setChecked(key == name)
        self._group.setExclusive(True)

    def show_state(self, name: str, tone: str, word: str) -> None:
        """The state of a step: tone "neutral", "good", "warn" or "bad", and a word behind its name."""
        glyph = "○" if tone == "neutral" else theme.tone_glyph(tone)
        button, title = self.buttons[name], STEPS[name].title
        text = f"{glyph}  {title}  {word}".rstrip()
        if button.text() != text:
            button.setText(text)
            button.setMinimumWidth(QFontMetrics(self._bold).horizontalAdvance(text) + _AIR)  # the one in front is bold
            button.setAccessibleName(f"Step {title}: {word or tone}")

    def _button(self, name: str, label: StepLabel) -> QToolButton:
        button = QToolButton()
        button.setProperty("role", "rail")
        button.setText(label.title)
        button.setCheckable(True)
        button.setToolTip(label.tip)
        button.setAccessibleName(f"Step {label.title}")
        button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        button.clicked.connect(lambda: self.chosen.emit(name))
        self._group.addButton(button)
        return button
