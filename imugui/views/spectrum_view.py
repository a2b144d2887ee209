"""The spectrum of the window on screen: one channel computed per refresh, all of them drawn."""

from __future__ import annotations

import math

import numpy as np

from imugui.signals.channels import QUANTITIES, Channel, Unit
from imugui.signals.columns import Columns, Grid, segments
from imugui.signals.scale import Range, tick_words, ticks
from imugui.signals.scope import Scope
from imugui.signals.spectrum import Spectrum, stretches, welch
from imugui.signals.statistics import mean_rate
from imugui.signals.strokes import DENSE, Strokes, bars_of
from imugui.views.signal_frame import Curve, Frame, Plot, Ticks
from imugui.views.signal_traces import LABEL_HEIGHT, LABEL_ROOM, extremes, why_empty
from imugui.views.signal_words import NO_PLOT, NOTHING_HERE, TOO_SHORT

LEAST_DECADES = 2
FAINTEST = 1e-12  # unit/sqrt(Hz): below it is rounding
_SUPERSCRIPT = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


class SpectrumView:
    """Keeps the newest spectrum of every channel shown."""

    def __init__(self) -> None:
        self._spectra: dict[str, Spectrum | None] = {}
        self._turn = 0  # of the channel computed last
        self._due = 0  # channels not yet up to date
        self._raw = False
        self._seen: tuple[object, ...] = ()

    def of(self, key: str) -> Spectrum | None:
        """The spectrum of a channel, in SI; None when there is none."""
        return self._spectra.get(key)

    def first(self) -> Spectrum | None:
        """Any spectrum there is: all have the same lines."""
        return next((one for one in self._spectra.values() if one is not None), None)

    def step(self, scope: Scope) -> bool:
        """Compute the next channel; False when all are up to date."""
        pairs = [(key, one) for key, channels in scope.choice.shown().items() for one in channels]
        if scope.choice.raw is not self._raw:
            self._raw = scope.choice.raw
            self._spectra.clear()
        seen = (scope.window, self._raw, tuple(one.key for _, one in pairs))
        if seen != self._seen:
            self._seen, self._due = seen, len(pairs)
        if self._due == 0:
            return False
        self._due -= 1
        self._turn = (self._turn + 1) % len(pairs)
        key, channel = pairs[self._turn]
        self._spectra[channel.key] = compute(scope, key, channel)
        return True

    def frame(self, scope: Scope, columns: int, size: tuple[float, float]) -> Frame:
        """The picture on ``columns`` columns; ``size`` is a plot's width and height in pixels."""
        choice = scope.choice
        shown = choice.shown()
        found = [self.of(one.key) for channels in shown.values() for one in channels]
        top = max((float(one.frequency[-1]) for one in found if one is not None), default=math.nan)
        grid = Grid(0.0, top / columns, columns)
        plots = []
        for key, channels in shown.items():
            unit = choice.unit(QUANTITIES[key])
            curves = tuple(self._curve(one, unit, grid) for one in channels if self.of(one.key) is not None)
            limits = decades(*extremes(curves))
            note = "" if curves else why_no_spectrum(scope, key, channels)
            ticks_ = decade_ticks(limits, size[1])
            plots.append(Plot(key, choice.title(key), f"{unit.name or 1}/√Hz", limits, ticks_, curves, note))
        return Frame(columns, tuple(plots), frequency_ticks(grid, size[0]), note="" if plots else NO_PLOT)

    def _curve(self, channel: Channel, unit: Unit, grid: Grid) -> Curve:
        """Amplitude density over frequency, as powers of ten; the first bins hold the removed mean."""
        spectrum = self._spectra[channel.key]
        assert spectrum is not None  # noqa: S101
        amplitude = np.sqrt(spectrum.density[1:]) * unit.scale
        values, x = np.log10(np.maximum(amplitude, FAINTEST)), spectrum.frequency[1:]
        if len(x) > DENSE * grid.count:
            return Curve(channel.label, channel.tone, Strokes(bars_of(Columns(grid, x), values)))
        return Curve(channel.label, channel.tone, Strokes(segments((x - grid.start) / grid.step, values)))


def compute(scope: Scope, key: str, channel: Channel) -> Spectrum | None:
    """The spectrum of a channel within the window; None where there is too little."""
    history, window = scope.choice.history(QUANTITIES[key], scope.feed), scope.window
    rows = history.span(*window)
    rate_hz = mean_rate(history.t[rows], history.gaps(*window))
    return welch(stretches(history.values(channel.key)[rows]), rate_hz) if rate_hz > 0.0 else None


def why_no_spectrum(scope: Scope, key: str, channels: tuple[Channel, ...]) -> str:
    """Why a plot shows nothing."""
    why = why_empty(key, channels, scope.choice, scope.feed)
    return TOO_SHORT if why == NOTHING_HERE else why


def decades(low: float, high: float) -> Range:
    """A scale of whole powers of ten."""
    if not (math.isfinite(low) and math.isfinite(high)):
        return -float(LEAST_DECADES), 0.0
    top = math.ceil(high + 0.05)
    return float(min(math.floor(low), top - LEAST_DECADES)), float(top)


def decade_ticks(limits: Range, height: float) -> Ticks:
    """Whole powers of ten, as numbers near 1 and as powers far from it."""
    every = max(1, math.ceil((limits[1] - limits[0]) / max(1, int(height / LABEL_HEIGHT))))
    powers = range(round(limits[0]), round(limits[1]) + 1, every)
    return Ticks(np.array(powers, float), tuple(_power_words(power) for power in powers))


def _power_words(power: int) -> str:
    if -3 <= power <= 4:
        return f"{10.0**power:.{max(0, -power)}f}"
    return f"10{str(power).translate(_SUPERSCRIPT)}"


def frequency_ticks(grid: Grid, width: float) -> Ticks:
    """Ticks in columns, their words in Hz."""
    if not math.isfinite(grid.step):
        return Ticks(np.empty(0), ())
    values, step = ticks(grid.start, grid.end, max(1, int(width / LABEL_ROOM)))
    return Ticks(values / grid.step, tuple(f"{tick_words(value, step)} Hz" for value in values.tolist()))
