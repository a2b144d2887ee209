"""What the page shows of the guided magnetometer calibration."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from imugui.calibration.axes_flow import AxesFlow, FoundAxes
from imugui.calibration.coverage import CELLS, cells_of, directions_from
from imugui.calibration.magnetometer import MagnetometerFlow, MagnetometerResult
from imugui.samples import Rows
from imugui.views.calibrate_look import Figure, Floats, Look, Plot, Verdict
from imugui.views.seed_table import seed_table

UNCHANGED = "+x +y +z"
FULL = 3  # samples that fill a cell
MOST_POINTS = 5000
TONES = {"clean": "good", "suspect": "warn", "contaminated": "bad"}
LIGHTS = {"green": "good", "yellow": "warn", "red": "bad"}


def mag_look(flow: MagnetometerFlow, recent: Rows) -> Look:
    """The raw cloud about the centre of the fit, the cells that are filled, and where to turn next."""
    fit, cloud = flow.fit, flow.cloud(MOST_POINTS)
    if fit is None or not math.isfinite(fit.radius) or fit.radius <= 0.0:
        return Look(levels=np.zeros(CELLS), figures=live_figures(flow), plot=Plot(before=_norms(cloud.seen)))
    return Look(
        levels=levels_of(fit.bias, cloud.kept),
        cloud=(cloud.seen - fit.bias) / fit.radius,
        outliers=(cloud.outliers - fit.bias) / fit.radius,
        centre=fit.bias,
        goal=flow.turn_next if flow.check is None else None,
        plot=Plot(_norms(cloud.seen), _norms(fit.apply(cloud.seen)), fit.radius),
        figures=live_figures(flow),
        level_turn=flow.check is not None,
        can_finish=flow.verdict.accepted and flow.check is None,
        comparison=seed_table(recent, fit, flow.before) if flow.done else (),
    )


def levels_of(centre: Floats, kept: Floats) -> Floats:
    """How full each cell is, (CELLS,), 0 to 1."""
    counts = np.bincount(cells_of(directions_from(centre, kept)), minlength=CELLS) if len(kept) else np.zeros(CELLS)
    return np.minimum(counts / FULL, 1.0)


def live_figures(flow: MagnetometerFlow) -> tuple[Figure, ...]:
    """The figures of the gate, as they stand."""
    now = flow.verdict
    if now.fit is None:
        return ()
    return (
        Figure("Directions seen", f"{100 * now.coverage:.0f} %", "Of 100 cells of equal area"),
        Figure("Largest gap", f"{now.gap_deg:.0f}°", "From the emptiest direction to the nearest sample"),
        Figure("Direction error", _degrees(now.error_deg), "Predicted from where the samples are", LIGHTS[now.light]),
        Figure("Heading error", _degrees(now.heading_deg), "The same, in the horizontal part of the field"),
        Figure("Field", f"{now.radius:.1f} µT, even to {100 * now.residual:.1f} %", "The earth's is 25 to 65 µT"),
        Figure("Left out", f"{100 * now.outliers:.1f} %", "Samples that do not fit the others: crosses in the picture"),
    )


def judge_mag(found: MagnetometerResult, profile: Any) -> Verdict:
    """Clean, suspect or contaminated, and what a heading will be worth in degrees."""
    now = found.verdict
    figures = [
        Figure(
            "Heading error", _degrees(now.heading_deg), "To be expected, at the dip of this place", LIGHTS[now.light]
        ),
        Figure("Direction error", _degrees(now.error_deg), "Of the field's direction, RMS over the sphere"),
        Figure("Directions seen", f"{100 * now.coverage:.0f} %, gap {now.gap_deg:.0f}°", "And the largest hole"),
        Figure("Field", f"{found.field_ut:.1f} µT, even to {100 * now.residual:.1f} %", "After calibration"),
        Figure("Dip", _degrees(found.dip_deg), "Of the field below the horizon, measured with the accelerometer"),
        Figure("Hard iron", ", ".join(f"{value:+.1f}" for value in found.bias) + " µT", "x, y, z"),
        Figure("Axis ratio", f"{now.axis_ratio:.2f}", "Longest to shortest axis of the cloud; 1 is a sphere"),
    ]
    if found.check is not None:
        closing = f"{abs(found.check.closing_deg):.1f}°"
        figures.insert(
            1,
            Figure(
                "Full turn closes to",
                closing,
                "Heading after a whole turn against the gyroscope, whose own scale may be 3 % off: 11°",
            ),
        )
    word = "suspect" if now.accepted and not found.accepted else now.word
    tone, word = TONES.get(word, "bad"), word.capitalize() if word in TONES else "Refused"
    return Verdict(tone, word, found.reason, tuple(figures), can_apply=found.accepted)


def _norms(points: Floats) -> Floats:
    return np.asarray(np.linalg.norm(points, axis=1))


def _degrees(value: float) -> str:
    return "---" if math.isnan(value) else f"{value:.1f}°"


def axes_look(flow: AxesFlow, recent: Rows) -> Look:
    """How far the best map leads."""
    found = flow.result().axes
    if math.isnan(found.best_deg):
        return Look()
    figures = (
        Figure("Best map", found.name, "From the magnetometer's axes to those of the accelerometer"),
        Figure("Its dip spreads by", _degrees(found.best_deg), "The dip must be the same in all attitudes"),
        Figure("Second best", _degrees(found.second_deg), "Of all 24 rotations"),
        Figure("Margin", f"{found.margin:.1f} times", "Second over best; 2.5 is needed"),
    )
    return Look(figures=figures)


def judge_axes(result: FoundAxes, profile: Any) -> Verdict:
    """The map and its margin."""
    found = result.axes
    if not found.accepted:
        return Verdict("bad", "Refused", found.reason)
    right = "The axes are right as they are." if found.name == UNCHANGED else "They are put right by Apply."
    figures = (
        Figure("Dip spreads by", _degrees(found.best_deg), "With the best map"),
        Figure("Second best", _degrees(found.second_deg), "Of all 24 rotations"),
        Figure("As it is now", _degrees(found.identity_deg), "Without a change"),
        Figure("Margin", f"{found.margin:.1f} times", "2.5 is needed"),
    )
    return Verdict("good", "Good", f"{found.reason} {right}", figures, can_apply=True)
