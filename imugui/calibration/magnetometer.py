"""The guided magnetometer calibration: turn the board to all sides, then once around to check.

Progress is coverage of the sphere: a sample counts only when the field has moved on, so holding still gains nothing.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from imugui.calibration.alignment import FineResult, fine_rotation
from imugui.calibration.check_turn import CheckResult, CheckTurn
from imugui.calibration.coverage import CELLS, NEAREST, CellBuffer, cells_of, directions_from, newest_of_each
from imugui.calibration.ellipsoid import FEWEST, Ellipsoid, Floats, robust_sphere, scaled, spread
from imugui.calibration.flow import Result
from imugui.calibration.gate import TYPICAL_DIP_DEG, TYPICAL_UT, Verdict, judge, plausible, refusal
from imugui.calibration.geometric import Prior
from imugui.calibration.heldout import Comparison, compare
from imugui.calibration.turning import turn_next
from imugui.fusion.correction import Correction
from imugui.samples import GRAVITY, Rows

REFIT_S = 1.0  # s of sample time between fits
ENOUGH_COVERAGE = 0.7
FULL_FIT_COVERAGE = 0.3  # below this the fit that is shown is a sphere
LOOKED_ABOUT = 0.3  # coverage from which a wrong field is blamed on a magnet, no longer on too little turning
TURNING_SHARE = 0.9  # of the progress; the rest is the check
HISTORY = 20_000  # measurements kept for the last fit and the picture
RECENT = 300  # of them judged while nothing is kept
DEEP = 60  # of them per cell in the last fit
LARGEST_FIELD = 1e5  # uT; more is no measurement
QUIET_ACC = 0.05  # of gravity: below this departure the accelerometer shows the vertical
QUIET_COUNT = 20
OUTLIER_SCALES = 4.685


@dataclass(frozen=True, eq=False)
class Cloud:
    """Raw points to show (each (k, 3), uT, sensor frame): all that came, those kept for the fit, outliers left out."""

    seen: Floats
    kept: Floats
    outliers: Floats


@dataclass(frozen=True, eq=False)
class MagnetometerResult(Result):
    """Values to apply when ``accepted``: corrected = matrix @ (raw - bias), in uT; and all that led to them."""

    bias: Floats
    matrix: Floats
    field_ut: float
    dip_deg: float  # measured with the accelerometer where it was quiet; NaN when it was not
    dip_spread_deg: float
    samples: int
    method: str
    temp_c: float  # mean over the turning; NaN without a thermometer
    cells: tuple[int, ...]  # numbers of the direction cells that were seen
    verdict: Verdict
    alignment: FineResult | None = None  # turned into the gyroscope's axes; already in ``matrix`` when accepted
    check: CheckResult | None = None
    comparison: Comparison | None = None  # with the calibration in force before, when there was one

    def correction(self, before: Correction) -> Correction:
        """The correction in force before, with this magnetometer."""
        return _with_mag(before, self.bias, self.matrix)


class MagnetometerFlow:
    """Collects, fits once a second, tells where to turn next, and checks. See ``flow.Flow``.

    ``field_ut`` and ``dip_deg``: what is expected at the place (a model or the user's figure), None when unknown.
    ``before``: the correction in force; its magnetometer is kept unless the new one is clearly better.
    """

    title = "Magnetometer"

    def __init__(
        self, field_ut: float | None = None, dip_deg: float | None = None, before: Correction | None = None
    ) -> None:
        self.field_ut, self.dip_deg = field_ut, dip_deg
        self.before = before or Correction()
        self.buffer = CellBuffer(field_ut or TYPICAL_UT)
        self.verdict = refusal(np.zeros((0, 3)), "Turn the board slowly in all directions.")
        self.check: CheckTurn | None = None
        self._history: Floats = np.zeros((0, 7))  # raw field (uT), acceleration (m/s2), time (s); oldest first
        self._last: Floats = np.full(3, np.nan)
        self._place: Floats = np.full(3, np.inf)  # where the last sample was kept
        self._moved = False  # since the last fit
        self._next_fit = -np.inf
        self._rates: Floats = np.zeros((0, 4))  # time (s) and raw rate (rad/s) of every row while turning
        self._alignment: FineResult | None = None
        self._temps = np.zeros(2)  # sum of the temperatures, and how many there were

    def expect(self, field_ut: float) -> None:
        """The field's strength at the place, uT, as the user or a model gives it; before anything is fed."""
        self.field_ut = field_ut
        self.buffer = CellBuffer(field_ut)

    def feed(self, rows: Rows) -> None:
        """Take raw SAMPLE rows, shape (n,)."""
        rows = rows[np.isfinite(rows["t"])]
        if self.check is not None:
            self.check.feed(rows)
            return
        moving = rows[np.isfinite(rows["gyr"]).all(axis=1)]
        self._rates = np.concatenate((self._rates, np.column_stack((moving["t"], moving["gyr"]))))[-HISTORY:]
        warm = np.isfinite(rows["temp_c"])
        self._temps += (rows["temp_c"][warm].sum(), np.count_nonzero(warm))
        fresh = rows[self._fresh(rows["mag"])]
        self._history = np.concatenate((self._history, np.column_stack((fresh["mag"], fresh["acc"], fresh["t"]))))[
            -HISTORY:
        ]
        for t, point in zip(fresh["t"].tolist(), fresh["mag"], strict=True):
            self._offer(point, t)
            if t >= self._next_fit or t < self._next_fit - 2.0 * REFIT_S:
                self._next_fit = t + REFIT_S
                self._refit()
                if self._enough():
                    self.finish_turning()
                    if self.check is not None:
                        self.check.feed(rows[rows["t"] > t])
                    return

    def _fresh(self, mag: Floats) -> NDArray[np.bool_]:
        """Which rows (n,) carry a field (n, 3) that is a number and not just repeated."""
        usable = np.asarray((np.abs(mag) < LARGEST_FIELD).all(axis=1))  # False for NaN
        seen = np.concatenate((self._last[None], mag[usable]))
        fresh = usable.copy()
        fresh[usable] = (seen[1:] != seen[:-1]).any(axis=1)
        self._last = seen[-1]
        return fresh

    def _offer(self, point: Floats, t: float) -> None:
        """Keep a sample when the field has moved on from the last one kept."""
        if float(np.sum((point - self._place) ** 2)) >= (NEAREST * self.buffer.radius) ** 2:
            self.buffer.add(point, t)
            self._place, self._moved = point, True

    def _refit(self) -> None:
        if not self._moved:
            if len(self._history) > FEWEST and self.verdict.fit is None:
                self.verdict = judge(self._history[-RECENT:, :3], self.field_ut, self._dip())
            return
        self._moved = False
        self.verdict = judge(self.buffer.points, self.field_ut, self._dip())
        fit = self.verdict.fit
        if fit is not None and plausible(fit.radius, self.field_ut):
            self.buffer.recentre(fit.bias, fit.radius)
            self.verdict = replace(self.verdict, inliers=self._inside(self.buffer.points))

    def _inside(self, points: Floats) -> NDArray[np.bool_]:
        """Which raw points (n, 3) agree with the fit."""
        fit = self.verdict.fit
        if fit is None:
            return np.ones(len(points), bool)
        limit = OUTLIER_SCALES * max(spread(fit.distances(self.buffer.points)), 1e-3 * fit.radius)
        return np.abs(fit.distances(points)) < limit

    def _dip(self) -> float:
        measured = self.measured_dip()[0]
        known = TYPICAL_DIP_DEG if self.dip_deg is None else self.dip_deg
        return measured if np.isfinite(measured) else known

    def measured_dip(self) -> tuple[float, float]:
        """Mean and spread (robust) of the dip in degrees over quiet samples with the present fit; NaN without."""
        acc = self._acc()[-2000:]
        size = np.linalg.norm(acc, axis=1)
        quiet = np.abs(size / GRAVITY - 1.0) < QUIET_ACC
        if self.verdict.fit is None or np.count_nonzero(quiet) < QUIET_COUNT:
            return np.nan, np.nan
        field = self.verdict.fit.apply(self._history[-2000:, :3][quiet])
        up = acc[quiet] / size[quiet, None]
        sine = (field * up).sum(axis=1) / np.maximum(np.linalg.norm(field, axis=1), 1e-9)
        dips = -np.degrees(np.arcsin(np.clip(sine, -1.0, 1.0)))
        middle = float(np.median(dips))
        return middle, spread(dips - middle)

    def _acc(self) -> Floats:
        """The accelerations (n, 3) of the history, corrected."""
        return np.asarray((self._history[:, 3:6] - self.before.acc_bias) @ np.transpose(self.before.acc_matrix))

    def _align(self, fit: Ellipsoid) -> FineResult | None:
        """The rotation into the gyroscope's axes, which no cloud can tell; None without a gyroscope."""
        if not len(self._rates):
            return None
        rates = (self._rates[:, 1:] - self.before.gyr_bias) @ np.transpose(self.before.gyr_matrix)
        field = fit.apply(self._history[:, :3])
        return fine_rotation(self._rates[:, 0], rates, self._history[:, 6], field, acc=self._acc())

    def _enough(self) -> bool:
        return self.verdict.accepted and self.verdict.coverage >= ENOUGH_COVERAGE

    def finish_turning(self) -> bool:
        """Go on to the check, which a person may ask for as soon as the gate accepts; False when it does not."""
        if self.verdict.accepted and self.check is None and self.verdict.fit is not None:
            fit = self.verdict.fit
            self._alignment = self._align(fit)
            self.check = CheckTurn(_with_mag(self.before, fit.bias, _turned(self._alignment) @ fit.matrix))
        return self.check is not None

    @property
    def fit(self) -> Ellipsoid | None:
        """The fit to show: a sphere while little is covered, then the full ellipsoid."""
        if self.verdict.fit is not None and self.verdict.coverage < FULL_FIT_COVERAGE:
            return robust_sphere(self.buffer.points)
        return self.verdict.fit

    @property
    def cells(self) -> NDArray[np.bool_]:
        """Which of the direction cells (CELLS,) have been seen; see ``coverage.fibonacci``."""
        hit = np.zeros(CELLS, bool)
        if self.verdict.fit is not None:
            points = self.buffer.points[self._inside(self.buffer.points)]
            hit[cells_of(directions_from(self.verdict.fit.bias, points))] = True
        return hit

    def cloud(self, most: int = 5000) -> Cloud:
        """The points to show, at most so many of all that came."""
        inside = self._inside(self.buffer.points)
        return Cloud(self._history[-most:, :3].copy(), self.buffer.points[inside], self.buffer.points[~inside])

    @property
    def turn_next(self) -> Floats:
        """Where the field has not been yet: unit vector (3,), sensor frame, into the largest gap."""
        return self.verdict.gap

    @property
    def progress(self) -> float:
        """0 to 1: coverage reached, then the turn of the check."""
        if self.check is not None:
            return 1.0 if self.done else TURNING_SHARE + (1.0 - TURNING_SHARE) * self.check.progress
        if self.verdict.fit is None or not plausible(self.verdict.radius, self.field_ut):
            return 0.0
        return TURNING_SHARE * min(self.verdict.coverage / ENOUGH_COVERAGE, 1.0)

    @property
    def sentence(self) -> str:
        """What to do now."""
        if self.check is not None:
            return "Done." if self.done else self.check.sentence
        magnet = self.verdict.word == "contaminated" and self.verdict.coverage >= LOOKED_ABOUT
        if self.verdict.fit is None or magnet:
            return self.verdict.reasons[0]
        return turn_next(self.verdict.gap, self._dip())

    @property
    def missing(self) -> tuple[str, ...]:
        """What is still missing, in words."""
        if self.check is not None:
            return () if self.done else ("the check: one full turn",)
        more = f"{100 * self.verdict.coverage:.0f} of {100 * ENOUGH_COVERAGE:.0f} % of all directions"
        enough = self.verdict.coverage >= ENOUGH_COVERAGE
        return (*self.verdict.reasons, *(() if enough else (more,)), "the check: one full turn")

    @property
    def done(self) -> bool:
        """Whether turning and check are complete; without a gyroscope there is nothing to check with."""
        return self.check is not None and (self.check.done or not len(self._rates))

    def result(self) -> MagnetometerResult:
        """The verdict on all that came so far."""
        verdict = self._final_verdict()
        dip_deg, dip_spread_deg = self.measured_dip()
        check = self.check.result() if self.check is not None else None
        comparison = self._compare() if verdict.accepted and self.before.has_mag else None
        accepted, reason = _decide(verdict, check, comparison)
        if check is not None and check.problems and self.before.acc_matrix == Correction().acc_matrix:
            reason += " The accelerometer is not calibrated: do that first, a wrong vertical looks like a wrong field."
        fit = verdict.fit or Ellipsoid(np.zeros(3), np.eye(3), np.nan, "none")
        alignment = self._alignment or (self._align(fit) if accepted else None)
        return MagnetometerResult(
            accepted=accepted,
            reason=reason,
            bias=fit.bias,
            matrix=_turned(alignment) @ fit.matrix,
            field_ut=fit.radius,
            dip_deg=dip_deg,
            dip_spread_deg=dip_spread_deg,
            samples=len(verdict.inliers),
            method=fit.method,
            temp_c=float(self._temps[0] / self._temps[1]) if self._temps[1] else np.nan,
            cells=tuple(np.flatnonzero(self.cells).tolist()),
            verdict=verdict,
            alignment=alignment,
            check=check,
            comparison=comparison,
        )

    def _compare(self) -> Comparison:
        """The calibration in force before against the new one."""
        old = scaled(np.array(self.before.mag_bias), np.array(self.before.mag_matrix), 1.0, "before")
        prior = Prior(field=self.field_ut, effective=CELLS * max(self.verdict.coverage, 0.01))
        return compare(old, self.buffer.points, prior)

    def _final_verdict(self) -> Verdict:
        """The last fit uses all that came, evenly over the cells, unless an earlier field is mixed in."""
        if self.verdict.fit is None:
            return self.verdict
        points = self._history[:, :3]
        cells = cells_of(directions_from(self.verdict.fit.bias, points))
        deep = judge(points[newest_of_each(cells, DEEP)], self.field_ut, self._dip())
        return deep if deep.accepted or not self.verdict.accepted else self.verdict


def _turned(alignment: FineResult | None) -> Floats:
    return alignment.matrix if alignment is not None and alignment.accepted else np.eye(3)


def _with_mag(before: Correction, bias: Floats, matrix: Floats) -> Correction:
    values: dict[str, Any] = {"mag_bias": bias, "mag_matrix": matrix}
    return replace(before, **values)


def _decide(verdict: Verdict, check: CheckResult | None, comparison: Comparison | None) -> tuple[bool, str]:
    """Whether the result may be applied, and why (not)."""
    if not verdict.accepted:
        return False, verdict.sentence
    if check is not None and check.problems:
        return False, check.sentence
    if comparison is not None and comparison.keep_old:
        return False, comparison.sentence
    said = (verdict.sentence, check.sentence if check else "", comparison.sentence if comparison else "")
    return True, " ".join(part for part in said if part)
