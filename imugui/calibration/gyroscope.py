"""Scale and cross-axis terms of the gyroscope: from turns between still positions, or from whole turns."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from imugui.calibration.accelerometer import NAN, UNIT, vector
from imugui.calibration.flow import Result
from imugui.calibration.stillness import DEGREE, Floats
from imugui.calibration.turns import Turn, gravity_errors, padded
from imugui.fusion.correction import Correction, Matrix

FEWEST_TURNS = 15
"""With 9 turns the 3x3 fits and does not predict (real: 3.3 deg left out against 3.3 with three scales)."""
LARGEST_TERM = 0.15
ROUNDS = 8
WHOLE_TURN = 2 * np.pi
ON_ONE_AXIS = 0.9
"""Share of all the turning that must go one way about one axis."""
TURN_TOLERANCE = 0.12
"""A whole turn may read this much too large or too small: datasheets allow 3 %, people 1 %."""


@dataclass(frozen=True)
class GyroscopeResult(Result):
    """corrected = matrix @ (raw - bias), the bias being that of ``rest``; errors in degrees per turn."""

    method: str = ""
    matrix: Matrix = UNIT
    nominal_deg: float = NAN  # RMS error of gravity's direction after a turn, without the matrix
    error_deg: float = NAN  # with it
    loo_deg: float = NAN  # with it, each turn left out
    turns: int = 0
    angles_deg: tuple[float, ...] = ()  # what whole turns read


def gyroscope_matrix(turns: Sequence[Turn], acc: Correction) -> GyroscopeResult:
    """The 3x3 that makes the turns carry gravity to where the accelerometer, corrected by ``acc``, sees it.

    Accepted with 15 turns or more, and only if it predicts turns that were left out better than nominal scales do
    (D. Tedaldi, A. Pretto, E. Menegatti, ICRA 2014, equations 11 to 14).
    """
    if len(turns) < FEWEST_TURNS:
        text = (
            f"{len(turns)} turns between still positions; {FEWEST_TURNS} are needed for the scale and cross-axis terms."
        )
        return GyroscopeResult(False, text + " The bias alone is used.", turns=len(turns))
    steps, before, after = padded(turns), _up(turns, "before", acc), _up(turns, "after", acc)
    nominal = _degrees(gravity_errors(steps, np.eye(3), before, after))
    matrix = _fitted(steps, before, after)
    error = _degrees(gravity_errors(steps, matrix, before, after))
    left_out = _degrees(gravity_errors(steps, _without_each(steps, matrix, before, after), before, after))
    figures = (_rms(nominal), _rms(error), _rms(left_out), len(turns))
    text = f"{len(turns)} turns: gravity off by {figures[0]:.2f} deg nominal, {figures[1]:.2f} fitted"
    text += f", {figures[2]:.2f} left out."
    if np.abs(matrix - np.eye(3)).max() > LARGEST_TERM:
        return GyroscopeResult(False, f"{text} Refused: no sensor is that far off.", "turns", UNIT, *figures)
    if figures[2] >= figures[0]:
        return GyroscopeResult(False, f"{text} No gain: the bias alone is used.", "turns", UNIT, *figures)
    return GyroscopeResult(True, text, "turns", _matrix(matrix), *figures)


def whole_turns(turns: Sequence[Turn]) -> dict[int, list[float]]:
    """What the whole turns (360 deg) about single axes read, rad, by axis."""
    found: dict[int, list[float]] = {}
    for turn in turns:
        total, path = np.abs(turn.total), float(np.linalg.norm(turn.steps, axis=1).sum())
        axis = int(total.argmax())
        if total[axis] >= ON_ONE_AXIS * path and _whole(total[axis]):
            found.setdefault(axis, []).append(float(total[axis]))
    return found


def scale_from_whole_turns(read: dict[int, list[float]]) -> GyroscopeResult:
    """Three scales from turns of exactly 360 deg about each axis (F. Ferraris et al., Sensors and Materials 7, 1995).

    ``read``: what each turn read, rad, by axis. An axis without a turn keeps its nominal scale. The hand's own error
    at the table's edge goes in: 1 % for 3.6 deg.
    """
    if not read:
        return GyroscopeResult(False, "No whole turn about one axis was seen: turn by 360 deg against a straight edge.")
    measured = {axis: float(np.mean(values)) for axis, values in read.items()}
    scale = np.ones(3)
    for axis, value in measured.items():
        scale[axis] = WHOLE_TURN / value
    words = ", ".join(f"{'xyz'[axis]} {measured[axis] / DEGREE:.0f}" for axis in sorted(measured))
    wrong = [axis for axis, value in measured.items() if not _whole(value)]
    angles = tuple(round(measured.get(axis, NAN) / DEGREE, 2) for axis in range(3))
    count = sum(map(len, read.values()))
    if wrong:
        text = f"Turns of 360 deg read {words}: too far off for a scale. Was it one whole turn?"
        return GyroscopeResult(False, text, "whole turns", turns=count, angles_deg=angles)
    text = f"Turns of 360 deg read {words} deg. Turning by hand against an edge: 1 % for each 3.6 deg of error."
    return GyroscopeResult(True, text, "whole turns", _matrix(np.diag(scale)), turns=count, angles_deg=angles)


def _whole(turned: float) -> bool:
    return abs(turned / WHOLE_TURN - 1) <= TURN_TOLERANCE


def _up(turns: Sequence[Turn], which: str, acc: Correction) -> Floats:
    """Corrected directions of gravity (m, 3), unit vectors."""
    raw = np.array([getattr(turn, which) for turn in turns])
    corrected = (raw - acc.acc_bias) @ np.array(acc.acc_matrix).T
    return np.asarray(corrected / np.linalg.norm(corrected, axis=1, keepdims=True))


def _slopes(steps: Floats, matrix: Floats, before: Floats, after: Floats) -> Floats:
    """Derivatives (m, 3, 9) of the gravity errors by the terms of the matrix, by central differences."""
    columns = []
    for k in range(9):
        change = np.zeros(9)
        change[k] = 1e-4
        pair = [gravity_errors(steps, matrix + s * change.reshape(3, 3), before, after) for s in (1, -1)]
        columns.append((pair[0] - pair[1]) / 2e-4)
    return np.stack(columns, axis=-1)


def _fitted(steps: Floats, before: Floats, after: Floats) -> Floats:
    """Gauss-Newton from the nominal scales."""
    matrix = np.eye(3)
    for _ in range(ROUNDS):
        slopes = _slopes(steps, matrix, before, after).reshape(-1, 9)
        error = gravity_errors(steps, matrix, before, after).reshape(-1)
        step = np.linalg.lstsq(slopes, -error, rcond=None)[0]
        matrix = matrix + step.reshape(3, 3)
        if np.abs(step).max() < 1e-7:
            break
    return matrix


def _without_each(steps: Floats, matrix: Floats, before: Floats, after: Floats) -> Floats:
    """The matrices (m, 3, 3) that the fit would give without each turn: one Gauss-Newton step from the whole fit."""
    slopes = _slopes(steps, matrix, before, after)
    error = gravity_errors(steps, matrix, before, after)
    others = []
    for k in range(len(steps)):
        part, rest = np.delete(slopes, k, axis=0).reshape(-1, 9), np.delete(error, k, axis=0).reshape(-1)
        others.append(matrix + np.linalg.lstsq(part, -rest, rcond=None)[0].reshape(3, 3))
    return np.array(others)


def _degrees(errors: Floats) -> Floats:
    """Chords between unit vectors (m, 3) as angles (m,), degrees."""
    return np.asarray(2 * np.arcsin(np.minimum(1.0, np.linalg.norm(errors, axis=1) / 2)) / DEGREE)


def _rms(values: Floats) -> float:
    return float(np.sqrt(np.mean(values**2)))


def _matrix(values: Floats) -> Matrix:
    return vector(values[0]), vector(values[1]), vector(values[2])
