"""Sensor fusion: from corrected samples to attitudes.

``FILTERS`` is the one table of filters; its order is the order on screen. Where the ``vqf`` library cannot be
imported the table lacks "vqf", Madgwick's filter is the default, and ``VQF_MISSING`` says so in a sentence.
"""

from __future__ import annotations

from imugui.fusion.complementary import Complementary
from imugui.fusion.filter import Filter
from imugui.fusion.imugui_filter import Imugui
from imugui.fusion.madgwick import Madgwick
from imugui.fusion.mahony import Mahony

FILTERS: dict[str, type[Filter]] = {
    "imugui": Imugui,
    "madgwick": Madgwick,
    "mahony": Mahony,
    "complementary": Complementary,
}

VQF_MISSING = ""
"""A sentence for the screen where the best filter is missing; empty where it is there."""

try:
    from imugui.fusion.vqf_filter import Vqf
except ImportError as problem:
    VQF_MISSING = (
        f"The VQF filter is not available because its library cannot be loaded ({problem}). "
        "Madgwick's filter is used instead. On systems with a wheel, 'pip install vqf' brings it."
    )
else:
    FILTERS = {"vqf": Vqf, **FILTERS}

DEFAULT_FILTER = "madgwick" if VQF_MISSING else "vqf"
