"""The left rail: one button for each page."""

from __future__ import annotations

from collections.abc import Mapping

from PySide6.QtCore import QEvent, QSize, Qt, Signal
from PySide6.QtWidgets import QButtonGroup, QFrame, QToolButton, QVBoxLayout

from imugui.views import Page, theme

WIDTH = 90
ICON = QSize(26, 26)


class Navigation(QFrame):
    """Buttons in the order of the pages; those of pages at the foot stand below."""

    chosen = Signal(str)  # key of the page

    def __init__(self, pages: Mapping[str, Page]) -> None:
        super().__init__()
        self.setProperty("role", "rail")
        self.setAccessibleName("Pages")
        self.setFixedWidth(WIDTH)
        self._pages = pages
        self._group = QButtonGroup(self)
        self.buttons = {name: self._button(name, page, i) for i, (name, page) in enumerate(pages.items(), 1)}
        column = QVBoxLayout(self)
        column.setContentsMargins(8, 12, 8, 12)
        column.setSpacing(4)
        for at_foot in (False, True):
            for name, page in pages.items():
                if page.at_foot is at_foot:
                    column.addWidget(self.buttons[name])
            if not at_foot:
                column.addStretch(1)
        self._paint_icons()

    def select(self, name: str) -> None:
        """Mark the page in front."""
        self.buttons[name].setChecked(True)
        self._paint_icons()

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() == QEvent.Type.PaletteChange:
            self._paint_icons()

    def _button(self, name: str, page: Page, number: int) -> QToolButton:
        button = QToolButton()
        button.setProperty("role", "rail")
        button.setText(page.title)
        button.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextUnderIcon)
        button.setIconSize(ICON)
        button.setFixedSize(WIDTH - 12, 62)
        button.setFont(theme.font("small"))
        button.setCheckable(True)
        button.setFocusPolicy(Qt.FocusPolicy.TabFocus)  # after a click the keys stay with the page and the replay
        button.setToolTip(f"{page.tip} ({number})")
        button.setAccessibleName(f"Page {page.title}")
        button.clicked.connect(lambda: self.chosen.emit(name))
        self._group.addButton(button)
        return button

    def _paint_icons(self) -> None:
        colours = theme.palette()
        for name, button in self.buttons.items():
            colour = colours.accent if button.isChecked() else colours.muted
            button.setIcon(theme.icon(self._pages[name].icon, colour, ICON.width()))
