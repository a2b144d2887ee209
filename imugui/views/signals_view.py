"""The Signals page: any channel over time or frequency, held and measured, its data taken away."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from typing import Any

from PySide6.QtCore import Slot
from PySide6.QtGui import QShowEvent
from PySide6.QtWidgets import QHBoxLayout, QStackedLayout, QVBoxLayout, QWidget

from imugui.signals.channels import QUANTITIES
from imugui.signals.scope import Scope
from imugui.signals.table import Table, make_table
from imugui.views.empty import EmptyState
from imugui.views.filters import use_spike_mask
from imugui.views.live_words import stale_word
from imugui.views.settings_store import SettingsStore
from imugui.views.signal_card import SignalCard
from imugui.views.signal_controls import SignalControls
from imugui.views.signal_export import SignalExport, export_header
from imugui.views.signal_numbers import Numbers
from imugui.views.signal_plots import PlotStack
from imugui.views.signal_traces import is_sent, time_frame
from imugui.views.signal_words import liveness
from imugui.views.spectrum_view import SpectrumView
from imugui.views.view import View
from imugui.workers.session import Port, Session, State, Status

WILL_SHOW = (
    "This page shows every channel of the board over time, with cursors, statistics and spectra, live or recorded."
)
PAGE = 0.5  # of the window, a press of Page Up or Page Down
MIDDLE = 0.5


class SignalsView(View):
    """Pulls both rings while in front and not held; draws only when something changed."""

    title = "Signals"
    icon = "signals"
    tip = "Curves over time, spectra, statistics"

    def __init__(self, session: Session, settings_store: SettingsStore) -> None:
        super().__init__(session, settings_store)
        self.scope = Scope(session.samples, session.attitude, settings_store.settings.convention)
        self.spectra = SpectrumView()
        self.in_spectrum = False
        self.mode = "now"
        self.controls = SignalControls()
        self.plots = PlotStack()
        self.card = SignalCard(self.scope.choice)
        self.export = SignalExport(self)
        self.empty = EmptyState("signals", "Nothing to show yet", WILL_SHOW)
        self._numbers = Numbers(self.scope, self.spectra)
        self._drawn_for: tuple[object, ...] = ()
        self._lay_out()
        self._connect_parts()
        self.slow_refresh()

    # the two timers

    def refresh(self) -> None:
        convention = self.settings_store.settings.convention
        if convention != self.scope.feed.convention:
            self.scope.restart(convention)
        changed = self.scope.refresh()
        if self.in_spectrum:
            changed |= self.spectra.step(self.scope)
        if changed or self._drawn_for != self._room():
            self._draw()

    def slow_refresh(self) -> None:
        status = self.session.status()
        nothing = self.session.samples.count == 0 and self.session.attitude.count == 0
        self._bring_to_front(0 if nothing and status.state is State.IDLE else 1)
        self._show_state(status)
        self.card.show_numbers(*self._numbers.of(self.mode))

    # what keys and buttons do

    def toggle_pause(self) -> None:
        """Hold the picture and set cursors, or follow the newest sample again."""
        if self.scope.held:
            self.scope.resume()
        else:
            self.scope.hold()
        self._mode_follows()

    def toggle_spectrum(self) -> None:
        """Frequencies instead of time, or back."""
        self.in_spectrum = not self.in_spectrum
        self._mode_follows()

    def toggle_spike_mask(self) -> None:
        """Leave the accelerometer out while the board's button moves, or not."""
        use_spike_mask(self.session, self.settings_store, not self.session.spike_mask)
        self._show_all()

    def fit_scales(self) -> None:
        """Take the scales from the data again."""
        self.scope.choice.fit()
        self._show_all()

    def copy_picture(self) -> None:
        """Put the plots on the clipboard."""
        self.export.copy(self.plots)

    def export_data(self) -> None:
        """Write the data on screen to a file; while that lasts, cancel it."""
        if self.export.busy:
            self.export.cancel()
            return
        self.export.ask(self.export_table(), export_header(self.session, self.scope.feed, self.scope.choice))

    def export_table(self) -> Table:
        """The data on screen."""
        return make_table(self.scope.feed, self.scope.choice, *self.scope.window)

    @Slot(int, float)
    def zoom(self, steps: int, share: float = MIDDLE) -> None:
        """Longer (positive) or shorter windows; a held one keeps what is at this share of its width."""
        self.scope.zoom(steps, share)
        self._show_all()

    def zoom_out(self) -> None:
        """A longer window."""
        self.zoom(1)

    def zoom_in(self) -> None:
        """A shorter window."""
        self.zoom(-1)

    def show_ports(self, ports: list[Port]) -> None:
        self.empty.show_ports(ports)

    def showEvent(self, event: QShowEvent) -> None:
        super().showEvent(event)
        self._take_focus()

    # from the parts

    @Slot(str, int)
    def _asked(self, what: str, n: int) -> None:
        """A key was pressed in the plots."""
        actions: dict[str, Callable[[], None]] = {
            "pause": self.toggle_pause,
            "zoom": lambda: self.zoom(n),
            "pan": lambda: self._pan(n * PAGE),
            "step": lambda: self.scope.step_cursor(n),
            "cursor": lambda: self.scope.cursors.take(n),
        }
        actions[what]()
        self._show_all()

    @Slot(float)
    def _pan(self, share: float) -> None:
        self.scope.pan(share)
        self._mode_follows()

    def _place(self, share: float) -> None:
        if not self.in_spectrum:
            self.scope.place_cursor(share)

    def _scale(self, key: str, low: float, high: float) -> None:
        if not self.in_spectrum:
            self.scope.fix_scale(key, low, high)

    def _choose_mode(self, mode: str) -> None:
        self.mode = mode

    def _then_show(self, act: Callable[..., object]) -> Callable[..., None]:
        """Does something, and shows it at once."""

        def both(*values: Any) -> None:
            act(*values)
            self._show_all()

        return both

    # showing

    def _bring_to_front(self, index: int) -> None:
        """0: the empty state, 1: the plots."""
        if index != self._stack.currentIndex():
            self._stack.setCurrentIndex(index)
            self._take_focus()

    def _take_focus(self) -> None:
        """The keys go to the plots, or to what brings data."""
        if self.isVisible():
            (self.plots if self._stack.currentIndex() else self.empty.buttons()[0]).setFocus()

    def _mode_follows(self) -> None:
        """The numbers follow what is shown: of the spectrum, between the cursors, or the newest."""
        fitting = "spectrum" if self.in_spectrum else "cursors" if self.scope.held else self.mode
        self.mode = fitting if fitting in self._offered() else "now"
        self._show_all()

    def _offered(self) -> tuple[str, ...]:
        special = ("spectrum",) if self.in_spectrum else ("cursors",) if self.scope.held else ()
        return ("now", "statistics", *special)

    def _show_all(self) -> None:
        """At once, after something was pressed."""
        self._draw()
        self.slow_refresh()

    def _room(self) -> tuple[object, ...]:
        return self.plots.columns(), self.plots.height(), tuple(self.scope.choice.plots)

    def _draw(self) -> None:
        columns, size = self.plots.columns(), self.plots.room(len(self.scope.choice.plots))
        make = self.spectra.frame if self.in_spectrum else time_frame
        self.plots.show_frame(make(self.scope, columns, size))
        self._drawn_for = self._room()

    def _show_state(self, status: Status) -> None:
        scope = self.scope
        choice = scope.choice
        self.card.show_liveness(*self._liveness(status))
        self.controls.show_state(scope.held, scope.viewport.window_s, choice.fixed, self.in_spectrum)
        self.card.show_mask(is_sent(scope.feed.corrected, QUANTITIES["button"].channels), self.session.spike_mask)
        self.card.show_mode(self.mode, self._offered())
        for key, rows in self.card.quantities.items():
            quantity = QUANTITIES[key]
            sent = is_sent(choice.history(quantity, scope.feed), quantity.channels)
            rows.show_state(key in choice.plots, sent, choice.fixed and not self.in_spectrum, choice.unit(quantity))
            if key in choice.ranges:
                rows.range.show_range(choice.ranges[key], choice.unit(quantity).decimals)

    def _liveness(self, status: Status) -> tuple[str, str]:
        """Tone and word: is the right edge of the plots now?"""
        player = self.session.player
        stopped = player is not None and not player.playing and not player.ended
        still = "Paused" if self.scope.held else "Replay paused" if stopped else ""
        rows = self.session.samples.last(1)
        age_s = time.perf_counter() - float(rows["t_arrival"][0]) if len(rows) else math.nan
        return liveness(status.state, still, stale_word(status.state, age_s), player is not None)

    # parts

    def _connect_parts(self) -> None:
        controls, plots, card = self.controls, self.plots, self.card
        scope, choice, shows = self.scope, self.scope.choice, self._then_show
        pairs = (
            (self.empty.wanted, self.wanted),
            (controls.pause_wanted, self.toggle_pause),
            (controls.window_chosen, shows(scope.set_window)),
            (controls.zoom_wanted, self.zoom),
            (controls.fixed_chosen, shows(scope.set_fixed)),
            (controls.spectrum_wanted, self.toggle_spectrum),
            (card.mask_wanted, self.toggle_spike_mask),
            (plots.asked, self._asked),
            (plots.panned, lambda share: self._pan(-share)),
            (plots.zoomed, self.zoom),
            (plots.placed, shows(self._place)),
            (plots.caught, shows(scope.cursors.take)),
            (plots.scaled, shows(self._scale)),
            (plots.fitted, shows(choice.fit)),
            (card.raw_chosen, shows(choice.set_raw)),
            (card.plot_toggled, shows(choice.show_plot)),
            (card.channel_toggled, shows(choice.show_channel)),
            (card.unit_wanted, shows(choice.next_unit)),
            (card.range_edited, shows(self._scale)),
            (card.mode_chosen, shows(self._choose_mode)),
            (card.copy.clicked, self.copy_picture),
            (card.export.clicked, self.export_data),
            (self.export.said, self.session.message),
            (self.export.progressed, card.show_progress),
            (self.export.ended, card.show_no_progress),
        )
        for signal, slot in pairs:
            signal.connect(slot)

    def _lay_out(self) -> None:
        left = QVBoxLayout()
        left.setContentsMargins(0, 0, 0, 6)
        left.setSpacing(0)
        left.addWidget(self.controls)
        left.addWidget(self.plots, 1)
        content = QWidget()
        row = QHBoxLayout(content)
        row.setContentsMargins(0, 0, 12, 0)
        row.setSpacing(0)
        row.addLayout(left, 1)
        right = QVBoxLayout()
        right.setContentsMargins(0, 12, 0, 12)
        right.addWidget(self.card)
        row.addLayout(right)
        self._stack = QStackedLayout(self)
        self._stack.addWidget(self.empty)
        self._stack.addWidget(content)
