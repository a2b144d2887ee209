"""The states of the controller, as a table; every transition is logged with its cause.

Modelled on the da Vinci research kit's teleoperation (E.1 of the reference notes).
"""

from __future__ import annotations

import enum
from typing import NamedTuple


class State(enum.Enum):
    """(word on screen, tone of it, what it means and what to do)."""

    DISARMED = ("Disarmed", "neutral", "The view does not follow. Confirm to arm the controller.")
    READY = ("Ready", "neutral", "Press a button to steer.")
    ALIGNING = ("Aligning", "neutral", "Waiting until the button's jolt has passed.")
    ENGAGED = ("Steering", "good", "The view follows the hand.")
    CLUTCHED = ("Clutched", "neutral", "The view waits while the hand goes back.")
    HOLD = ("Hold", "warn", "The input failed: the view stays. Let go and press again.")
    FAULT = ("Stopped", "bad", "Emergency stop. Reset, then confirm.")

    @property
    def word(self) -> str:
        """For the screen."""
        return self.value[0]

    @property
    def tone(self) -> str:
        """ "neutral", "good", "warn" or "bad"."""
        return self.value[1]

    @property
    def sentence(self) -> str:
        """What it means and what to do next."""
        return self.value[2]


ACTIVE = frozenset({State.ALIGNING, State.ENGAGED, State.CLUTCHED})
"""The states within an activation."""


class Transition(NamedTuple):
    """One line of the log; ``source`` equals ``target`` for what was refused."""

    t: float  # s, sample time
    source: State
    target: State
    cause: str
    mode: str  # of the activation: "pan", "zoom" or ""


_ENDS = {"release": State.READY, "lost": State.HOLD, "disarm": State.DISARMED, "stop": State.FAULT}

TABLE: dict[State, dict[str, State]] = {
    State.DISARMED: {"confirm": State.READY, "stop": State.FAULT},
    State.READY: {"press": State.ALIGNING, "disarm": State.DISARMED, "stop": State.FAULT},
    State.ALIGNING: {**_ENDS, "aligned": State.ENGAGED, "clutch": State.CLUTCHED},
    State.ENGAGED: {**_ENDS, "clutch": State.CLUTCHED},
    State.CLUTCHED: {**_ENDS, "unclutch": State.ALIGNING},
    State.HOLD: {**_ENDS, "press": State.ALIGNING},
    State.FAULT: {"reset": State.DISARMED},  # the second step is the "confirm" there
}
"""What each event leads to; any other event changes nothing."""


class Machine:
    """Where the controller is, and how it came there."""

    def __init__(self) -> None:
        self.state = State.DISARMED
        self.log: list[Transition] = []

    def fire(self, event: str, t: float, cause: str, mode: str) -> bool:
        """Go where the table says and log it; False when the event means nothing here."""
        target = TABLE[self.state].get(event, self.state)
        if target is self.state:
            return False
        self.note(t, target, cause, mode)
        self.state = target
        return True

    def note(self, t: float, target: State, cause: str, mode: str) -> None:
        """Log a step to ``target`` at t in s, or what was refused."""
        self.log.append(Transition(t, self.state, target, cause, mode))
