"""What the Live page decides before it shows anything: is it alive, which angles, is the heading to be trusted."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from imugui.fusion.attitude import CONVENTIONS, display_quat
from imugui.fusion.quaternion import conjugate, multiply
from imugui.views.status_words import span
from imugui.workers.session import State, Status

STALE_S = 0.5
DEAD = (
    State.IMPOSSIBLE,
    State.STALLED,
    State.MISSING,
    State.BUSY,
    State.DENIED,
    State.AWAY,
    State.TAKEN,
    State.NO_BLUETOOTH,
    State.LOST,
    State.ENDED,
    State.FAILED,
)
"""States in which nothing on the page may look alive, whatever the age of the newest row."""
UNRELIABLE = "unreliable here: look at the picture"

_NO_HEADING = {
    "none": "no field",
    "off": "not used",
    "disturbed": "disturbed",
}


def stale_word(state: State, age_s: float) -> str:
    """Why the picture is not live, in words; "" when it is. ``age_s`` is NaN when there are no data at all."""
    if state in DEAD or math.isnan(age_s):
        return state.word
    if age_s <= STALE_S:
        return ""
    return f"No data for {span(age_s)}" if state is State.STREAMING else state.word


def shown_quat(local: NDArray[np.float64], convention: str, has_origin: bool) -> NDArray[np.float64]:
    """The rotation whose angles are shown, (4,), from the attitude ``local`` (4,) in ENU or relative to the origin.

    Relative to an origin only the body's axes follow the convention: at the origin all angles are zero in each.
    """
    if not has_origin:
        return display_quat(local, convention)
    body = CONVENTIONS[convention].body
    return multiply(multiply(body, local), conjugate(body))


def heading_reason(status: Status) -> str:
    """Why the heading is not one from the magnetic north; "" when it is."""
    return _NO_HEADING.get(status.mag_trust, "")


def origin_words(set_s_ago: float) -> str:
    """How the angles are to be read while an origin is set; NaN: not known since when."""
    if math.isnan(set_s_ago):
        return "relative to the origin"
    whole = f"{set_s_ago:.0f} s" if set_s_ago < 60 else span(set_s_ago)
    return f"relative to the origin set {whole} ago"


def quat_words(quat: NDArray[np.float64]) -> str:
    """A quaternion (4,) with the digits a cheap board deserves: a step of 0.001 is a tenth of a degree."""
    return "  ".join(f"{name} {value:+.3f}".replace("-", "−") for name, value in zip("wxyz", quat, strict=True))


def takeover_words(note: str) -> tuple[str, str]:
    """A filter's note in two parts: what happened, in short, and why, as a sentence."""
    what, _, why = note.partition(": ")
    return what, why[:1].upper() + why[1:]


def sigma_words(tilt: float, heading: float) -> str:
    """The filter's own 1 sigma, rad, in degrees with two digits at most; "" where it says none."""
    said = [(name, math.degrees(value)) for name, value in (("tilt", tilt), ("heading", heading)) if value == value]
    return "  ".join(f"{name} ±{degrees:.{int(degrees < 10.0)}f}°" for name, degrees in said)
