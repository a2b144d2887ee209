"""The 3D scene of a board that can be turned by hand: with the mouse, and with the arrow keys."""

from __future__ import annotations

import math

from PySide6.QtCore import Qt
from PySide6.QtGui import QKeyEvent

from imugui.views.scene3d import Scene3D

_STEP = math.radians(4.0)
_KEYS = {
    Qt.Key.Key_Left: (-_STEP, 0.0),
    Qt.Key.Key_Right: (_STEP, 0.0),
    Qt.Key.Key_Up: (0.0, -_STEP),
    Qt.Key.Key_Down: (0.0, _STEP),
}


class HandScene(Scene3D):
    """In hand mode the arrow keys turn the board as the mouse does; with Shift they look around it."""

    def set_hand_mode(self, on: bool) -> None:
        self.turned_by_hand = on
        super().set_hand_mode(on)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        turn = _KEYS.get(Qt.Key(event.key()))
        shift = bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier)
        if self.turned_by_hand and turn is not None and not shift:
            self.hand_turned.emit(*turn)
        else:
            super().keyPressEvent(event)
