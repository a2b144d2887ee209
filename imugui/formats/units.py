"""Which unit a sensor's columns are in: what is written there, held against what the numbers say."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from imugui.formats.columns import QUANTITIES
from imugui.formats.evidence import (
    ACC_UNITS,
    FIELD_UT,
    GYR_UNITS,
    MAG_UNITS,
    TIME_UNITS,
    Numbers,
    acc_unit,
    gyr_unit,
    is_whole,
    mag_unit,
    median_norm,
    norms,
    scale,
    time_base,
    time_unit,
    turning,
)
from imugui.samples import GRAVITY

SURE, LIKELY, UNSURE = "sure", "likely", "unsure"
LEVELS = (SURE, LIKELY, UNSURE)
"""How far a guess can be trusted: it needs no question; it is said; it is asked."""

CHOICES: dict[str, tuple[str, ...]] = {
    "a": (*ACC_UNITS, "m/s2*-1", "g*-1"),
    "g": GYR_UNITS,
    "m": (*MAG_UNITS, "uT*50"),
    "t": TIME_UNITS,
    "temp_c": ("C",),
    "lat": ("deg",),
    "lon": ("deg",),
    "alt": ("m",),
    "speed": ("m/s", "km/h", "kn"),
    "course_deg": ("deg",),
}
"""The units offered for each quantity (columns.UNITS); "/16384" means counts per unit, "*-1" the axis turned round."""

LINEAR_BELOW, GRAVITY_BETWEEN = 0.35, (0.5, 2.0)  # g
STILL = 0.02  # spread of |acc| in its median below which the board is taken to lie still
STILL_DPS, STILL_RADPS = 0.25, 0.02  # |gyr| of a board at rest is above the first in deg/s, below the second in rad/s
FAST_RADPS = 6.0  # more than that in a tenth of the rows is no motion of a hand or a vehicle
POWER_UP_RANGE = "dps/131"  # InvenSense sensors, 250 deg/s
ARBITRARY = ("a.u.", "au", "a.u", "arb", "normalized", "normalised")


@dataclass(frozen=True)
class Guessed:
    """A unit (of CHOICES, or as written), how far to trust it, and why in words."""

    unit: str
    level: str
    reason: str


def canonical(slot: str, unit: str) -> str:
    """The spelling of CHOICES for a unit written in any way; the unit itself when it is none of them."""
    size = scale(slot, unit)
    return next(
        (one for one in CHOICES.get(QUANTITIES.get(slot, slot), ()) if math.isclose(scale(slot, one), size)), unit
    )


def worst(levels: Sequence[str]) -> str:
    """The least certain of some levels."""
    return max(levels, key=LEVELS.index, default=SURE)


def gravity_share(values: Numbers, unit: str) -> float:
    """Median |acc| of values, shape (n, 3), as a share of gravity."""
    return median_norm(values) * scale("ax", unit) / GRAVITY


def judge_acc(values: Numbers, written: str) -> Guessed:
    """The unit of an accelerometer, shape (n, 3), from gravity."""
    seen = acc_unit(values)
    if not math.isnan(scale("ax", written)):
        return _named_acc(values, canonical("ax", written), seen)
    said = f"{written!r} is no unit of acceleration; " if written else "no unit is named; "
    if not seen:
        counts = " (raw counts whose scale or zero is not known)" if is_whole(values) else ""
        return Guessed("m/s2", UNSURE, f"{said}|acc| is mostly {median_norm(values):.4g}, gravity in no unit{counts}")
    reads = f"gravity reads {gravity_share(values, seen) * GRAVITY:.2f} m/s2 with {seen}"
    return Guessed(seen, LIKELY if is_whole(values) else SURE, said + reads)


def _named_acc(values: Numbers, unit: str, seen: str) -> Guessed:
    share = gravity_share(values, unit)
    reads = f"named {unit}; gravity reads {share * GRAVITY:.2f} m/s2"
    if seen and math.isclose(scale("ax", seen), abs(scale("ax", unit))):
        return Guessed(unit, SURE, f"{reads}: right")
    if GRAVITY_BETWEEN[0] < share < GRAVITY_BETWEEN[1]:
        return Guessed(unit, LIKELY, f"{reads}: it was moved, or its scale is off")
    if seen:
        return Guessed(seen, UNSURE, f"{reads}, but {gravity_share(values, seen) * GRAVITY:.2f} m/s2 with {seen}")
    return Guessed(unit, UNSURE, f"{reads}: is that right?")


def judge_gyr(values: Numbers, written: str, acc: Numbers | None, unit_of_acc: str, t: Numbers | None) -> Guessed:
    """The unit of a gyroscope, shape (n, 3), from how gravity turns, else from how it reads at rest.

    ``acc``, shape (n, 3), at the same times ``t`` (s) or None.
    """
    known = not math.isnan(scale("gx", written))
    by_turning = gyr_unit(acc, values, t) if acc is not None and t is not None else ""
    if known:
        unit = canonical("gx", written)
        if by_turning and not math.isclose(scale("gx", by_turning), abs(scale("gx", unit)), rel_tol=0.5):
            return Guessed(unit, UNSURE, f"named {unit}, but gravity turns as if it were {by_turning}")
        return Guessed(unit, SURE, f"named {unit}" + ("; agrees with how gravity turns" if by_turning else ""))
    said = f"{written!r} is no unit of turning; " if written else "no unit is named; "
    if by_turning:
        return Guessed(by_turning, SURE, f"{said}with {by_turning} it agrees with how gravity turns")
    return _gyr_from_size(values, said, acc, unit_of_acc)


def _gyr_from_size(values: Numbers, said: str, acc: Numbers | None, unit_of_acc: str) -> Guessed:
    lengths = norms(values)
    lengths = lengths[np.isfinite(lengths)]
    if is_whole(values):
        return Guessed(POWER_UP_RANGE, UNSURE, f"{said}raw counts; this is the range sensors start with")
    if len(lengths) and (fast := float(np.quantile(lengths, 0.9))) > FAST_RADPS:
        return Guessed("deg/s", LIKELY, f"{said}often {fast:.3g}: too fast for rad/s")
    if acc is not None and len(lengths) and _is_still(acc):
        median = float(np.median(lengths))
        if median > STILL_DPS:
            return Guessed("deg/s", LIKELY, f"{said}{median:.2g} at rest is too much for rad/s")
        if median < STILL_RADPS:
            return Guessed("rad/s", LIKELY, f"{said}{median:.2g} at rest is too little for deg/s")
    usual = "rad/s" if unit_of_acc == "m/s2" else "deg/s"
    return Guessed(usual, UNSURE, f"{said}{usual} is usual beside {unit_of_acc or 'this'}; the motion does not tell")


def _is_still(acc: Numbers) -> bool:
    complete = acc[np.isfinite(acc).all(axis=1)]
    if len(complete) < 3:
        return False
    return bool(np.linalg.norm(complete.std(axis=0)) < STILL * median_norm(complete))


def judge_mag(values: Numbers, written: str) -> Guessed:
    """The unit of a magnetometer, shape (n, 3), from the strength of the earth's field."""
    if not math.isnan(scale("mx", written)):
        unit = canonical("mx", written)
        field = median_norm(values) * scale("mx", unit)
        note = "" if FIELD_UT[0] < field < FIELD_UT[1] else ", not the earth's: iron or a magnet is near"
        return Guessed(unit, SURE, f"named {unit}; the field is {field:.3g} uT{note}")
    if written.lower() in ARBITRARY:
        return Guessed("uT*50", LIKELY, "arbitrary units: 1 is taken as 50 uT, so only the direction counts")
    said = f"{written!r} is no unit of a field; " if written else "no unit is named; "
    seen = mag_unit(values)
    if not seen:
        return Guessed("uT", UNSURE, f"{said}|mag| is mostly {median_norm(values):.3g}, the earth's field in no unit")
    field = median_norm(values) * scale("mx", seen)
    level = UNSURE if is_whole(values) else LIKELY
    counts = ", or raw counts" if level == UNSURE else ""
    return Guessed(seen, level, f"{said}as {seen} the field is {field:.3g} uT{counts}")


def judge_time(values: Numbers, written: str) -> Guessed | None:
    """The unit of a time column, shape (n,); None when it is none."""
    base = time_base(values)
    if not base.spacing > 0.0:
        return None
    if not math.isnan(scale("t", written)):
        unit = canonical("t", written)
        rate = 1.0 / (base.spacing * scale("t", unit))
        if 0.05 < rate < 1e5:
            return Guessed(unit, SURE, f"named {unit}; {rate:.4g} rows a second")
        unit = time_unit(base)
        return Guessed(unit or written, UNSURE, f"named {written}, but that makes {rate:.3g} rows a second")
    unit = time_unit(base)
    if not unit:
        return None
    rate = 1.0 / (base.spacing * scale("t", unit))
    return Guessed(unit, LIKELY, f"no unit is named; with {unit} there are {rate:.4g} rows a second")


def guess_rate(acc: Numbers | None, gyr: Numbers | None, unit_of_gyr: str) -> float:
    """The rate (Hz) at which gyroscope and gravity agree, for a table without times; NaN when they do not tell."""
    if acc is None or gyr is None:
        return math.nan
    found = turning(acc, gyr, None)
    if not found.is_clear:
        return math.nan
    return abs(scale("gx", unit_of_gyr)) / found.ratio
