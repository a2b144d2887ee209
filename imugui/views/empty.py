"""The empty state: what a page will show, and the ways to get there."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QSize, Qt, Signal
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QVBoxLayout, QWidget

from imugui.views import about, theme
from imugui.views.controls import Button, clear
from imugui.views.labels import ElidedLabel, heading, muted
from imugui.workers.session import Port

FIRST_MOTION = "hand"
CARD_WIDTH = 580
PICTURE = 56  # px
MOST_PORTS = 4  # the connection bar lists them all
NO_PORTS = "No serial port found. Plug a board in: it appears here by itself."


class EmptyState(QWidget):
    """In the middle of a page while nothing is connected."""

    wanted = Signal(str, str)  # transport, address; an empty address: ask for a file, or search

    def __init__(self, icon: str, title: str, words: str) -> None:
        super().__init__()
        self._icon = icon
        self._picture = QLabel()
        self._picture.setAlignment(Qt.AlignmentFlag.AlignCenter)
        top = heading(title)
        top.setAlignment(Qt.AlignmentFlag.AlignCenter)
        text = muted(words)
        text.setFont(theme.font("body"))
        text.setAlignment(Qt.AlignmentFlag.AlignHCenter)
        self._ports = QVBoxLayout()
        self._ports.setSpacing(6)
        card = QVBoxLayout()
        card.setSpacing(12)
        for widget in (self._picture, top, text, self._buttons()):
            card.addWidget(widget)
        card.addSpacing(12)
        card.addLayout(self._ports)
        middle = QWidget()
        middle.setFixedWidth(CARD_WIDTH)
        middle.setLayout(card)
        column = QVBoxLayout(self)
        column.addStretch(2)
        column.addWidget(middle, 0, Qt.AlignmentFlag.AlignHCenter)
        column.addStretch(3)
        foot = muted(about.LINE)
        foot.setAlignment(Qt.AlignmentFlag.AlignCenter)
        column.addWidget(foot)
        self.show_ports([])
        self._paint_picture()

    def show_ports(self, ports: list[Port]) -> None:
        """List the serial ports, each with a Connect button."""
        clear(self._ports)
        for port in ports[:MOST_PORTS]:
            self._ports.addWidget(self._row(port))
        more = len(ports) - MOST_PORTS
        if not ports or more > 0:
            note = muted(f"{more} more in the list at the top." if more > 0 else NO_PORTS)
            note.setAlignment(Qt.AlignmentFlag.AlignCenter)
            self._ports.addWidget(note)

    def buttons(self) -> list[Button]:
        """Every way to get data, in the order on screen."""
        return self.findChildren(Button)

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() == QEvent.Type.PaletteChange:
            self._paint_picture()

    def _buttons(self) -> QWidget:
        words = "A virtual board that you turn with the mouse"
        start = Button("Start the simulated board", words, icon="play", role="primary")
        start.clicked.connect(lambda: self.wanted.emit("simulator", FIRST_MOTION))
        open_ = Button("Open a recording", "A capture of a board's bytes, or a CSV file", "open_recording", "open")
        open_.clicked.connect(lambda: self.wanted.emit("replay", ""))
        search = Button("Bluetooth", "Search for boards that speak Bluetooth LE", icon="bluetooth")
        search.clicked.connect(lambda: self.wanted.emit("ble", ""))
        box = QWidget()
        row = QHBoxLayout(box)
        row.setContentsMargins(0, 8, 0, 0)
        row.setSpacing(10)
        row.addStretch(1)
        for button in (start, open_, search):
            row.addWidget(button)
        row.addStretch(1)
        return box

    def _row(self, port: Port) -> QWidget:
        frame = QFrame()
        frame.setProperty("role", "card")
        words = QLabel(port.device)
        about = ElidedLabel(port.hint or port.description)
        about.setProperty("role", "muted")
        button = Button("Connect", f"Connect {port.device}; format and speed are found by themselves")
        button.setAccessibleName(f"Connect {port.device}")
        button.clicked.connect(lambda: self.wanted.emit("serial", port.device))
        row = QHBoxLayout(frame)
        row.setContentsMargins(14, 8, 8, 8)
        row.setSpacing(12)
        row.addWidget(words)
        row.addWidget(about, 1)
        row.addWidget(button)
        return frame

    def _paint_picture(self) -> None:
        icon = theme.icon(self._icon, theme.palette().muted, PICTURE)
        self._picture.setPixmap(icon.pixmap(QSize(PICTURE, PICTURE), self.devicePixelRatioF()))
