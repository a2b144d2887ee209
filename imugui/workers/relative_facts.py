"""What guidance must know of two boards together, from what it must know of each."""

from __future__ import annotations

import math
from typing import Any

from imugui.workers.relative_worker import RelativeWorker

NOT_ALIGNED = (
    "The headings of the two boards are not aligned. Hold them the same way round and press Set origin, then "
    "register again."
)
LENGTHS = ("base_tilt", "base_heading", "drift")
"""Errors that the two boards make independently of each other."""
EITHER = ("mag_disturbed", "profile_expired")
BOTH = ("streaming", "calibrated", "prior_holds")


def relative_facts(tool: dict[str, Any], reference: dict[str, Any], relative: RelativeWorker) -> dict[str, Any]:
    """Keyword values of ``guidance.facts.Facts``, and ``epoch``, from the ``guide_facts`` of the two."""
    turned, reference_turned = relative.turnings
    return {
        **tool,
        **{name: math.hypot(tool[name], reference[name]) for name in LENGTHS},
        **{name: tool[name] or reference[name] for name in EITHER},
        **{name: tool[name] and reference[name] for name in BOTH},
        "relative": True,
        "use_mag": relative.same_north,
        "epoch": relative.epoch,
        "epoch_words": "" if relative.aligned else NOT_ALIGNED,
        "aligned_at": relative.aligned_at,
        "filter": _words(tool["filter"], reference["filter"]),
        "profile_words": f"{tool['profile_words']}; reference: {reference['profile_words']}",
        "profile_warning": " ".join(filter(None, (tool["profile_warning"], reference["profile_warning"]))),
        "temp_c": math.nan,  # of two boards: the usual warming up is reckoned with
        "turn_share": 1.0,  # the turning below has each board's own share in it
        "turning": math.hypot(tool["turn_share"] * turned, reference["turn_share"] * reference_turned),
        "shaken": relative.shaken,
    }


def _words(tool: str, reference: str) -> str:
    return tool if tool == reference else f"{tool}; reference: {reference}"
