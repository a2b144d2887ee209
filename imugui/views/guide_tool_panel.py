"""The Tool step: which direction of the box the tool is, one of its axes or one that is measured by a spin."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal, Slot
from PySide6.QtWidgets import QHBoxLayout, QLabel, QWidget

from imugui.guidance.reading import Vector
from imugui.guidance.tool_axis import BOX_AXES, SpinFlow
from imugui.samples import Rows
from imugui.views.controls import Button, StillBox
from imugui.views.guide_parts import Card, Complaint, column_of, row_of
from imugui.views.guide_stage import Stage
from imugui.views.labels import Chip, muted
from imugui.workers.session import Session, State

IDLE = "The dotted line is the tool. Choose the axis of the box it lies along, or measure it."
MEASURED = "measured"
BOX_WORDS = "The tool is clamped along one of the box's axes. Taken as exact: a degree off is a degree of error."
SPIN_WORDS = "Turn the tool about its own axis, tip down at first. Its axis is what stays where it is."


class ToolPanel(QWidget):
    """Emits ``chosen`` with an axis of the box (x, y, z) towards the tip, and how well it is known in degrees."""

    chosen = Signal(object, float)
    finished = Signal()  # on to the next step

    def __init__(self, session: Session) -> None:
        super().__init__()
        self.stage = Stage(session)
        self._flow: SpinFlow | None = None
        self._axis: Vector = BOX_AXES["+x"]
        self._quality_deg = 0.0
        self.box = StillBox("Axis of the box", "The axis of the box that the tool lies along, towards the tip")
        for name in BOX_AXES:
            self.box.add(f"{name} of the box", name)
        self.box.add(MEASURED, MEASURED)
        self.box.activated.connect(self._box_chosen)
        self.chip = Chip(("Box axis", "Measured"), "Tool axis")
        self.words = QLabel()
        self.words.setWordWrap(True)
        self.trouble = Complaint("Why the spin was refused")
        self.spin_button = Button("Measure by a spin", SPIN_WORDS, "take")
        self.spin_button.clicked.connect(self.take)
        self.next_button = Button("Next: register", "On to the next step", role="primary")
        self.next_button.clicked.connect(self.finished)
        self._lay_out()
        self.show_axis(self._axis, 0.0)

    @property
    def measuring(self) -> bool:
        """Whether a spin is being measured."""
        return self._flow is not None

    def show_axis(self, axis: Vector, quality_deg: float) -> None:
        """Show the axis in use."""
        self._axis, self._quality_deg = axis, quality_deg
        name = next((key for key, way in BOX_AXES.items() if way == tuple(axis)), MEASURED)
        self.box.choose(name)
        measured = name == MEASURED
        self.chip.show_state("good" if measured else "neutral", "Measured" if measured else "Box axis")
        numbers = ", ".join(f"{value:+.3f}".replace("-", "−") for value in axis)
        found = f"({numbers}) in the box's axes. It kept its direction to {quality_deg:.1f}°."
        self.words.setText(found if measured else f"The {name} axis of the box.")
        self.stage.scene.show_tool(axis)

    @Slot()
    def take(self) -> None:
        """Begin a spin, or give it up."""
        self._flow = None if self._flow is not None else SpinFlow()
        self.trouble.show_wrong("")
        self._tell()
        self.stage.scene.setFocus(Qt.FocusReason.OtherFocusReason)

    def feed(self, rows: Rows) -> None:
        """Take the ATTITUDE rows (n,) that are new."""
        flow = self._flow
        if flow is None:
            return
        flow.feed(rows)
        if flow.done:
            self._flow = None
            found = flow.result()
            self.chosen.emit(found.axis, found.quality_deg)
            self._tell()
            self.stage.show_state(flow.sentence, 1.0)
        elif flow.progress >= 1.0:
            self._flow = None
            self.trouble.show_wrong(flow.result().reason)
            self._tell()
        else:
            self._tell()

    def refresh(self, state: State) -> None:
        """Turn the picture."""
        self.stage.refresh(state)

    def slow_refresh(self) -> None:
        """Follow scheme and session."""
        self.stage.slow_refresh()
        self.stage.scene.show_tool(self._axis)

    @Slot(int)
    def _box_chosen(self, row: int) -> None:
        name = self.box.itemData(row)
        if name == MEASURED:
            self.show_axis(self._axis, self._quality_deg)  # only a spin measures
        else:
            self.chosen.emit(BOX_AXES[name], 0.0)

    def _tell(self) -> None:
        flow = self._flow
        self.stage.show_state(flow.sentence if flow else IDLE, flow.progress if flow else 0.0)
        self.spin_button.setText("Give up" if flow else "Measure by a spin")

    def _lay_out(self) -> None:
        use = Card("In use").add(row_of(self.chip), self.words)
        box = Card("One of the box's axes").add(self.box, muted(BOX_WORDS))
        spin = Card("Measure it").add(muted(SPIN_WORDS), self.trouble, row_of(self.spin_button))
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(0)
        row.addWidget(self.stage, 1)
        row.addWidget(column_of(use, box, spin, self.next_button))
        self._tell()
