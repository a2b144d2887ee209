"""Widgets. PAGES and VIEWS: the pages by name, in the order of the rail. A new page is one line in PAGES."""

from __future__ import annotations

from dataclasses import dataclass

from imugui.lazy import Lazy
from imugui.views.view import View


@dataclass(frozen=True)
class Page:
    """What the rail shows of a page, as its View has it too, and where that is."""

    title: str
    icon: str
    tip: str
    place: str  # module of this package, and class
    at_foot: bool = False


PAGES: dict[str, Page] = {
    "live": Page("Live", "live", "The board as it is held now", "live_view:LiveView"),
    "calibrate": Page(
        "Calibrate", "calibrate", "Calibrate the board, and see how far to trust it", "calibrate_view:CalibrateView"
    ),
    "guide": Page("Guide", "guide", "Aim a tool at a planned direction", "guide_view:GuideView"),
    "target": Page(
        "Target", "target", "Steer a field of view onto targets, and compare mappings", "target_view:TargetView"
    ),
    "record": Page("Record", "record", "Collect data for a set time; all recordings", "record_view:RecordView"),
    "signals": Page("Signals", "signals", "Curves over time, spectra, statistics", "signals_view:SignalsView"),
    "settings": Page("Settings", "settings", "Colours, display, files, keyboard", "settings_view:SettingsView", True),
}
VIEWS: Lazy[type[View]] = Lazy({name: f"imugui.views.{page.place}" for name, page in PAGES.items()})
