"""SourceBox: the one list of everything data can come from."""

from __future__ import annotations

import textwrap

from PySide6.QtCore import QEvent, QSize, Qt, QTimer, Signal, Slot
from PySide6.QtGui import QKeyEvent, QStandardItem, QStandardItemModel
from PySide6.QtWidgets import QComboBox, QLineEdit

from imugui.simulation import MOTION_TITLES
from imugui.views import theme
from imugui.views.ble_search import BleSearch
from imugui.views.controls import ENTRY_HEIGHT, StillBox
from imugui.views.signal_bars import bars_icon
from imugui.views.source_choices import (
    BLUETOOTH,
    OPEN_FILE,
    TYPE_ADDRESS,
    Choice,
    Note,
    bare_choice,
    bluetooth,
    names_of,
    sections,
)
from imugui.workers.session import Port

__all__ = ["OPEN_FILE", "TYPE_ADDRESS", "Choice", "SourceBox"]

HEADING_HEIGHT = 28
NOTE_LINE = 17  # px
NOTE_COLUMNS = 64  # letters in a line of a note
REMEMBERED = 4  # files and typed addresses
LAST = "RECORDING"
PLACE = Qt.ItemDataRole.UserRole + 2
"""Which section an item is of."""


class SourceBox(StillBox):
    """Shows Choices under headings. Its list renews itself without losing what is chosen."""

    picked = Signal()  # the user has chosen an entry, or typed an address

    def __init__(self, search: BleSearch | None = None) -> None:
        """``search``: looks for Bluetooth boards; None where there are none to choose."""
        super().__init__("Source", "Where the data come from. Serial ports appear by themselves")
        self._search = search
        self._show_all = False
        self.setMaxVisibleItems(24)
        self.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
        self.setMinimumContentsLength(11)
        self.setInsertPolicy(QComboBox.InsertPolicy.NoInsert)
        self._ports: list[Port] = []
        self._extra: list[Choice] = []
        self._chosen = Choice("simulator", next(iter(MOTION_TITLES)), "")
        self._late = False
        self._fill()
        self.activated.connect(self._picked)
        if search is not None:
            search.changed.connect(self._boards_changed)

    def choice(self) -> Choice:
        """What is chosen."""
        return self._chosen

    def choose_source(self, transport: str, address: str, name: str = "") -> None:
        """Choose an entry; one that the list does not hold joins it, a Bluetooth board with its name."""
        self._end_typing()
        known = {one.key: one for one in self.choices()}
        name = name or names_of(self._search).get(address, "")
        self._chosen = known.get((transport, address)) or bare_choice(transport, address, name)
        if address and self._chosen.key not in known:
            self._extra = [self._chosen, *self._extra][:REMEMBERED]
        self._fill()

    def show_ports(self, ports: list[Port]) -> None:
        """Take a new list of ports; it waits while the user reads the list or types."""
        self._ports = ports
        self._late = self.view().isVisible() or self.isEditable()
        if not self._late:
            self._fill()

    def ports(self) -> list[Port]:
        """The serial ports of this computer."""
        return self._ports

    def choices(self) -> list[Choice]:
        """Every entry, without the headings."""
        return [data for row in range(self.count()) if isinstance(data := self.itemData(row), Choice)]

    def showPopup(self) -> None:
        """While the list is open Bluetooth boards are looked for, once somebody has asked for them."""
        if self._search is not None and (self._search.used or self._chosen.transport == "ble"):
            self._search.start()
        super().showPopup()

    def hidePopup(self) -> None:
        super().hidePopup()
        if self._search is not None and self._search.running:
            self._search.stop()
            self._late = True
        QTimer.singleShot(0, self, self._catch_up)  # what was clicked is looked up in the list as it was

    @Slot()
    def _catch_up(self) -> None:
        if self._late and not self.isEditable() and not self.view().isVisible():
            self._fill()

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() == QEvent.Type.PaletteChange and self.count() and not self.isEditable():
            self._fill()  # the headings have a colour of their own

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if self.isEditable() and event.key() == Qt.Key.Key_Escape:
            self._end_typing()
        else:
            super().keyPressEvent(event)

    @Slot(int)
    def _picked(self, row: int) -> None:
        data = self.itemData(row)
        if self.isEditable() or not isinstance(data, Choice):
            return
        if data == TYPE_ADDRESS:
            self._begin_typing()
            return
        if data.action:
            self._show_all ^= data.action == "show_all"
            self.search_bluetooth()
            return
        self._chosen = data
        self.picked.emit()

    def search_bluetooth(self) -> None:
        """Search for boards, and open the list with what was found."""
        if self._search is not None:
            self._search.used = True
        QTimer.singleShot(0, self, self._show_boards)

    @Slot()
    def _show_boards(self) -> None:
        self._fill()
        self.showPopup()
        heading = self.findText(BLUETOOTH)
        self.view().scrollTo(self.model().index(heading, 0), self.view().ScrollHint.PositionAtTop)

    @Slot()
    def _boards_changed(self) -> None:
        """Renew the Bluetooth section, also of an open list: what stands in it keeps its place."""
        model = self.model()
        if self._search is None or self.isEditable() or not isinstance(model, QStandardItemModel):
            return
        fresh = self._bluetooth_items(self._search)
        old = [row for row in range(model.rowCount()) if model.item(row).data(PLACE) == BLUETOOTH]
        widest = max(map(self._room_for, old))
        self.blockSignals(True)
        for row, item in zip(old, fresh, strict=False):
            model.setItem(row, item)
        for row, item in enumerate(fresh[len(old) :], old[-1] + 1):
            model.insertRow(row, item)
        model.removeRows(old[0] + len(fresh), max(0, len(old) - len(fresh)))
        self.setCurrentIndex(self._row_of(self._chosen))
        self.blockSignals(False)
        wider = any(self._room_for(row) > widest for row in range(old[0], old[0] + len(fresh)))
        if self.view().isVisible() and (len(fresh) != len(old) or wider):
            self._fit_list()

    def _fit_list(self) -> None:
        """An open list grows with what was found, as far as the screen goes."""
        place = self.view().verticalScrollBar().value()
        super().showPopup()
        self.view().verticalScrollBar().setValue(place)

    def _bluetooth_items(self, search: BleSearch) -> list[QStandardItem]:
        items = [_heading(BLUETOOTH)]
        for one in bluetooth(search, self._remembered(), self._show_all):
            items.append(_note(one) if isinstance(one, Note) else _entry(one))
        for item in items:
            item.setData(BLUETOOTH, PLACE)
        return items

    def _remembered(self) -> list[Choice]:
        """Choices beside those that were found: unplugged, a board is still the one that the user wants."""
        known = {one.key for one in self._extra}
        wanted = [self._chosen] if self._chosen.address and self._chosen.key not in known else []
        return [*wanted, *self._extra]

    def _begin_typing(self) -> None:
        edit = QLineEdit()
        self.setLineEdit(edit)
        edit.clear()
        edit.setPlaceholderText("/dev/ttyUSB0, COM7, socket://host:port")
        edit.setAccessibleName("Port address")
        edit.editingFinished.connect(self.finish_typing)
        self.setCompleter(None)  # type: ignore[arg-type]
        edit.setFocus()

    @Slot()
    def finish_typing(self) -> None:
        """Take the address that is being typed, if one is."""
        address = self.currentText().strip()
        if not self.isEditable():
            return
        if address:
            self.choose_source("serial", address)
            self.picked.emit()
        else:
            self._end_typing()

    def _end_typing(self) -> None:
        edit = self.lineEdit()
        if edit is not None:
            edit.blockSignals(True)
            self.setEditable(False)
            self._fill()

    def _fill(self) -> None:
        self._late = False
        model = QStandardItemModel(self)
        for title, choices in sections(self._ports, self._remembered()):
            if title == LAST and self._search is not None:
                for item in self._bluetooth_items(self._search):
                    model.appendRow(item)
            model.appendRow(_heading(title))
            for choice in choices:
                model.appendRow(_entry(choice))
        self.blockSignals(True)
        self.setModel(model)  # deletes the old one, which is its child
        self.setCurrentIndex(self._row_of(self._chosen))
        self.blockSignals(False)
        self.setAccessibleDescription(self.currentText())

    def _row_of(self, choice: Choice) -> int:
        rows = (
            i for i in range(self.count()) if isinstance(data := self.itemData(i), Choice) and data.key == choice.key
        )
        return next(rows, -1)


def _heading(title: str) -> QStandardItem:
    item = QStandardItem(title)
    item.setFlags(Qt.ItemFlag.NoItemFlags)
    item.setFont(theme.font("small"))
    item.setSizeHint(QSize(0, HEADING_HEIGHT))
    item.setForeground(theme.palette().muted)
    item.setTextAlignment(Qt.AlignmentFlag.AlignBottom)
    return item


def _entry(choice: Choice) -> QStandardItem:
    item = QStandardItem(choice.text)
    item.setSizeHint(QSize(0, ENTRY_HEIGHT))
    item.setData(choice, Qt.ItemDataRole.UserRole)
    item.setData(choice.short or None, StillBox.SHORT)
    item.setToolTip(choice.tip)
    if choice.bars >= 0:
        item.setIcon(bars_icon(choice.bars))
    return item


def _note(note: Note) -> QStandardItem:
    lines = textwrap.wrap(f"{theme.tone_glyph(note.tone)} {note.text}", NOTE_COLUMNS)
    item = QStandardItem("\n".join(lines))
    item.setFlags(Qt.ItemFlag.NoItemFlags)
    item.setFont(theme.font("small"))
    item.setForeground(theme.palette().text if note.tone != "neutral" else theme.palette().muted)
    item.setSizeHint(QSize(0, ENTRY_HEIGHT + NOTE_LINE * (len(lines) - 1)))
    item.setToolTip(note.text)
    return item
