"""GameLook: everything a painter and a panel need to show a run, as one snapshot; and the words on it."""

from __future__ import annotations

from dataclasses import dataclass

from imugui.fusion.scalar import Vector
from imugui.targeting.states import State, Transition
from imugui.targeting.tally import Labels
from imugui.targeting.tasks import AUTO, DWELL, Target, Task
from imugui.targeting.trials import Trial
from imugui.targeting.view_pose import PAN, ZOOM, View

READY, WAITING, DONE = "ready", "waiting", "done"

PHASES: dict[str, tuple[str, str]] = {
    "disarmed": ("Not armed", "neutral"),
    READY: ("Ready", "neutral"),
    WAITING: ("Not steering", "neutral"),
    PAN: ("Panning", "good"),
    ZOOM: ("Zooming", "good"),
    "clutched": ("Clutched", "neutral"),
    "held": ("Hold", "warn"),
    "stopped": ("Stopped", "bad"),
    DONE: ("Done", "good"),
}
"""A phase -> its word and tone on screen."""

OF_STATES = {
    State.DISARMED: "disarmed",
    State.CLUTCHED: "clutched",
    State.HOLD: "held",
    State.FAULT: "stopped",
}

LEFT_ON = "The board's button is still on: press it once, then again to steer."

BEFORE = {PAN: "Stop panning, then", ZOOM: "Stop zooming, then", "clutched": "Let the clutch go to"}
"""What has to be done before the other mode is steered; else a button is to be pressed."""

SELECTING = {AUTO: "It matches.", DWELL: "It matches: hold still."}
"""What to do when all matches, by selection; else the button is to be used."""


@dataclass(frozen=True)
class GameLook:
    """A run as it stands after a row; lengths in px of the 600 px field, origin at its centre, x right, y up."""

    task: Task
    labels: Labels
    view: View
    target: Target
    following: Target | None  # the target after it, of the same sequence
    ring: tuple[Target, ...]  # every circle of the sequence, each once; empty in the game
    state: State
    mode: str  # "pan", "zoom" or ""
    phase: str  # a key of PHASES
    to_do: str  # one sentence
    reason: str  # why it is held, stopped or disarmed; else ""
    message: str  # why the last press or selection was refused; else ""
    position_ok: bool
    size_ok: bool
    dwell: float  # part of the dwell that has passed, 0 to 1
    index: int  # targets selected so far
    total: int  # targets in the run
    remaining: int
    elapsed_s: float  # sample time since the clock started
    target_s: float  # the same for this target
    last: Trial | None  # the target before
    errors: int
    valid: bool  # the newest row was good and is not stale
    displacement_deg: Vector  # the hand's turn since engaging

    @property
    def phase_word(self) -> str:
        """For the screen."""
        return PHASES[self.phase][0]

    @property
    def tone(self) -> str:
        """ "neutral", "good", "warn" or "bad"."""
        return PHASES[self.phase][1]

    @property
    def practice(self) -> bool:
        """This run does not count."""
        return self.labels.practice

    @property
    def matched(self) -> bool:
        """Place and size match."""
        return self.position_ok and self.size_ok

    @property
    def tolerance_px(self) -> float:
        """How far the view may be off: of place and size, or the radius of the circle."""
        return 0.5 * self.task.width(self.target)

    @property
    def last_missed(self) -> bool:
        """The target before was selected without a match."""
        return self.last is not None and self.last.error


def phase_of(state: State, mode: str, done: bool, running: bool) -> str:
    """The phase of a run; ``running``: its clock runs."""
    if done:
        return DONE
    if state in OF_STATES:
        return OF_STATES[state]
    return mode or (WAITING if running else READY)


def to_do(task: Task, phase: str, view: View, target: Target, ok: tuple[bool, bool]) -> str:
    """What the person should do next, in one sentence; ``ok``: place and size match."""
    fixed = {
        DONE: "All targets are done.",
        "disarmed": State.DISARMED.sentence,
        "held": State.HOLD.sentence,
        "stopped": State.FAULT.sentence,
    }
    if phase in fixed:
        return fixed[phase]
    if all(ok):
        return SELECTING.get(task.selection, "It matches: select.")
    need = ZOOM if ok[0] else PAN
    way = bigger(view, target) if need == ZOOM else directions(view, target, 0.5 * task.width(target))
    start = " It starts the clock." if target.start else ""
    if phase == need:
        return f"{way[0].upper()}{way[1:]}.{start}"
    stop = BEFORE.get(phase, "Press to")
    return f"{stop} {need}: {way}.{start}"


def directions(view: View, target: Target, tolerance: float) -> str:
    """Where the target is from the view, in words, like "right and up"."""
    across, up = target.x - view.x, target.y - view.y
    # within a circle's radius of the axes both may be small: then name the larger one
    limit = min(tolerance, 0.99 * max(abs(across), abs(up)))
    words = ["left" if across < 0.0 else "right"] * (abs(across) > limit)
    words += ["down" if up < 0.0 else "up"] * (abs(up) > limit)
    return " and ".join(words) or "hold still"


def bigger(view: View, target: Target) -> str:
    """What is to be done with the size."""
    return "larger" if target.size > view.size else "smaller"


def message_of(line: Transition) -> str:
    """The words for a press that was refused; empty for a transition."""
    return f"{line.cause[0].upper()}{line.cause[1:]}." if line.source is line.target and line.cause else ""
