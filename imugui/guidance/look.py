"""Look: everything that is to be seen and heard of the target at one moment."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

import numpy as np

from imugui.fusion.quaternion import Floats
from imugui.guidance.aiming import Aim, band, words
from imugui.guidance.plan import Plan
from imugui.guidance.trust import Trust

COLOURS = ("green", "amber", "red", "hatched", "blank")
"""Trusted: inside the tolerance, inside the wider one, outside. Not trusted: hatched; too old to show: blank."""
FASTEST_HZ, SLOWEST_HZ = 12.0, 1.0
"""Beeps per second on the plan and far from it."""


def no_trail() -> Floats:
    """A trail of nothing, (0, 2)."""
    return np.zeros((0, 2))


@dataclass(frozen=True, eq=False)
class Look:
    """What to paint. ``colour`` is one of COLOURS; NaN: not known, or not to be shown.

    ``aim``: None when blank or without plan, board or registration. ``arrow``: unit vector (towards m', towards c')
    in which to move the tool, (0, 0) inside the tolerance or when no way is shorter. ``trail`` (n, 2): offsets in rad
    of the last 1.5 s, oldest first. ``reasons``: why not to trust, and what to do.
    """

    colour: str = "blank"
    plan: Plan | None = None
    aim: Aim | None = None
    aim_words: tuple[str, ...] = ()
    arrow: tuple[float, float] = (0.0, 0.0)
    trail: Floats = field(default_factory=no_trail)
    reasons: tuple[str, ...] = ()
    sigma_deg: float = math.nan
    armed: bool = False
    hold_progress: float = 0.0
    rate_deg_s: float = math.nan
    twist_deg: float = math.nan
    heading_age_s: float = math.nan
    heading_sigma_deg: float = math.nan
    reference_due_s: float = math.nan
    age_ms: float = math.nan
    beep_hz: float = 0.0

    @property
    def error_deg(self) -> float:
        """The aiming error in degrees; NaN without an aim."""
        return math.degrees(self.aim.error) if self.aim else math.nan

    @property
    def trusted(self) -> bool:
        """Whether the colour tells the error, not a lack of trust."""
        return self.colour in COLOURS[:3]


def looked(look: Look, trust: Trust, aim: Aim | None) -> Look:
    """The look with the verdict and the aim in it: colour, words, arrow and sound; nothing of the aim when blank."""
    look = replace(
        look,
        colour="blank" if trust.blank else "hatched",
        reasons=trust.reasons,
        sigma_deg=math.degrees(trust.sigma),
        heading_age_s=trust.heading_age_s,
        heading_sigma_deg=math.degrees(trust.heading_sigma),
        reference_due_s=trust.reference_due_s,
        age_ms=1000.0 * trust.age_s,
    )
    plan = look.plan
    if trust.blank or aim is None or plan is None:
        return replace(look, trail=no_trail(), rate_deg_s=math.nan)
    tolerance = math.radians(plan.tolerance_deg)
    look = replace(
        look,
        aim=aim,
        aim_words=words(aim, plan.side, plan.kind == "plain"),
        arrow=arrow(aim, tolerance),
        twist_deg=math.degrees(aim.twist),
    )
    return replace(look, colour=band(aim, plan), beep_hz=beep_hz(aim.error, tolerance)) if trust.ok else look


def beep_hz(error: float, tolerance: float) -> float:
    """Beeps per second for an error and a tolerance, rad: the nearer the faster, steady inside; 0 for NaN."""
    if math.isnan(error):
        return 0.0
    return min(FASTEST_HZ, max(SLOWEST_HZ, FASTEST_HZ * tolerance / max(error, tolerance)))


def arrow(aim: Aim, tolerance: float) -> tuple[float, float]:
    """The way to move the tool, towards (m', c'), length 1; (0, 0) inside ``tolerance`` rad or exactly backwards."""
    size = math.hypot(*aim.offset)
    if not size > tolerance:
        return (0.0, 0.0)
    return (-aim.offset[0] / size, -aim.offset[1] / size)
