"""Facts: everything that decides whether the target may be trusted, at one moment."""

from __future__ import annotations

import math
from dataclasses import dataclass

from imugui.guidance.registration import Registration


@dataclass(frozen=True)
class Facts:
    """What is so now. Nothing said is nothing trusted; times are those of one monotonic clock of the host.

    The page says the first group, with the help of ``trust_profile.profile_facts``. The Guide fills in the second
    from the attitudes, the plan and the registration: there it only adds to what was said.
    """

    now: float = math.nan
    streaming: bool = False
    calibrated: bool = False
    profile_words: str = ""  # which profile; the same words as long as the same corrections are applied
    profile_expired: bool = False
    profile_warning: str = ""  # why it is expired, one sentence
    filter: str = ""
    use_mag: bool = False
    epoch_same: bool = True  # the filter has not begun anew since the registration
    temp_c: float = math.nan
    base_tilt: float = math.nan  # rad, rms angle that the accelerometer's calibration leaves
    base_heading: float = math.nan  # rad, 1 sigma that the magnetometer's calibration leaves
    drift: float = math.nan  # rad/s, 1 sigma of the heading without the magnetometer
    turn_share: float = math.nan  # 1 sigma of the gyroscope's scale and cross-axis terms
    prior_holds: bool = True  # the filter takes the gyroscope for no better than that
    relative: bool = False  # of the tool against a reference board, in that board's frame: up is not known there
    aligned_at: float = math.inf  # the headings of the two drift apart since then; infinite where they do not

    arrival: float = math.nan  # of the newest usable attitude
    registration: Registration | None = None
    registered_at: float = math.nan
    epoch_words: str = ""  # why the registration is no longer good, one sentence
    side_confirmed: bool = False
    plan_problem: str = ""
    mag_disturbed: bool = False
    shaken: bool = False
    sigma_tilt: float = math.nan  # rad, 1 sigma, when the filter says it
    sigma_heading: float = math.nan  # the same; without the magnetometer since the registration, or since earlier
    heading_before: float = 0.0  # rad, what it said of the heading last, when it says nothing any more
    heading_growth: float = math.nan  # rad/s, by which sigma_heading grows while the tool is held
    held_tilt: float = math.nan  # rad, sigma_tilt of a tool that is held: the least since the registration
    turning: float = math.nan  # rad, by how much gyroscope errors have been turned into heading: see turning.Turning
    axis_error: float = 0.0  # rad, of the tool's axis in the box
    tilt_from_vertical: float = math.nan  # rad, of the tool; unknown counts as level, the worst case
