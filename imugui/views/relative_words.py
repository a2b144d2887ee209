"""What is said of the tool's attitude in the reference board's frame."""

from __future__ import annotations

import math

from imugui.views.status_words import span
from imugui.workers.session import RelativeStatus

IN_FRAME = "Relative to the reference board"
WAITING = "Waiting for both boards"
SILENT_MS = 500.0
"""A newest attitude older than this is said first."""
HELD_DEG = 10.0
"""Two boards that differ by more than this, apart from the heading, were hardly held the same way round."""
NOT_ALIGNED = "Not aligned"
HOW_TO_ALIGN = (
    "Without a magnetometer each board has a heading of its own. Hold both the same way round, then press Set origin."
)


def relative_words(status: RelativeStatus) -> tuple[str, str]:
    """Tone and phrase: whether the relative attitude can be trusted, and why not."""
    for name, age_ms in (("Tool", status.tool_age_ms), ("Reference", status.reference_age_ms)):
        if math.isnan(age_ms):
            return "bad", f"{name} sends nothing"
        if age_ms > SILENT_MS:
            return "bad", f"{name} silent for {span(age_ms / 1e3)}"
    if not status.aligned:
        return "warn", NOT_ALIGNED
    if status.same_north:
        return "good", "Common north"
    since = f"{status.aligned_s:.0f} s" if status.aligned_s < 60.0 else span(status.aligned_s)
    return "good", f"Aligned {since} ago"


def stale_relative(status: RelativeStatus, rows: int) -> str:
    """Why the relative attitude is not live, in words; "" when it is. ``rows``: how many there are of it."""
    tone, words = relative_words(status)
    return words if tone == "bad" else "" if rows else WAITING


def age_words(tool_ms: float, reference_ms: float) -> str:
    """How old the newest attitudes of both are."""
    return f"tool {_ms(tool_ms)}, reference {_ms(reference_ms)}"


def aligned_words(status: RelativeStatus) -> tuple[str, str]:
    """Tone of a message and what to say of an alignment; an empty sentence when all is well."""
    if not status.residual_deg > HELD_DEG:
        return "info", ""
    return "warn", (
        f"Apart from the heading the two boards differ by {status.residual_deg:.0f}°. If they were meant to be held "
        "the same way round, hold them so and set the origin again; else their headings are not aligned."
    )


def _ms(age_ms: float) -> str:
    if math.isnan(age_ms):
        return "–"
    return f"{age_ms:.0f} ms" if age_ms < 1e3 else span(age_ms / 1e3)
