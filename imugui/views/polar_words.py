"""What the polar target says in words, from a guidance Look and the plan."""

from __future__ import annotations

import math

from imugui.guidance.look import Look
from imugui.guidance.plan import Plan
from imugui.views.readout import number_text

STATES = {
    "green": ("good", "On target"),
    "amber": ("warn", "Close"),
    "red": ("bad", "Off target"),
    "hatched": ("warn", "Not trusted"),
    "blank": ("bad", "No fresh data"),
}
"""Tone and word of each colour of a Look."""

HOLD = "Hold still"
READY = "Ready: take the reading"


def sides(plan: Plan | None) -> tuple[str, str, str, str]:
    """The words at top, right, bottom and left: as seen from behind, along the way of insertion, head up."""
    if plan is None or plan.kind == "plain":
        return "up", "right", "down", "left"
    across = ("medial", "lateral") if plan.side == "left" else ("lateral", "medial")
    return "cranial", across[0], "caudal", across[1]


def side_notes(plan: Plan | None) -> tuple[str, str]:
    """The patient's own sides, under the words at the right and at the left."""
    if plan is None or plan.kind == "plain":
        return "", ""
    return "patient's right", "patient's left"


def main_words(look: Look) -> str:
    """The one thing to do now."""
    if not look.trusted:
        return look.reasons[0] if look.reasons else STATES[look.colour][1]
    if look.armed:
        return READY
    if look.colour == "green":
        return HOLD
    return capital(look.aim_words[0]) if look.aim_words else ""


def more_words(look: Look) -> str:
    """What comes after it."""
    if not look.trusted:
        return " ".join(look.reasons[1:])
    if look.armed:
        return "Space, the button on the page, or the board's own"
    if look.colour == "green":
        return ", ".join(look.aim_words)
    return f"then {', '.join(look.aim_words[1:])}" if len(look.aim_words) > 1 else ""


def age_words(look: Look) -> str:
    """How old the newest sample is."""
    if not math.isfinite(look.age_ms):
        return "no data"
    return f"{look.age_ms:.0f} ms" if look.age_ms < 1000.0 else f"{look.age_ms / 1000.0:.0f} s old"


def twist_words(look: Look) -> str:
    """How far the tool is turned about its own axis; never scored."""
    if look.colour == "blank" or not math.isfinite(look.twist_deg):
        return ""
    return f"twist {number_text(look.twist_deg, 0, signed=True)}°"


def heading_words(look: Look) -> str:
    """How long ago the zero was set, and within how much 9 of 10 errors stay."""
    if not math.isfinite(look.heading_age_s):
        return ""
    sigma = f", ±{look.sigma_deg:.1f}°" if math.isfinite(look.sigma_deg) and look.colour != "blank" else ""
    return f"registered {clock(look.heading_age_s)} ago{sigma}"


def clock(seconds: float) -> str:
    """Minutes and seconds, such as 2:05."""
    whole = max(0, int(seconds))
    return f"{whole // 60}:{whole % 60:02d}"


def capital(words: str) -> str:
    """With a capital letter in front."""
    return words[:1].upper() + words[1:]
