"""View: the base of every page."""

from __future__ import annotations

from typing import Any

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QWidget

from imugui.views.settings_store import SettingsStore
from imugui.workers.session import Port, Session


class View(QWidget):
    """A page of the window. Only the page in front is refreshed; hidden pages do no work."""

    title = ""
    icon = ""  # a file of resources/icons
    tip = ""
    at_foot = False  # True: its button stands at the foot of the rail

    wanted = Signal(str, str)  # transport, address: the user asks this page for a source; an empty address: any file

    said = Signal(str, str)  # tone "info", "warn" or "error", and a sentence for the banner

    record_wanted = Signal()  # the user asks this page to begin or end a recording

    def __init__(self, session: Session, settings_store: SettingsStore) -> None:
        super().__init__()
        self.session = session
        self.settings_store = settings_store
        self.setAccessibleName(self.title)

    def refresh(self) -> None:
        """Paint the newest data; called 60 times a second while in front."""

    def slow_refresh(self) -> None:
        """Bring words and controls up to date; called 8 times a second while in front."""

    def show_ports(self, ports: list[Port]) -> None:
        """The serial ports of this computer have changed."""

    def show_ghost(self, quat: Any | None) -> None:
        """Another attitude (w, x, y, z) to be seen beside the present one, or None."""

    def stop(self) -> None:
        """The window closes: end what runs beside."""

    def origin_moved(self) -> None:
        """The user has just set the origin."""
