"""The Settings page: look and display, where files are, the keyboard, what this program is."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import Any

from PySide6.QtCore import Qt, QUrl, Slot
from PySide6.QtGui import QDesktopServices
from PySide6.QtWidgets import QFrame, QGridLayout, QHBoxLayout, QLabel, QScrollArea, QVBoxLayout, QWidget

from imugui import paths
from imugui.fusion import VQF_MISSING
from imugui.settings import Settings
from imugui.views import about, theme
from imugui.views.controls import Button
from imugui.views.form import Form
from imugui.views.labels import ElidedLabel, heading, muted
from imugui.views.settings_store import SettingsStore
from imugui.views.shortcuts import GAME_KEYS, KEYS, PLOT_KEYS
from imugui.views.view import View
from imugui.workers.session import Session

WIDTH = 680
ON_PAGE = ("theme", "convention", "decimals", "field_ut")
"""The settings that are edited here; the others follow what the user does elsewhere."""


def shown_settings(settings: Settings) -> Any:
    """The part of the settings that this page edits, as a dataclass of its own."""
    items = [item for item in dataclasses.fields(Settings) if item.name in ON_PAGE]
    described = [
        (item.name, type(item.default), dataclasses.field(default=item.default, metadata=item.metadata))
        for item in items
    ]
    kind = dataclasses.make_dataclass("ShownSettings", described, frozen=True)
    return kind(**{item.name: getattr(settings, item.name) for item in items})


class SettingsView(View):
    """Changes act at once and are kept."""

    title = "Settings"
    icon = "settings"
    tip = "Colours, display, files, keyboard"
    at_foot = True

    def __init__(self, session: Session, settings_store: SettingsStore) -> None:
        super().__init__(session, settings_store)
        self.form = Form(shown_settings(settings_store.settings))
        self.form.changed.connect(self._changed)
        column = QVBoxLayout()
        column.setContentsMargins(0, 16, 0, 24)
        column.setSpacing(16)
        column.addWidget(_card("Display", self.form))
        column.addWidget(_card("Files", self._files()))
        if VQF_MISSING:
            column.addWidget(_card("Filter", muted(f"{theme.tone_glyph('warn')} {VQF_MISSING}")))
        column.addWidget(_card("Keyboard", _keyboard()))
        column.addWidget(_card("About", _about()))
        column.addStretch(1)
        inside = QWidget()
        inside.setMaximumWidth(WIDTH)
        inside.setLayout(column)
        middle = QWidget()
        row = QHBoxLayout(middle)
        row.setContentsMargins(16, 0, 16, 0)
        row.addStretch(1)
        row.addWidget(inside, 100)
        row.addStretch(1)
        area = QScrollArea()
        area.setWidgetResizable(True)
        area.setWidget(middle)
        outside = QVBoxLayout(self)
        outside.setContentsMargins(0, 0, 0, 0)
        outside.addWidget(area)

    def slow_refresh(self) -> None:
        shown = shown_settings(self.settings_store.settings)
        if dataclasses.astuple(shown) != dataclasses.astuple(self.form.value()):
            self.form.set_value(dataclasses.replace(self.form.value(), **dataclasses.asdict(shown)))

    @Slot(object)
    def _changed(self, shown: Any) -> None:
        self.settings_store.update(**dataclasses.asdict(shown))

    def _files(self) -> QWidget:
        own = self.settings_store.path
        places = {
            "Settings and log": own.parent if own else paths.user_folder(),
            "Recordings": paths.documents_folder(),
        }
        box = QWidget()
        grid = QGridLayout(box)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setHorizontalSpacing(16)
        grid.setColumnStretch(1, 1)
        for row, (title, folder) in enumerate(places.items()):
            button = Button("Open folder", f"Show {folder} in the file manager", small=True)
            button.setAccessibleName(f"Open the folder of {title.lower()}")
            button.clicked.connect(lambda _=False, folder=folder: _open(folder))
            grid.addWidget(QLabel(title), row, 0)
            grid.addWidget(ElidedLabel(str(folder)), row, 1)
            grid.addWidget(button, row, 2)
        return box


def _open(folder: Path) -> None:
    """Show a folder in the file manager; where it does not exist yet, the nearest that does."""
    there = next((one for one in (folder, *folder.parents) if one.is_dir()), folder)
    QDesktopServices.openUrl(QUrl.fromLocalFile(str(there)))


def _card(title: str, inside: QWidget) -> QFrame:
    card = QFrame()
    card.setProperty("role", "card")
    column = QVBoxLayout(card)
    column.setContentsMargins(20, 16, 20, 18)
    column.setSpacing(12)
    column.addWidget(heading(title))
    column.addWidget(inside)
    return card


def _keyboard() -> QWidget:
    box = QWidget()
    grid = QGridLayout(box)
    grid.setContentsMargins(0, 0, 0, 0)
    grid.setHorizontalSpacing(20)
    grid.setVerticalSpacing(6)
    grid.setColumnStretch(1, 1)
    every = (*KEYS, *PLOT_KEYS, *GAME_KEYS)
    rows = [("1, 2, …", "Bring a page to the front"), *((key.keys, key.words) for key in every)]
    rows.append(("Arrows, + and −", "In the picture: look around and zoom; turn the board where it is turned by hand"))
    for row, (keys, words) in enumerate(rows):
        label = QLabel(keys)
        label.setProperty("role", "heading")
        grid.addWidget(label, row, 0, Qt.AlignmentFlag.AlignTop)
        explained = QLabel(words)
        explained.setWordWrap(True)
        grid.addWidget(explained, row, 1)
    return box


def _about() -> QWidget:
    box = QWidget()
    column = QVBoxLayout(box)
    column.setContentsMargins(0, 0, 0, 0)
    column.setSpacing(6)
    column.addWidget(QLabel(about.NAME))
    for text in (about.NOT_MEDICAL, about.LICENCE):
        line = muted(text)
        column.addWidget(line)
    return box
