"""The game: rows and inputs in, trials out. What counts, and when.

* The clock of the game starts with the first activation, that of a ring with the selection of its first target. The
  time of a target runs from the selection of the one before to its own.
* Time is that of the samples. Should it ever go back, the game's clock stands still and goes on from there.
* An activation counts where it begins, its largest rotation where it ends; one that is still on at the end of a
  sequence ends there.
* A clutch is an activation of the same mode as the one before it on the way to the same target, or a press of the
  clutch button.
* In the game place (x and y) and size must be within the tolerance at once; in the ring the centre of the view must be
  within the circle.

Everything is a function of the rows and of the inputs that came with them: the same again gives the same trials, bit
for bit. Hand over plain floats, not numpy's.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import hypot, isfinite, nan

from imugui.fusion.scalar import Quat, Vector
from imugui.samples import NO_STATUS
from imugui.targeting.activation import STATUS_MODES, Input
from imugui.targeting.controller import Controller
from imugui.targeting.game_look import LEFT_ON, READY, WAITING, GameLook, message_of, phase_of, to_do
from imugui.targeting.settings import Control
from imugui.targeting.states import ACTIVE, State, Transition
from imugui.targeting.tally import Labels, Tally
from imugui.targeting.tasks import AUTO, BUTTON, Target, Task, matches
from imugui.targeting.trials import Trial

SELECT = "select"
"""The kind of input that selects, where a button does; the controller passes it over."""

STEERING = frozenset({State.ALIGNING, State.ENGAGED})


class Game:
    """One run. It owns its controller, which begins disarmed: hand ``Input("confirm")`` to ``step`` to arm it.

    Raises ValueError without targets.
    """

    def __init__(self, task: Task, control: Control, targets: Sequence[Target], labels: Labels | None = None) -> None:
        if not targets:
            raise ValueError("a run needs a target")
        self.task, self.labels, self.targets = task, labels or Labels(), tuple(targets)
        self.controller = Controller(control, task.start_view)
        self.trials: list[Trial] = []
        self.message = ""  # why something was not done, for the screen
        self._place = 0  # of the target to hit, in targets
        self._tally: Tally | None = None  # None while no clock runs
        self._now = nan  # s
        self._shift = 0.0  # s, by which time has gone back so far
        self._started = nan  # s
        self._matched_since = nan  # s
        self._status = NO_STATUS  # of the board
        self._steered = ""  # what was steered until this row
        self._largest = nan  # deg, largest rotation of the activation that is on; NaN without one
        self._lines = 0  # of the controller's log that were read

    @property
    def done(self) -> bool:
        """Whether every target has been selected."""
        return self._place >= len(self.targets)

    @property
    def matched(self) -> tuple[bool, bool]:
        """Whether the place of the view matches, and its size."""
        return matches(self.task, self.target, self.controller.view)

    def step(self, t: float, quat: Quat, gyr: Vector, status: int, inputs: Iterable[Input] = ()) -> tuple[Trial, ...]:
        """Take one row and what the person did since the row before; the trials that it ended, mostly none.

        The arguments are those of ``Controller.step``; one more kind of input, "select", selects.
        """
        if self.done:
            return ()
        inputs = tuple(inputs)
        controller, before, count = self.controller, self.controller.view, len(self.trials)
        view = controller.step(t, quat, gyr, status, inputs)
        self._pass_time(t)
        if len(controller.log) != self._lines:
            self._read_log()
        if self._tally and view != before:
            self._tally.moved(before, view)
        if controller.state is State.ENGAGED:
            self._turned(controller.displacement_deg)
        if self._selected(inputs):
            self._next_target()
        if self.done:
            controller.step(t, quat, gyr, status, (Input("disarm"),))
        self._status = status
        self._steered = controller.mode if controller.state in STEERING else ""
        return tuple(self.trials[count:])

    def tick(self, age_s: float, inputs: Iterable[Input] = ()) -> tuple[Input, ...]:
        """Between rows, as ``Controller.tick``: returns what to hand to the next ``step``, and to record with it."""
        return tuple(inputs) if self.done else self.controller.tick(age_s, inputs)

    def look(self) -> GameLook:
        """Everything a screen shows, now."""
        task, controller, target = self.task, self.controller, self.target
        following = self.targets[self._place + 1] if self._place + 1 < len(self.targets) else None
        total = sum(not one.start for one in self.targets)
        phase = phase_of(controller.state, controller.mode, self.done, self._tally is not None)
        ok, left_on = self.matched, self._status in STATUS_MODES
        return GameLook(
            task=task,
            labels=self.labels,
            view=controller.view,
            target=target,
            following=following if following and following.sequence == target.sequence else None,
            ring=() if task.sized else tuple(one for one in self.targets if one.sequence == target.sequence)[1:],
            state=controller.state,
            mode=controller.mode,
            phase=phase,
            to_do=LEFT_ON if left_on and phase in (READY, WAITING) else to_do(task, phase, controller.view, target, ok),
            reason=self._reason(),
            message=self.message,
            position_ok=ok[0],
            size_ok=ok[1],
            dwell=self._dwell(),
            index=len(self.trials),
            total=total,
            remaining=total - len(self.trials),
            elapsed_s=self._now - self._started if self._started == self._started else 0.0,
            target_s=self._now - self._tally.t_start if self._tally else 0.0,
            last=self.trials[-1] if self.trials else None,
            errors=sum(trial.error for trial in self.trials),
            valid=controller.valid,
            displacement_deg=controller.displacement_deg,
        )

    @property
    def target(self) -> Target:
        """The one to hit; the last one when all are done."""
        return self.targets[min(self._place, len(self.targets) - 1)]

    def _reason(self) -> str:
        """Why the controller is where it is, when it does not steer."""
        log = self.controller.log
        return log[-1].cause if log and self.controller.state not in (*ACTIVE, State.READY) else ""

    def _dwell(self) -> float:
        """The part of the dwell that has passed, 0 to 1."""
        since = self._matched_since
        return min((self._now - since) / self.task.dwell_s, 1.0) if since == since else 0.0

    def _pass_time(self, t: float) -> None:
        """Go on to the row at t (s); the time since the row before belongs to what was steered until now."""
        if not isfinite(t):
            return
        now, last = t + self._shift, self._now
        if now < last:
            self._shift += last - now
            now = last
        self._now = now
        if self._tally:
            self._tally.times[self._steered] += now - last

    def _read_log(self) -> None:
        """Look through what the controller has logged since the row before."""
        log = self.controller.log
        for line in log[self._lines :]:
            self._read(line)
        self._lines = len(log)

    def _read(self, line: Transition) -> None:
        self.message = message_of(line)
        if line.target is State.ALIGNING and line.source not in ACTIVE:
            self._largest = 0.0
            if not self._tally and self.task.sized:
                self._start_clock()
            if self._tally:
                self._tally.press(line.mode)
        elif line.target is State.CLUTCHED and self._tally:
            self._tally.clutches += line.source is not State.CLUTCHED
        elif line.source in ACTIVE and line.target not in ACTIVE:
            self._end_activation()

    def _start_clock(self, mode: str = "") -> None:
        """The way to the target that is next begins now, while ``mode`` is steered already."""
        self._tally = Tally(self.task, self.target, self.controller.view, self._now, mode)
        if self._started != self._started:
            self._started = self._now

    def _end_activation(self) -> None:
        if self._tally and self._largest == self._largest:
            self._tally.rotations.append(self._largest)
        self._largest = nan

    def _turned(self, turn: Vector) -> None:
        self._largest = max(self._largest, hypot(*turn))
        if self._tally:
            self._tally.turned(turn)

    def _selected(self, inputs: tuple[Input, ...]) -> bool:
        """Whether this row selects the target."""
        selection, matched = self.task.selection, all(self.matched)
        if not (self._tally or self.target.start):
            return False
        if selection == BUTTON:
            return any(item.kind == SELECT for item in inputs) and self._may_select(matched)
        if not matched or not self.controller.valid:
            self._matched_since = nan
            return False
        if selection == AUTO:
            return True
        if self._matched_since != self._matched_since:
            self._matched_since = self._now
        return self._now - self._matched_since >= self.task.dwell_s

    def _may_select(self, matched: bool) -> bool:
        """Whether the button counts; else the message says why not."""
        state = self.controller.state
        if not self.controller.valid or state in (State.HOLD, State.FAULT, State.DISARMED):
            self.message = f"Not selected: {state.word.lower()}."
        elif self.target.start and not matched:
            self.message = "Missed. The first target starts the clock: hit it."
        else:
            return True
        return False

    def _next_target(self) -> None:
        """This target has been selected; the next one appears."""
        place, first = self._place, self.target.start
        self._place += 1
        self._matched_since, self.message = nan, ""
        if self._tally and not first:
            if self.done or self.target.start:
                self._end_activation()
            start = self.targets[place - 1] if place else self.task.start_view
            trial = self._tally.trial(self.labels, len(self.trials), start, self.controller.view, self._now)
            self.trials.append(trial)
        self._tally = None
        mode = self.controller.mode
        if not (self.done or self.target.start):
            self._start_clock("" if first else mode)
        if first and self._tally and mode:
            self._tally.press(mode)
            self._largest = hypot(*self.controller.displacement_deg)
