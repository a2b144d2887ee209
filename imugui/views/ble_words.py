"""Bluetooth boards in words: how strong, how full, what they are. No widget, no colour."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from imugui.workers.session import Sighting

MOST_BARS = 4
WEAK_DBM = -85.0  # below, a link is easily lost
STRENGTHS = ((-60.0, 4, "strong"), (-75.0, 3, "good"), (WEAK_DBM, 2, "weak"), (-math.inf, 1, "very weak"))
"""(from so many dBm on, bars, word)."""
UNKNOWN_SIGNAL = "signal not known"
LOW_PERCENT, EMPTY_PERCENT = 20.0, 10.0
NO_NAME = "(no name)"

SEARCHING = "Searching… Switch the board on; one that is connected elsewhere cannot be seen"


def signal(rssi_dbm: float) -> tuple[int, str]:
    """Bars, 0 to MOST_BARS, and word of a signal; NaN when it is not known."""
    if math.isnan(rssi_dbm):
        return 0, UNKNOWN_SIGNAL
    return next((bars, word) for least, bars, word in STRENGTHS if rssi_dbm >= least)


def minus(text: str) -> str:
    """The text with a true minus sign."""
    return text.replace("-", "−")


def board_words(board: Sighting) -> str:
    """Family, signal and battery of a board in the list."""
    parts = [board.family or "unknown kind", signal_words(board.rssi_dbm)]
    if math.isfinite(board.battery_percent):
        parts.append(f"battery {board.battery_percent:.0f} %")
    return ", ".join(parts)


def signal_words(rssi_dbm: float) -> str:
    """ "signal good, −62 dBm"."""
    _, word = signal(rssi_dbm)
    return word if word == UNKNOWN_SIGNAL else minus(f"signal {word} {rssi_dbm:.0f} dBm")


def in_order(boards: Iterable[Sighting]) -> list[Sighting]:
    """Known boards first, else as they were first seen: a list must not move under the pointer."""
    return sorted(boards, key=lambda board: not board.family)


def show_all_words(hidden: int, show_all: bool) -> str:
    """The entry that shows devices of unknown kind, or hides them again; "" when there are none."""
    if show_all:
        return "Show known boards only"
    devices = "device" if hidden == 1 else "devices"
    return f"Show all: {hidden} more {devices} of unknown kind" if hidden else ""
