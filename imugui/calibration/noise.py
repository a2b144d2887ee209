"""Noise figures of a sensor that lay still: overlapping Allan deviation (IEEE Std 952-1997, annex C)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from imugui.calibration.accelerometer import vector
from imugui.calibration.flow import Result
from imugui.calibration.gravity_fit import MG
from imugui.calibration.stillness import DEGREE, Floats, Gathered, rate_of, still_spans
from imugui.fusion.correction import Vector
from imugui.samples import Rows

WHITE_S = (0.1, 2.0)
"""s; where white noise rules in cheap sensors: N is read there, at tau 1 s on the line of slope -1/2."""
SLOPE_TOLERANCE = 0.1
SHORTEST_S = 60.0
TAU_SHARE = 5
"""tau goes up to this part of the record: beyond, too few pairs are left."""
FLICKER = 0.664
"""sqrt(2 ln 2 / pi): minimum of the curve over bias instability."""
NANS: Vector = (float("nan"),) * 3
UNITS = {"gyr": (DEGREE, "deg/s"), "acc": (MG, "mg")}
"""Unit of the figures and its size in SI."""


@dataclass(frozen=True)
class SensorNoise:
    """One sensor's figures, each axis its own, in deg/s or mg: NaN where the curve does not show them."""

    unit: str
    tau: Floats  # (n,) s
    deviation: Floats  # (n, 3)
    white: Vector  # N, unit/sqrt(Hz)
    slope: Vector  # of the curve between 0.1 and 2 s; white noise has -0.5
    instability: Vector  # minimum / 0.664
    instability_tau: Vector  # s, where
    walk: Vector  # K, unit/s/sqrt(Hz), only where the curve rises with slope +1/2

    @property
    def is_white(self) -> bool:
        """Whether the slope is that of white noise on all axes, so that N means what it says."""
        return all(abs(slope + 0.5) <= SLOPE_TOLERANCE for slope in self.slope)


@dataclass(frozen=True)
class NoiseResult(Result):
    """Figures of gyroscope and accelerometer from ``seconds`` at rest."""

    gyr: SensorNoise | None = None
    acc: SensorNoise | None = None
    seconds: float = 0.0
    rate_hz: float = 0.0
    samples: int = 0


class NoiseFlow:
    """Noise: let the board lie; ten minutes show the bias instability too."""

    title = "Noise"

    def __init__(self) -> None:
        self._gathered = Gathered()
        self._still_s = 0.0

    def feed(self, rows: Rows) -> None:
        """Take raw SAMPLE rows, shape (n,)."""
        self._gathered.feed(rows)
        t = self._gathered.rows["t"]
        self._still_s = max((float(t[s.stop - 1] - t[s.start]) for s in still_spans(self._gathered.rows)), default=0.0)

    @property
    def progress(self) -> float:
        """Share of the shortest record."""
        return min(1.0, self._still_s / SHORTEST_S)

    @property
    def missing(self) -> tuple[str, ...]:
        """Time still to lie."""
        return () if self.done else (f"{SHORTEST_S - self._still_s:.0f} s more at rest",)

    @property
    def sentence(self) -> str:
        """What to do now."""
        return "Enough for N; leave it ten minutes for the bias instability." if self.done else "Leave the board lying."

    @property
    def done(self) -> bool:
        """Whether N can be read."""
        return self._still_s >= SHORTEST_S

    def result(self) -> NoiseResult:
        """The figures, or why there are none."""
        return noise_of(self._gathered.rows)


def noise_of(rows: Rows) -> NoiseResult:
    """Noise figures from the longest still span of usable raw SAMPLE rows, shape (n,)."""
    rate = rate_of(rows)
    spans = still_spans(rows)
    longest = max(spans, key=lambda span: span.stop - span.start) if spans else None
    seconds = (longest.stop - longest.start) / rate if longest else 0.0
    if longest is None or seconds < SHORTEST_S:
        return NoiseResult(False, f"Only {seconds:.0f} s at rest; {SHORTEST_S:.0f} s are needed.", seconds=seconds)
    still = rows[longest.rows]
    found = {name: sensor_noise(still[name], rate, *UNITS[name]) for name in UNITS if np.isfinite(still[name]).all()}
    words = [f"{name} N {', '.join(f'{n:.4f}' for n in one.white)} {one.unit}/√Hz" for name, one in found.items()]
    words += [f"{name} is not white there: N is only a guide" for name, one in found.items() if not one.is_white]
    text = f"{seconds:.0f} s at rest: {'; '.join(words)}."
    return NoiseResult(True, text, found.get("gyr"), found.get("acc"), seconds, rate, len(still))


def sensor_noise(values: Floats, rate_hz: float, size: float = 1.0, unit: str = "") -> SensorNoise:
    """Read the figures off the curve of values (n, 3) sampled at ``rate_hz``; ``size``: the unit in that of values."""
    longest = len(values) // TAU_SHARE
    counts = np.unique(np.round(np.geomspace(1, max(2, longest), 60)).astype(int))
    tau, deviation = counts / rate_hz, allan_deviation(values / size, counts)
    read = [_read(tau, axis) for axis in deviation.T]
    white, slope, low, low_tau, walk = (vector(np.array(column)) for column in zip(*read, strict=True))
    return SensorNoise(unit, tau, deviation, white, slope, low, low_tau, walk)


def allan_deviation(values: Floats, counts: Floats) -> Floats:
    """Overlapping Allan deviation (m, 3) of rates (n, 3) averaged over ``counts`` (m,) samples each.

    sigma^2(tau) = mean of (x[k+2m] - 2 x[k+m] + x[k])^2 / (2 m^2), x the sum of the rates so far (W. J. Riley, NIST
    Special Publication 1065, equation 11). NaN where the record is shorter than two averages.
    """
    sums = np.cumsum(np.vstack((np.zeros((1, values.shape[1])), values - values.mean(axis=0))), axis=0)
    out = np.full((len(counts), values.shape[1]), np.nan)
    for row, m in enumerate(np.asarray(counts, int)):
        if 2 * m <= len(values):
            second = sums[2 * m :] - 2 * sums[m:-m] + sums[: -2 * m]
            out[row] = np.sqrt((second**2).mean(axis=0) / 2) / m
    return out


def _read(tau: Floats, curve: Floats) -> tuple[float, float, float, float, float]:
    """N, slope, bias instability, its tau and K of one axis' curve (n,)."""
    nan = float("nan")
    tau, curve = tau[curve > 0], curve[curve > 0]  # a value that never changes has no noise to tell of
    white_part = (tau >= WHITE_S[0]) & (tau <= WHITE_S[1])
    if white_part.sum() < 3:
        return nan, nan, nan, nan, nan
    logs = np.log10(tau[white_part]), np.log10(curve[white_part])
    slope = float(np.polyfit(*logs, 1)[0])
    white = float(10 ** np.mean(logs[1] + 0.5 * logs[0]))
    lowest = int(curve.argmin())
    # a curve that still falls at its end has not shown its minimum
    seen = lowest < len(curve) - 1
    low, low_tau = (float(curve[lowest]) / FLICKER, float(tau[lowest])) if seen else (nan, nan)
    return white, slope, low, low_tau, _walk(tau, curve, lowest)


def _walk(tau: Floats, curve: Floats, lowest: int) -> float:
    """K: the value at tau 3 s of the line of slope +1/2, where the curve behind its minimum has that slope."""
    late = slice(lowest, None)
    if len(tau[late]) < 4:
        return float("nan")
    logs = np.log10(tau[late]), np.log10(curve[late])
    if abs(float(np.polyfit(*logs, 1)[0]) - 0.5) > SLOPE_TOLERANCE:
        return float("nan")
    return float(10 ** np.mean(logs[1] - 0.5 * (logs[0] - np.log10(3.0))))
