"""SourceBox: the one list of everything data can come from."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from PySide6.QtCore import QEvent, QSize, Qt, Signal, Slot
from PySide6.QtGui import QKeyEvent, QStandardItem, QStandardItemModel
from PySide6.QtWidgets import QComboBox, QLineEdit

from imugui.views import theme
from imugui.views.controls import ENTRY_HEIGHT, StillBox
from imugui.workers.session import MOTION_TITLES, Port

HEADING_HEIGHT = 28
REMEMBERED = 4  # files and typed addresses


@dataclass(frozen=True)
class Choice:
    """An entry of the list. An empty address means: ask the user for it."""

    transport: str
    address: str
    text: str  # in the list
    tip: str = ""
    short: str = ""  # in the closed box, where that differs

    @property
    def key(self) -> tuple[str, str]:
        """What tells two choices apart."""
        return self.transport, self.address


TYPE_ADDRESS = Choice("serial", "", "Type a port address…", "A port by name, or any address that pyserial opens")
OPEN_FILE = Choice("replay", "", "Open a recording…", "A capture of a board's bytes, or a CSV file with samples")
Sections = list[tuple[str, list[Choice]]]


def port_choice(port: Port) -> Choice:
    """A serial port with what is known of the board behind it."""
    about = port.hint or port.description
    return Choice("serial", port.device, f"{port.device}  ({about})" if about else port.device, port.description)


def _motion_choice(name: str, title: str) -> Choice:
    return Choice("simulator", name, title, "A virtual board in this computer", f"Simulated: {title.lower()}")


def bare_choice(transport: str, address: str) -> Choice:
    """A choice the lists do not hold: a typed address, a port that is gone, a file."""
    if transport == "replay":
        name = Path(address).name
        return Choice(transport, address, name, address, f"Recording: {name}")
    return Choice(transport, address, address, address)


def sections(ports: list[Port], extra: list[Choice]) -> Sections:
    """The whole list: simulated motions, serial ports, recordings; ``extra`` choices join the section of their kind."""
    known = {port.device for port in ports}
    typed = [one for one in extra if one.transport == "serial" and one.address not in known]
    files = [one for one in extra if one.transport == "replay"]
    return [
        ("SIMULATED BOARD", [_motion_choice(name, title) for name, title in MOTION_TITLES.items()]),
        ("SERIAL PORT", [*map(port_choice, ports), *typed, TYPE_ADDRESS]),
        ("RECORDING", [*files, OPEN_FILE]),
    ]


class SourceBox(StillBox):
    """Shows Choices under headings. Its list renews itself without losing what is chosen."""

    picked = Signal()  # the user has chosen an entry, or typed an address

    def __init__(self) -> None:
        super().__init__("Source", "Where the data come from. Serial ports appear by themselves")
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

    def choice(self) -> Choice:
        """What is chosen."""
        return self._chosen

    def choose_source(self, transport: str, address: str) -> None:
        """Choose an entry; one that the list does not hold joins it."""
        self._end_typing()
        known = {one.key: one for one in self.choices()}
        self._chosen = known.get((transport, address)) or bare_choice(transport, address)
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

    def hidePopup(self) -> None:
        super().hidePopup()
        if self._late and not self.isEditable():
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
        self._chosen = data
        self.picked.emit()

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
        extra = list(self._extra)
        if self._chosen.address and self._chosen.key not in {one.key for one in extra}:
            extra.insert(0, self._chosen)  # unplugged it is still the one that the user wants
        model = QStandardItemModel(self)
        for title, choices in sections(self._ports, extra):
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
    return item
