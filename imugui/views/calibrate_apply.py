"""From the result of a flow to a profile with a new part."""

from __future__ import annotations

import dataclasses

import numpy as np

from imugui.calibration.accelerometer import AccelerometerResult, vector
from imugui.calibration.axes import MAPS
from imugui.calibration.axes_flow import FoundAxes
from imugui.calibration.build import (
    accelerometer_part,
    gyroscope_part,
    magnetometer_part,
    mounting_part,
    temperature_part,
)
from imugui.calibration.magnetometer import MagnetometerResult
from imugui.calibration.mounting import MountingResult
from imugui.calibration.parts import MagnetometerPart
from imugui.calibration.profile import Profile, now_utc
from imugui.calibration.rest import RestResult
from imugui.calibration.temperature import TemperatureResult
from imugui.fusion.correction import Matrix
from imugui.views.calibrate_look import Floats, Look

AXES_METHOD = "while finding the axes"
"""Method of a magnetometer part that is no more than a by-product."""


def apply_rest(profile: Profile, found: RestResult, look: Look) -> Profile:
    """A new gyroscope bias; scale and cross-axis terms that were measured before stay."""
    part, old = gyroscope_part(found), profile.gyroscope
    if old is not None:
        part = dataclasses.replace(part, **old.scale)
    return profile.with_part(part)


def apply_acc(profile: Profile, found: AccelerometerResult, look: Look) -> Profile:
    """A new accelerometer calibration."""
    return profile.with_part(accelerometer_part(found))


def apply_mounting(profile: Profile, found: MountingResult, look: Look) -> Profile:
    """A new mounting."""
    return profile.with_part(mounting_part(found))


def apply_temperature(profile: Profile, found: TemperatureResult, look: Look) -> Profile:
    """A new curve of the bias over temperature."""
    return profile.with_part(temperature_part(found))


def apply_mag(profile: Profile, found: MagnetometerResult, look: Look) -> Profile:
    """A new magnetometer calibration, found in the axes that were known before; with the cells that it saw."""
    axes = profile.magnetometer.axes if profile.magnetometer else ""
    part = magnetometer_part(found, found.bias + look.cloud, axes=axes)
    return profile.with_part(_as_it_comes(part, MAPS.get(axes, np.eye(3))))


def apply_axes(profile: Profile, found: FoundAxes, look: Look) -> Profile:
    """The axes, with the rough magnetometer calibration under which they were found."""
    fit, verdict, matrix = found.verdict.fit, found.verdict, found.axes.matrix
    if fit is None or not found.accepted:
        return profile
    part = MagnetometerPart(
        method=AXES_METHOD,
        date=now_utc(),
        samples=len(verdict.inliers),
        quality="poor",
        verdict=found.reason,
        hard_iron=vector(fit.bias),
        soft_iron=_matrix(matrix @ fit.matrix),
        field_ut=fit.radius,
        predicted_deg=verdict.error_deg,
        residual_percent=100.0 * verdict.residual,
        coverage=verdict.coverage,
        gap_deg=verdict.gap_deg,
        axes=found.axes.name,
    )
    return profile.with_part(part)


def _as_it_comes(part: MagnetometerPart, axes: Floats) -> MagnetometerPart:
    """The same for a field that was not brought into the accelerometer's axes: M (Q h - b) = M Q (h - Q' b)."""
    bias, matrix = axes.T @ np.array(part.hard_iron), np.array(part.soft_iron) @ axes
    return dataclasses.replace(part, hard_iron=vector(bias), soft_iron=_matrix(matrix))


def _matrix(values: Floats) -> Matrix:
    first, second, third = (vector(row) for row in values)
    return first, second, third
