"""The accelerometer's bias, scale and cross-axis terms, in four ways of different worth."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from imugui.calibration.flow import Result
from imugui.calibration.gravity_fit import MG, GravityFit, fit_gravity, leave_one_out, norms, rms
from imugui.calibration.positions import FACES, Position, face_of, missing_faces
from imugui.calibration.stillness import DEGREE, Floats
from imugui.fusion.correction import Matrix, Vector
from imugui.samples import GRAVITY

FLAT_TILT_DEG = 7.0
"""One position leaves 2.5 to 7 deg elsewhere (real: 44 and 127 mg)."""
CROSS_TILT_DEG = 0.8
"""What cross-axis terms leave when they are not measured (real: 1.9 and 13.8 mg with six faces)."""
FEWEST, FEWEST_FULL = 6, 9
LARGEST_RESIDUAL_MG = 30.0
"""Beyond this the positions were not still, or the unit is wrong."""
LARGEST_TILT_DEG = 2.0

ZERO: Vector = (0.0, 0.0, 0.0)
UNIT: Matrix = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
NAN = float("nan")


@dataclass(frozen=True)
class AccelerometerResult(Result):
    """corrected = matrix @ (raw - bias), bias in m/s2; what it leaves, in mg and in degrees of tilt."""

    method: str = ""
    bias: Vector = ZERO
    matrix: Matrix = UNIT
    residual_mg: float = NAN  # RMS over the positions used
    loo_mg: float = NAN  # RMS, each position under the fit to the others
    tilt_deg: float = NAN  # direction error to expect, RMS over all attitudes
    positions: int = 0
    samples: int = 0
    directions: tuple[Vector, ...] = ()  # unit vectors that pointed up, sensor axes
    temp_c: float = NAN


def flat(positions: Sequence[Position]) -> AccelerometerResult:
    """Bias only, from the last position held, taken for exactly level: seeds 000 and 004 did this."""
    if not positions:
        return AccelerometerResult(False, "The board was not still yet. Lay it flat and let go of it.")
    last = positions[-1]
    face = face_of(last.acc)
    if not face:
        return AccelerometerResult(False, "No side of the board points up. Lay it flat.")
    axis, sign = FACES[face]
    bias = last.acc - sign * GRAVITY * np.eye(3)[axis]
    if np.abs(bias).max() > 0.3 * GRAVITY:
        return AccelerometerResult(False, f"An error of {np.abs(bias).max() / MG:.0f} mg is no bias: lay it level.")
    text = f"Bias with {face}. It takes the table's tilt for an error of the sensor: up to {FLAT_TILT_DEG:g} deg wrong."
    return _made("flat", text, np.eye(3), bias, [last], tilt_deg=FLAT_TILT_DEG)


def six(positions: Sequence[Position]) -> AccelerometerResult:
    """Bias and scale of each axis from its reading up and down; the faces may come in any order."""
    missing = missing_faces(positions)
    if missing:
        return AccelerometerResult(False, f"Missing: {', '.join(missing)}.")
    reading = np.array([_best(positions, face) for face in FACES]).reshape(3, 2)  # up, down of each axis
    bias, scale = reading.mean(axis=1), 2 * GRAVITY / (reading[:, 0] - reading[:, 1])
    tilt = max(CROSS_TILT_DEG, rms(_residuals(np.diag(scale), bias, positions)) / GRAVITY / DEGREE)
    text = f"Six faces: bias and scale. Cross-axis terms stay unknown: about {tilt:.1f} deg of tilt."
    return _judged(_made("six", text, np.diag(scale), bias, positions, tilt_deg=tilt))


def many(positions: Sequence[Position]) -> AccelerometerResult:
    """9 parameters from 9 or more positions, 6 from 6 to 8 (Tedaldi 2014); no jig and no exact faces needed."""
    if len(positions) < FEWEST:
        return AccelerometerResult(False, f"{len(positions)} positions; at least {FEWEST} are needed, better 12.")
    fit = fit_positions(positions)
    loo_mg = rms(leave_one_out(fit)) / MG
    predicted = fit.predicted_tilt / DEGREE
    # what is not fitted is not in the prediction, but shows in the positions left out
    unseen = max(CROSS_TILT_DEG, float(np.nan_to_num(loo_mg)) * 1e-3 / DEGREE)
    tilt = predicted if fit.parameters == 9 else max(predicted, unseen)
    text = f"{len(positions)} positions, {fit.parameters} parameters: "
    if np.isfinite(loo_mg):
        text += f"residual {fit.residual_mg:.2f} mg, left out {loo_mg:.2f} mg"
    else:
        text += "none to spare for a check"
    text += f"; tilt to about {max(tilt, 0.01):.2f} deg."
    return _judged(_made("many", text, fit.matrix, fit.bias, positions, loo_mg=loo_mg, tilt_deg=tilt))


def fit_positions(positions: Sequence[Position]) -> GravityFit:
    """As many parameters as the positions bear: 9 from nine, else 6."""
    acc = np.array([position.acc for position in positions])
    return fit_gravity(acc, 9 if len(acc) >= FEWEST_FULL else 6)


SOLVERS: dict[str, Callable[[Sequence[Position]], AccelerometerResult]] = {"flat": flat, "six": six, "many": many}


def _best(positions: Sequence[Position], face: str) -> float:
    """The reading of a face's axis in the position that shows this face best."""
    axis, sign = FACES[face]
    return float(max((p for p in positions if p.face == face), key=lambda p: sign * p.direction[axis]).acc[axis])


def _residuals(matrix: Floats, bias: Floats, positions: Sequence[Position]) -> Floats:
    return norms(matrix, bias, np.array([position.acc for position in positions])) - GRAVITY


def _made(
    method: str,
    text: str,
    matrix: Floats,
    bias: Floats,
    positions: Sequence[Position],
    *,
    loo_mg: float = NAN,
    tilt_deg: float,
) -> AccelerometerResult:
    return AccelerometerResult(
        True,
        text,
        method,
        vector(bias),
        (vector(matrix[0]), vector(matrix[1]), vector(matrix[2])),
        rms(_residuals(matrix, bias, positions)) / MG,
        loo_mg,
        float(tilt_deg),
        len(positions),
        sum(position.samples for position in positions),
        tuple(vector(np.round(position.direction, 4)) for position in positions),
    )


def _judged(result: AccelerometerResult) -> AccelerometerResult:
    """The same, or a refusal when the values cannot be a sensor's."""
    problems = []
    if result.residual_mg > LARGEST_RESIDUAL_MG or result.loo_mg > LARGEST_RESIDUAL_MG:
        worst = np.nanmax([result.residual_mg, result.loo_mg])
        problems.append(f"the positions disagree by {worst:.0f} mg: some were not still, or the unit is wrong")
    if np.abs(np.array(result.matrix) - np.eye(3)).max() > 0.5 or np.abs(result.bias).max() > 0.5 * GRAVITY:
        problems.append("scale or bias is beyond what a sensor can have: is the unit right?")
    if result.tilt_deg > LARGEST_TILT_DEG:
        problems.append(f"the positions are too alike: {result.tilt_deg:.1f} deg of tilt stay open")
    if not problems:
        return result
    return AccelerometerResult(False, f"Refused: {'; '.join(problems)}.", result.method, positions=result.positions)


def vector(values: Floats) -> Vector:
    """A (3,) array as a tuple of floats."""
    x, y, z = np.asarray(values, float).tolist()
    return x, y, z
