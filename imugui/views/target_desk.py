"""TargetDesk: one run at a time, between a page and the session's game worker; no picture of its own."""

from __future__ import annotations

from PySide6.QtCore import QObject, Signal, Slot
from PySide6.QtWidgets import QApplication

from imugui.targeting.game import SELECT, Game
from imugui.targeting.game_look import GameLook
from imugui.targeting.states import State, Transition
from imugui.targeting.tally import Labels
from imugui.targeting.tasks import BUTTON
from imugui.targeting.trials import Trial
from imugui.targeting.view_pose import PAN
from imugui.views.game_hand import turn_rad, viewer
from imugui.workers.session import Session

LOUD = ("held", "stopped")
"""The phases that begin with a beep."""


class TargetDesk(QObject):
    """``pull`` it for every frame. The worker plays on whatever the window does."""

    changed = Signal()
    """A run has begun, or was left."""
    target_done = Signal(object)  # Trial
    run_done = Signal()

    def __init__(self, session: Session) -> None:
        super().__init__()
        self.look: GameLook | None = None
        """The run as it stood at the last ``pull``; None before its first row, and without a run."""
        self.trials: list[Trial] = []
        """Of the run that is played, or was last."""
        self.recorded = False
        """A recording ran when the run began, so that it can be computed again."""
        self.sound = True
        self._session = session
        self._game: Game | None = None
        self._total = 0  # targets that count
        self._connected = False
        self._phase = ""

    @property
    def playing(self) -> bool:
        """Whether a run is on."""
        return self._game is not None and len(self.trials) < self._total

    @property
    def game(self) -> Game | None:
        """The run that is played, or was last; only its settings are for this thread."""
        return self._game

    @property
    def log(self) -> list[Transition]:
        """What the controller did in this run, and why."""
        return list(self._game.controller.log) if self._game is not None else []

    def begin(self, game: Game) -> None:
        """Play this run from the next attitude on; it is armed at once."""
        worker = self._session.game
        if not self._connected:
            self._connected = True
            worker.target_done.connect(self._target_done)
            worker.run_done.connect(self._run_over)
        self._game, self.look, self.trials = game, None, []
        self._total = sum(not target.start for target in game.targets)
        self._phase = ""
        self.recorded = self._session.recording is not None
        worker.play(game)
        worker.hand("confirm")
        self.changed.emit()

    @Slot()
    def leave(self) -> None:
        """The run ends here."""
        if self._game is not None:
            self._session.game.play(None)
        self._game, self.look, self.trials = None, None, []
        self.changed.emit()

    def pull(self) -> GameLook | None:
        """The run as it stands now."""
        game = self._game
        if game is None:
            return None
        look = self._session.game.look
        if look is None or look.labels is not game.labels:  # the worker has not begun yet
            return None
        self.look = look
        if look.phase != self._phase:
            self._phase = look.phase
            if self.sound and look.phase in LOUD:
                QApplication.beep()
        return look

    # what the person does

    @Slot(str)
    def press(self, button: str) -> None:
        """A button goes down."""
        self._hand("press", button)

    @Slot(str)
    def release(self, button: str) -> None:
        """A button comes up."""
        self._hand("release", button)

    @Slot()
    def stop(self) -> None:
        """The emergency stop."""
        self._hand("stop")

    @Slot()
    def reset(self) -> None:
        """The first step out of an emergency stop."""
        self._hand("reset")

    @Slot()
    def confirm(self) -> None:
        """The second one; also arms after ``disarm``."""
        self._hand("confirm")

    def disarm(self) -> None:
        """Nobody looks any more."""
        self._hand("disarm")

    def go_on(self) -> None:
        """Confirm where that is asked for, else select where a button does."""
        if self.look is not None and self.look.state is State.DISARMED:
            self.confirm()
        elif self._game is not None and self._game.task.selection == BUTTON:
            self._hand(SELECT)

    @Slot(float, float)
    def turn(self, right_px: float, up_px: float) -> None:
        """Turn the virtual board so that the view moves to the right and up, px of the field."""
        newest = self._session.attitude.last(1)
        if self._game is None or not len(newest) or not self._session.hand_turned:
            return
        control = self._game.controller.control
        mode = (self.look.mode if self.look is not None else "") or PAN
        w, x, y, z = newest["quat"][0].tolist()
        right, up = turn_rad(control, mode, right_px, up_px)
        self._session.turn_board(right, up, viewer(control, mode, (w, x, y, z)))

    # inside

    def _hand(self, kind: str, value: str = "") -> None:
        if self.playing:
            self._session.game.hand(kind, value)

    @Slot(object)
    def _target_done(self, trial: Trial) -> None:
        """A target was hit; one of a run that was left is passed over."""
        if not self.playing or self._game is None or not of_run(trial, self._game.labels):
            return
        self.trials.append(trial)
        self.target_done.emit(trial)

    @Slot()
    def _run_over(self) -> None:
        """The worker has played a run to its end; the targets came before."""
        if self._game is not None and not self.playing:
            self.run_done.emit()


def of_run(trial: Trial, labels: Labels) -> bool:
    """Whether a target belongs to the run with these labels."""
    return all(getattr(trial, name) == value for name, value in vars(labels).items())
