"""The Target page: the game, studies with it, and their results; one tab is in front."""

from __future__ import annotations

import time
from pathlib import Path

from PySide6.QtCore import QEvent, QObject, Qt, QTimer, Slot
from PySide6.QtGui import QHideEvent, QKeyEvent, QShowEvent
from PySide6.QtWidgets import QVBoxLayout

from imugui.samples import NO_STATUS
from imugui.targeting.settings import TOGGLE, Control
from imugui.targeting.study_plan import StudyPlan
from imugui.targeting.study_store import PLAN
from imugui.targeting.trials import Trial
from imugui.views.game_keys import hint_words
from imugui.views.record_control import NOTHING_TO_RECORD
from imugui.views.settings_store import SettingsStore
from imugui.views.target_desk import TargetDesk
from imugui.views.target_file import FILE_NAME, PLAIN, Kept, load, save
from imugui.views.target_frame import RESULTS, STUDY, TargetFrame
from imugui.views.target_study_desk import StudyDesk
from imugui.views.view import View
from imugui.workers.session import Port, Session, State

NO_BOARD = "Connect a board first: the game is steered with it."
NOTHING_NOW = "There is no run to play now."
CLICK = "Click into the picture: it does not have the keys."
DONE_S = 2.0
"""A run of a study shows its result for so long, and Enter begins no run so soon after another."""
SAVE_DELAY_MS = 400


class TargetView(View):
    """Esc is the emergency stop, wherever the focus is, as long as a run is on."""

    title = "Target"
    icon = "target"
    tip = "Steer a field of view onto targets, and compare mappings"

    def __init__(self, session: Session, settings_store: SettingsStore) -> None:
        super().__init__(session, settings_store)
        path = settings_store.path
        self._path = path.parent / FILE_NAME if path is not None else None
        kept, self._problems = load(self._path) if self._path is not None else (Kept(), [])
        self.desk = TargetDesk(session)
        self.study_desk = StudyDesk(session, self.desk)
        self.frame = TargetFrame(session, self.desk, self.study_desk, kept)
        self.trials: list[Trial] = []
        """Of the runs that were finished in this window, outside of studies."""
        self._study = kept.study  # folder of the study that was open last
        self._kept = kept
        self._in_study = False
        self._frame_t = time.perf_counter()
        self._done_t = self._frame_t - DONE_S
        self._timer = QTimer(self)
        self._timer.setSingleShot(True)
        self._timer.setInterval(SAVE_DELAY_MS)
        self._connect_parts()
        self.frame.setup.show_last(kept.study)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.addWidget(self.frame)
        self._take_play()
        self.slow_refresh()

    # the window's timers

    def refresh(self) -> None:
        now = time.perf_counter()
        self.study_desk.pull()
        look = self.desk.pull()
        self.frame.scene.carry_on(now - self._frame_t)
        self._frame_t = now
        gone = not self.desk.playing and self._in_study and not self._resulting
        self.frame.scene.show_look(None if gone else look)

    def slow_refresh(self) -> None:
        status = self.session.status()
        for problem in self._problems:
            self.said.emit("warn", problem)
        self._problems = []
        self.study_desk.tick()
        playing, frame = self.desk.playing, self.frame
        frame.run.show_run(self.desk.look, playing)
        frame.play.history.show_log(self.desk.log)
        frame.offer_start(self._why_not())
        frame.show_front(status.state is State.IDLE, self._resulting)
        self._tell_keys()
        by_itself = frame.tab == STUDY and self.study_desk.study is not None and self.study_desk.record_runs
        frame.foot.show_run(status, playing and not self.desk.recorded, by_itself and not playing)

    def show_ports(self, ports: list[Port]) -> None:
        self.frame.empty.show_ports(ports)

    def stop(self) -> None:
        self.leave()
        self.frame.setup.simulation.stop()
        self.frame.results.stop()
        if self._timer.isActive():
            self._timer.stop()
            self._save()

    # what the keys and buttons do

    @Slot()
    def start(self) -> None:
        """Begin the run that is set, or the next step of the study."""
        if self.desk.playing or self._why_not():
            return
        self._in_study = self.frame.tab == STUDY
        if self._in_study:
            self.study_desk.start()
        else:
            self.desk.begin(self.frame.play.setup().game())

    @Slot()
    def go_on(self) -> None:
        """Enter, in the picture: select or confirm; without a run, start one."""
        if self.desk.playing:
            self.desk.go_on()
        elif not self._resulting:  # Enter may have been meant for the last target
            self.start()

    @Slot()
    def leave(self) -> None:
        """End the run that is on; it does not count."""
        if self.study_desk.playing:
            self.study_desk.leave()
        elif self.desk.playing:
            self.desk.leave()

    @Slot(object)
    def open_study(self, folder: Path) -> None:
        """Go on with the study in a folder."""
        if self.study_desk.open_folder(folder):
            self._study_opened()

    @Slot(object, object)
    def create_study(self, folder: Path, plan: StudyPlan) -> None:
        """Begin a study in a new folder."""
        if self.study_desk.create(folder, plan):
            self._study_opened()

    @Slot()
    def close_study(self) -> None:
        """Leave the study that is open."""
        self.leave()
        self.study_desk.close()
        self.slow_refresh()

    # Qt's events

    def showEvent(self, event: QShowEvent) -> None:
        super().showEvent(event)
        self.window().installEventFilter(self)

    def hideEvent(self, event: QHideEvent) -> None:
        """Nobody looks any more, so nothing may move."""
        self.frame.scene.let_go()
        self.desk.disarm()
        super().hideEvent(event)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Esc reaches the window from wherever the focus is, before it is anybody's shortcut."""
        stops = isinstance(event, QKeyEvent) and event.key() == Qt.Key.Key_Escape and self.desk.playing
        if event.type() != QEvent.Type.ShortcutOverride or not stops:
            return False
        self.desk.stop()
        event.accept()
        return True

    # inside

    @property
    def _resulting(self) -> bool:
        """A run has just ended."""
        return time.perf_counter() - self._done_t < DONE_S

    @property
    def _control(self) -> Control:
        """The mapping of the run that is on, or that will be."""
        game, step, study = self.desk.game, self.study_desk.step, self.study_desk.study
        if game is not None and self.desk.playing:
            return game.controller.control
        if self.frame.tab == STUDY and study is not None and step is not None and step.played:
            return study.plan.conditions[step.condition]
        control: Control = self.frame.play.control.value()
        return control

    def _why_not(self) -> str:
        """Why no run can begin now; empty when one can."""
        if self.session.status().state in NOTHING_TO_RECORD:
            return NO_BOARD
        if self.frame.tab == STUDY:
            study, step = self.study_desk.study, self.study_desk.step
            over = study is None or (step is None and study.next_person() is None)
            return NOTHING_NOW if over or (step is not None and step.asked) else ""
        return next(iter(self.frame.play.problems()), "")

    @Slot()
    def _follow_game(self) -> None:
        """A run has begun or ended."""
        playing, hand = self.desk.playing, self.session.hand_turned
        scene, run = self.frame.scene, self.frame.run
        # a latched button would begin and end with every drag
        scene.set_playing(playing, hand, not hand or self._control.latch != TOGGLE)
        self.frame.lock(playing)
        run.show_run(self.desk.look, playing)
        if playing:
            scene.setFocus(Qt.FocusReason.OtherFocusReason)

    def _tell_keys(self) -> None:
        newest = self.session.attitude.last(1)
        button = len(newest) > 0 and int(newest["status"][0]) != NO_STATUS
        scene, hand = self.frame.scene, self.session.hand_turned
        for panel in (self.frame.play, self.frame.study):
            panel.keys.show_keys(self._control, hand, button)
        keyless = self.desk.playing and not scene.hasFocus()
        scene.set_hint(CLICK if keyless else hint_words(self._control, hand))

    @Slot()
    def _run_done(self) -> None:
        self._done_t = time.perf_counter()
        self._follow_game()
        if self._in_study:
            self._offer_study()
            return
        self.trials += self.desk.trials
        self.frame.results.offer_free(self.trials)
        self.frame.play.next_list()

    def _study_opened(self) -> None:
        study = self.study_desk.study
        if study is not None:
            self._study = str(study.folder)
            self.frame.setup.show_last(self._study)
            self.frame.questions.forget()
            self._offer_study()
            self._keep()
            self.slow_refresh()
            self.frame.scene.setFocus(Qt.FocusReason.OtherFocusReason)

    def _offer_study(self) -> None:
        study = self.study_desk.study
        if study is not None:
            self.frame.results.offer_study(study.plan.name, study.folder)

    @Slot(str)
    def _tab_chosen(self, name: str) -> None:
        self.slow_refresh()
        if name == RESULTS:
            self.frame.results.refresh_results()

    @Slot()
    def _show_study_results(self) -> None:
        study = self.study_desk.study
        if study is not None:
            self.frame.results.source.choose(f"Study {study.plan.name}")
            self.frame.select(RESULTS)

    @Slot(object)
    def _show_simulated(self, folder: Path) -> None:
        self.said.emit("info", f"Simulated people played the study in {folder}.")
        self.frame.results.open_file(folder / PLAN)
        self.frame.select(RESULTS)

    @Slot()
    def _take_play(self) -> None:
        play = self.frame.play
        self.frame.scene.set_plain(play.play.value().picture == PLAIN)
        self.desk.sound = play.play.value().sound
        self.frame.setup.set_played(play.control.value())
        self._keep()

    def _keep(self) -> None:
        """Remember how the game is set, in a moment."""
        kept = self.frame.play.kept(self._study)
        if kept != self._kept:
            self._kept = kept
            self._timer.start()

    @Slot()
    def _save(self) -> None:
        if self._path is None:
            return
        try:
            save(self._path, self._kept)
        except OSError as error:
            self.said.emit("warn", f"The game's settings cannot be kept: {error.strerror or error}.")

    def _connect_parts(self) -> None:
        frame, desk, study = self.frame, self.desk, self.study_desk
        for signal, slot in (
            (frame.scene.pressed, desk.press), (frame.scene.released, desk.release), (frame.scene.turned, desk.turn),
            (frame.scene.go_on, self.go_on), (frame.scene.reset_wanted, desk.reset),
            (frame.run.start_wanted, self.start), (frame.run.stop_wanted, desk.stop),
            (frame.run.reset_wanted, desk.reset), (frame.run.confirm_wanted, desk.confirm),
            (frame.run.leave_wanted, self.leave), (desk.run_done, self._run_done), (desk.changed, self._follow_game),
            (frame.setup.create_wanted, self.create_study), (frame.setup.open_wanted, self.open_study),
            (frame.study.close_wanted, self.close_study), (frame.study.results_wanted, self._show_study_results),
            (frame.questions.answered, study.answer), (frame.questions.liked, self._liked),
            (frame.play.changed, self._take_play), (frame.chosen, self._tab_chosen), (self._timer.timeout, self._save),
            (frame.empty.wanted, self.wanted), (frame.foot.record_wanted, self.record_wanted),
            (frame.setup.simulation.finished, self._show_simulated), (frame.setup.simulation.said, self.said),
            (study.said, self.said), (frame.results.said, self.said),
        ):  # fmt: skip
            signal.connect(slot)

    @Slot(str)
    def _liked(self, name: str) -> None:
        self.study_desk.answer(liked=name)
