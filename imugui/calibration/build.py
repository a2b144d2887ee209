"""From the verdicts of the flows to the parts of a profile."""

from __future__ import annotations

import numpy as np

from imugui.calibration.accelerometer import AccelerometerResult, vector
from imugui.calibration.coverage import cells_of, directions_from
from imugui.calibration.flow import Result
from imugui.calibration.gyroscope import GyroscopeResult
from imugui.calibration.magnetometer import MagnetometerResult
from imugui.calibration.mounting import MountingResult
from imugui.calibration.noise import NoiseResult
from imugui.calibration.parts import (
    LONGEST_TEXT,
    NANS,
    UNIT,
    AccelerometerPart,
    GyroscopePart,
    MagnetometerPart,
    MountingPart,
    NoisePart,
    TemperaturePart,
)
from imugui.calibration.profile import now_utc
from imugui.calibration.rest import RestResult
from imugui.calibration.stillness import Floats
from imugui.calibration.temperature import TemperatureResult

GYR_DPS, TILT_DEG, FIELD_DEG = (0.02, 0.1), (0.2, 1.0), (1.0, 2.0)
MOUNTING_DEG, TEMPERATURE_DPS = (1.5, 3.0), (0.02, 0.05)
"""Largest figures that are called good and usable."""
SEEN = 0.1
"""A field counts as seen when its corrected length is off by less than this share."""


def gyroscope_part(rest: RestResult, matrix: GyroscopeResult | None = None, date: str = "") -> GyroscopePart:
    """The bias of an accepted rest, with the matrix if one was accepted; ValueError for a refused rest."""
    _accepted(rest)
    used = matrix if matrix and matrix.accepted else None
    return GyroscopePart(
        "at rest",
        date or now_utc(),
        rest.temp_c,
        rest.samples,
        _quality(2 * rest.sigma_dps, GYR_DPS),
        _words(f"{rest.reason} {matrix.reason if matrix else ''}"),
        rest.bias,
        rest.sigma,
        used.matrix if used else UNIT,
        used.method if used else "",
        used.loo_deg if used else float("nan"),
    )


def accelerometer_part(found: AccelerometerResult, date: str = "") -> AccelerometerPart:
    """The part of an accepted accelerometer result; ValueError for a refused one."""
    _accepted(found)
    quality = _quality(found.tilt_deg, TILT_DEG)
    head = (found.method, date or now_utc(), found.temp_c, found.samples, quality, _words(found.reason))
    figures = (found.residual_mg, found.loo_mg, found.tilt_deg)
    return AccelerometerPart(*head, found.bias, found.matrix, *figures, found.directions)


def magnetometer_part(
    found: MagnetometerResult, points: Floats, temp_c: float = float("nan"), axes: str = "", date: str = ""
) -> MagnetometerPart:
    """The part of an accepted magnetometer result; ``points`` (n, 3) are the raw fields, uT; ValueError if refused."""
    _accepted(found)
    verdict = found.verdict
    quality = _quality(verdict.error_deg, FIELD_DEG)
    matrix = np.asarray(found.matrix, float)
    return MagnetometerPart(
        found.method,
        date or now_utc(),
        temp_c,
        found.samples,
        quality,
        _words(found.reason),
        vector(found.bias),
        (vector(matrix[0]), vector(matrix[1]), vector(matrix[2])),
        float(found.field_ut),
        float(found.dip_deg),
        float(verdict.error_deg),
        100 * float(verdict.residual),
        float(verdict.coverage),
        float(verdict.gap_deg),
        axes,
        _cells(found, points),
    )


def mounting_part(found: MountingResult, date: str = "") -> MountingPart:
    """The part of an accepted mounting; ValueError for a refused one."""
    _accepted(found)
    quality = _quality(found.error_deg, MOUNTING_DEG)
    head = ("level, nose up", date or now_utc(), float("nan"), found.samples, quality, _words(found.reason))
    return MountingPart(*head, found.quat, found.error_deg)


def temperature_part(found: TemperatureResult, date: str = "") -> TemperaturePart:
    """The part of an accepted temperature model; ValueError for a refused one."""
    _accepted(found)
    if found.model is None:
        raise ValueError("no model")
    model = found.model
    quality = _quality(found.error_dps, TEMPERATURE_DPS)
    method = ("constant", "linear", "quadratic")[model.order]
    head = (method, date or now_utc(), model.reference_c, found.samples, quality, _words(found.reason))
    return TemperaturePart(*head, model.coefficients, model.reference_c, model.low_c, model.high_c, found.error_dps)


def noise_part(found: NoiseResult, date: str = "") -> NoisePart:
    """The part of accepted noise figures; ValueError for refused ones."""
    _accepted(found)
    white = all(one is None or one.is_white for one in (found.gyr, found.acc))
    quality = "good" if white else "usable"
    head = ("Allan deviation", date or now_utc(), float("nan"), found.samples, quality, _words(found.reason))
    pairs = [(one.white, one.instability) if one else (NANS, NANS) for one in (found.gyr, found.acc)]
    return NoisePart(*head, found.rate_hz, *pairs[0], *pairs[1])


def _cells(found: MagnetometerResult, points: Floats) -> tuple[int, ...]:
    """The cells of calibration.coverage in which there is a raw field (n, 3) that the fit does not call an outlier."""
    length = np.linalg.norm((points - found.bias) @ np.transpose(found.matrix), axis=1)
    inside = np.abs(length / found.field_ut - 1.0) < SEEN
    return tuple(np.unique(cells_of(directions_from(found.bias, points[inside]))).tolist())


def _accepted(result: Result) -> None:
    if not result.accepted:
        raise ValueError(f"refused: {result.reason}")


def _quality(figure: float, limits: tuple[float, float]) -> str:
    return "good" if figure <= limits[0] else "usable" if figure <= limits[1] else "poor"


def _words(text: str) -> str:
    return " ".join(text.split())[:LONGEST_TEXT]
