"""The Aim step: the polar target, its numbers, and the button that takes a reading."""

from __future__ import annotations

import time
from collections.abc import Sequence

import numpy as np
from PySide6.QtCore import Qt, Signal, Slot
from PySide6.QtWidgets import QApplication, QCheckBox, QHBoxLayout, QVBoxLayout, QWidget

from imugui.fusion.quaternion import from_matrix
from imugui.guidance.guide import Guide
from imugui.guidance.look import Look
from imugui.guidance.plan import Plan, direction, screen_sign, target_basis
from imugui.guidance.reading import Reading
from imugui.views.guide_cards import CaptureCard, NumberCard, SideCard, TrajectoryCard
from imugui.views.guide_parts import column_of
from imugui.views.polar_target import PolarTarget
from imugui.workers.session import Session


class AimPanel(QWidget):
    """Shows the newest Look of a guide; what the person wants goes out as signals."""

    wanted = Signal()  # a reading
    selected = Signal(int)
    side_confirmed = Signal(str)
    register_wanted = Signal()

    def __init__(self, session: Session, guide: Guide) -> None:
        super().__init__()
        self._session, self._guide = session, guide
        self._beeped = 0.0
        self.target = PolarTarget()
        self.trajectory, self.side = TrajectoryCard(), SideCard()
        self.numbers, self.reading = NumberCard(), CaptureCard()
        self.sound = QCheckBox("Sound: faster the nearer")
        self.sound.setAccessibleName("Sound")
        self.sound.setToolTip("The system's beep, more often the smaller the error; nothing where there is no sound")
        self._lay_out()
        self.target.tool_turned.connect(self.turn_tool)
        for source in (self.target.taken, self.reading.wanted):
            source.connect(self.wanted)
        self.trajectory.selected.connect(self._select)
        self.side.confirmed.connect(self._confirm)
        self.reading.again.connect(self.register_wanted)

    def refresh(self, look: Look, rows: int) -> None:
        """Paint the newest look; ``rows``: attitudes received so far."""
        self.target.beat(rows)
        self.target.show_plan(look.plan)
        self.target.show_look(look)
        self.numbers.show_look(look)
        self._beep(look)

    def slow_refresh(self, readings: Sequence[Reading]) -> None:
        """Bring words and controls up to date."""
        guide = self._guide
        self.trajectory.show_plans(guide.plans, guide.index, readings)
        self.side.ask(guide.plan, guide.confirmed_side)
        self.numbers.show_due(guide.look)
        self.reading.show_look(guide.look)
        hand = self._session.hand_turned and guide.registration is not None
        if self.target.turned_by_hand != hand:
            self.target.set_hand_mode(hand)

    def take_keys(self) -> None:
        """Space and the arrow keys go to the target from now on."""
        self.target.setFocus(Qt.FocusReason.OtherFocusReason)

    @Slot(float, float)
    def turn_tool(self, right: float, up: float) -> None:
        """Turn the virtual board so that the tool's tip moves to the right and up on the dial, rad."""
        plan, registration = self._guide.plan, self._guide.registration
        if plan is None or registration is None or not self._session.hand_turned:
            return
        viewer = dial_axes(plan, self._guide.tool_axis, np.asarray(registration.matrix))
        self._session.turn_board(-right, up, from_matrix(viewer))

    @Slot(int)
    def _select(self, index: int) -> None:
        self.selected.emit(index)
        self.take_keys()

    @Slot(str)
    def _confirm(self, side: str) -> None:
        self.side_confirmed.emit(side)
        self.take_keys()

    def _beep(self, look: Look) -> None:
        """A beep when it is time for one."""
        now = time.perf_counter()
        if self.sound.isChecked() and look.beep_hz > 0.0 and now - self._beeped >= 1.0 / look.beep_hz:
            self._beeped = now
            QApplication.beep()

    def _lay_out(self) -> None:
        left = QVBoxLayout()
        left.setContentsMargins(8, 4, 0, 0)
        left.setSpacing(0)
        left.addWidget(self.target, 1)
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(0)
        row.addLayout(left, 1)
        row.addWidget(column_of(self.trajectory, self.side, self.numbers, self.reading, self.sound))


def dial_axes(plan: Plan, tool_axis: Sequence[float], matrix: np.ndarray) -> np.ndarray:
    """Rotation (3, 3) from the dial's axes (right, up, towards the eye) to the earth's, for one who looks along it."""
    way = direction(plan, tool_axis)
    medial, cranial = target_basis(way, plan.side)
    return np.asarray(matrix @ np.stack((screen_sign(plan.side) * medial, cranial, -way), axis=1))
