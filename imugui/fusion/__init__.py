"""Sensor fusion: from corrected samples to attitudes.

``FILTERS`` is the one table of filters; its order is the order on screen. Where the ``vqf`` library cannot be
imported the table lacks "vqf", Madgwick's filter is the default, and ``VQF_MISSING`` says so in a sentence.
"""

from __future__ import annotations

from imugui.fusion.filter import Filter
from imugui.lazy import Lazy

FILTER_TITLES = {
    "vqf": "VQF",
    "imugui": "imugui",
    "madgwick": "Madgwick",
    "mahony": "Mahony",
    "complementary": "Complementary",
}
"""What the filters are called, without importing them."""

_PLACES = {
    "vqf": "imugui.fusion.vqf_filter:Vqf",
    "imugui": "imugui.fusion.imugui_filter:Imugui",
    "madgwick": "imugui.fusion.madgwick:Madgwick",
    "mahony": "imugui.fusion.mahony:Mahony",
    "complementary": "imugui.fusion.complementary:Complementary",
}

VQF_MISSING = ""
"""A sentence for the screen where the best filter is missing; empty where it is there."""

try:
    import imugui.fusion.vqf_filter  # noqa: F401
except ImportError as problem:
    VQF_MISSING = (
        f"The VQF filter is not available because its library cannot be loaded ({problem}). "
        "Madgwick's filter is used instead. On systems with a wheel, 'pip install vqf' brings it."
    )
    del FILTER_TITLES["vqf"], _PLACES["vqf"]

FILTERS: Lazy[type[Filter]] = Lazy(_PLACES)

DEFAULT_FILTER = "madgwick" if VQF_MISSING else "vqf"
