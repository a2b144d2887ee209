"""ScaleBar: an answer on a scale between two words. It has none until the person gives one."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QKeyEvent, QMouseEvent, QPainter, QPaintEvent
from PySide6.QtWidgets import QSizePolicy, QWidget

from imugui.views import theme

HEIGHT = 46
_END = 14.0
_LINE = 15.0
_MARK = 7.0
_STEPS = {Qt.Key.Key_Left: -1, Qt.Key.Key_Down: -1, Qt.Key.Key_Right: 1, Qt.Key.Key_Up: 1}


class ScaleBar(QWidget):
    """A line with one mark for each value; click, or arrow keys."""

    changed = Signal()

    def __init__(self, name: str, low: str, high: str, values: Sequence[float]) -> None:
        super().__init__()
        self._low, self._high, self._values = low, high, tuple(values)
        self._place: int | None = None
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.setAccessibleName(name)
        self.setToolTip(f"{low} at the left, {high} at the right. Click, or use the arrow keys.")
        self._tell()

    @property
    def value(self) -> float | None:
        """The answer; None before there is one."""
        return None if self._place is None else self._values[self._place]

    def place_of(self, place: int) -> QPointF:
        """Where a mark is, px."""
        room = self.width() - 2.0 * _END
        return QPointF(_END + room * place / (len(self._values) - 1), _LINE)

    def choose(self, place: int) -> None:
        """Answer with a mark, the nearest there is."""
        place = max(0, min(place, len(self._values) - 1))
        if place != self._place:
            self._place = place
            self._tell()
            self.update()
            self.changed.emit()

    def sizeHint(self) -> QSize:
        return QSize(360, HEIGHT)

    def minimumSizeHint(self) -> QSize:
        return QSize(200, HEIGHT)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        room = self.width() - 2.0 * _END
        self.choose(round((event.position().x() - _END) / room * (len(self._values) - 1)))

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        self.mousePressEvent(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        step = _STEPS.get(Qt.Key(event.key()))
        if step is None:
            super().keyPressEvent(event)
        else:
            middle = (len(self._values) - 1) // 2
            self.choose(middle if self._place is None else self._place + step)

    def paintEvent(self, event: QPaintEvent) -> None:
        colours = theme.palette()
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        last = len(self._values) - 1
        painter.setPen(theme.pen(colours.muted, 1.5))
        painter.drawLine(self.place_of(0), self.place_of(last))
        for place in range(last + 1):
            tall = _MARK if place in (0, last) or 2 * place == last else 0.6 * _MARK
            at = self.place_of(place)
            painter.drawLine(at - QPointF(0.0, tall), at + QPointF(0.0, tall))
        if self._place is not None:
            painter.setPen(theme.pen(colours.panel, 2.0))
            painter.setBrush(colours.accent)
            painter.drawEllipse(self.place_of(self._place), 8.0, 8.0)
        self._paint_words(painter)
        painter.end()

    def _paint_words(self, painter: QPainter) -> None:
        colours = theme.palette()
        painter.setFont(theme.font("small"))
        painter.setPen(colours.muted)
        below = QRectF(4.0, _LINE + 10.0, self.width() - 8.0, self.height() - _LINE - 10.0)
        painter.drawText(below, Qt.AlignmentFlag.AlignLeft, self._low)
        painter.drawText(below, Qt.AlignmentFlag.AlignRight, self._high)
        if self.hasFocus():
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.setPen(theme.pen(colours.accent, 1.0))
            painter.drawRoundedRect(QRectF(self.rect()).adjusted(0.5, 0.5, -0.5, -0.5), 6.0, 6.0)

    def _tell(self) -> None:
        self.setAccessibleDescription("no answer yet" if self.value is None else f"{self.value:g}")
