"""Timed collection: countdown, record, pause, and again; whatever happens, what is complete is kept."""

from __future__ import annotations

import datetime
import time
from dataclasses import dataclass
from pathlib import Path

from PySide6.QtCore import QFile, QObject, QTimer, Signal, Slot

from imugui import paths
from imugui.fields import field
from imugui.views.record_control import why_not
from imugui.views.record_words import length_words, recording_path
from imugui.workers.session import RecordingStatus, Session

TICK_MS = 50
NO_DATA_S = 5.0
COUNTDOWN, RECORDING, PAUSE, IDLE = "countdown", "recording", "pause", "idle"


@dataclass(frozen=True)
class Plan:
    """What to collect."""

    duration_s: float = field(10.0, "Duration", unit="s", low=0.5, high=86400.0, step=0.5, tip="Of each recording")
    countdown_s: float = field(3.0, "Countdown", unit="s", low=0.0, high=600.0, step=0.5, tip="Before the first")
    repeats: int = field(1, "Recordings", low=1, high=1000, step=1, tip="How many, one after the other")
    pause_s: float = field(3.0, "Pause between", unit="s", low=0.0, high=3600.0, step=0.5)
    label: str = field("", "Label", tip="Becomes part of the file name")
    note: str = field("", "Note", tip="Is kept in the recording")

    @property
    def total_s(self) -> float:
        """All of it, s."""
        return self.countdown_s + self.repeats * self.duration_s + (self.repeats - 1) * self.pause_s


@dataclass(frozen=True)
class Stage:
    """Where a collection is: ``left_s`` of this phase, ``total_left_s`` of all, ``share`` done of all."""

    phase: str = IDLE
    run: int = 0  # from 1
    left_s: float = 0.0
    total_left_s: float = 0.0
    share: float = 0.0


class Collection(QObject):
    """Runs a plan by its own timer, whichever page is in front."""

    changed = Signal()  # the phase, or what was made
    ended = Signal(str, str)  # tone, sentence

    def __init__(self, session: Session, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.plan = Plan()
        self.made: list[Path] = []
        self._session = session
        self._phase = IDLE
        self._since = 0.0  # host time at which the phase began
        self._seen: RecordingStatus | None = None
        self._fed = False  # samples arrive in this recording
        self._timer = QTimer(self)
        self._timer.setInterval(TICK_MS)
        self._timer.timeout.connect(self.tick)

    @property
    def running(self) -> bool:
        return self._phase != IDLE

    def start(self, plan: Plan) -> bool:
        """Begin; False, with the reason said, when nothing can be recorded."""
        problem = why_not(self._session.status())
        if self._session.recording is not None:
            problem = "Stop the recording first: press R."
        if problem or self.running:
            self.ended.emit("warn", problem or "A collection is running.")
            return False
        self.plan, self.made = plan, []
        self._enter(COUNTDOWN)
        self._timer.start()
        self.tick()
        return True

    @Slot()
    def cancel(self) -> None:
        """End it now; the recording that is not complete goes to the trash."""
        if self.running:
            self._end("warn", "Cancelled", drop=True)

    def stop(self) -> None:
        """The window closes: the recording that runs is ended by the session, and kept."""
        self._timer.stop()
        self._phase = IDLE

    def stage(self) -> Stage:
        """Where it is now."""
        if not self.running:
            return Stage()
        plan, done = self.plan, len(self.made)
        lengths = {COUNTDOWN: plan.countdown_s, RECORDING: plan.duration_s, PAUSE: plan.pause_s}
        left = max(0.0, lengths[self._phase] - self._elapsed())
        after = (plan.repeats - done - 1) * (plan.duration_s + plan.pause_s)
        total_left = left + after + (plan.duration_s if self._phase != RECORDING else 0.0)
        share = 1.0 - total_left / plan.total_s
        return Stage(self._phase, done + 1, left, total_left, min(max(share, 0.0), 1.0))

    @Slot()
    def tick(self) -> None:
        """Go on as far as the time says."""
        {COUNTDOWN: self._wait, PAUSE: self._wait, RECORDING: self._watch, IDLE: self._timer.stop}[self._phase]()

    def _wait(self) -> None:
        if self.stage().left_s > 0.0:
            return
        problem = why_not(self._session.status())
        path = recording_path(paths.documents_folder(), self.plan.label, datetime.datetime.now())
        if problem or not self._session.record(path, self.plan.label, self.plan.note):
            self._end("error", f"Stopped: {problem or 'the recording could not begin'}", drop=False)
            return
        self._seen, self._fed = self._session.recording, False
        self._enter(RECORDING)

    def _watch(self) -> None:
        running, seen = self._session.recording, self._seen
        if running is None or seen is None or running.path != seen.path:
            self._end("warn", "Stopped, because the recording was ended", drop=False)
            return
        self._seen = running
        if not self._fed and running.rows:
            self._fed = True
            self._enter(RECORDING)  # its time counts from the first sample, which came a moment ago
            rate_hz = self._session.rate_hz
            self._since -= running.rows / rate_hz if rate_hz else 0.0
        elif not self._fed and running.elapsed_s > NO_DATA_S:
            self._end("error", "Stopped, because the board sends no samples", drop=True)
        elif self._fed and self.stage().left_s <= 0.0:
            self._keep(running)

    def _keep(self, running: RecordingStatus) -> None:
        self._session.stop_recording()
        self.made.append(running.path)
        self._seen = None
        if len(self.made) == self.plan.repeats:
            self._end("info", "Done", drop=False)
        else:
            self._enter(PAUSE)

    def _enter(self, phase: str) -> None:
        self._phase, self._since = phase, time.perf_counter()
        self.changed.emit()

    def _elapsed(self) -> float:
        waits = self._phase == RECORDING and not self._fed
        return 0.0 if waits else time.perf_counter() - self._since

    def _end(self, tone: str, words: str, drop: bool) -> None:
        """Stop for good, and say what there is."""
        self._timer.stop()
        seen, self._seen = self._seen, None
        rest = ""
        if seen is not None:
            self._session.stop_recording()
            rest = f" {unfinished(seen, drop)}"
        self._enter(IDLE)
        count, asked = len(self.made), self.plan.repeats
        what = "recording is" if asked == 1 else "recordings are"
        self.ended.emit(tone, f"{words.rstrip('.')}. {count} of {asked} {what} complete and kept.{rest}")


def unfinished(seen: RecordingStatus, drop: bool) -> str:
    """What became of a recording that is not complete, after moving it to the trash if it is to be dropped."""
    words = f"The one that ran, {length_words(seen.elapsed_s)} long,"
    if drop and QFile.moveToTrash(str(seen.path)):
        return f"{words} was moved to the trash."
    return f"{words} was kept as {seen.path.name}."
