"""The keyboard: one table of what each key does, used by the window and shown on the Settings page."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Key:
    """``action`` is a method of MainWindow, or of the page in front for those marked ``page``."""

    keys: str  # as QKeySequence reads it
    action: str
    words: str
    page: bool = False


KEYS = (
    Key("Ctrl+K", "toggle_connection", "Connect or disconnect"),
    Key("Ctrl+O", "open_recording", "Open a recording"),
    Key("O", "set_origin", "Set the origin: the board as it is held now becomes zero"),
    Key("Shift+O", "clear_origin", "Clear the origin"),
    Key("X", "view_from_x", "Look along the x axis", page=True),
    Key("Y", "view_from_y", "Look along the y axis", page=True),
    Key("Z", "view_from_z", "Look along the z axis", page=True),
    Key("H", "view_default", "Look from the usual place", page=True),
    Key("L", "show_link_log", "Open the link log"),
    Key("Esc", "dismiss_message", "Dismiss the message"),
    Key("F11", "toggle_full_screen", "Full screen on or off"),
    Key("Ctrl+Q", "close", "Quit"),
)


def tip(action: str, words: str) -> str:
    """A tooltip that names the key of ``action`` behind ``words``."""
    keys = next((key.keys for key in KEYS if key.action == action), "")
    return f"{words} ({keys})" if keys else words
