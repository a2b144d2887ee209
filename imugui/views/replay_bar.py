"""The replay bar: play, pause, seek, speed and loop, while a file is the source."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from PySide6.QtCore import QSize, Qt, QTimer, Signal, Slot
from PySide6.QtGui import QFontMetrics
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QVBoxLayout

from imugui.views import theme
from imugui.views.controls import Button, StillBox
from imugui.views.job import Job, Jobs
from imugui.views.labels import ToneLabel
from imugui.views.replay_words import (
    EVENT_WORDS,
    RESTARTED,
    SHORT_SPEED,
    SPEED_WORDS,
    clock_words,
    event_words,
    next_speed,
)
from imugui.views.shortcuts import tip
from imugui.views.timeline import Tick, Timeline, widest_clock
from imugui.workers.session import Player, Session

STEP_S = 5.0
NOTE_MS = 4000


class ReplayBar(QFrame):
    """Hidden unless the session plays a file."""

    compare_wanted = Signal()
    appeared = Signal()  # another file is played

    def __init__(self, session: Session) -> None:
        super().__init__()
        self.setProperty("role", "bar")
        self.setAccessibleName("Replay")
        self._session = session
        self._player: Player | None = None
        self._jobs = Jobs(self)
        self._overview: Job | None = None
        self._peek: tuple[int, float] | None = None  # attitudes there were at a seek while it stood still, and where to
        self.timeline = Timeline()
        self.play_button = _icon_button("play", "Play", "toggle_playing")
        self.loop_button = _icon_button("loop", "Begin again at the end", "")
        self.loop_button.setCheckable(True)
        self.clock = QLabel()
        self.clock.setAccessibleName("Position and duration")
        self.clock.setAlignment(Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignRight)
        self.speed = StillBox("Speed", f"How fast it plays ({'<'} and {'>'} change it)")
        for speed, words in SPEED_WORDS.items():
            self.speed.add(words, speed, short=SHORT_SPEED[speed])
        self.compare_button = Button(
            "Compare…", "Fuse this recording again with another filter, and see both", "show_compare"
        )
        self.note = ToneLabel(f"{theme.tone_glyph('warn')} {RESTARTED}")  # its room is kept: nothing jumps
        self._note_leaves = QTimer(self)
        self._note_leaves.setSingleShot(True)
        self._note_leaves.setInterval(NOTE_MS)
        self._note_leaves.timeout.connect(self._forget_note)
        self._lay_out()
        self._connect_parts()
        self.hide()

    def refresh(self) -> None:
        """Show where the player is; to be called for every frame."""
        player = self._player
        if player is not None:
            self._end_peek(player)
            self.timeline.set_position(player.position_s)

    def slow_refresh(self) -> None:
        """Follow the session."""
        if self._session.player is not self._player:
            self._take(self._session.player)
        player = self._player
        if player is None:
            return
        self.clock.setText(f"{clock_words(player.position_s)} / {clock_words(player.duration_s)}")
        self._show_playing(player.playing and self._peek is None)
        self.speed.choose(player.speed)
        self.loop_button.setChecked(player.loop)

    def stop(self) -> None:
        """End the threads."""
        self._jobs.stop()

    # what the keys and buttons do; nothing without a player

    @Slot()
    def toggle_playing(self) -> None:
        """Play or pause."""
        if self._player is not None:
            pauses = self._player.playing and self._peek is None
            self._peek = None
            (self._player.pause if pauses else self._player.play)()
            self.slow_refresh()

    def skip_back(self) -> None:
        """Go a step back."""
        self._skip(-STEP_S)

    def skip_on(self) -> None:
        """Go a step on."""
        self._skip(STEP_S)

    @Slot(float)
    def seek(self, position_s: float) -> None:
        """Go to a place, s, within the recording."""
        player = self._player
        if player is None:
            return
        position_s = min(max(position_s, 0.0), player.duration_s)
        player.seek(position_s)
        if self._peek is not None or not player.playing:
            self._peek = (self._session.attitude.count, position_s)
            player.play()
        self.note.show_phrase("warn", RESTARTED)
        self._note_leaves.start()
        self.slow_refresh()

    def slower(self) -> None:
        """Play slower."""
        self._change_speed(-1)

    def faster(self) -> None:
        """Play faster."""
        self._change_speed(1)

    def to_start(self) -> None:
        """Go to the beginning."""
        self.seek(0.0)

    def to_end(self) -> None:
        """Go to the end."""
        self.seek(math.inf)

    # inside

    def _skip(self, step_s: float) -> None:
        if self._player is not None:
            self.seek((self._peek[1] if self._peek is not None else self._player.position_s) + step_s)

    def _end_peek(self, player: Player) -> None:
        """A seek while it stood still has shown its attitude: stand still again, there."""
        if self._peek is None or self.timeline.dragging or self._session.attitude.count <= self._peek[0]:
            return
        player.pause()
        player.seek(self._peek[1])
        self._peek = None

    def _change_speed(self, step: int) -> None:
        if self._player is not None:
            self._player.set_speed(next_speed(self._player.speed, step))
            self.slow_refresh()

    def _take(self, player: Player | None) -> None:
        self._player, self._peek = player, None
        self.setVisible(player is not None)
        if self._overview is not None:
            self._overview.cancel()
        self._forget_note()
        if player is None:
            return
        self.timeline.show_recording(player.duration_s, ticks_of(player))
        self.clock.setFixedWidth(widest_clock(QFontMetrics(self.clock.font()), player.duration_s))
        self._overview = self._jobs.start(lambda _: player.overview(), self._overview_done, self._overview_failed)
        self.appeared.emit()

    @Slot(object)
    def _overview_done(self, band: Any) -> None:
        self.timeline.show_band(band)

    @Slot(str)
    def _overview_failed(self, why: str) -> None:
        self.note.show_phrase("warn", f"No overview: {why}")

    @Slot()
    def _forget_note(self) -> None:
        self.note.show_phrase("neutral", "")

    @Slot(int)
    def _speed_chosen(self, row: int) -> None:
        if self._player is not None:
            self._player.set_speed(self.speed.itemData(row))

    @Slot(bool)
    def _loop_chosen(self, on: bool) -> None:
        if self._player is not None:
            self._player.set_loop(on)

    def _show_playing(self, playing: bool) -> None:
        words = "Pause" if playing else "Play"
        self.play_button.set_icon("pause" if playing else "play")
        self.play_button.setAccessibleName(words)
        self.play_button.setToolTip(tip("toggle_playing", words))

    def _connect_parts(self) -> None:
        self.play_button.clicked.connect(self.toggle_playing)
        self.loop_button.clicked.connect(self._loop_chosen)
        self.speed.activated.connect(self._speed_chosen)
        self.timeline.sought.connect(self.seek)
        self.compare_button.clicked.connect(self.compare_wanted)

    def _lay_out(self) -> None:
        controls = QHBoxLayout()
        controls.setSpacing(6)
        for widget in (self.play_button, self.loop_button, self.clock, self.speed):
            controls.addWidget(widget)
        self.speed.setMinimumContentsLength(5)
        self.speed.setSizeAdjustPolicy(StillBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
        under = QHBoxLayout()
        under.setSpacing(6)
        under.addWidget(self.note, 1)
        under.addWidget(self.compare_button)
        left = QVBoxLayout()
        left.setSpacing(4)
        left.addLayout(controls)
        left.addLayout(under)
        row = QHBoxLayout(self)
        row.setContentsMargins(12, 6, 12, 6)
        row.setSpacing(10)
        row.addLayout(left)
        row.addWidget(self.timeline, 1)


def ticks_of(player: Player) -> list[Tick]:
    """The events of a recording as places on its timeline."""
    times = player.times
    ticks = []
    for event in player.events:
        if event.kind in EVENT_WORDS and len(times):
            at_s = float(times[np.clip(event.sample, 0, len(times) - 1)])
            ticks.append(Tick(at_s, event.kind, event_words(event, at_s)))
    return ticks


def _icon_button(icon: str, words: str, action: str) -> Button:
    button = Button("", words, action, icon)
    button.setIconSize(QSize(18, 18))
    button.setFixedWidth(38)
    button.setFocusPolicy(Qt.FocusPolicy.TabFocus)  # a click leaves the keys to the timeline
    return button
