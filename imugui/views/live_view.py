"""The Live page: the board as it is held now, its angles, its heading, its filter."""

from __future__ import annotations

import math
import time
from typing import Any

from PySide6.QtCore import Qt, QTimer, Slot
from PySide6.QtWidgets import QHBoxLayout, QLabel, QScrollArea, QStackedLayout, QVBoxLayout, QWidget

from imugui.fusion.attitude import heading_deg
from imugui.fusion.quaternion import conjugate, from_matrix, multiply
from imugui.samples import Rows
from imugui.views.attitude_panel import AttitudePanel
from imugui.views.controls import Button
from imugui.views.empty import EmptyState
from imugui.views.filter_panel import FilterPanel
from imugui.views.hand_scene import HandScene
from imugui.views.heading_panel import HeadingPanel
from imugui.views.labels import ElidedLabel, muted
from imugui.views.live_words import origin_words, stale_word
from imugui.views.relative_words import IN_FRAME, stale_relative
from imugui.views.settings_store import SettingsStore
from imugui.views.view import View
from imugui.workers.session import Port, Session, State

COLUMN = 336
SCROLL_BAR = 12
HAND_HINT = "Turn it with the mouse or the arrow keys"
WILL_SHOW = (
    "This page shows the board as you hold it, turning as it turns, with yaw, pitch and roll, its heading, "
    "and how far to trust them."
)
VIEWS_FROM = {
    "view_from_x": ("x", "Look along the x axis"),
    "view_from_y": ("y", "Look along the y axis"),
    "view_from_z": ("z", "Look along the z axis"),
    "view_default": ("default", "Look from the usual place"),
}


class LiveView(View):
    """Never shows an old picture as if it were alive."""

    title = "Live"
    icon = "live"
    tip = "The board as it is held now"

    def __init__(self, session: Session, settings_store: SettingsStore) -> None:
        super().__init__(session, settings_store)
        kept = settings_store.settings
        self.scene = HandScene()
        self.angles = AttitudePanel(kept.convention, kept.decimals)
        self.heading = HeadingPanel()
        self.filter = FilterPanel(session, settings_store)
        self.empty = EmptyState("board", "No board is connected", WILL_SHOW)
        self.origin = QLabel()
        self.hint = ElidedLabel(HAND_HINT)
        self.hint.setProperty("role", "muted")
        self._display = (kept.convention, kept.decimals)
        self._state = State.IDLE
        self._origin_t = math.nan
        self._ghost: Any | None = None
        self._lay_out()
        self.scene.hand_turned.connect(self.turn_board)
        self.empty.wanted.connect(self.wanted)
        self.filter.head.toggled.connect(self._filter_unfolded)
        self.slow_refresh()

    def refresh(self) -> None:
        rows = self.session.shown.last(1)
        word = self._stale_word(rows)
        self.scene.set_dimmed(word or None)
        if word:
            self.angles.blank()
            self.heading.blank()
        else:
            self._show(rows)

    def slow_refresh(self) -> None:
        status = self.session.status()
        self._state = status.state
        rows = self.session.shown.last(1)
        alive = len(rows) > 0 and not self._stale_word(rows)
        if alive:
            self.angles.show_sigma(float(rows["sigma_tilt"][0]), float(rows["sigma_heading"][0]))
            self.heading.show_flags(status, bool(rows["rest"][0]))
        self.angles.show_note(self._filter_note())
        self._stack.setCurrentIndex(0 if status.state is State.IDLE and not alive else 1)
        self.filter.refresh()
        self.heading.setVisible(self.session.relative is None)
        self._follow_display()
        self._follow_hand()
        self._tell_origin()

    def show_ports(self, ports: list[Port]) -> None:
        self.empty.show_ports(ports)

    def origin_moved(self) -> None:
        self._origin_t = time.perf_counter()

    def show_ghost(self, quat: Any | None) -> None:
        self._ghost = quat
        if quat is None:
            self.scene.set_ghost(None)

    @Slot(float, float)
    def turn_board(self, dx_rad: float, dy_rad: float) -> None:
        """Turn the virtual board as seen on screen: right by dx, down by dy, rad."""
        self.session.turn_board(dx_rad, dy_rad, from_matrix(self.scene.camera().basis.T))

    def view_from_x(self) -> None:
        """Look along the x axis."""
        self.scene.view_from("x")

    def view_from_y(self) -> None:
        """Look along the y axis."""
        self.scene.view_from("y")

    def view_from_z(self) -> None:
        """Look along the z axis."""
        self.scene.view_from("z")

    def view_default(self) -> None:
        """Look from the usual place."""
        self.scene.view_from("default")

    def _filter_note(self) -> str:
        """Why another filter has taken over for now, on this board or on the one in whose frame it is shown."""
        boards = filter(None, (self.session, self.session.reference))
        return next(filter(None, (board.filter_note for board in boards)), "")

    def _stale_word(self, rows: Rows) -> str:
        """Why the picture is not live, in words; a paused replay shows where it stands."""
        relative = self.session.relative
        if relative is not None and (word := stale_relative(relative.status(), len(rows))):
            return word
        player = self.session.player
        if player is not None and len(rows) and not player.playing and not player.ended:
            return ""
        age_s = time.perf_counter() - float(rows["t_arrival"][0]) if len(rows) else math.nan
        return stale_word(self._state, age_s)

    def _show(self, rows: Rows) -> None:
        local = rows["local"][0]
        self.scene.set_quat(local)
        against = self.session.relative is not None
        if self._ghost is not None and not against:  # relative to the same origin
            self.scene.set_ghost(multiply(multiply(local, conjugate(rows["quat"][0])), self._ghost))
        self.scene.set_north(not (self.session.has_origin or against))
        self.angles.show_attitude(local, self.session.has_origin or against)
        self.heading.show_heading(float(heading_deg(rows["quat"][0])))

    def _follow_display(self) -> None:
        kept = self.settings_store.settings
        if self._display != (kept.convention, kept.decimals):
            self._display = (kept.convention, kept.decimals)
            self.angles.set_display(*self._display)

    def _follow_hand(self) -> None:
        hand = self.session.hand_turned
        self.hint.setVisible(hand)
        if hand != self.scene.turned_by_hand:
            self.scene.set_hand_mode(hand)
            if hand:
                self.scene.setFocus(Qt.FocusReason.MouseFocusReason)

    def _tell_origin(self) -> None:
        if self.session.relative is not None:
            self.origin.setText(IN_FRAME)
        elif not self.session.has_origin:
            self._origin_t = math.nan
            self.origin.clear()
        else:
            self.origin.setText(origin_words(time.perf_counter() - self._origin_t).capitalize())

    @Slot(bool)
    def _filter_unfolded(self, on: bool) -> None:
        """Bring the parameters into view, once they have their room."""
        if on:
            QTimer.singleShot(0, self, lambda: self._area.verticalScrollBar().setValue(self.filter.y() - 14))

    def _lay_out(self) -> None:
        column = QVBoxLayout()
        column.setContentsMargins(16, 14, 2, 14)
        column.setSpacing(10)
        for panel in (self.angles, self.heading, self.filter):
            column.addWidget(panel)
        column.addStretch(1)
        inside = QWidget()
        inside.setLayout(column)
        inside.setFixedWidth(COLUMN - SCROLL_BAR)  # the bar comes and goes, the cards keep their width
        area = self._area = QScrollArea()
        area.setWidget(inside)
        area.setWidgetResizable(True)
        area.setAlignment(Qt.AlignmentFlag.AlignLeft)
        area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        area.setFixedWidth(COLUMN)
        left = QVBoxLayout()
        left.setContentsMargins(0, 0, 0, 0)
        left.setSpacing(0)
        left.addWidget(self.scene, 1)
        left.addLayout(self._foot())
        content = QWidget()
        row = QHBoxLayout(content)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(0)
        row.addLayout(left, 1)
        row.addWidget(area)
        self._stack = QStackedLayout(self)
        self._stack.addWidget(self.empty)
        self._stack.addWidget(content)

    def _foot(self) -> QHBoxLayout:
        row = QHBoxLayout()
        row.setContentsMargins(16, 6, 12, 6)
        row.setSpacing(4)
        row.addWidget(self.origin)
        row.addSpacing(12)
        row.addWidget(self.hint, 1)
        row.addStretch(0)
        label = muted("View from")
        label.setWordWrap(False)
        row.addWidget(label)
        for action, (view, words) in VIEWS_FROM.items():
            button = Button(view, words, action, small=True)
            button.setAccessibleName(words)
            button.clicked.connect(lambda _=False, view=view: self.scene.view_from(view))
            row.addWidget(button)
        return row
