"""Widgets. VIEWS: the pages by name, in the order of the rail."""

from __future__ import annotations

from imugui.views.calibrate_view import CalibrateView
from imugui.views.live_view import LiveView
from imugui.views.record_view import RecordView
from imugui.views.settings_view import SettingsView
from imugui.views.signals_view import SignalsView
from imugui.views.view import View

VIEWS: dict[str, type[View]] = {
    "live": LiveView,
    "calibrate": CalibrateView,
    "record": RecordView,
    "signals": SignalsView,
    "settings": SettingsView,
}
