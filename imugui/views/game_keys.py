"""The keys of the game's picture, and who holds which button down."""

from __future__ import annotations

from PySide6.QtCore import Qt

from imugui.targeting.activation import CLUTCH
from imugui.targeting.settings import TOGGLE, Control
from imugui.targeting.view_pose import PAN, ZOOM

PLAIN = ""
"""The button that pans while it is held; latched, a short press pans and a long one zooms, as on the board."""

BUTTON_KEYS = {Qt.Key.Key_Space: PLAIN, Qt.Key.Key_Z: ZOOM, Qt.Key.Key_X: CLUTCH}
MOUSE_BUTTONS = {Qt.MouseButton.LeftButton: PAN, Qt.MouseButton.RightButton: ZOOM}
NO_BREAK = "\u00a0"
ARROWS = {
    Qt.Key.Key_Left: (-1.0, 0.0), Qt.Key.Key_Right: (1.0, 0.0), Qt.Key.Key_Up: (0.0, 1.0), Qt.Key.Key_Down: (0.0, -1.0),
}  # fmt: skip
GO_ON = (Qt.Key.Key_Return, Qt.Key.Key_Enter)
RESET = Qt.Key.Key_Backspace
TAKEN = {*BUTTON_KEYS, *ARROWS, *GO_ON, RESET}
"""Keys that mean something to the game, and so nothing else while its picture has the focus."""


class Held:
    """Buttons that are down. A key and a mouse button may hold the same one: it is up when both are."""

    def __init__(self) -> None:
        self._holders: dict[str, set[object]] = {}

    def down(self, button: str, holder: object) -> bool:
        """Whether this brings the button down."""
        holders = self._holders.setdefault(button, set())
        holders.add(holder)
        return len(holders) == 1

    def up(self, button: str, holder: object) -> bool:
        """Whether this brings the button up."""
        holders = self._holders.get(button, set())
        known = holder in holders
        holders.discard(holder)
        return known and not holders

    def drop(self) -> list[str]:
        """The buttons that were down; none is any more."""
        down = [button for button, holders in self._holders.items() if holders]
        self._holders.clear()
        return down


def hint_words(control: Control, hand: bool) -> str:
    """The keys in one line, which may be broken only between them."""
    rows = key_words(control, hand)
    return "    ".join(f"{keys}: {what}".replace(" ", NO_BREAK) for keys, what in rows if keys != "mouse")


def key_words(control: Control, hand: bool) -> tuple[tuple[str, str], ...]:
    """(keys, what they do) for these settings; ``hand``: the virtual board is turned with the mouse."""
    if control.latch == TOGGLE:
        steer: tuple[tuple[str, str], ...] = (
            ("Space, short", "pan; again: stop"),
            ("Space, long", "zoom; again: stop"),
        )
        mouse = "turns the board" if hand else "left: pan, right: zoom; again: stop"
    else:
        steer = (("hold Space", "pan"), ("hold Z", "zoom"))
        mouse = "drag left: pan, right: zoom" if hand else "hold left: pan, right: zoom"
    turn = (("arrows", "turn the virtual board"),) if hand else ()
    return (*steer, ("mouse", mouse), *turn, ("Enter", "select, confirm"), ("Esc", "emergency stop"))
