"""What a window of a channel amounts to in numbers. Rows of NaN do not count."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from imugui.signals.channels import fold

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Summary:
    """Of n values, in their unit; NaN where there are too few."""

    n: int
    mean: float
    sd: float
    peak_to_peak: float
    rms: float


NOTHING = Summary(0, math.nan, math.nan, math.nan, math.nan)


def summary(values: Floats, period: float = 0.0) -> Summary:
    """Mean, standard deviation (n - 1), peak to peak and root mean square of values, shape (n,).

    Of an angle with a period the values are continuous, whole turns counted on: deviation and peak to peak are those
    of the way it went, the mean is folded back, and the RMS is that of the folded angle.
    """
    known = values if not np.isnan(values).any() else values[np.isfinite(values)]
    n = len(known)
    if n == 0:
        return NOTHING
    mean = float(known.mean())
    sd = float(known.std(ddof=1)) if n > 1 else math.nan
    seen = known - period * np.floor(known / period + 0.5) if period else known
    rms = math.sqrt(float(seen @ seen) / n)
    return Summary(n, fold(mean, period), sd, float(known.max() - known.min()), rms)


def mean_rate(t: Floats, gaps: Floats) -> float:
    """Samples a second (Hz) of times (n,) in s, the gaps (m, 2) between them left out; NaN of fewer than two."""
    if len(t) < 2:
        return math.nan
    inside = (gaps[:, 0] >= t[0]) & (gaps[:, 1] <= t[-1])
    steps = np.count_nonzero(np.diff(t)) - int(inside.sum())
    lost = float((gaps[inside, 1] - gaps[inside, 0]).sum())
    spent = float(t[-1] - t[0]) - lost
    return steps / spent if spent > 0.0 else math.nan
