"""The controller: how the input flows from a row to the view.

1. ``Validity`` measures dt and looks at the row. A useless one, or one that came too late, ends in HOLD.
2. ``Activation`` turns status edges and buttons into commands; ``Machine`` obeys those that its table knows.
3. A press leads to ALIGNING. For ``mask_s`` the gyroscope alone carries the attitude, as the button jolts the board.
4. Then ENGAGED, with a new ``Engagement``: attitude and place are captured, nothing old is left to move the view.
5. From then on each row: turn since engaging (rotation vector, body axes) -> view axes -> 1-euro -> dead time ->
   mapping (ramp, curve, gain, limits, lag) -> view.

In every other state the view stays exactly where it is. All is a function of the rows and of the inputs that came
with them: the same again gives the same views and the same log, bit for bit. Hand over plain floats, not numpy's.
"""

from __future__ import annotations

from collections.abc import Iterable
from math import hypot, isfinite

from imugui.fusion.scalar import NOTHING, Quat, Vector, turned_in_sensor
from imugui.targeting.activation import Activation, Command, Input
from imugui.targeting.engagement import NO_STAGES, Engagement, Stages
from imugui.targeting.settings import Control
from imugui.targeting.states import ACTIVE, Machine, State, Transition
from imugui.targeting.validity import Validity
from imugui.targeting.view_pose import View

LEVEL: Quat = (1.0, 0.0, 0.0, 0.0)
STOP, STALE = "stop", "stale"

CAUSES = {"confirm": "confirmed", "reset": "reset", "disarm": "disarmed", STOP: "emergency stop"}
"""The inputs that are events of the table by themselves, and the cause to log."""


class Controller:
    """Steers the view with the board, one row at a time. It begins disarmed: ``Input("confirm")`` arms it."""

    def __init__(self, control: Control, view: View) -> None:
        self.control = control
        self._view = view
        self._validity = Validity(control)
        self._activation = Activation(control)
        self._machine = Machine()
        self._engagement: Engagement | None = None
        self._mode = ""
        self._valid = False
        self._now = 0.0  # s, of the last row that had a time
        self._masked_until = 0.0  # s
        self._quat = LEVEL

    @property
    def view(self) -> View:
        """Where the field of view is, px."""
        return self._view

    @property
    def state(self) -> State:
        """Where the controller is in its table of states."""
        return self._machine.state

    @property
    def mode(self) -> str:
        """What the activation steers: "pan" or "zoom"; "" outside an activation."""
        return self._mode

    @property
    def log(self) -> list[Transition]:
        """Every transition, and every press that was refused, with its cause."""
        return self._machine.log

    @property
    def displacement_deg(self) -> Vector:
        """The rotation vector since engaging, (3,) deg, in the axes the board had then; zeros unless engaged."""
        return self._engagement.turn if self._engagement else NOTHING

    @property
    def stages(self) -> Stages:
        """What the newest row became on its way through the chain; zeros unless engaged."""
        return self._engagement.stages if self._engagement else NO_STAGES

    @property
    def valid(self) -> bool:
        """Whether the newest row was good and is not stale."""
        return self._valid

    def step(self, t: float, quat: Quat, gyr: Vector, status: int, inputs: Iterable[Input] = ()) -> View:
        """Take one row and what the person did since the row before; the new view.

        ``t`` in s, sample time; ``quat`` sensor -> earth; ``gyr`` (3,) rad/s, NaN without a gyroscope; ``status``
        the board's status byte. What makes the view stop acts first, and is logged at the time of the row before.
        """
        inputs = tuple(inputs)
        self._stop_first(inputs)
        reason = self._validity.look(t, quat, gyr)
        self._valid = not reason
        if reason:
            self._lose(reason)
        if isfinite(t):
            self._now = t
        self._take(status, inputs)
        if not reason:
            self._follow(quat, gyr)
            self._move()
        return self._view

    def tick(self, age_s: float, inputs: Iterable[Input] = ()) -> tuple[Input, ...]:
        """Between rows: stop at once when asked to, and hold when the last row was stepped ``age_s`` s ago.

        Call it before a backlog is stepped, too. Returns the inputs to hand to the next ``step``: all those given,
        and "stale" when the input just became it. Recorded with that row they make a replay come out the same.
        """
        inputs = tuple(inputs)
        if self._valid and age_s > self._validity.limit_s:
            inputs = (*inputs, Input(STALE))
        self._stop_first(inputs)
        return inputs

    def place(self, view: View) -> None:
        """Put the view somewhere else, between runs; an activation ends."""
        if self.state in ACTIVE:
            self._fire("release", "view placed")
        self._view = view

    def _stop_first(self, inputs: tuple[Input, ...]) -> None:
        """What must not wait for the next row, nor for the inputs before it."""
        for item in inputs:
            if item.kind == STALE:
                self._valid = False
                self._lose(self._validity.stale_words)
            elif item.kind == STOP:
                self._fire(STOP, CAUSES[STOP])

    def _take(self, status: int, inputs: tuple[Input, ...]) -> None:
        """Status byte, inputs in their order, and what time brings."""
        t, activation = self._now, self._activation
        self._obey(activation.take_status(t, status))
        for item in inputs:
            if item.kind in CAUSES:
                self._fire(item.kind, CAUSES[item.kind])
            elif item.kind == STALE:
                self._lose(self._validity.stale_words)  # once more: a press before it counts no longer
            else:
                self._obey(activation.take(t, item))
        self._obey(activation.elapse(t))

    def _obey(self, commands: list[Command]) -> None:
        for event, mode, cause in commands:
            if event == "press":
                self._press(mode, cause)
            elif event == "jolt":
                self._mask()
            else:
                self._fire(event, cause)

    def _press(self, mode: str, cause: str) -> None:
        """Begin an activation, or log why not."""
        machine = self._machine
        if self._valid and machine.fire("press", self._now, cause, mode):
            self._mode = mode
            self._mask()
            return
        why = machine.state.word.lower() if self._valid else "the input is not valid"
        machine.note(self._now, machine.state, f"{cause}: refused, {why}", mode)
        self._activation.drop()

    def _fire(self, event: str, cause: str) -> None:
        """Tell the machine. No transition leaves an engagement behind; ``_capture`` makes a new one."""
        if not self._machine.fire(event, self._now, cause, self._mode):
            return
        self._engagement = None
        if self.state is State.ALIGNING:
            self._mask()
        elif self.state not in ACTIVE:
            self._mode = ""
            self._activation.drop()

    def _lose(self, reason: str) -> None:
        """The input is not valid: hold, and forget what was pressed before."""
        self._fire("lost", reason)
        self._activation.drop()

    def _mask(self) -> None:
        self._masked_until = self._now + self.control.mask_s

    def _follow(self, quat: Quat, gyr: Vector) -> None:
        """The attitude to steer with: while masked, the last one turned on by the gyroscope."""
        if self._now < self._masked_until:
            dt = self._validity.dt
            self._quat = turned_in_sensor(self._quat, gyr[0] * dt, gyr[1] * dt, gyr[2] * dt)
        else:
            self._quat = quat

    def _move(self) -> None:
        if self._engagement:
            self._steer(self._engagement)
        elif self.state is State.ALIGNING and self._now >= self._masked_until:
            self._capture()

    def _capture(self) -> None:
        """Engage: this attitude is the origin, this place the base."""
        mode = self._mode
        self._fire("aligned", f"reference taken {1000.0 * self.control.mask_s:g} ms after the button")
        self._engagement = Engagement(self.control, mode, self._now, self._quat, self._view.part(mode))

    def _steer(self, engagement: Engagement) -> None:
        farthest, dt = self.control.disengage_deg, self._validity.dt
        if hypot(*engagement.look(self._quat)) > farthest:
            self._fire("release", f"turned by more than {farthest:g}°")
        elif dt > 0.0:
            self._view = self._view.moved(self._mode, engagement.step(self._now, dt))
