"""The list of channels: what is drawn, in which colour, and its numbers."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QLocale, QRect, QRectF, QSize, Qt, Signal, Slot
from PySide6.QtGui import QFontMetrics, QPainter, QPaintEvent, QWheelEvent
from PySide6.QtWidgets import QCheckBox, QDoubleSpinBox, QHBoxLayout, QSizePolicy, QVBoxLayout, QWidget

from imugui.signals.channels import UNITS, Channel, Quantity, Unit
from imugui.signals.scale import Range
from imugui.views import theme
from imugui.views.controls import Button
from imugui.views.labels import muted
from imugui.views.signal_paint import tone_colour
from imugui.views.signal_words import NOT_SENT

INDENT = 26
NAME = 62  # room for the channel's name
SWATCH = 16
ROW = 23
FIELD = 92  # room for the end of a scale
UNIT_PAD = 13  # between the text and the edge of a button: numbers end where their unit ends


class Cells(QWidget):
    """Numbers in columns of equal width, flush right, which keep their places."""

    def __init__(self) -> None:
        super().__init__()
        self._cells: tuple[str, ...] = ()
        self.setFont(theme.font("small"))
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)

    def texts(self) -> tuple[str, ...]:
        """What is shown."""
        return self._cells

    def show_cells(self, cells: tuple[str, ...]) -> None:
        """Show these, left to right."""
        if cells != self._cells:
            self._cells = cells
            self.setAccessibleDescription("  ".join(cells))
            self.update()

    def sizeHint(self) -> QSize:
        return QSize(60, QFontMetrics(self.font()).height() + 2)

    def paintEvent(self, event: QPaintEvent) -> None:
        if not self._cells:
            return
        painter = QPainter(self)
        painter.setPen(theme.palette().text if self.isEnabled() else theme.palette().muted)
        width = self.width() / len(self._cells)
        for i, cell in enumerate(self._cells):
            room = QRect(round(i * width), 0, round(width), self.height())
            painter.drawText(room, Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter, cell)
        painter.end()


class Swatch(QWidget):
    """A piece of the curve's colour."""

    def __init__(self, tone: int) -> None:
        super().__init__()
        self._tone = tone
        self.setFixedSize(SWATCH, 12)

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() == QEvent.Type.PaletteChange:
            self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(tone_colour(self._tone))
        painter.drawRoundedRect(QRectF(0.0, 4.0, SWATCH - 3.0, 4.0), 2.0, 2.0)
        painter.end()


class ChannelRow(QWidget):
    """One channel: tick, colour, name, numbers."""

    toggled = Signal(str, bool)

    def __init__(self, channel: Channel, quantity: Quantity, on: bool) -> None:
        super().__init__()
        self.setFixedHeight(ROW)
        self.box = QCheckBox(channel.label)
        self.box.setFont(theme.font("small"))
        self.box.setChecked(on)
        self.box.setAccessibleName(f"{quantity.title} {channel.label}")
        self.box.setToolTip(f"Show or hide {channel.label} of {quantity.title.lower()}")
        self.box.setFixedWidth(NAME)
        self.box.toggled.connect(lambda ticked: self.toggled.emit(channel.key, ticked))
        self.cells = Cells()
        row = QHBoxLayout(self)
        row.setContentsMargins(INDENT, 0, UNIT_PAD, 0)
        row.setSpacing(4)
        row.addWidget(Swatch(channel.tone))
        row.addWidget(self.box)
        row.addWidget(self.cells, 1)


class RangeRow(QWidget):
    """The ends of a fixed scale."""

    edited = Signal(float, float)

    def __init__(self, quantity: Quantity) -> None:
        super().__init__()
        row = QHBoxLayout(self)
        row.setContentsMargins(INDENT, 2, UNIT_PAD, 4)
        row.setSpacing(6)
        row.addStretch(1)
        self.low, self.high = (_field(f"{end} end of the scale of {quantity.title}") for end in ("Lower", "Upper"))
        for word, box in (("from", self.low), ("to", self.high)):
            label = muted(word)
            label.setWordWrap(False)
            row.addWidget(label)
            row.addWidget(box)
            box.valueChanged.connect(self._edited)

    def show_range(self, ends: Range, decimals: int) -> None:
        """Show a scale, unless it is being written."""
        if not (self.low.hasFocus() or self.high.hasFocus()):
            for box, value in zip((self.low, self.high), ends, strict=True):
                box.blockSignals(True)
                box.setDecimals(decimals)
                box.setValue(value)
                box.blockSignals(False)

    @Slot()
    def _edited(self) -> None:
        if self.low.value() < self.high.value():
            self.edited.emit(self.low.value(), self.high.value())


class QuantityRows(QWidget):
    """One quantity: its own tick and unit, and beneath them its channels while it is shown."""

    plot_toggled = Signal(str, bool)
    channel_toggled = Signal(str, bool)
    unit_wanted = Signal(str)
    range_edited = Signal(str, float, float)

    def __init__(self, key: str, quantity: Quantity, on: bool, shown: set[str]) -> None:
        super().__init__()
        self._key, self._quantity = key, quantity
        self.box = QCheckBox(quantity.title)
        self.box.setChecked(on)
        self.box.setAccessibleName(quantity.title)
        self.box.setToolTip(quantity.tip)
        self.box.toggled.connect(lambda ticked: self.plot_toggled.emit(key, ticked))
        self.unit = Button("", "The unit of these numbers", role="quiet", small=True)
        self.unit.setAccessibleName(f"Unit of {quantity.title}")
        self.unit.setEnabled(len(UNITS[quantity.kind]) > 1)
        self.unit.clicked.connect(lambda: self.unit_wanted.emit(key))
        self.note = muted(NOT_SENT)
        self.note.setContentsMargins(INDENT, 0, 0, 4)
        self.range = RangeRow(quantity)
        self.range.edited.connect(lambda low, high: self.range_edited.emit(key, low, high))
        self.rows = {one.key: ChannelRow(one, quantity, one.key in shown) for one in quantity.channels}
        head = QHBoxLayout()
        head.setSpacing(4)
        head.addWidget(self.box, 1)
        head.addWidget(self.unit)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        column.addLayout(head)
        column.addWidget(self.note)
        for row in self.rows.values():
            row.toggled.connect(self.channel_toggled)
            column.addWidget(row)
        column.addWidget(self.range)

    def show_state(self, on: bool, sent: bool, fixed: bool, unit: Unit) -> None:
        """Unfold what is to be seen."""
        self.box.setChecked(on)
        self.note.setVisible(on and not sent)
        for row in self.rows.values():
            row.setVisible(on and sent)
        self.range.setVisible(on and sent and fixed)
        if self.unit.text() != unit.name:
            self.unit.setText(unit.name)
            self.unit.setAccessibleName(f"Unit of {self._quantity.title}: {unit.ascii or 'none'}")
            others = [one.name for one in UNITS[self._quantity.kind] if one is not unit]
            self.unit.setToolTip(f"Show it in {others[0]}" if others else "The unit of these numbers")


class ScaleField(QDoubleSpinBox):
    """One end of a scale; a passing wheel does not change it."""

    def wheelEvent(self, event: QWheelEvent) -> None:
        event.ignore()


def _field(words: str) -> ScaleField:
    box = ScaleField()
    box.setRange(-1e9, 1e9)
    box.setFont(theme.font("small"))
    box.setAccessibleName(words)
    box.setToolTip(words)
    box.setKeyboardTracking(False)
    box.lineEdit().setTextMargins(6, 0, 0, 0)  # Qt gives a spin box no padding on this side
    locale = QLocale.c()
    locale.setNumberOptions(QLocale.NumberOption.OmitGroupSeparator)
    box.setLocale(locale)
    box.setFixedWidth(FIELD)
    box.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
    return box
