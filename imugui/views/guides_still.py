"""What the page shows of the guided calibrations of mounting and temperature."""

from __future__ import annotations

from typing import Any

import numpy as np

from imugui.calibration.mounting import MountingFlow, MountingResult
from imugui.calibration.temperature import QUADRATIC_FROM_K, TemperatureFlow, TemperatureResult
from imugui.samples import Rows
from imugui.views.calibrate_look import Figure, Look, Plot, Verdict

DEGREE = np.pi / 180.0


def mounting_look(flow: MountingFlow, recent: Rows) -> Look:
    """Two attitudes of the box."""
    held = round(2.0 * flow.progress)
    return Look(figures=(Figure("Attitudes held", f"{held} of 2", "Level, then with its nose up"),))


def judge_mounting(found: MountingResult, profile: Any) -> Verdict:
    """How the sensor sits, and how well its direction ahead is known."""
    if not found.accepted:
        return Verdict("bad", "Refused", found.reason)
    figures = (
        Figure("Sensor turned by", f"{found.angle_deg:.1f} deg", "Between the sensor's axes and those of the box"),
        Figure("Ahead known to", f"{found.error_deg:.1f} deg", "How evenly a hand raises the nose"),
    )
    return Verdict("good", "Good" if found.error_deg <= 2.0 else "Usable", found.reason, figures, can_apply=True)


def temperature_look(flow: TemperatureFlow, recent: Rows) -> Look:
    """The bias in 2 s means, in deg/s."""
    points = flow.points
    biases = np.linalg.norm(points[:, 1:] - points[:1, 1:], axis=1) / DEGREE if len(points) else np.empty(0)
    temps = recent["temp_c"][np.isfinite(recent["temp_c"])]
    figures = (
        Figure("Temperature", f"{temps[-1]:.1f} °C" if len(temps) else "not sent by this board", "Of the sensor, now"),
        Figure("Span so far", f"{flow.span_k:.1f} of {QUADRATIC_FROM_K:g} K", "Between the coldest and the warmest"),
        Figure("Means so far", f"{len(points)}", "Of 2 s each, while the board lay still; told twice a minute"),
    )
    return Look(plot=Plot(before=biases), figures=figures)


def judge_temperature(found: TemperatureResult, profile: Any) -> Verdict:
    """Whether the bias follows the temperature, and how well."""
    figures = (
        Figure("Span", f"{found.span_k:.1f} K"),
        Figure("Error with the curve", f"{found.error_dps:.3f} deg/s", "On blocks of time left out of the fit"),
        Figure("Error without", f"{found.constant_error_dps:.3f} deg/s", "With one bias for all temperatures"),
    )
    if not found.accepted:
        return Verdict("bad", "Refused", found.reason, figures)
    return Verdict("good", "Good", found.reason, figures, can_apply=True)
