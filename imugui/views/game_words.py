"""What the game's picture says, as words: state, count, time, and the plate over it while it does not go on."""

from __future__ import annotations

from typing import NamedTuple

from imugui.targeting.game_look import DONE, GameLook
from imugui.targeting.states import State
from imugui.views import theme


class Plate(NamedTuple):
    """A plate over the picture: tone "neutral", "good", "warn" or "bad", a large word, sentences below each other."""

    tone: str
    title: str
    lines: tuple[str, ...] = ()


SQUARES = "Bring the blue view onto the red target: first the place, then the size."
CIRCLES = "Bring the blue cross into the red circle."


def state_words(look: GameLook) -> str:
    """The state as shape and word."""
    return f"{theme.tone_glyph(look.tone)} {look.phase_word}"


def count_words(look: GameLook) -> str:
    """Which target this is."""
    if look.phase == DONE:
        return f"{look.index} of {look.total} targets"
    if look.target.start:
        return "First target: starts the clock"
    return f"Target {min(look.index + 1, look.total)} of {look.total}"


def match_words(look: GameLook) -> tuple[tuple[str, bool], ...]:
    """What has to match, and whether it does."""
    if look.phase == DONE:
        return ()
    return (("place", look.position_ok), ("size", look.size_ok))[: 2 if look.task.sized else 1]


def plate(look: GameLook) -> Plate | None:
    """The plate of a phase that stops the play; None while it goes on."""
    if look.phase == DONE:
        missed = f", {look.errors} missed" if look.errors else ""
        return Plate("good", "Done", (f"{look.total} targets in {look.elapsed_s:.1f} s{missed}.", "Enter: go on"))
    if look.state is State.FAULT:
        return Plate("bad", "Stopped", ("Emergency stop.", "1. Reset: Backspace", "2. Confirm: Enter"))
    if look.state is State.DISARMED:
        after = look.reason not in ("", "confirmed")
        return Plate("neutral", "Not armed", ("Confirm to go on: Enter" if after else "Confirm to begin: Enter",))
    if look.state is State.HOLD:
        why = f"{look.reason[:1].upper()}{look.reason[1:]}." if look.reason else "The input failed."
        return Plate("warn", "Hold", (why, "The view stays. Let go, then press again."))
    return None


def spoken(look: GameLook) -> str:
    """The whole picture in words, for screen readers."""
    return f"{look.phase_word}. {count_words(look)}. {look.to_do} {look.message}".strip()
