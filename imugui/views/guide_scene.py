"""The board as it is held now, with the tool as a dotted line from it; turned by hand where it is a virtual one."""

from __future__ import annotations

import math
import time

import numpy as np
from numpy.typing import ArrayLike
from PySide6.QtCore import Qt, Slot
from PySide6.QtGui import QKeyEvent

from imugui.fusion.quaternion import from_matrix
from imugui.views import theme
from imugui.views.hand_scene import HandScene
from imugui.views.live_words import stale_word
from imugui.views.relative_words import stale_relative
from imugui.workers.session import Session, State

DOTS = 46
LENGTH = 1.55
"""Of the tool, scene units: a little longer than the axes."""

_STEPS = {Qt.KeyboardModifier.NoModifier: math.radians(3.0), Qt.KeyboardModifier.ControlModifier: math.radians(0.5)}
_KEYS = {
    Qt.Key.Key_Left: (-1.0, 0.0), Qt.Key.Key_Right: (1.0, 0.0), Qt.Key.Key_Up: (0.0, -1.0), Qt.Key.Key_Down: (0.0, 1.0),
}  # fmt: skip


class GuideScene(HandScene):
    """Shows attitudes against the earth, or a reference board; without a fresh one it is greyed."""

    def __init__(self, session: Session) -> None:
        super().__init__()
        self._session = session
        self._tool: tuple[float, float, float] | None = None
        self._dark = False
        self.setAccessibleName("The tool as it is held now")
        self.hand_turned.connect(self.turn_board)

    def show_tool(self, axis: ArrayLike) -> None:
        """Draw the tool along a direction (3,) of the box's axes."""
        x, y, z = np.asarray(axis, float).tolist()
        way = (x, y, z)
        if (way, theme.is_dark()) == (self._tool, self._dark):
            return
        self._tool, self._dark = way, theme.is_dark()
        points = np.linspace(0.3, LENGTH, DOTS)[:, None] * np.array((x, y, z))
        colour = theme.palette().ghost
        self.set_points(points, np.tile((colour.red(), colour.green(), colour.blue()), (DOTS, 1)))

    def refresh(self, state: State) -> None:
        """Turn the board."""
        rows = self._session.shown.last(1)
        player = self._session.player
        paused = player is not None and not player.playing and not player.ended
        age_s = time.perf_counter() - float(rows["t_arrival"][0]) if len(rows) else math.nan
        relative = self._session.relative
        word = stale_relative(relative.status(), len(rows)) if relative is not None else stale_word(state, age_s)
        self.set_dimmed(None if paused and len(rows) else word or None)
        self.set_north(self._session.relative is None)
        if len(rows):
            self.set_quat(rows["quat"][0])

    def slow_refresh(self) -> None:
        """Take the mouse and the arrow keys for the virtual board while there is one."""
        if self.turned_by_hand != self._session.hand_turned:
            self.set_hand_mode(self._session.hand_turned)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """In hand mode the arrow keys turn by 3 degrees, with Ctrl by half a degree: a right angle can be met."""
        way = _KEYS.get(Qt.Key(event.key()))
        modifiers = event.modifiers() & ~Qt.KeyboardModifier.KeypadModifier
        step = _STEPS.get(modifiers)
        if self.turned_by_hand and way is not None and step is not None:
            self.turn_board(way[0] * step, way[1] * step)
        else:
            super().keyPressEvent(event)

    @Slot(float, float)
    def turn_board(self, dx_rad: float, dy_rad: float) -> None:
        """Turn the virtual board as seen on screen: right by dx, down by dy, rad."""
        self._session.turn_board(dx_rad, dy_rad, from_matrix(self.camera().basis.T))
