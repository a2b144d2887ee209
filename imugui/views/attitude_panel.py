"""The angles: yaw, pitch and roll large, the quaternion small, and when not to trust them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from PySide6.QtWidgets import QFrame, QHBoxLayout, QVBoxLayout

from imugui.fusion.attitude import CONVENTIONS, euler, euler_reliable
from imugui.views.controls import clear
from imugui.views.labels import Chip, heading, muted
from imugui.views.live_words import UNRELIABLE, quat_words, shown_quat, sigma_words, takeover_words
from imugui.views.readout import Readout

ANGLES = {"Yaw": 2, "Pitch": 1, "Roll": 0}
"""Name and axis of each angle, in the order of euler()."""
NO_QUAT = "w ------  x ------  y ------  z ------"


class AttitudePanel(QFrame):
    """Shows one attitude in a display convention."""

    def __init__(self, convention: str, decimals: int) -> None:
        super().__init__()
        self.setProperty("role", "card")
        self.readouts: dict[str, Readout] = {}
        self.convention = Chip(tuple(CONVENTIONS), "Display convention", shape=False)
        self.quat = muted(NO_QUAT)
        self.quat.setWordWrap(False)
        self.quat.setToolTip("The shown attitude as a quaternion")
        self.sigma = muted("")
        self.sigma.setToolTip("How far tilt and heading may be off, 1 sigma, as the filter itself says")
        self.sigma.hide()
        self.takeover = Chip(name="Filter")
        self.takeover.setToolTip("The chosen filter no longer believes itself: another one runs until it does")
        self.why = muted("")
        for part in (self.takeover, self.why):
            part.hide()
        head = QHBoxLayout()
        head.addWidget(heading("Attitude"))
        head.addStretch(1)
        head.addWidget(self.convention)
        self._numbers = QVBoxLayout()
        self._numbers.setSpacing(6)
        column = QVBoxLayout(self)
        column.setContentsMargins(16, 12, 16, 12)
        column.setSpacing(8)
        column.addLayout(head)
        column.addLayout(self._numbers)
        column.addWidget(self.quat)
        for part in (self.sigma, self.takeover, self.why):
            column.addWidget(part)
        self.set_display(convention, decimals)

    def set_display(self, convention: str, decimals: int) -> None:
        """Take another convention (a key of CONVENTIONS) or number of decimals."""
        self._convention = convention
        self.convention.show_state("neutral", convention)
        self.convention.setToolTip(f"{CONVENTIONS[convention].title}. {CONVENTIONS[convention].tip}")
        clear(self._numbers)
        self.readouts = {name: _readout(name, decimals, axis) for name, axis in ANGLES.items()}
        for readout in self.readouts.values():
            self._numbers.addWidget(readout)

    def show_attitude(self, local: NDArray[np.float64], has_origin: bool) -> None:
        """Show an attitude (w, x, y, z), in ENU or relative to the origin."""
        shown = shown_quat(local, self._convention, has_origin)
        reliable = bool(euler_reliable(shown))
        for name, angle in zip(ANGLES, np.degrees(euler(shown)), strict=True):
            doubt = "" if reliable or name == "Pitch" else UNRELIABLE
            self.readouts[name].set_value(float(angle), doubt)
        self.quat.setText(quat_words(shown))

    def show_sigma(self, tilt: float, heading: float) -> None:
        """What the filter says of its own error, rad; nothing is shown for a filter that says nothing (NaN)."""
        words = sigma_words(tilt, heading)
        self.sigma.setText(words)
        self.sigma.setVisible(bool(words))

    def show_note(self, note: str) -> None:
        """Why another filter has taken over from the chosen one, in its words; "" when none has."""
        what, why = takeover_words(note)
        if note:
            self.takeover.show_state("warn", what)
            self.why.setText(why)
        self.takeover.setVisible(bool(note))
        self.why.setVisible(bool(why))

    def blank(self) -> None:
        """There is no attitude."""
        for readout in self.readouts.values():
            readout.set_value(None)
        self.quat.setText(NO_QUAT)


def _readout(name: str, decimals: int, axis: int) -> Readout:
    return Readout(name, decimals=decimals, axis=axis, font="huge")
