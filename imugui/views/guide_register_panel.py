"""The Register step: where the patient lies, in one of three ways, with what is left over."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal, Slot
from PySide6.QtWidgets import QCheckBox, QHBoxLayout, QLabel, QWidget

from imugui.guidance.reading import Vector
from imugui.guidance.registration import POSITIONS, REFUSE_DEG, WARN_DEG, Registration
from imugui.samples import Rows
from imugui.views.controls import Button, StillBox
from imugui.views.guide_parts import Card, Complaint, column_of, row_of
from imugui.views.guide_pose import Pose, PoseTaker
from imugui.views.guide_register_steps import WAYS, Way
from imugui.views.guide_stage import Stage
from imugui.views.labels import Chip, muted
from imugui.views.shortcuts import tip
from imugui.workers.session import Session, State

HOLD = "Hold it still…"
NONE = "Not registered: there is no guidance."
GONE = "From an earlier run, so no zero any more: register again."
NO_NORTH = "In the frame of a reference board the headings of both count: see there whether they are aligned"
MAG_WORDS = "Off: the heading drifts a little, and no iron disturbs it. On: the heading follows the magnetic field."


class RegisterPanel(QWidget):
    """Emits ``registered`` once all poses of a way were held."""

    started = Signal(bool)  # the first pose is being taken; with the magnetometer or without
    registered = Signal(object)  # Registration
    removed = Signal()
    finished = Signal()  # on to the next step

    def __init__(self, session: Session) -> None:
        super().__init__()
        self.stage = Stage(session)
        self._taker = PoseTaker((1.0, 0.0, 0.0))
        self._axis: Vector = (1.0, 0.0, 0.0)
        self._poses: list[Pose] = []
        self._done = False
        self._make_parts()
        self._lay_out()
        self._connect_parts()
        self.show_registration(None)
        self.choose("axes")

    # what the person does

    @Slot(str)
    def choose(self, method: str) -> None:
        """Begin one of the three ways anew."""
        self.method.choose(method)
        self._restart()

    @Slot()
    def take(self) -> None:
        """Take the next pose as soon as the tool is held still; pressed again: wait no longer."""
        if self._taker.waiting:
            self._taker.stop()
        else:
            if self._done:
                self._restart()
            if not self._poses:
                self.started.emit(self.mag.isChecked())
            self.trouble.show_wrong("")
            self._taker.begin(self._axis)
        self.stage.scene.setFocus(Qt.FocusReason.OtherFocusReason)
        self._tell()

    # what the page tells

    def feed(self, rows: Rows, first_number: int) -> None:
        """Take the ATTITUDE rows (n,) that are new, the first having this number."""
        pose = self._taker.feed(rows, first_number)
        if pose is not None:
            self._poses.append(pose)
            if len(self._poses) == len(self._way.steps):
                self._finish()
        if self._taker.waiting or pose is not None:
            self._tell()

    def show_tool(self, axis: Vector) -> None:
        """The tool's axis in the box."""
        if axis != self._axis:
            self._axis = axis
            self._restart()
        self.stage.scene.show_tool(axis)

    def show_registration(self, registration: Registration | None, void: str = "") -> None:
        """What is in use, or None; ``void`` says why it is not good any more."""
        self.remove_button.setEnabled(registration is not None)
        self.next_button.setEnabled(registration is not None and not void)
        if registration is None:
            self.chip.show_state("warn", "Not registered")
            self.words.setText(NONE)
            self.residual.clear()
        else:
            good = registration.residual_deg <= WARN_DEG
            word = "No longer good" if void else "Registered" if good else "Poor"
            self.chip.show_state("warn" if void or not good else "good", word)
            self.words.setText(registration.words)
            self.residual.setText(f"Residual {registration.residual_deg:.1f}°, identity {registration.id}")
        warning = registration.warning if registration is not None else ""
        self.warning.show_wrong(void or warning, "warn")

    def refresh(self, state: State) -> None:
        """Turn the picture."""
        self.stage.refresh(state)

    def slow_refresh(self) -> None:
        """Follow scheme and session."""
        self.stage.slow_refresh()
        self.stage.scene.show_tool(self._axis)
        self._follow_frame(self.stage.session.relative is not None)

    # inside

    def _follow_frame(self, against: bool) -> None:
        """In a reference board's frame there is neither a vertical nor a north."""
        if self.mag.isEnabled() is not against:
            return
        self.mag.setEnabled(not against)
        self.mag.setToolTip(NO_NORTH if against else MAG_WORDS)
        row = self.method.findData("mark")
        if against:
            self.method.removeItem(row)
        elif row < 0:
            self.method.insert(1, WAYS["mark"].title, "mark")
        self._restart()

    @property
    def _way(self) -> Way:
        return WAYS[self.method.currentData()]

    def _finish(self) -> None:
        """All poses were held: make the registration, or say why it was refused."""
        self._done = True
        try:
            made = self._way.make(self._poses, self._axis, self.position.currentData())
        except ValueError as error:
            self._restart()
            self.trouble.show_wrong(str(error))
            return
        self.registered.emit(made)

    @Slot()
    def _restart(self) -> None:
        self._taker.stop()
        self._poses, self._done = [], False
        self.trouble.show_wrong("")
        self.about.setText(self._way.words)
        self.position.setVisible(self._way.asks_position)
        self._tell()

    def _tell(self) -> None:
        """What to do now, and which steps are done."""
        steps, held = self._way.steps, len(self._poses)
        total = (held + self._taker.progress) / len(steps)
        if self._done:
            sentence = "Registered. Press Take to register anew."
        else:
            ask = HOLD if self._taker.waiting else "Then press Take (T) and hold still."
            sentence = f"{steps[held][1]} {ask}"
        self.stage.show_state(sentence, total)
        marks = ("✓" if i < held else "▶" if i == held else "○" for i in range(len(steps)))
        self.steps.setText("\n".join(f"{mark}  {name}" for mark, (name, _) in zip(marks, steps, strict=True)))
        self.take_button.setText("Stop" if self._taker.waiting else "Take")
        self.take_button.set_role("" if self._taker.waiting or self._done else "primary")
        self.again_button.setEnabled(held > 0 or self._taker.waiting)

    def _make_parts(self) -> None:
        self.method = StillBox("Way to register", "How the program learns where the patient lies")
        for key, way in WAYS.items():
            self.method.add(way.title, key)
        self.position = StillBox("Position of the patient", "How the patient lies on the level table")
        for name in POSITIONS:
            self.position.add(f"Patient {name}", name)
        self.mag = QCheckBox("Use the magnetometer")
        self.mag.setAccessibleName("Use the magnetometer")
        self.mag.setToolTip(MAG_WORDS)
        self.about, self.steps, self.words, self.residual = muted(), QLabel(), QLabel(), muted()
        self.words.setWordWrap(True)
        self.trouble = Complaint("Why the registration was refused")
        self.warning = Complaint("Warning about the registration")
        self.chip = Chip(("Not registered", "Registered", "No longer good"), "Registration")
        self.take_button = Button("Take", "Take this pose as soon as the tool is held still", "take", role="primary")
        self.again_button = Button("Start again", "Forget the poses that were taken")
        self.remove_button = Button("Remove", "Remove the registration: no guidance until there is another one")
        self.next_button = Button("Next: aim", "On to the next step", role="primary")
        self.residual.setToolTip(tip("", f"Above {WARN_DEG:g}° it is warned about, above {REFUSE_DEG:g}° refused"))

    def _connect_parts(self) -> None:
        self.method.activated.connect(self._restart)
        self.take_button.clicked.connect(self.take)
        self.again_button.clicked.connect(self._restart)
        self.remove_button.clicked.connect(self.removed)
        self.next_button.clicked.connect(self.finished)

    def _lay_out(self) -> None:
        how = Card("Register").add(self.method, self.about, self.position, self.steps, self.trouble)
        how.add(row_of(self.take_button, self.again_button), self.mag)
        use = Card("In use").add(row_of(self.chip), self.words, self.residual, self.warning, row_of(self.remove_button))
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(0)
        row.addWidget(self.stage, 1)
        row.addWidget(column_of(how, use, self.next_button))
