"""What the numbers themselves say: units from gravity and from turning, the time base from its spacing."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from imugui.formats.columns import MAP_NAMES, read_name
from imugui.samples import GRAVITY

Numbers = NDArray[np.float64]

ACC_UNITS = ("m/s2", "g", "mg", "g/16384", "g/8192", "g/4096", "g/2048")
GYR_UNITS = ("rad/s", "deg/s", "mdps", "dps/131", "dps/65.5", "dps/32.8", "dps/16.4")
MAG_UNITS = ("uT", "G", "mG", "mT", "T", "nT")
TIME_UNITS = ("s", "ms", "us", "ns")
FIELD_UT = (15.0, 110.0)  # uT; the earth's is between 22 and 67, the rest is iron near the sensor
NEAR_GRAVITY = 0.2  # |ln| of the ratio: 18 % below to 22 % above
AT_LEAST_RATE, AT_MOST_RATE = 0.5, 20_000.0  # Hz
STEP_S = 0.05  # s over which turning and gravity are compared
STEP_ROWS = 5  # the same when times are not known
FEWEST_STEPS = 10
RIDGE = 1e-9  # keeps the fit solvable for a gyroscope that reads the same all the time
CLEAR = 5.0  # standard errors by which the comparison must differ from nothing
SYSTEMATIC = 0.05  # error of the comparison that does not come from noise: times and axes that are a little off
NEAR_ERRORS, FAR_ERRORS = 2.5, 4.0  # standard errors: so near is the unit that fits, so far the next one


@np.errstate(over="ignore")
def norms(values: Numbers) -> Numbers:
    """Lengths of vectors, shape (n, 3) to (n,)."""
    return np.asarray(np.sqrt((values * values).sum(axis=1)))


def median_norm(values: Numbers) -> float:
    """Median length of those vectors, shape (n, 3), that are complete; NaN without any."""
    lengths = norms(values)
    lengths = lengths[np.isfinite(lengths)]
    return float(np.median(lengths)) if len(lengths) else math.nan


def scale(slot: str, unit: str) -> float:
    """What one ``unit``, perhaps with "/counts" behind, is worth in SAMPLE's unit of a slot; NaN when it is none."""
    column = read_name(f"{slot}_{unit}", MAP_NAMES) if unit else None
    return math.nan if column is None or column.factor is None or column.slot != slot else column.factor


def acc_unit(values: Numbers) -> str:
    """The unit in which acceleration, shape (n, 3), reads about gravity; "" when in none."""
    length = median_norm(values)
    ratios = {unit: abs(math.log(length * scale("ax", unit) / GRAVITY)) for unit in ACC_UNITS if length > 0.0}
    return min(ratios, key=lambda unit: ratios[unit]) if ratios and min(ratios.values()) < NEAR_GRAVITY else ""


def mag_unit(values: Numbers) -> str:
    """The unit in which a field, shape (n, 3), is about the earth's; "" when in none. uT goes before others."""
    length = median_norm(values)
    return next((unit for unit in MAG_UNITS if FIELD_UT[0] < length * scale("mx", unit) < FIELD_UT[1]), "")


def is_whole(values: Numbers) -> bool:
    """Whether all numbers are whole, as raw counts are, and some are not small."""
    known = values[np.isfinite(values)]
    return bool(len(known)) and bool((known == np.round(known)).all()) and float(np.abs(known).max()) > 20.0


@dataclass(frozen=True)
class Turning:
    """How the turning that gravity shows compares with the gyroscope's."""

    ratio: float  # rad of turning that gravity shows for one unit of gyroscope times one unit of time
    errors: float  # how many of its standard errors that is; negative when they turn in opposite ways

    @property
    def is_clear(self) -> bool:
        """Whether there was enough motion, and the axes agree."""
        return self.errors > CLEAR


NO_TURNING = Turning(math.nan, math.nan)


@np.errstate(over="ignore", invalid="ignore")
def turning(acc: Numbers, gyr: Numbers, t: Numbers | None) -> Turning:
    """Compare the change of gravity's direction in the sensor, da/dt = -omega x a, with the gyroscope.

    ``acc`` and ``gyr``, shape (n, 3), in any unit, ``t`` in s; None takes one row as the unit of time.
    """
    good = np.isfinite(acc).all(axis=1) & np.isfinite(gyr).all(axis=1)
    times = np.arange(len(acc), dtype=float) if t is None else t
    good &= np.isfinite(times)
    acc, gyr, times = acc[good], gyr[good], times[good]
    spacing = float(np.median(np.diff(times))) if len(times) > 1 else 0.0
    if spacing <= 0.0:
        return NO_TURNING
    step = STEP_ROWS if t is None else max(1, min(50, round(STEP_S / spacing)))
    count = len(acc) // step
    if count < FEWEST_STEPS:
        return NO_TURNING
    down = acc[: count * step].reshape(count, step, 3).mean(axis=1)
    rate = gyr[: count * step].reshape(count, step, 3).mean(axis=1)
    middle = times[: count * step].reshape(count, step).mean(axis=1)
    lasts = np.diff(middle)
    return _regress(np.diff(down, axis=0), (down[1:] + down[:-1]) / 2, (rate[1:] + rate[:-1]) / 2, lasts)


def _regress(seen: Numbers, down: Numbers, rate: Numbers, lasts: Numbers) -> Turning:
    """Least squares of ``seen`` = ratio (-rate x down) lasts - bias x down lasts, all (n, 3) but lasts (n,).

    With the bias an unknown of its own, a gyroscope that drifts at rest says nothing about its unit.
    """
    pushes = [-np.cross(axis, down) * lasts[:, None] for axis in (rate, *np.eye(3))]
    matrix = np.stack([push.ravel() for push in pushes], axis=1)
    sizes = np.abs(matrix).max(axis=0)
    if not np.isfinite(sizes).all() or sizes[0] <= 0.0:
        return NO_TURNING
    matrix = matrix / np.maximum(sizes, 1e-300)
    inverse = np.linalg.inv(matrix.T @ matrix + RIDGE * np.eye(4))
    found = inverse @ matrix.T @ seen.ravel()
    noise = float(np.var(seen.ravel() - matrix @ found)) * float(inverse[0, 0])
    return Turning(float(found[0] / sizes[0]), float(found[0]) / math.sqrt(noise)) if noise > 0.0 else NO_TURNING


def gyr_unit(acc: Numbers, gyr: Numbers, t: Numbers) -> str:
    """The unit in which the gyroscope agrees with how gravity turns, or hardly turns; "" when the motion leaves more.

    Shapes (n, 3), (n, 3) and (n,), t in s. Whole numbers are taken for counts, others for rad/s or deg/s.
    """
    found = turning(acc, gyr, t)
    if not math.isfinite(found.errors) or found.errors < -CLEAR or found.errors == 0.0:
        return ""
    spread = math.hypot(found.ratio / found.errors, SYSTEMATIC * found.ratio)
    units = GYR_UNITS[2:] if is_whole(gyr) else GYR_UNITS[:2]
    distances = sorted((abs(found.ratio - scale("gx", unit)) / spread, unit) for unit in units)
    (nearest, best), (second, _) = distances[:2]
    return best if nearest < NEAR_ERRORS and second > FAR_ERRORS else ""


def _nearest(units: Mapping[str, float], value: float, within: float) -> str:
    distances = {unit: abs(math.log(value / size)) for unit, size in units.items()}
    best = min(distances, key=lambda unit: distances[unit])
    return best if distances[best] < within else ""


@dataclass(frozen=True)
class TimeBase:
    """What one column would be as time."""

    spacing: float  # median step, in the column's own unit; NaN when it is no time at all
    is_counter: bool  # it counts the rows by ones
    start: float


def time_base(values: Numbers) -> TimeBase:
    """Judge a column, shape (n,): time hardly ever goes back."""
    known = values[np.isfinite(values)]
    steps = np.diff(known)
    if len(known) < 3 or len(known) < 0.9 * len(values):
        return TimeBase(math.nan, False, math.nan)
    forward = steps[steps > 0.0]
    if (steps < 0.0).sum() > 0.02 * len(steps) or len(forward) < 0.02 * len(steps) or not len(forward):
        return TimeBase(math.nan, False, math.nan)
    # what stands still for some rows (bursts) still goes on at its mean rate
    spacing = float(np.median(forward)) if len(forward) > 0.5 * len(steps) else float(np.mean(steps))
    return TimeBase(spacing, bool((steps == 1.0).all()), float(known[0]))


def time_unit(base: TimeBase) -> str:
    """The unit in which such a column is a sensible time; "" when in none."""
    epochs = {"s": 1e9, "ms": 1e12, "us": 1e15, "ns": 1e18}  # seconds since 1970, between 2001 and 2065
    for unit, size in epochs.items():
        if size <= base.start < 3 * size:
            return unit
    if base.is_counter or not base.spacing > 0.0:
        return ""
    rates = {unit: 1.0 / (base.spacing * scale("t", unit)) for unit in TIME_UNITS}
    possible = {unit: abs(math.log(rate / 100.0)) for unit, rate in rates.items() if 0.5 <= rate <= 20_000.0}
    return min(possible, key=lambda unit: possible[unit]) if possible else ""


EARTH_RADIUS = 6_371_000.0  # m


def speed_unit(lat: Numbers, lon: Numbers, speed: Numbers, t: Numbers) -> str:
    """The unit in which a speed is that of the positions, degrees, each shape (n,), t in s; "" when standing."""
    good = np.isfinite(lat + lon + speed + t)
    if good.sum() < 3:
        return ""
    lat, lon, speed, t = np.radians(lat[good]), np.radians(lon[good]), speed[good], t[good]
    steps = np.hypot(np.diff(lat), np.diff(lon) * np.cos(lat[:-1])) * EARTH_RADIUS
    lasts, mean = t[-1] - t[0], float(speed.mean())
    if lasts <= 0.0 or mean <= 0.0 or steps.sum() < 5.0:
        return ""
    return _nearest({unit: scale("speed", unit) for unit in ("m/s", "km/h", "kn")}, steps.sum() / lasts / mean, 0.3)
