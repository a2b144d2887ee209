"""What the page shows of the guided calibrations of gyroscope and accelerometer."""

from __future__ import annotations

from typing import Any

import numpy as np

from imugui.calibration.accelerometer import AccelerometerResult
from imugui.calibration.accelerometer_flows import AccelerometerFlow
from imugui.calibration.free_fall import FreeFallFlow
from imugui.calibration.positions import FACES, between_faces
from imugui.calibration.profile import Profile
from imugui.calibration.rest import RestFlow, RestResult
from imugui.samples import GRAVITY, Rows
from imugui.views.calibrate_look import Figure, Floats, Look, Plot, Verdict

DEGREE = np.pi / 180.0
MG = GRAVITY / 1000.0
SHOWN = 2000  # newest rows in a plot
NEAR_DEG = 25.0  # a cube's mark is ticked by a position this near
TILT_WORDS = ((0.3, "good", "Good"), (1.0, "good", "Usable"), (float("inf"), "warn", "Rough"))


def rest_look(flow: RestFlow, recent: Rows) -> Look:
    """The rate of turn before and after: at rest it should be zero."""
    found = flow.result()
    recent = recent[-SHOWN:]
    rates = recent["gyr"][np.isfinite(recent["gyr"]).all(axis=1)] / DEGREE
    before = np.linalg.norm(rates, axis=1)
    after = np.linalg.norm(rates - np.array(found.bias) / DEGREE, axis=1) if found.accepted else np.empty(0)
    figures = (Figure("Still for", f"{found.seconds:.1f} s", "The longest still span so far"),)
    return Look(plot=Plot(before, after, 0.0), figures=figures)


def judge_rest(found: RestResult, profile: Profile | None) -> Verdict:
    """The bias with its uncertainty, and what it would have turned the picture by."""
    if not found.accepted:
        return Verdict("bad", "Refused", found.reason)
    bias = np.array(found.bias) / DEGREE
    figures = (
        *(_figure(f"Bias {axis}", f"{value:+.3f} deg/s") for axis, value in zip("xyz", bias, strict=True)),
        _figure("Uncertainty", f"{2 * found.sigma_dps:.3f} deg/s", "Two sigmas of the worst axis"),
        _figure("Turned away by", f"{60 * np.abs(bias).max():.0f} deg/min before", "What the bias cost per minute"),
    )
    return Verdict("good", "Good", found.reason, figures, can_apply=True)


def positions_look(flow: AccelerometerFlow, recent: Rows) -> Look:
    """Six or 26 marks on the cube, ticked by the positions held."""
    held = np.array([position.direction for position in flow.positions]).reshape(-1, 3)
    directions = marks(flow)
    reached = (directions @ held.T > np.cos(NEAR_DEG * DEGREE)).any(axis=1) if len(held) else np.zeros(len(directions))
    goal = None if flow.done or not flow.missing else direction_of(flow.missing[0])
    figures = (Figure("Positions held", f"{len(held)}", "Different attitudes in which the board was still"),)
    return Look(
        directions=directions, reached=reached, goal=goal, figures=figures, plot=_gravity_plot(flow.positions, flow)
    )


def marks(flow: AccelerometerFlow) -> Floats:
    """Directions (n, 3) that the cube shows: its faces, and edges and corners where they are asked for."""
    faces = np.array([sign * np.eye(3)[axis] for axis, sign in FACES.values()])
    if flow.title == "Flat":
        return np.array([faces[list(FACES).index("z up")]])
    return faces if flow.title.startswith("Six") else np.concatenate((faces, between_faces()[0]))


def direction_of(words: str) -> Floats | None:
    """The direction (3,) that is meant by a position in words; None when it is none."""
    ways, names = between_faces()
    for name, (axis, sign) in FACES.items():
        if words.startswith(name):
            face: Floats = sign * np.eye(3)[axis]
            return face
    return np.asarray(ways[names.index(words)]) if words in names else None


def fall_look(flow: FreeFallFlow, recent: Rows) -> Look:
    """The length of the acceleration: it drops to zero in a fall."""
    norms = np.linalg.norm(recent["acc"][-SHOWN:], axis=1) / GRAVITY
    figures = (
        Figure("Falls seen", f"{len(flow.falls)}"),
        Figure("Not used", f"{flow.spinning}", "The board was turning"),
    )
    return Look(plot=Plot(norms[np.isfinite(norms)], np.empty(0), 1.0), figures=figures)


def judge_acc(found: AccelerometerResult, profile: Profile | None) -> Verdict:
    """Residuals in mg, and what they mean for roll and pitch in degrees."""
    if not found.accepted:
        return Verdict("bad", "Refused", found.reason)
    tone, word = next((tone, word) for limit, tone, word in TILT_WORDS if found.tilt_deg <= limit)
    figures = [
        _figure("Tilt error to expect", f"{found.tilt_deg:.2f} deg", "Direction of gravity, RMS over all attitudes")
    ]
    if np.isfinite(found.residual_mg):
        figures.append(
            _figure("Residual", f"{found.residual_mg:.2f} mg", "RMS of the length of gravity over the positions")
        )
    if np.isfinite(found.loo_mg):
        figures.append(_figure("Left out", f"{found.loo_mg:.2f} mg", "Each position under the fit to the others"))
    bias = np.array(found.bias) / MG
    figures.append(_figure("Bias x, y, z", ", ".join(f"{value:+.0f}" for value in bias) + " mg"))
    figures.append(_figure("Positions", f"{found.positions}"))
    old_tilt = profile.tilt_error_deg if profile else float("nan")
    keep = (
        f"The old one leaves {old_tilt:.2f} deg: the new one is not clearly better."
        if old_tilt <= found.tilt_deg
        else ""
    )
    return Verdict(tone, word, found.reason, tuple(figures), can_apply=True, keep=keep)


def _gravity_plot(positions: Any, flow: AccelerometerFlow) -> Plot:
    """The length of gravity in each position, in g."""
    acc = np.array([position.acc for position in positions]).reshape(-1, 3)
    before = np.linalg.norm(acc, axis=1) / GRAVITY
    found = flow.result()
    if not found.accepted:
        return Plot(before, np.empty(0), 1.0)
    after = np.linalg.norm((acc - found.bias) @ np.array(found.matrix).T, axis=1) / GRAVITY
    return Plot(before, after, 1.0)


def _figure(label: str, value: str, tip: str = "") -> Figure:
    return Figure(label, value, tip or label)
