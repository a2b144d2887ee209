"""Guard: says when the self-calibrating filter is no longer to be believed, and runs VQF meanwhile."""

from __future__ import annotations

from math import exp, radians
from typing import Any

import numpy as np

from imugui.fusion.filter import Filter
from imugui.fusion.madgwick import Madgwick
from imugui.fusion.quaternion import Floats
from imugui.fusion.self_calibrating_steps import BIAS, MATRIX, healthy

try:
    from imugui.fusion.vqf_filter import Vqf
except ImportError:  # no wheel for this system
    FALLBACK: type[Filter] = Madgwick
else:
    FALLBACK = Vqf

WINDOW = 2.0  # s, over which innovations are averaged
LARGEST_NIS = 6.0  # mean squared innovation over its variance; 1 when the model is right
LARGEST_BIAS = radians(20.0)  # rad/s
LARGEST_MATRIX = 0.15
RETURN_AFTER = 10.0  # s without trouble

BROKEN = "its numbers have failed"
OUT_OF_BOUNDS = "what it learnt about the gyroscope cannot be true"
TOO_FAR = "the board seems to travel farther than an arm reaches"
WRONG_NORTH = "its heading has parted from the magnetic field"


class Guard:
    """Watches the innovations of position and heading and the bounds of what is learnt."""

    def __init__(self) -> None:
        self.reason = ""  # why the fallback runs, "" when it does not
        self.fallback: Filter | None = None
        self._since = 0.0  # s since the last trouble
        self._position = self._heading = 1.0  # mean squared innovations

    def trouble(self, nominal: Floats, p: Floats, time: float, position: float, heading: float | None) -> str:
        """Take a block's innovations, squared over their variance; returns what is wrong, "" for nothing."""
        k = 1.0 - exp(-time / WINDOW)
        self._position += k * (min(position, 100.0) - self._position)
        if heading is not None:
            self._heading += k * (min(heading, 100.0) - self._heading)
        if not healthy(nominal, p):
            return BROKEN
        if np.abs(nominal[BIAS]).max() > LARGEST_BIAS or np.abs(nominal[MATRIX]).max() > LARGEST_MATRIX:
            return OUT_OF_BOUNDS
        if self._position > LARGEST_NIS:
            return TOO_FAR
        return WRONG_NORTH if self._heading > LARGEST_NIS else ""

    def fall_back(self, reason: str, quat: tuple[float, ...]) -> None:
        """Let VQF take over from this attitude, or keep it where it is running already."""
        self.reason, self._since = reason, 0.0
        self._position = self._heading = 1.0
        if self.fallback is None:
            self.fallback = FALLBACK()
            self.fallback.start(quat)

    def passed(self, time: float) -> None:
        """So many seconds without trouble: after ten of them the filter comes back."""
        self._since += time
        if self.fallback is not None and self._since >= RETURN_AFTER:
            self.reason, self.fallback = "", None

    def state(self) -> dict[str, Any]:
        """Everything that the next block depends on, as plain numbers."""
        return {
            "reason": self.reason,
            "since": self._since,
            "means": [self._position, self._heading],
            "fallback": None if self.fallback is None else self.fallback.state(),
        }

    def restore(self, state: dict[str, Any]) -> None:
        """Continue from ``state``."""
        self.reason, self._since = state["reason"], state["since"]
        self._position, self._heading = state["means"]
        self.fallback = None
        if state["fallback"] is not None:
            self.fallback = FALLBACK()
            self.fallback.restore(state["fallback"])
