"""What the Aim step says of a Look: components, the age of the zero, the readings."""

from __future__ import annotations

import math

from imugui.guidance.aiming import Aim
from imugui.guidance.look import Look
from imugui.guidance.plan import Plan, screen_sign
from imugui.guidance.reading import Reading
from imugui.views.polar_words import clock

UNKNOWN = "–"
SOON_S = 20.0
"""The user is asked to register again when the zero is good for less than this."""


def component_words(aim: Aim | None, plan: Plan | None) -> tuple[str, str]:
    """Where the tool is against the plan, across and along: ("1.2° too medial", "0.4° too caudal")."""
    if aim is None or plan is None or not all(map(math.isfinite, aim.offset)):
        return UNKNOWN, UNKNOWN
    across, along = (math.degrees(part) for part in aim.offset)
    if plan.kind == "plain":
        names = (("right", "left"), ("high", "low"))
        across *= screen_sign(plan.side)
    else:
        names = (("medial", "lateral"), ("cranial", "caudal"))
    return _too(across, *names[0]), _too(along, *names[1])


def _too(angle_deg: float, positive: str, negative: str) -> str:
    size = f"{abs(angle_deg):.1f}°"
    return size if size == "0.0°" else f"{size} too {negative if angle_deg < 0.0 else positive}"


def due_words(look: Look) -> tuple[str, str]:
    """Tone and words about how long the registration is good for the plan in use."""
    due_s = look.reference_due_s
    if math.isnan(look.heading_age_s):
        return "warn", "Not registered"
    if math.isnan(due_s):
        return "neutral", f"Registered {clock(look.heading_age_s)} ago"
    if math.isinf(due_s):
        return "good", "The zero does not age"
    if due_s <= 0.0:
        return "bad", "Register again now"
    return ("warn", f"Register again within {clock(due_s)}") if due_s < SOON_S else ("good", f"Good for {clock(due_s)}")


def reading_words(reading: Reading) -> str:
    """A reading in one phrase: "L4 left: 1.3° ±0.5°"."""
    sigma = f" ±{reading.sigma_deg:.1f}°" if math.isfinite(reading.sigma_deg) else ""
    return f"{reading.title}: {reading.error_deg:.1f}°{sigma}"
