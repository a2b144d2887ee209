"""Widgets. PAGES and VIEWS: the pages by name, in the order of the rail. A new page is one line in PAGES."""

from __future__ import annotations

import importlib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from imugui.views.view import View


@dataclass(frozen=True)
class Page:
    """What the rail shows of a page, as its View has it too, and where that is."""

    title: str
    icon: str
    tip: str
    place: str  # module of this package, and class
    at_foot: bool = False


class Views(Mapping[str, type[View]]):
    """The pages' classes. A page is imported when it is first asked for: the window starts in half the time."""

    def __init__(self, pages: Mapping[str, Page]) -> None:
        self._pages = pages

    def __getitem__(self, name: str) -> type[View]:
        module, kind = self._pages[name].place.split(":")
        view: type[View] = getattr(importlib.import_module(f"{__name__}.{module}"), kind)
        return view

    def __iter__(self) -> Iterator[str]:
        return iter(self._pages)

    def __len__(self) -> int:
        return len(self._pages)


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
VIEWS = Views(PAGES)
