"""The error to expect of a reading: one angle, about the tool's axis, that is stated before it is needed.

    sigma^2 = COVER^2 (tilt^2 + registration^2 + axis^2 + (sin(theta) psi)^2)

- tilt: what the accelerometer's calibration leaves, and what the filter says it does not know yet;
- registration: the same tilt error again, when the axes were measured, and what its residual shows;
- axis: how well the tool's axis is known in the box;
- psi: the heading's error. It matters only as far as the tool leans from the vertical by theta: a turn by psi moves
  the axis by psi sin(theta) (guidance-teleop.md B.4). Without a magnetometer psi is what the filter states, counted
  from the registration (fusion's ``refer_heading``). A filter that states nothing, or nothing now, leaves
  psi^2 = (drift age)^2 + (share turning)^2, with the age of the registration and the turning since (turning.py).

All parts are rms angles of a direction on the sphere. The errors of a direction have two components; if both are
normal and alike, 9 of 10 lie within sqrt(ln 10) times their rms. So sigma is the angle that 9 of 10 errors stay
within by this model, not a standard deviation of one component: on screen it stands as "± sigma".
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

from imugui.guidance.facts import Facts

COVER = math.sqrt(math.log(10.0))
"""P(r < R) = 1 - exp(-R^2 / rms^2) for two alike normal components: 0.9 at this many rms."""

REGISTRATION = {"axes": (1.0, 0.5), "mark": (math.sqrt(0.5), 1.0), "origin": (1.0, 1.0)}
"""How much of the tilt error and of the residual each way of registering puts into a reading. Axes: two directions
with the tilt error each, half the residual taken up by each. Mark: the vertical has no error, the mark's heading has
one component of it, and the residual says how far the table may not be level. Origin: all of both."""


def axis_sigma(facts: Facts) -> float:
    """The angle in rad that 9 of 10 errors of the axis stay within; NaN when a part of it is not known."""
    return COVER * math.hypot(fixed_part(facts), lean(facts) * heading_sigma(facts))


def fixed_part(facts: Facts) -> float:
    """Rms angle in rad of all that does not grow with time; NaN without a registration or a tilt error."""
    if facts.registration is None:
        return math.nan
    tilt_share, residual_share = REGISTRATION[facts.registration.method]
    tilt = math.hypot(facts.base_tilt, known(facts.sigma_tilt))
    residual = math.radians(facts.registration.residual_deg)
    return math.hypot(tilt, tilt_share * facts.base_tilt, residual_share * residual, facts.axis_error)


def heading_sigma(facts: Facts) -> float:
    """1 sigma of the heading against the registration's, rad; NaN when it is not known."""
    return SOURCES[heading_source(facts)](facts)


def heading_source(facts: Facts) -> str:
    """What tells how far the heading may be off, a key of SOURCES: the filter, if it states a figure that holds.

    Without a magnetometer nothing shows an error of scale about the vertical. A filter that takes the gyroscope for
    better than it is calibrated is then too sure of its heading.
    """
    if not math.isnan(facts.sigma_heading) and (facts.use_mag or facts.prior_holds):
        return "filter"
    return "calibration" if facts.use_mag else "drift"


def drifted(facts: Facts) -> float:
    """1 sigma of a heading that drifts, rad; no less than what the filter states, or stated before it fell silent."""
    aged = math.hypot(facts.drift * drift_age(facts), facts.turn_share * facts.turning)
    return aged if math.isnan(aged) else max(aged, facts.heading_before)


SOURCES: dict[str, Callable[[Facts], float]] = {
    "filter": lambda facts: facts.sigma_heading,
    "calibration": lambda facts: facts.base_heading,  # of the magnetometer; it does not age
    "drift": drifted,
}


def heading_age(facts: Facts) -> float:
    """Seconds since the registration; NaN without one."""
    return facts.now - facts.registered_at if facts.registration is not None else math.nan


def drift_age(facts: Facts) -> float:
    """Seconds since the heading drifts: since the registration or, where it was before, the alignment of two boards."""
    since = min(facts.registered_at, facts.aligned_at)
    return facts.now - since if facts.registration is not None else math.nan


def seconds_left(facts: Facts, limit: float) -> float:
    """Seconds until sigma passes ``limit`` (rad) if the tool is held as it is; 0 when it has, NaN when not known.

    Where the filter states the heading's sigma, that goes on growing as it grew when the tool was held last, but no
    slower than a gyroscope drifts soon after a rest (``heading_growth``). Otherwise it grows by the formula of the
    drift. Doubt of the tilt that comes from moving the tool (``held``) does not count: no registration would cure it.
    """
    if facts.use_mag:
        return math.inf if axis_sigma(facts) <= limit else 0.0
    facts = held(facts)
    spare = (limit / COVER) ** 2 - fixed_part(facts) ** 2
    if math.isnan(spare):
        return math.nan
    if spare <= 0.0:
        return 0.0
    allowed = math.sqrt(spare) / lean(facts) if lean(facts) > 0.0 else math.inf
    return (_until_stated if heading_source(facts) == "filter" else _until_drifted)(facts, allowed)


def held(facts: Facts) -> Facts:
    """The same for a tool that has been held for a moment, so that the filter is as sure of its tilt as it can be."""
    sure = facts.held_tilt < facts.sigma_tilt
    return replace(facts, sigma_tilt=facts.held_tilt) if sure else facts


def _until_stated(facts: Facts, allowed: float) -> float:
    """Seconds until the heading's sigma, as the filter states it, passes ``allowed`` rad."""
    if facts.sigma_heading >= allowed:
        return 0.0
    return math.inf if facts.heading_growth == 0.0 else (allowed - facts.sigma_heading) / facts.heading_growth


def _until_drifted(facts: Facts, allowed: float) -> float:
    """The same by drift and turning."""
    turned = facts.turn_share * facts.turning
    if math.isnan(turned + facts.drift):
        return math.nan
    if allowed <= max(turned, facts.heading_before):
        return 0.0
    if facts.drift == 0.0:
        return math.inf
    return max(0.0, math.sqrt(allowed**2 - turned**2) / facts.drift - drift_age(facts))


def lean(facts: Facts) -> float:
    """sin(theta): how much of a heading error the axis feels; 1 when the lean is not known."""
    return 1.0 if math.isnan(facts.tilt_from_vertical) else math.sin(facts.tilt_from_vertical)


def known(value: float) -> float:
    """The value, or 0 for one that the filter does not state."""
    return 0.0 if math.isnan(value) else value
