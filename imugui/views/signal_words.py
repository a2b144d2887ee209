"""The numbers of the Signals page as text, and its small tables of words. No widget, no colour."""

from __future__ import annotations

import math
from dataclasses import dataclass

from imugui.signals.channels import Channel, Unit, fold
from imugui.signals.cursors import Cursors, Reading
from imugui.signals.spectrum import Spectrum
from imugui.signals.statistics import Summary
from imugui.views.readout import MINUS, number_text
from imugui.workers.session import State

NO_NUMBER = "---"
SMALLEST_POWER = -4  # below, numbers are written with a power of ten
LONGEST = 5  # digits of a number, before its decimals are cut

NOT_SENT = "not sent by this board"
NO_ROWS = "Waiting for data"
NO_CHANNEL = "No channel is chosen: tick one at the right"
NO_PLOT = "Nothing is chosen: tick a quantity at the right"
TOO_SHORT = "Too few samples in this window for a spectrum"
NOTHING_HERE = "No data in this window"


@dataclass(frozen=True)
class Mode:
    """What stands beside each channel: the heads of the columns, and the button that chooses it."""

    title: str
    heads: tuple[str, ...]
    tip: str


MODES = {
    "now": Mode("Newest", ("newest",), "The newest value"),
    "statistics": Mode("Statistics", ("mean", "SD", "p-p", "RMS"), "Of the window on screen"),
    "cursors": Mode("Cursors", ("A", "B", "B − A", "per s"), "Values at the cursors, difference and slope a second"),
    "spectrum": Mode("Spectrum", ("peak Hz", "RMS", "noise/√Hz"), "The strongest line, and the noise between lines"),
}


def liveness(state: State, still: str, stale: str, replayed: bool) -> tuple[str, str]:
    """Tone and word of the right edge of the plots: is it now?

    ``still`` says what the user has stopped, ``stale`` why nothing comes; "" where that is not so.
    """
    if still or state is State.IDLE:
        return "neutral", still or state.word
    return ("warn", stale) if stale else ("good", "Playing" if replayed else "Live")


def number(value: float, decimals: int) -> str:
    """A number with at the most so many decimals, fewer where it is long, dashes for NaN."""
    if not math.isfinite(value):
        return NO_NUMBER
    return number_text(value, max(0, min(decimals, LONGEST - len(str(int(abs(value)))))), signed=False)


def significant(value: float, digits: int = 3) -> str:
    """A number > 0 with so many digits that count; very small ones as a power of ten."""
    if not math.isfinite(value) or value <= 0.0:
        return NO_NUMBER
    power = math.floor(math.log10(value))
    if power < SMALLEST_POWER:
        return f"{value / 10.0**power:.{digits - 1}f}e{power}".replace("-", MINUS)
    return number_text(value, max(0, digits - 1 - power), signed=False)


def now_cells(value: float, channel: Channel, unit: Unit) -> tuple[str, ...]:
    """The newest value, SI."""
    return (number(fold(value, channel.period) * unit.scale, unit.decimals),)


def statistics_cells(summary: Summary, unit: Unit) -> tuple[str, ...]:
    """Mean, standard deviation, peak to peak, RMS, SI; one decimal more than a single value bears."""
    values = (summary.mean, summary.sd, summary.peak_to_peak, summary.rms)
    return tuple(number(value * unit.scale, unit.decimals + 1) for value in values)


def cursor_cells(reading: Reading, channel: Channel, unit: Unit) -> tuple[str, ...]:
    """Both values, difference and slope, SI."""
    a, b = (fold(value, channel.period) for value in (reading.a, reading.b))
    return tuple(number(value * unit.scale, unit.decimals) for value in (a, b, reading.delta, reading.slope))


def spectrum_cells(spectrum: Spectrum | None, unit: Unit) -> tuple[str, ...]:
    """The strongest line and the noise density."""
    if spectrum is None:
        return (NO_NUMBER,) * 3
    frequency, rms = spectrum.line()
    return number(frequency, 2), significant(rms * unit.scale), significant(spectrum.floor() * unit.scale)


def seconds(value: float) -> str:
    """A length of time to the millisecond: "4.000 s"."""
    return f"{number(value, 3)} s"


def statistics_line(span_s: float, samples: int, rate_hz: float, gaps: int) -> str:
    """What the statistics are of."""
    count = "no gaps" if gaps == 0 else "1 gap" if gaps == 1 else f"{gaps} gaps"
    return f"{number(span_s, 1)} s, {samples:,} samples, {number(rate_hz, 1)} Hz, {count}"


def cursors_line(cursors: Cursors) -> str:
    """How far the cursors are apart."""
    if not cursors.shown:
        return ""
    apart = cursors.delta_s
    often = f" ({significant(1.0 / abs(apart))} Hz)" if apart else ""
    return f"B − A is {seconds(apart)}{often}"


def spectrum_line(spectrum: Spectrum | None) -> str:
    """What the spectrum was made of."""
    if spectrum is None:
        return TOO_SHORT
    count = "1 segment" if spectrum.segments == 1 else f"{spectrum.segments} segments"
    return f"Welch, {count} averaged, lines {significant(spectrum.resolution_hz)} Hz apart"
