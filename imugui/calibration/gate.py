"""Whether a magnetometer fit may be used, and if not, why, in words.

The residual is no test: a bad fit of a thin cloud has a small one. What counts is the direction error that the
samples' places allow, with at most one effective sample per direction cell; the rest catches clouds that are no
ellipsoid at all. The thresholds are those of the project's study (1620 simulated fits and 18 recordings).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from imugui.calibration.coverage import CELLS, cells_of, coverage, directions_from, fibonacci, largest_gap, planarity
from imugui.calibration.ellipsoid import FEWEST, Ellipsoid, Floats, bisquare, robust_sphere, spread
from imugui.calibration.geometric import SCALE_FLOOR, Prior, covariance, direction_error_deg, with_prior

GREEN_DEG, YELLOW_DEG = 1.0, 2.0  # predicted direction error
LARGEST_RATIO = 1.8  # of the axes
LARGEST_RESIDUAL = 0.04  # of the field
CLEAN_RESIDUAL = 0.02
LEAST_COVERAGE = 0.25  # below this no full ellipsoid is believed
LARGEST_OUTLIERS = 0.2  # share of samples; more is a second state, not a few wrong ones
EARTH_UT = (20.0, 75.0)  # radius that is plausible without a figure for the place
PLAUSIBLE = (0.5, 2.0)  # times the expected field
TYPICAL_UT, TYPICAL_DIP_DEG = 45.0, 65.0
STILL_SHARE = 0.5  # a cloud less wide than this share of the field has not been turned
FLAT = 0.02  # smallest over largest scatter of a turn about one axis
STUCK_VALUES = 2  # a living axis has more than two values
LIGHTS = {"green": "good", "yellow": "usable", "red": "not usable"}


@dataclass(frozen=True, eq=False)
class Verdict:
    """What the gate says of a cloud; ``inliers`` (n,) are the samples the fit believes, figures are NaN without a fit.

    ``error_deg``: expected error of a corrected direction; ``heading_deg``: of a heading at the local dip;
    ``residual``, ``outliers``, ``coverage``: shares; ``gap``: unit vector (3,) into the largest hole.
    """

    fit: Ellipsoid | None
    accepted: bool
    light: str  # a key of LIGHTS
    word: str  # clean, suspect, contaminated; or no verdict yet
    reasons: tuple[str, ...]
    inliers: NDArray[np.bool_]
    gap: Floats
    error_deg: float = np.nan
    heading_deg: float = np.nan
    residual: float = np.nan
    axis_ratio: float = np.nan
    radius: float = np.nan
    outliers: float = 0.0
    coverage: float = 0.0
    gap_deg: float = 180.0
    planarity: float = 0.0

    @property
    def sentence(self) -> str:
        """The verdict in one line: what was reached, in degrees, or the first reason against it."""
        if not self.accepted:
            return self.reasons[0]
        return (
            f"{self.word.capitalize()}: a heading will be right to about {self.heading_deg:.1f}° "
            f"(directions {self.error_deg:.1f}°, field even to {100 * self.residual:.1f} %)."
        )


def judge(points: ArrayLike, field_ut: float | None = None, dip_deg: float = TYPICAL_DIP_DEG) -> Verdict:
    """Fit raw field vectors (n, 3) in uT and judge the fit.

    ``field_ut`` and ``dip_deg`` are what is expected at the place; without a field the earth's whole range is.
    ValueError for points that are not numbers.
    """
    points = np.asarray_chkfinite(points, float)
    trouble = too_simple(points, field_ut)
    if trouble:
        return refusal(points, trouble)
    middle = robust_sphere(points)
    seen = len(np.unique(cells_of(directions_from(middle.bias, points))))
    prior = Prior(field=field_ut, effective=float(seen))
    fit = with_prior(points, prior)
    distances = fit.distances(points)
    inliers = bisquare(distances, max(spread(distances), SCALE_FLOOR * fit.radius)) > 0.0
    directions = directions_from(fit.bias, points[inliers])
    spread_of = covariance(fit, points[inliers], cells_of(directions), prior)
    error_deg = direction_error_deg(fit, spread_of, fibonacci(CELLS))
    residual = float(distances[inliers].std() / fit.radius)
    gap, gap_deg = largest_gap(directions)
    figures = {
        "error_deg": error_deg,
        "heading_deg": heading_error_deg(error_deg, residual, dip_deg),
        "residual": residual,
        "axis_ratio": fit.axis_ratio,
        "radius": fit.radius,
        "outliers": 1.0 - float(inliers.mean()),
        "coverage": coverage(directions),
        "gap_deg": gap_deg,
        "planarity": planarity(directions),
    }
    reasons = against(figures, field_ut)
    light = "red" if reasons else "green" if error_deg <= GREEN_DEG else "yellow"
    word = word_for(figures, light, plausible(fit.radius, field_ut))
    return Verdict(fit, not reasons, light, word, reasons, inliers, gap, **figures)


def heading_error_deg(error_deg: float, residual: float, dip_deg: float) -> float:
    """Expected heading error: of a direction error and an uneven field, seen in the horizontal part of the field.

    Half of a direction's error (by variance) is sideways; an uneven field moves it sideways as much as outward.
    """
    level = max(float(np.cos(np.radians(dip_deg))), 0.05)
    return min(float(np.hypot(error_deg / np.sqrt(2.0), np.degrees(residual))) / level, 180.0)


def plausible(radius: float, field_ut: float | None) -> bool:
    """Whether a radius in uT can be the earth's field, here when the field is known."""
    low, high = EARTH_UT if field_ut is None else (PLAUSIBLE[0] * field_ut, PLAUSIBLE[1] * field_ut)
    return low <= radius <= high


def too_simple(points: Floats, field_ut: float | None) -> str:
    """Why a cloud (n, 3) cannot be fitted at all, and what to do; empty when it can."""
    if len(points) < FEWEST:
        return "There are too few samples yet: turn the board slowly in all directions."
    stuck = [len(np.unique(column)) <= STUCK_VALUES for column in points.T]
    moving = [name for name, still in zip("xyz", stuck, strict=True) if not still]
    if any(stuck) and moving:
        dead = " and ".join(name for name, still in zip("xyz", stuck, strict=True) if still)
        return f"The magnetometer's {dead} axis is stuck at one value: the sensor or its wiring is broken."
    values, axes = np.linalg.eigh(np.cov(points.T))
    # a circle of radius r has the largest scatter r^2 / 2
    if np.sqrt(2.0 * values[-1]) < STILL_SHARE * (field_ut or TYPICAL_UT) / 2.0:
        return "The board was held still: turn it slowly in all directions."
    if values[0] < FLAT * values[-1]:
        about = "xyz"[int(np.abs(axes[:, 0]).argmax())]
        return f"The board was turned about one axis only ({about}): tip it over onto its other sides too."
    return ""


def against(figures: dict[str, float], field_ut: float | None) -> tuple[str, ...]:
    """Every reason against a fit, the one to tell first first; empty when there is none."""
    expected = f"{field_ut:.0f} µT" if field_ut else "20 to 75 µT"
    magnet = "is a magnet, iron or a current near? Go away from it and begin again."
    checks = (
        (
            not plausible(figures["radius"], field_ut),
            f"The field is {figures['radius']:.0f} µT strong where {expected} is expected: {magnet}",
        ),
        (
            figures["residual"] > LARGEST_RESIDUAL,
            f"The field changes by {100 * figures['residual']:.1f} % while the board turns: {magnet}",
        ),
        (
            figures["outliers"] > LARGEST_OUTLIERS,
            f"{100 * figures['outliers']:.0f} % of the samples do not fit the rest: {magnet}",
        ),
        (
            figures["coverage"] < LEAST_COVERAGE or figures["error_deg"] > YELLOW_DEG,
            f"Too few directions have been seen (the largest hole is {figures['gap_deg']:.0f}° deep): "
            f"directions would be wrong by about {figures['error_deg']:.1f}°, so go on turning.",
        ),
        (
            figures["axis_ratio"] >= LARGEST_RATIO,
            f"The field would be bent {figures['axis_ratio']:.1f} times more one way than another: "
            "iron right beside the sensor, or too little turning.",
        ),
    )
    return tuple(said for wrong, said in checks if wrong)


def word_for(figures: dict[str, float], light: str, believable: bool) -> str:
    """Clean, suspect or contaminated: what the field itself is like."""
    bent = figures["axis_ratio"] >= LARGEST_RATIO and figures["error_deg"] <= YELLOW_DEG
    mixed = figures["residual"] > LARGEST_RESIDUAL or figures["outliers"] > LARGEST_OUTLIERS
    if mixed or bent or not believable:
        return "contaminated"
    return "clean" if light == "green" and figures["residual"] <= CLEAN_RESIDUAL else "suspect"


def refusal(points: Floats, reason: str) -> Verdict:
    """The verdict on a cloud that has no fit."""
    away = directions_from(points.mean(axis=0), points) if len(points) else np.zeros((0, 3))
    gap, _ = largest_gap(away)
    return Verdict(None, False, "red", "no verdict yet", (reason,), np.ones(len(points), bool), gap)
