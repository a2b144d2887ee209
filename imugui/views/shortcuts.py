"""The keyboard: one table of what each key does, used by the window and shown on the Settings page."""

from __future__ import annotations

from dataclasses import dataclass

from PySide6.QtCore import Qt
from PySide6.QtGui import QKeySequence


@dataclass(frozen=True)
class Key:
    """``action`` is a method of MainWindow, of the page in front for ``page`` keys, of the replay bar for ``spare``.

    Spare keys are taken only where the widget in focus has no use for them: Space presses a button, arrows move.
    """

    keys: str  # as QKeySequence reads it
    action: str
    words: str
    page: bool = False
    spare: bool = False


KEYS = (
    Key("Ctrl+K", "toggle_connection", "Connect or disconnect"),
    Key("Ctrl+O", "open_recording", "Open a recording"),
    Key("O", "set_origin", "Set the origin: the board as it is held now becomes zero"),
    Key("Shift+O", "clear_origin", "Clear the origin"),
    Key("R", "toggle_recording", "Start or stop recording"),
    Key("M", "mark", "Put a marker into the recording"),
    Key("X", "view_from_x", "Look along the x axis", page=True),
    Key("Y", "view_from_y", "Look along the y axis", page=True),
    Key("Z", "view_from_z", "Look along the z axis", page=True),
    Key("H", "view_default", "Look from the usual place", page=True),
    Key("P", "toggle_pause", "Signals: pause or resume", page=True),
    Key("S", "toggle_spectrum", "Signals: spectrum or time", page=True),
    Key("F", "fit_scales", "Signals: fit the scales to the data", page=True),
    Key("K", "toggle_spike_mask", "Signals: mask the spikes of the board's button, or not", page=True),
    Key("Ctrl+E", "export_data", "Signals: export the data on screen", page=True),
    Key("Ctrl+Shift+C", "copy_picture", "Signals: copy the plots as a picture", page=True),
    Key("T", "take", "Guide: take the reading, or the pose; in the target also Space", page=True),
    Key("N", "next_plan", "Guide: the next trajectory", page=True),
    Key("Shift+N", "previous_plan", "Guide: the trajectory before", page=True),
    Key("G", "register", "Guide: register again", page=True),
    Key("Space", "toggle_playing", "Replay: play or pause", spare=True),
    Key("Left", "skip_back", "Replay: 5 s back", spare=True),
    Key("Right", "skip_on", "Replay: 5 s on", spare=True),
    Key("Home", "to_start", "Replay: to the beginning", spare=True),
    Key("End", "to_end", "Replay: to the end", spare=True),
    Key("<", "slower", "Replay: slower", spare=True),
    Key(">", "faster", "Replay: faster", spare=True),
    Key("C", "show_compare", "Replay: compare filters"),
    Key("L", "show_link_log", "Open the link log"),
    Key("Esc", "dismiss_message", "Dismiss the message; while a run of the game is on: emergency stop"),
    Key("F11", "toggle_full_screen", "Full screen on or off"),
    Key("Ctrl+Q", "close", "Quit"),
)

PLOT_KEYS = (
    Key("Space", "toggle_pause", "In the plots: pause or resume"),
    Key("+", "zoom_out", "In the plots: a longer window"),
    Key("-", "zoom_in", "In the plots: a shorter window"),
    Key("A", "cursor_a", "In the plots, paused: take cursor A"),
    Key("B", "cursor_b", "In the plots, paused: take cursor B"),
    Key("Left", "step_back", "In the plots, paused: the cursor one sample back, with Shift ten"),
    Key("Right", "step_on", "In the plots, paused: the cursor one sample on, with Shift ten"),
    Key("PgUp", "page_back", "In the plots: half a window back"),
    Key("PgDown", "page_on", "In the plots: half a window on"),
)
"""Keys that the plots of the Signals page take themselves, while they have the focus."""


GAME_KEYS = (
    Key("Space", "pan", "In the game: pan while held; with latching buttons short: pan, long: zoom, again: stop"),
    Key("Z", "zoom", "In the game: zoom while held"),
    Key("X", "clutch", "In the game: the view waits while held"),
    Key("Return", "go_on", "In the game: start, select, confirm"),
    Key("Backspace", "reset", "In the game: the first step out of an emergency stop"),
)
"""Keys that the picture of the Target page takes itself, while it has the focus."""


def spare_key(code: int, modifiers: Qt.KeyboardModifier) -> Key | None:
    """The spare key with this code of Qt's; Shift and the number pad make no difference."""
    if modifiers & ~(Qt.KeyboardModifier.ShiftModifier | Qt.KeyboardModifier.KeypadModifier):
        return None
    return next((key for key in KEYS if key.spare and QKeySequence(key.keys) == QKeySequence(code)), None)


def tip(action: str, words: str) -> str:
    """A tooltip that names the key of ``action`` behind ``words``."""
    keys = next((key.keys for key in KEYS + PLOT_KEYS if key.action == action), "")
    return f"{words} ({keys})" if keys else words
