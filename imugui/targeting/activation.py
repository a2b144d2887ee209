"""Who wants to steer, and how: the board's status byte, and buttons or keys that are pressed and released."""

from __future__ import annotations

from typing import NamedTuple

from imugui.samples import NO_STATUS
from imugui.targeting.settings import TOGGLE, Control
from imugui.targeting.view_pose import PAN, ZOOM

SHORT_S = 0.5
"""A shorter press pans, a longer one zooms (seed 004)."""

CLUTCH = "clutch"
BUTTONS = {"": PAN, PAN: PAN, ZOOM: ZOOM}
"""What a button steers. The plain button, "", pans when held to run; latched, the length of the press decides."""

STATUS_MODES = {1: PAN, 2: ZOOM}
"""What the board's status byte asks for; any other value asks for nothing, and NO_STATUS says nothing."""

BOARD = "board"
"""The owner of an activation that the status byte began."""


class Input(NamedTuple):
    """What a person did. Kinds and values:

    "press", "release": a button, "" (the plain one), "pan", "zoom" or "clutch"; "stop": the emergency stop;
    "reset", then "confirm": out of it again; "confirm": arm; "disarm"; "stale": see ``Controller.tick``.
    """

    kind: str
    value: str = ""


class Command(NamedTuple):
    """An event for the table of states, or "jolt": the board's button moved."""

    event: str
    mode: str
    cause: str


class Activation:
    """Turns button edges into commands. Its owner, the button that engaged, is who releases."""

    def __init__(self, control: Control) -> None:
        self._toggle = control.latch == TOGGLE
        self._timeout_s = control.latch_timeout_s
        self._status = NO_STATUS
        self._down: set[str] = set()
        self._owner: str | None = None
        self._latched_t: float | None = None
        self._pressed_t: float | None = None  # of the plain button, while short or long is not yet known

    def drop(self) -> None:
        """The activation has ended for another reason: whoever still holds a button must press it again."""
        self._owner = self._latched_t = self._pressed_t = None

    def take_status(self, t: float, status: int) -> list[Command]:
        """The status byte at t in s; only its edges count, and the first one seen is no edge."""
        before, self._status = self._status, self._status if status == NO_STATUS else status
        if before in (NO_STATUS, self._status):
            return []
        cause, mode = f"board status {before} to {status}", STATUS_MODES.get(status, "")
        commands = [Command("jolt", "", cause)]
        if self._owner == BOARD or (self._owner is None and not mode):
            self.drop()
            commands.append(Command("release", "", cause))
        if mode and self._owner is None:
            commands.append(self._engage(t, BOARD, mode, cause, latched=True))
        return commands

    def take(self, t: float, item: Input) -> list[Command]:
        """A "press" or "release" at t in s; any other input is none of its business."""
        if item.kind == "press":
            return self._press(t, item.value)
        return self._release(t, item.value) if item.kind == "release" else []

    def elapse(self, t: float) -> list[Command]:
        """What the time t in s alone brings: a press has become a long one, a latch has been on for too long."""
        if self._pressed_t is not None and t - self._pressed_t >= SHORT_S:
            return [self._by_length(t)]
        if self._latched_t is not None and t - self._latched_t >= self._timeout_s:
            self.drop()
            return [Command("release", "", f"latched for {self._timeout_s:g} s")]
        return []

    def _press(self, t: float, button: str) -> list[Command]:
        """A button goes down; one that is down already repeats itself, which means nothing."""
        if button in self._down or button not in (*BUTTONS, CLUTCH):
            return []
        self._down.add(button)
        cause = f"{button} button pressed".strip()
        if button == CLUTCH:
            return [Command("clutch", "", cause)]
        if self._owner is not None:
            if not self._toggle:
                return []
            self.drop()
            return [Command("release", "", cause)]
        if self._toggle and button == "":
            self._pressed_t = t
            return []
        return [self._engage(t, button, BUTTONS[button], cause, latched=self._toggle)]

    def _release(self, t: float, button: str) -> list[Command]:
        """A button goes up."""
        if button not in self._down:
            return []
        self._down.discard(button)
        cause = f"{button} button released".strip()
        if button == CLUTCH:
            return [Command("unclutch", "", cause)]
        if button == "" and self._pressed_t is not None:
            return [self._by_length(t)]
        if self._owner is not None and (self._toggle or self._owner != button):
            return []
        self.drop()
        return [Command("release", "", cause)]

    def _by_length(self, t: float) -> Command:
        """Engage as the length of the press says, at the release or as soon as it is a long one."""
        long = self._pressed_t is not None and t - self._pressed_t >= SHORT_S
        mode, cause = (ZOOM, "long press") if long else (PAN, "short press")
        return self._engage(t, "", mode, cause, latched=True)

    def _engage(self, t: float, owner: str, mode: str, cause: str, latched: bool) -> Command:
        self._owner, self._latched_t, self._pressed_t = owner, t if latched else None, None
        return Command("press", mode, cause)
