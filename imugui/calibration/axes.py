"""Which axes of the magnetometer and of the gyroscope are which of the accelerometer.

A map is a signed permutation Q: ``vector in the accelerometer's axes = Q @ vector as it came``. An ellipsoid leaves
the rotation open, so a second witness is needed: gravity, to which the field's dip must be the same in all
attitudes. The gyroscope in turn must predict how the field or gravity turns in the board.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import permutations, product

import numpy as np
from numpy.typing import ArrayLike, NDArray

from imugui.calibration.ellipsoid import Floats
from imugui.calibration.flow import Result
from imugui.calibration.steps import cut
from imugui.samples import GRAVITY

MAG_MARGIN = 2.5  # second best over best score, from which a map is believed
GYR_MARGIN = 2.0
QUIET_SHARE = 0.05  # of gravity
QUIET_FEWEST = 100
TILT_SPREAD = 0.01  # smallest scatter of gravity's direction that tells maps apart
STEPS_FEWEST = 40


def _maps() -> dict[str, Floats]:
    """All 48 signed permutations by name: "+y +x -z" makes x from the sensor's y."""
    found = {}
    for order in permutations(range(3)):
        for signs in product((1.0, -1.0), repeat=3):
            matrix = np.zeros((3, 3))
            matrix[range(3), order] = signs
            name = " ".join(("+" if s > 0 else "-") + "xyz"[i] for s, i in zip(signs, order, strict=True))
            found[name] = matrix
    return found


MAPS: dict[str, Floats] = _maps()
PROPER: dict[str, Floats] = {name: matrix for name, matrix in MAPS.items() if np.linalg.det(matrix) > 0.0}


@dataclass(frozen=True, eq=False)
class AxesResult(Result):
    """The best map with its score in degrees, that of the second, and of no change; ``scores`` has all of them."""

    name: str
    matrix: Floats
    best_deg: float
    second_deg: float
    identity_deg: float
    scores: dict[str, float]

    @property
    def margin(self) -> float:
        """Second over best; 1 is a tie."""
        return self.second_deg / max(self.best_deg, 1e-9)


def mag_map(acc: ArrayLike, mag: ArrayLike) -> AxesResult:
    """The magnetometer's map among the 24 proper ones, from calibrated fields (n, 3) and accelerations (n, 3).

    Score: spread of the dip over the samples in which the accelerometer shows gravity alone.
    """
    up, field = quiet_pairs(acc, mag)
    if len(up) < QUIET_FEWEST:
        return _not_enough("There are not enough quiet samples: turn the board slowly and stop now and then.")
    if np.linalg.eigvalsh(up.T @ up / len(up))[0] < TILT_SPREAD:
        return _not_enough("The board has not been tilted to enough sides to tell its axes apart.")
    scores = {name: _spread_deg(up, field @ matrix.T) for name, matrix in PROPER.items()}
    return _best(scores, MAG_MARGIN, "magnetometer")


def gyr_map(t: ArrayLike, gyr: ArrayLike, t_seen: ArrayLike, seen: ArrayLike) -> AxesResult:
    """The gyroscope's map among all 48, by how well it predicts a vector that is fixed in the earth.

    ``t`` (n,) s with rates ``gyr`` (n, 3) rad/s; ``t_seen`` (m,) with ``seen`` (m, 3): the calibrated field, or the
    acceleration of slow motion. Score: robust angle between predicted and seen vector after 0.2 s.
    """
    steps = cut(t, gyr, t_seen, seen)
    if len(steps.turn) < STEPS_FEWEST:
        return _not_enough("The board has not been turned enough to tell the gyroscope's axes.")
    scores = {name: steps.score_deg(matrix) for name, matrix in MAPS.items()}
    return _best(scores, GYR_MARGIN, "gyroscope")


def gravity_direction(acc: ArrayLike) -> tuple[Floats, NDArray[np.bool_]]:
    """Unit vectors up (n, 3) of accelerations (n, 3), and where their size is that of gravity alone (n,)."""
    acc = np.asarray(acc, float)
    size = np.linalg.norm(acc, axis=1)
    return acc / np.maximum(size, 1e-9)[:, None], np.abs(size / GRAVITY - 1.0) < QUIET_SHARE


def quiet_pairs(acc: ArrayLike, mag: ArrayLike) -> tuple[Floats, Floats]:
    """Unit vectors up and of the field, (k, 3) each, at the quiet samples of (n, 3) and (n, 3)."""
    up, quiet = gravity_direction(acc)
    field = np.asarray(mag, float)
    size = np.linalg.norm(field, axis=1)
    good = quiet & (size > 0.0) & np.isfinite(size)
    return up[good], field[good] / size[good, None]


def dip_spread_deg(acc: ArrayLike, mag: ArrayLike) -> float:
    """Standard deviation of the dip in degrees over the quiet samples of (n, 3) and (n, 3); NaN without any."""
    up, field = quiet_pairs(acc, mag)
    return _spread_deg(up, field) if len(up) else np.nan


def _spread_deg(up: Floats, field: Floats) -> float:
    sine = np.clip((up * field).sum(axis=1), -1.0, 1.0)
    return float(np.degrees(np.arcsin(sine).std()))


def _best(scores: dict[str, float], margin: float, what: str) -> AxesResult:
    """The map with the lowest score, accepted when it leads by the margin."""
    (name, best), (second_name, second) = sorted(scores.items(), key=lambda item: item[1])[:2]
    lead = second / max(best, 1e-9)
    if lead < margin:
        reason = (
            f"The {what}'s axes are not clear: {name} fits {lead:.1f} times better than {second_name}, "
            f"{margin:.1f} times is needed."
        )
    else:
        reason = f"The {what}'s axes are {name} in those of the accelerometer ({lead:.1f} times better than any other)."
    return AxesResult(lead >= margin, reason, name, MAPS[name], best, second, scores["+x +y +z"], scores)


def _not_enough(reason: str) -> AxesResult:
    return AxesResult(False, f"Not enough data. {reason}", "+x +y +z", np.eye(3), np.nan, np.nan, np.nan, {})
