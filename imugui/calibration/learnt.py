"""What imugui's own filter has learnt of the gyroscope in motion, kept in the profile as a better start.

The filter is fed ``w' = R K (w - b0)``: raw rates w, corrected by the profile's matrix K and bias b0, turned by the
mounting R. It turns by ``(1 + M) w' - b``. The same with nothing left to learn is ``R K1 (w - b1)`` with

    K1 = R' (1 + M) R K    and    b1 = b0 + K1^-1 R' b

so what was learnt goes into the profile whole, and every filter has it. The own filter starts from there as it always
starts, with M = 0 give or take its first uncertainty, and widens that where it is contradicted.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from datetime import UTC, datetime

import numpy as np
from numpy.typing import NDArray

from imugui.calibration.parts import NAN, UNIT, ZERO, GyroscopePart
from imugui.calibration.profile import SCALE_K, SCALE_LIFE_DAYS, Profile, now_utc
from imugui.fusion.correction import Correction, Matrix, Vector
from imugui.fusion.quaternion import to_matrix
from imugui.samples import Rows

METHOD = "learnt in motion by the imugui filter"
SHORTEST_S = 20.0
LARGEST_SIGMA = 0.004
LARGEST_SHARE = 0.75
"""Of the first uncertainty: less has to be left of it, or little was seen of some element."""
LARGEST_PULL = 0.003
"""By how much the first uncertainty may hold what was learnt back towards nothing."""
LARGEST_TILT_DEG = 0.5
"""What the accelerometer may leave: its cross-axis terms pass for the gyroscope's, and 0.5 deg are 0.9 %."""
LARGEST_TERM = 0.15
LARGEST_BIAS = math.radians(25.0)
REST_S = 2.0
BIAS_SIGMAS = math.radians(0.02), math.radians(0.05)
"""rad/s; a bias that is better known than these is good, and usable without any rest."""
FRESH_S, FRESH_K = 3600.0, 5.0
"""For how long, and in which range of temperatures, a bias measured at rest does not move by much."""
DRIFT = math.radians(0.01)
"""rad/s; what such a bias may have moved all the same."""
WORST_TURN_SHARE = 90.0
"""degrees: the turn to which a guided calibration's error of a turn belongs."""
FAST, STRONG = 3.4, 15.0
"""rad/s and m/s2: a sensor that is clipped reads at least that much."""

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Learnt:
    """What the filter knew at one moment: rate = matrix @ corrected - bias, of rates corrected by ``correction``.

    Sigmas are 1 sigma: of the worst element of the matrix, now and at first, and of the bias, rad/s. ``seconds`` it
    has learnt, ``rest_s`` of them at rest. ``note`` says why another filter has taken over, ``clipped`` that a sensor
    has reached the end of its range since.
    """

    correction: Correction = Correction()  # noqa: RUF009  (frozen)
    matrix: Matrix = UNIT
    bias: Vector = ZERO
    matrix_sigma: float = NAN
    first_sigma: float = NAN
    bias_sigma: Vector = ZERO
    note: str = ""
    seconds: float = 0.0
    rest_s: float = 0.0
    samples: int = 0
    clipped: bool = False
    temp_c: float = NAN
    refusal: str = ""  # why it cannot be kept, "" when it can

    @property
    def scale(self) -> float:
        """The largest error of a scale, with its sign, as a share."""
        return max((self.matrix[k][k] - 1.0 for k in range(3)), key=abs)

    @property
    def misalignment(self) -> float:
        """The largest of the other elements, as a share: the tangent of an angle."""
        return max(abs(self.matrix[j][k]) for j in range(3) for k in range(3) if j != k)


def folded(learnt: Learnt) -> tuple[Matrix, Vector]:
    """K1 (3, 3) and b1 (3,), rad/s: the gyroscope's correction with what was learnt in it; see the module."""
    correction = learnt.correction
    mounting = to_matrix(correction.mounting)
    matrix = mounting.T @ np.array(learnt.matrix) @ mounting @ np.array(correction.gyr_matrix)
    bias = np.array(correction.gyr_bias) + np.linalg.solve(matrix, mounting.T @ np.array(learnt.bias))
    first, second, third = (_vector(row) for row in matrix)
    return (first, second, third), _vector(bias)


def refusal(learnt: Learnt, profile: Profile, factory: bool = False, now: datetime | None = None) -> str:
    """Why what was learnt cannot be kept in the board's profile, in a sentence; "" when it can.

    ``factory``: the accelerometer counts as calibrated without a profile. The magnetometer need not be: a field that
    changes as the board turns is not followed (docs/calibration.md has figures).
    """
    return (
        _unfit(learnt, profile, factory)
        or _untrue(learnt)
        or _unobserved(learnt)
        or _no_better(learnt, profile.gyroscope, now or datetime.now(UTC))
        or _no_bias(learnt, profile.gyroscope)
    )


def kept_part(learnt: Learnt, earlier: GyroscopePart | None = None, date: str = "") -> GyroscopePart:
    """The gyroscope's part with what was learnt in it; ``earlier`` keeps its bias where that is better known."""
    date = date or now_utc()
    matrix, bias = folded(learnt)
    part = earlier
    if part is None or not _better_bias(part, learnt, date):
        sigma = max(learnt.bias_sigma)
        quality = "good" if 2.0 * sigma <= BIAS_SIGMAS[0] else "usable" if sigma <= BIAS_SIGMAS[1] else "poor"
        words = f"Bias known to {math.degrees(2.0 * sigma):.3f} deg/s (2 sigma) after {learnt.seconds:.0f} s."
        head = (METHOD, date, learnt.temp_c, learnt.samples, quality, words)
        part = GyroscopePart(*head, bias, learnt.bias_sigma)
    return replace(
        part,
        matrix=matrix,
        matrix_method=METHOD,
        turn_error_deg=NAN,
        matrix_sigma=learnt.matrix_sigma,
        matrix_date=date,
        matrix_temp_c=learnt.temp_c,
    )


class Clipping:
    """Notices a sensor that has reached the end of its range: twice in a row the largest value it ever gave."""

    def __init__(self) -> None:
        self.seen = False
        self._tops = {"gyr": FAST, "acc": STRONG}

    def feed(self, rows: Rows) -> None:
        """Take raw SAMPLE rows, shape (n,)."""
        for name, top in self._tops.items():
            values = rows[name]
            size = np.abs(values)
            largest = float(np.max(size, initial=0.0, where=np.isfinite(size)))
            if largest >= top:
                same = values[1:] == values[:-1]
                # a board that sends a sample twice repeats all of it
                self.seen |= bool((same & (size[1:] == largest) & ~same.all(axis=1)[:, None]).any())
                self._tops[name] = largest


def _unfit(learnt: Learnt, profile: Profile, factory: bool) -> str:
    if learnt.note:
        return "Another filter has taken over: nothing is learnt now."
    tilt_deg = profile.tilt_error_deg
    if math.isnan(tilt_deg) and not factory:
        return "Calibrate the accelerometer first: its errors pass for the gyroscope's."
    if tilt_deg > LARGEST_TILT_DEG:
        return f"Calibrate the accelerometer better first: its {tilt_deg:.1f} deg pass for the gyroscope's."
    if learnt.clipped:
        return "A sensor has reached the end of its range. Connect again, and turn the board more slowly."
    return ""


def _unobserved(learnt: Learnt) -> str:
    if learnt.seconds < SHORTEST_S:
        return f"{learnt.seconds:.0f} of {SHORTEST_S:.0f} s so far. Turn the board about all its axes."
    limit = min(LARGEST_SIGMA, LARGEST_SHARE * learnt.first_sigma)
    if not learnt.matrix_sigma <= limit:
        known = f"known to {100 * learnt.matrix_sigma:.2f} %, {100 * limit:.2f} % is needed"
        return f"Not seen well enough yet: {known}. Turn the board about all its axes."
    if _pull(learnt) > LARGEST_PULL:
        return "Not seen well enough yet: more is wrong than was expected. Turn the board about all its axes."
    return ""


def _pull(learnt: Learnt) -> float:
    """How far what was learnt falls short: of an error e the filter has found (1 - r) e, with r = s^2 / f^2.

    s is the sigma now and f that at first, which is a measurement "nothing, give or take f" of weight 1 / f^2.
    """
    share = (learnt.matrix_sigma / learnt.first_sigma) ** 2
    largest = float(np.abs(np.array(learnt.matrix) - np.eye(3)).max())
    return share / (1.0 - share) * largest


def _untrue(learnt: Learnt) -> str:
    matrix, bias = folded(learnt)
    if not np.isfinite([*np.ravel(matrix), *bias, *learnt.bias_sigma]).all():
        return "The filter's numbers have failed."
    if np.abs(np.array(matrix) - np.eye(3)).max() > LARGEST_TERM or np.abs(bias).max() > LARGEST_BIAS:
        return "No gyroscope is that far off: is the sensor family right?"
    return ""


def _no_better(learnt: Learnt, part: GyroscopePart | None, now: datetime) -> str:
    """A matrix that is as well known stays, unless it is old, another temperature's, or contradicted."""
    if part is None or not part.matrix_method:
        return ""
    known = part.matrix_sigma
    if math.isnan(known) and not math.isnan(part.turn_error_deg):
        known = part.turn_error_deg / WORST_TURN_SHARE
    old = (now - part.matrix_when()).days > SCALE_LIFE_DAYS or abs(learnt.temp_c - part.matrix_temp_c) > SCALE_K
    apart = float(np.abs(np.array(learnt.matrix) - np.eye(3)).max())
    if old or not known <= learnt.matrix_sigma or apart > 3.0 * math.hypot(known, learnt.matrix_sigma):
        return ""
    return f"The profile's scale is as well known: to {100 * known:.2f} %."


def _no_bias(learnt: Learnt, part: GyroscopePart | None) -> str:
    if part is not None or _bias_known(learnt):
        return ""
    return "The bias is not known well enough: let the board lie still for a moment."


def _bias_known(learnt: Learnt) -> bool:
    return learnt.rest_s >= REST_S or max(learnt.bias_sigma) <= BIAS_SIGMAS[1]


def _better_bias(part: GyroscopePart, learnt: Learnt, date: str) -> bool:
    """Does the earlier bias stay? It must be fresh, and better known than the one that was learnt."""
    if not _bias_known(learnt):
        return True
    age_s = (datetime.fromisoformat(date) - part.when()).total_seconds()
    if age_s > FRESH_S or abs(learnt.temp_c - part.temp_c) > FRESH_K:
        return False
    return math.hypot(max(part.sigma), DRIFT) < max(learnt.bias_sigma)


def _vector(values: Floats) -> Vector:
    x, y, z = values.tolist()
    return x, y, z
