"""The numbers of a report: errors over all readings, what was reached in words, one row of plain values each."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from imugui.guidance.plan import ANGLES, FRAME, LOCAL_TO_RAS, plan_words, plane_angles
from imugui.guidance.reading import Reading

COMPONENTS = {
    "projected": (("medial", "lateral"), ("cranial", "caudal")),
    "plain": (("right", "left"), ("up", "down")),
}
"""Kind of plan -> what a positive and a negative component towards m' and c' are called."""
PLANNED = tuple(name for names in ANGLES.values() for name in names)


@dataclass(frozen=True)
class Spread:
    """Of n angles in degrees; NaN where too few give none. ``worst``: the largest by size."""

    n: int
    mean: float
    sd: float
    rms: float
    worst: float


def spread(values: Sequence[float]) -> Spread:
    """Mean, standard deviation (n - 1), root mean square and largest size of degrees; unknown ones are left out."""
    known = np.array([value for value in values if math.isfinite(value)])
    n = len(known)
    if n == 0:
        return Spread(0, math.nan, math.nan, math.nan, math.nan)
    sd = float(known.std(ddof=1)) if n > 1 else math.nan
    return Spread(n, float(known.mean()), sd, float(np.sqrt(np.mean(known**2))), float(np.abs(known).max()))


def summary(readings: Sequence[Reading]) -> dict[str, Spread]:
    """The spread of the error and of each of its components, by what it is called."""
    kinds = list(dict.fromkeys(reading.plan.kind for reading in readings)) or ["projected"]
    across, along = (
        " or ".join(f"{', '.join(COMPONENTS[kind][part][sign] for kind in kinds)} ({'+-'[sign]})" for sign in (0, 1))
        for part in (0, 1)
    )
    return {
        "error of the axis": spread([reading.error_deg for reading in readings]),
        across: spread([reading.medial_deg for reading in readings]),
        along: spread([reading.cranial_deg for reading in readings]),
    }


def covered(readings: Sequence[Reading]) -> int:
    """How many errors from the plan lie within their own expected error: there plan and tool cannot be told apart."""
    return sum(reading.error_deg <= reading.sigma_deg for reading in readings)


def achieved_words(reading: Reading) -> str:
    """Where the tool pointed, in the plan's own angles: "19.2° medial, 5.1° caudal"."""
    plan = reading.plan
    if plan.kind == "plain":
        ahead, left, up = (np.array(reading.direction) @ np.array(LOCAL_TO_RAS)).tolist()
        level = math.degrees(math.atan2(left, ahead))
        height = math.degrees(math.atan2(up, math.hypot(ahead, left)))
        return f"points {signed(level, 'left', 'right')}, {signed(height, 'up', 'down')}"
    axial, sagittal = np.degrees(plane_angles(reading.direction, plan.side)).tolist()
    return f"{signed(axial, 'medial', 'lateral')}, {signed(sagittal, 'cranial', 'caudal')}"


def component_words(reading: Reading) -> str:
    """The two components of the error in words: "0.8° lateral, 0.3° cranial"."""
    across, along = COMPONENTS[reading.plan.kind]
    return f"{signed(reading.medial_deg, *across)}, {signed(reading.cranial_deg, *along)}"


def miss_mm(reading: Reading) -> float:
    """How far aside the tip ends at the planned depth, mm: L sin(error); NaN without a depth."""
    return reading.plan.depth_mm * math.sin(math.radians(reading.error_deg))


def signed(angle_deg: float, positive: str, negative: str) -> str:
    """An angle with the word for its sign, never a bare sign."""
    if math.isnan(angle_deg):
        return "not known"
    return f"{abs(angle_deg):.1f}° {negative if angle_deg < 0.0 else positive}"


MEASURED = (
    "steadiness_deg_s", "time_to_green_s", "time_in_green_s", "duration_s", "overshoots", "heading_age_s",
    "heading_sigma_deg",
)  # fmt: skip
"""Columns that a reading holds under the same name."""


def values(reading: Reading) -> dict[str, str | int | float]:
    """One row of the CSV, by column: SI or the unit in the name; NaN for what is not known."""
    plan = reading.plan
    axial, sagittal = np.degrees(plane_angles(reading.direction, plan.side)).tolist()
    vectors = {"direction": reading.direction, "plan_direction": reading.plan_direction}
    return {
        "number": reading.number,
        "level": plan.name,
        "side": plan.side,
        "kind": plan.kind,
        "plan": plan_words(plan),
        **{f"plan_{name}": getattr(plan, name) if name in ANGLES[plan.kind] else math.nan for name in PLANNED},
        "reference": plan.reference,
        "tolerance_deg": plan.tolerance_deg,
        "axial_deg": axial,
        "sagittal_deg": sagittal,
        "error_deg": reading.error_deg,
        "medial_deg": reading.medial_deg,
        "cranial_deg": reading.cranial_deg,
        "sigma_deg": reading.sigma_deg,
        "twist_deg": reading.twist_deg,
        "depth_mm": plan.depth_mm,
        "miss_mm": miss_mm(reading),
        **{name: getattr(reading, name) for name in MEASURED},
        "heading_sigma_from": reading.heading_from,
        "frame": FRAME,
        **{f"{name}_{axis}": vector[k] for name, vector in vectors.items() for k, axis in enumerate(FRAME.lower())},
        "t_s": reading.t,
        "first_attitude": reading.rows[0],
        "last_attitude": reading.rows[1],
        "registration": reading.registration_id,
        "registration_method": reading.registration.method,
        "registration_residual_deg": reading.registration.residual_deg,
        "profile": reading.profile,
        "measured": "against a reference board" if reading.relative else "against the earth",
        "filter": reading.filter,
        "magnetometer": "used" if reading.use_mag else "not used",
        "version": reading.version,
        "utc": reading.utc,
    }
