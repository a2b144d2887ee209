"""The numbers beside the channels: newest values, statistics, cursors, spectrum; by mode."""

from __future__ import annotations

from collections.abc import Callable

from imugui.signals.channels import QUANTITIES, Channel, Unit
from imugui.signals.history import History
from imugui.signals.scope import Scope
from imugui.signals.statistics import mean_rate, summary
from imugui.views import signal_words as words
from imugui.views.spectrum_view import SpectrumView

Cells = dict[str, tuple[str, ...]]


class Numbers:
    """Texts by channel for one of MODES, and the line beneath the list."""

    def __init__(self, scope: Scope, spectra: SpectrumView) -> None:
        self._scope = scope
        self._spectra = spectra
        self._cells: dict[str, Callable[[History, Channel, Unit], tuple[str, ...]]] = {
            "now": self._now,
            "statistics": self._statistics,
            "cursors": self._cursors,
            "spectrum": self._spectrum,
        }
        self._lines: dict[str, Callable[[], str]] = {
            "now": self._window_line,
            "statistics": self._window_line,
            "cursors": lambda: words.cursors_line(scope.cursors),
            "spectrum": lambda: words.spectrum_line(spectra.first()),
        }

    def of(self, mode: str) -> tuple[Cells, str]:
        """The cells of every channel shown, by key, and the line."""
        choice = self._scope.choice
        cells: Cells = {}
        for key, channels in choice.shown().items():
            quantity = QUANTITIES[key]
            history, unit = choice.history(quantity, self._scope.feed), choice.unit(quantity)
            for channel in channels:
                cells[channel.key] = self._cells[mode](history, channel, unit)
        return cells, self._lines[mode]()

    def _now(self, history: History, channel: Channel, unit: Unit) -> tuple[str, ...]:
        return words.now_cells(history.newest(channel.key), channel, unit)

    def _statistics(self, history: History, channel: Channel, unit: Unit) -> tuple[str, ...]:
        values = history.values(channel.key)[history.span(*self._scope.window)]
        return words.statistics_cells(summary(values, channel.period), unit)

    def _cursors(self, history: History, channel: Channel, unit: Unit) -> tuple[str, ...]:
        return words.cursor_cells(self._scope.cursors.read(history, channel.key), channel, unit)

    def _spectrum(self, history: History, channel: Channel, unit: Unit) -> tuple[str, ...]:
        return words.spectrum_cells(self._spectra.of(channel.key), unit)

    def _window_line(self) -> str:
        history, window = self._scope.times, self._scope.window
        t, gaps = history.t[history.span(*window)], history.gaps(*window)
        if len(t) == 0:
            return ""
        rows = len(t) - len(gaps)  # a row of NaN stands in each gap
        return words.statistics_line(float(t[-1] - t[0]), rows, mean_rate(t, gaps), len(gaps))
