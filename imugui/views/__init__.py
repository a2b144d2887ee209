"""Widgets. VIEWS: the pages by name, in the order of the rail."""

from __future__ import annotations

from imugui.views.live_view import LiveView
from imugui.views.settings_view import SettingsView
from imugui.views.view import View

VIEWS: dict[str, type[View]] = {
    "live": LiveView,
    "settings": SettingsView,
}
