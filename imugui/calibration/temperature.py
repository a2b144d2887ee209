"""The gyroscope's bias against temperature, as far as the data support it (calibration-position.md 2.3).

Constant below 5 K of span, linear from 5 K, quadratic from 10 K and only when it predicts held-out blocks better. The
model is never used outside the temperatures it has seen: there it stays at their edge.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from imugui.calibration.accelerometer import vector
from imugui.calibration.flow import Result
from imugui.calibration.stillness import AT_REST, DEGREE, Floats, Gathered, still_spans
from imugui.fusion.correction import Vector
from imugui.samples import Rows

BLOCK_S = 2.0
LINEAR_FROM_K, QUADRATIC_FROM_K = 5.0, 10.0
GAIN = 0.8
"""A higher order must bring the error of held-out blocks below this part of the lower one's."""
FITS = 0.05 * DEGREE
"""rad/s; a bias that strays further from the curve does not follow the temperature."""
FOLDS = 10
WORK_OFF_S = 30.0
NAN = float("nan")


@dataclass(frozen=True)
class TemperatureModel:
    """bias(T) = c0 + c1 d + c2 d^2, d = T - reference_c with T clamped to low_c..high_c; rad/s, for each axis."""

    coefficients: tuple[Vector, ...]
    reference_c: float
    low_c: float
    high_c: float

    @property
    def order(self) -> int:
        """0 constant, 1 linear, 2 quadratic."""
        return len(self.coefficients) - 1

    def bias(self, temp_c: float) -> Floats:
        """The bias (3,), rad/s, at a temperature in degrees Celsius."""
        distance = min(max(temp_c, self.low_c), self.high_c) - self.reference_c
        return np.asarray(sum(np.array(c) * distance**k for k, c in enumerate(self.coefficients)))


@dataclass(frozen=True)
class TemperatureResult(Result):
    """The model and its error on held-out blocks; refused when the bias does not follow the temperature."""

    model: TemperatureModel | None = None
    span_k: float = 0.0
    error_dps: float = NAN
    constant_error_dps: float = NAN  # the same for a constant
    samples: int = 0


class TemperatureFlow:
    """Temperature: the board lies still while it warms up or cools down."""

    title = "Temperature"

    def __init__(self) -> None:
        self._gathered = Gathered()
        self._points: list[Floats] = []  # each: temperature (degrees C), bias (3) rad/s
        self._samples = 0

    def feed(self, rows: Rows) -> None:
        """Take raw SAMPLE rows, shape (n,)."""
        self._gathered.feed(rows)
        if self._gathered.seconds >= WORK_OFF_S:  # hours fit in memory only as means
            self._work_off()

    @property
    def points(self) -> Floats:
        """What was seen so far, (n, 4): temperature in degrees C and bias in rad/s."""
        return np.array(self._points).reshape(-1, 4)

    @property
    def span_k(self) -> float:
        """Degrees between the coldest and the warmest point."""
        temperatures = self.points[:, 0]
        return float(np.ptp(temperatures)) if len(temperatures) else 0.0

    @property
    def progress(self) -> float:
        """Share of the span that a quadratic needs."""
        return min(1.0, self.span_k / QUADRATIC_FROM_K)

    @property
    def missing(self) -> tuple[str, ...]:
        """Degrees still to go."""
        left = LINEAR_FROM_K - self.span_k
        return (f"{left:.1f} K more, warming or cooling at rest",) if left > 0 else ()

    @property
    def sentence(self) -> str:
        """What to do now."""
        if not self.missing:
            return f"{self.span_k:.1f} K seen; {QUADRATIC_FROM_K:g} K show a curve."
        return "Leave the board lying while it warms up, or let it cool."

    @property
    def done(self) -> bool:
        """Whether there is enough for a line."""
        return not self.missing

    def result(self) -> TemperatureResult:
        """The model, or why there is none."""
        self._work_off()
        return temperature_fit(self.points, self._samples)

    def _work_off(self) -> None:
        rows = self._gathered.rows
        known = rows[np.isfinite(rows["gyr"]).all(axis=1)]
        for span in still_spans(known, AT_REST):
            still = known[span.rows]
            parts = max(1, int((still["t"][-1] - still["t"][0]) / BLOCK_S))
            for part in np.array_split(still, parts):
                if np.isfinite(part["temp_c"]).any():
                    self._points.append(np.array([np.nanmean(part["temp_c"]), *part["gyr"].mean(axis=0)]))
                    self._samples += len(part)
        self._gathered = Gathered()


def temperature_fit(points: Floats, samples: int = 0) -> TemperatureResult:
    """Choose and fit the model for points (n, 4): temperature (degrees C), then bias (rad/s), in order of time."""
    if len(points) == 0:
        return TemperatureResult(False, "No temperature came while the board lay still.")
    span = float(np.ptp(points[:, 0]))
    errors = {0: _held_out(points, 0)}
    order = 0
    for higher, least in ((1, LINEAR_FROM_K), (2, QUADRATIC_FROM_K)):
        if span >= least and len(points) >= 2 * FOLDS:
            errors[higher] = _held_out(points, higher)
            order = higher if errors[higher] < GAIN * errors[order] else order
    model, error = _fitted(points, order), errors[order]
    figures = (model, span, error / DEGREE, errors[0] / DEGREE, samples)
    if span < LINEAR_FROM_K:
        return TemperatureResult(False, f"Only {span:.1f} K of span: the bias is taken as constant.", *figures)
    if order == 0 or error > FITS:
        stray = f"it strays by {error / DEGREE:.3f} deg/s from the best curve"
        return TemperatureResult(False, f"The bias does not follow the temperature: {stray}. Not applied.", *figures)
    kind = ("constant", "linear", "quadratic")[order]
    text = f"{kind.capitalize()} from {model.low_c:.1f} to {model.high_c:.1f} deg C: error {error / DEGREE:.3f} deg/s"
    return TemperatureResult(True, f"{text}, {errors[0] / DEGREE:.3f} without.", *figures)


def _fitted(points: Floats, order: int) -> TemperatureModel:
    temperature = points[:, 0]
    reference = float(np.round(temperature.mean(), 2))
    powers = np.vander(temperature - reference, order + 1, increasing=True)
    coefficients = np.linalg.lstsq(powers, points[:, 1:], rcond=None)[0]
    low, high = float(temperature.min()), float(temperature.max())
    return TemperatureModel(tuple(map(vector, coefficients)), reference, low, high)


def _held_out(points: Floats, order: int) -> float:
    """RMS error, rad/s, of the worst axis on blocks of time left out of the fit in turn."""
    total = np.zeros(3)
    blocks = [block for block in np.array_split(np.arange(len(points)), FOLDS) if len(block)]
    for block in blocks:
        rest = np.delete(points, block, axis=0) if len(blocks) > 1 else points
        model = _fitted(rest, order)
        total += sum((points[k, 1:] - model.bias(float(points[k, 0]))) ** 2 for k in block)
    return float(np.sqrt(total.max() / len(points)))
