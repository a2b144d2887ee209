"""Small controls that all pages share."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QSize, Qt
from PySide6.QtGui import QPaintEvent, QWheelEvent
from PySide6.QtWidgets import (
    QComboBox,
    QLayout,
    QPushButton,
    QStyle,
    QStyledItemDelegate,
    QStyleOptionComboBox,
    QStylePainter,
)

from imugui.views import theme
from imugui.views.shortcuts import tip

ENTRY_HEIGHT = 25
"""Of an entry in an open list, px."""
ICON_GAP = 12


class Button(QPushButton):
    """A button with a tooltip, an accessible name, and an icon in the scheme's colours."""

    def __init__(self, text: str, words: str, action: str = "", icon: str = "", role: str = "", small: bool = False):
        """``words`` is the tooltip, ``action`` a key of the keyboard table, ``role`` one of the style sheet's."""
        super().__init__()
        self._icon = icon
        self.setText(text)
        self.setToolTip(tip(action, words))
        self.setAccessibleName(text.replace("…", "") or words)
        self.setProperty("role", role)
        if small:
            self.setFont(theme.font("small"))
        self.setIconSize(QSize(16, 16))

    def setText(self, text: str) -> None:
        """Text with air between it and the icon."""
        super().setText(f" {text}" if self._icon and text else text)

    def setIconSize(self, size: QSize) -> None:
        """Show the icon this large."""
        super().setIconSize(size)
        self._paint_icon()

    def set_icon(self, name: str) -> None:
        """Show another icon."""
        if name != self._icon:
            self._icon = name
            self._paint_icon()

    def set_role(self, role: str) -> None:
        """Take another look: "primary", "quiet", "recording" or ""."""
        if role != self.property("role"):
            self.setProperty("role", role)
            self.style().polish(self)
            self._paint_icon()

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() == QEvent.Type.PaletteChange:
            self._paint_icon()

    def _paint_icon(self) -> None:
        if self._icon:
            colours = theme.palette()
            special = {"primary": colours.on_accent, "recording": colours.bad}
            colour = special.get(self.property("role"), colours.text)
            self.setIcon(theme.icon(self._icon, colour, self.iconSize().width()))


class StillBox(QComboBox):
    """A combo box that a passing wheel does not change, and that cuts a long text with dots."""

    SHORT = Qt.ItemDataRole.UserRole + 1
    """What the closed box shows of an entry, where that is shorter than in the list."""

    def __init__(self, name: str, words: str) -> None:
        super().__init__()
        self.setAccessibleName(name)
        self.setToolTip(words)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setItemDelegate(QStyledItemDelegate(self))  # the usual one of a combo box gives entries no room

    def add(self, text: str, data: object, short: str = "", words: str = "") -> None:
        """Add an entry; ``words`` is its tooltip."""
        self.insert(self.count(), text, data, short, words)

    def insert(self, row: int, text: str, data: object, short: str = "", words: str = "") -> None:
        """Add an entry at a row."""
        self.insertItem(row, text, data)
        self.setItemData(row, QSize(0, ENTRY_HEIGHT), Qt.ItemDataRole.SizeHintRole)
        self.setItemData(row, short or None, self.SHORT)
        self.setItemData(row, words or None, Qt.ItemDataRole.ToolTipRole)

    def choose(self, data: object) -> None:
        """Show the entry with these data; the first where there is none."""
        row = max(0, self.findData(data))
        if row != self.currentIndex():
            self.setCurrentIndex(row)

    def showPopup(self) -> None:
        widest = max(map(self._room_for, range(self.count())), default=0)
        self.view().setMinimumWidth(widest + 32)
        super().showPopup()

    def _room_for(self, row: int) -> int:
        """Width of an entry, pixels."""
        icon = 0 if self.itemIcon(row).isNull() else self.iconSize().width() + ICON_GAP
        return icon + max(map(self.fontMetrics().horizontalAdvance, self.itemText(row).split("\n")))

    def wheelEvent(self, event: QWheelEvent) -> None:
        event.ignore()

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QStylePainter(self)
        option = QStyleOptionComboBox()
        self.initStyleOption(option)
        room = self.style().subControlRect(
            QStyle.ComplexControl.CC_ComboBox, option, QStyle.SubControl.SC_ComboBoxEditField, self
        )
        text = self.currentData(self.SHORT) or self.currentText()
        option.currentText = self.fontMetrics().elidedText(text, Qt.TextElideMode.ElideRight, room.width() - 4)
        painter.drawComplexControl(QStyle.ComplexControl.CC_ComboBox, option)
        if not self.isEditable():
            painter.drawControl(QStyle.ControlElement.CE_ComboBoxLabel, option)
        painter.end()


def clear(layout: QLayout) -> None:
    """Take every widget out of a layout and let it go."""
    while item := layout.takeAt(0):
        widget = item.widget()
        if widget is not None:
            widget.hide()
            widget.deleteLater()
