"""Power spectral density by averaged periodograms.

P. D. Welch, "The use of fast Fourier transform for the estimation of power spectra", IEEE Transactions on Audio and
Electroacoustics AU-15(2), 1967, pages 70 to 73: segments that overlap by half, each without its mean and under a Hann
window, their periodograms averaged. One-sided; the integral over frequency is the variance.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

SHORTEST = 32  # samples of a segment
LONGEST = 1 << 15
SEGMENTS = 8  # about so many are wanted, half overlapping
LINE_HEIGHT = 10.0  # times the median density; averaged noise does not reach it
LINE_BINS = 2  # a line under a Hann window spreads over its bin and this many on either side


@dataclass(frozen=True)
class Spectrum:
    """``density`` is in unit2/Hz at ``frequency`` (Hz), both (n,); ``segments`` were averaged."""

    frequency: Floats
    density: Floats
    segments: int

    @property
    def resolution_hz(self) -> float:
        """Distance of two frequencies."""
        return float(self.frequency[1])

    def line(self) -> tuple[float, float]:
        """Frequency (Hz) and RMS (unit) of the strongest line; NaN when there is none.

        A line rises above both neighbours and far above the floor; the slope of slow movements is none.
        """
        inner, height = self.density[1:-1], LINE_HEIGHT * self.floor() ** 2
        rises = (inner > self.density[:-2]) & (inner >= self.density[2:]) & (inner > height)
        lines = LINE_BINS + np.flatnonzero(rises[LINE_BINS - 1 :])
        if len(lines) == 0:
            return math.nan, math.nan
        peak = int(lines[np.argmax(self.density[lines])])
        around = slice(peak - LINE_BINS, peak + LINE_BINS + 1)
        power, frequency = self.density[around], self.frequency[around]
        total = float(power.sum())
        return float(power @ frequency) / total, math.sqrt(total * self.resolution_hz)

    def floor(self) -> float:
        """Noise density, unit/sqrt(Hz): the median over frequency, which lines do not move; NaN when empty."""
        above = self.density[LINE_BINS + 1 :]
        return math.sqrt(float(np.median(above))) if len(above) else math.nan


def segment_length(n: int) -> int:
    """Samples of a segment for a stretch of n: a power of two that gives about SEGMENTS; 0 when n is too short."""
    if n < SHORTEST:
        return 0
    wanted = 2 * n // (SEGMENTS + 1)
    return min(max(1 << (wanted.bit_length() - 1), SHORTEST), LONGEST)


def stretches(values: Floats) -> list[Floats]:
    """The stretches of values (n,) between those of NaN."""
    edges = np.flatnonzero(np.diff(np.isfinite(values), prepend=False, append=False))
    return [values[start:stop] for start, stop in edges.reshape(-1, 2)]


def welch(parts: Sequence[Floats], rate_hz: float) -> Spectrum | None:
    """The spectrum of evenly sampled stretches, each (n,), at a rate; None when all are too short.

    No segment reaches over the end of a stretch. Raises ValueError when the rate is not above 0.
    """
    if not rate_hz > 0.0:
        raise ValueError(f"the rate must be above 0, not {rate_hz}")
    length = segment_length(max((len(part) for part in parts), default=0))
    if length == 0:
        return None
    window = 0.5 - 0.5 * np.cos(2.0 * np.pi * np.arange(length) / length)  # periodic Hann
    total, count = np.zeros(length // 2 + 1), 0
    for part in parts:
        if len(part) >= length:
            cut = np.lib.stride_tricks.sliding_window_view(part, length)[:: length // 2]
            power = np.abs(np.fft.rfft((cut - cut.mean(axis=1, keepdims=True)) * window, axis=1)) ** 2
            total += power.sum(axis=0)
            count += len(cut)
    density = total * (2.0 / (count * rate_hz * float(window @ window)))
    density[0] *= 0.5  # zero and the Nyquist frequency have no mirror image
    density[-1] *= 0.5
    return Spectrum(np.asarray(np.fft.rfftfreq(length, 1.0 / rate_hz), float), density, count)
