"""What a board's profile is worth to the target: the figures that trust is computed from, and where they come from."""

from __future__ import annotations

import math
from dataclasses import replace
from datetime import datetime
from typing import Any

from imugui.calibration.profile import UNKNOWN_TILT_DEG, Profile

TILT_DEG = 0.25
"""What a good calibration of an MPU-9250 still leaves, rms over all attitudes: 5 mg on each axis and 0.2 % of scale
and cross-axis, evenly within these limits. A fit's own figure tells of the day of the fit only, so this is added."""
DRIFT_DEG_S = 0.01
"""1 sigma of a gyroscope's bias that was taken at rest minutes before: rms 0.0093 over the nine drifts that seed 004
measured on three kinds of board (0.12 to 0.97 deg/min)."""
TURN_SHARE = 0.003 / math.sqrt(3.0)
"""1 sigma of scale and cross-axis terms after a good calibration: evenly within 0.3 %."""
RAW_TURN_SHARE = 0.03 / math.sqrt(3.0)
"""The same without one: the limits of the MPU-9250's datasheet, 3 %."""
WARM_SHARE = 0.04 / 60.0 / math.sqrt(3.0)
"""The same, for each kelvin away from where the scale was learnt: the MPU-9250's moves by 4 % at most over 60 K."""
USUAL_K = 3.0
"""How far away it counts as where a temperature is not known: a room's."""
USUAL_TURN_DEG = 90.0
"""The turn to which a profile's error of a turn belongs."""


def profile_facts(
    profile: Profile | None, now: datetime, use_mag: bool, temp_c: float = math.nan, factory: bool = False
) -> dict[str, Any]:
    """The Facts that follow from a profile, by name; ``now`` with its time zone, ``temp_c`` in degrees C if known.

    ``factory``: the board was calibrated where it was made, and counts as calibrated without a profile.
    """
    profile = profile or Profile()
    warning = _warning(profile, now, use_mag, temp_c)
    return {
        "calibrated": factory or profile.accelerometer is not None,
        "profile_words": profile_words(profile, factory),
        "profile_expired": bool(warning),
        "profile_warning": warning,
        "temp_c": temp_c,
        "base_tilt": base_tilt(profile, factory),
        "base_heading": math.radians(profile.heading_error_deg),
        "drift": drift(profile),
        "turn_share": turn_share(profile, factory, temp_c),
    }


def profile_words(profile: Profile, factory: bool = False) -> str:
    """Which profile, in words that stay the same as long as its corrections do."""
    dates = [part.date for part in profile.parts.values()]
    dates += [profile.gyroscope.matrix_date] if profile.gyroscope else []
    if not dates:
        return "calibrated at the factory" if factory else "no profile"
    return f"{profile.board.title}, calibrated {max(dates)}"


def base_tilt(profile: Profile, factory: bool = False) -> float:
    """Rms angle in rad that the accelerometer's calibration leaves."""
    fitted_deg = profile.tilt_error_deg
    if math.isnan(fitted_deg):
        fitted_deg = 0.0 if factory else UNKNOWN_TILT_DEG
    return math.radians(math.hypot(TILT_DEG, fitted_deg))


def drift(profile: Profile) -> float:
    """1 sigma in rad/s of the heading's drift without a magnetometer, soon after a rest.

    The worst axis' bias instability, where the profile has it, is added to the usual figure.
    """
    measured = [value for value in (profile.noise.gyr_instability if profile.noise else ()) if not math.isnan(value)]
    return math.radians(math.hypot(DRIFT_DEG_S, max(measured, default=0.0)))


def turn_share(profile: Profile, factory: bool = False, temp_c: float = math.nan) -> float:
    """1 sigma of the gyroscope's scale and cross-axis terms, at ``temp_c`` degrees C if known.

    Learnt ones carry their own sigma, that of the worst element, which holds where they were learnt.
    """
    gyroscope = profile.gyroscope
    if gyroscope is None or not gyroscope.matrix_method:
        return TURN_SHARE if factory else RAW_TURN_SHARE
    if not math.isnan(gyroscope.matrix_sigma):
        away = abs(temp_c - gyroscope.matrix_temp_c)
        warm = WARM_SHARE * (USUAL_K if math.isnan(away) else away)
        return min(RAW_TURN_SHARE, math.hypot(gyroscope.matrix_sigma, warm))
    error_deg = 0.0 if math.isnan(gyroscope.turn_error_deg) else gyroscope.turn_error_deg
    return math.hypot(TURN_SHARE, error_deg / USUAL_TURN_DEG)


def prior_holds(share: float, params: Any) -> bool:
    """Whether a filter with these parameters reckons with terms of ``share``, or does not reckon with any."""
    reckoned = [getattr(params, name) for name in ("matrix_sigma", "matrix_worst") if hasattr(params, name)]
    return bool(share <= max(reckoned, default=math.inf))


def _warning(profile: Profile, now: datetime, use_mag: bool, temp_c: float) -> str:
    """Why the parts that are in use are not to be trusted now, or empty.

    The gyroscope's bias is found again at every rest, so its temperature does not count.
    """
    bias_only = Profile(gyroscope=profile.gyroscope)
    others = replace(profile, gyroscope=None, magnetometer=profile.magnetometer if use_mag else None)
    return " ".join((*bias_only.warnings(now), *others.warnings(now, temp_c)))
