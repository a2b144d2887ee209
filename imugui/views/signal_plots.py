"""PlotStack: plots above each other over one axis, painted from a Frame; what the mouse and the keys ask for."""

from __future__ import annotations

import math

from PySide6.QtCore import QPoint, QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QKeyEvent, QMouseEvent, QPainter, QPaintEvent, QWheelEvent
from PySide6.QtWidgets import QSizePolicy

from imugui.views import signal_paint as paint
from imugui.views import theme
from imugui.views.painted import Painted
from imugui.views.signal_frame import Frame, Plot
from imugui.views.signal_paint import Body

GUTTER = 62.0  # for the numbers at the left
RIGHT = 14.0
HEAD = 23.0
FOOT = 24.0
LEAST_BODY = 24.0
CATCH = 7.0  # pixels from a cursor within which it is taken
CLICK = 3.0  # pixels within which a press and its release are a click
WHEEL_NOTCH = 120.0
STRETCH = 1.25  # of a scale, a notch of the wheel
FAR = 10  # samples a step with Shift

_KEYS = {
    Qt.Key.Key_Left: ("step", -1),
    Qt.Key.Key_Right: ("step", 1),
    Qt.Key.Key_PageUp: ("pan", -1),
    Qt.Key.Key_PageDown: ("pan", 1),
    Qt.Key.Key_Plus: ("zoom", 1),
    Qt.Key.Key_Equal: ("zoom", 1),  # the same key without Shift
    Qt.Key.Key_Minus: ("zoom", -1),
    Qt.Key.Key_Space: ("pause", 0),
    Qt.Key.Key_A: ("cursor", 0),
    Qt.Key.Key_B: ("cursor", 1),
}
_CURSOR_KEYS = ("step", "cursor")  # without cursors they are anybody's
_POINTERS = {
    "cursor": Qt.CursorShape.SplitHCursor,
    "time": Qt.CursorShape.ArrowCursor,
    "": Qt.CursorShape.ArrowCursor,
}


class PlotStack(Painted):
    """Knows pixels and columns, nothing of boards and time. Places along x are given as a share, 0 left to 1 right."""

    asked = Signal(str, int)  # a key: "step", "pan", "zoom", "pause" or "cursor", and how far or which
    panned = Signal(float)  # dragged by this share of the width, to the right
    zoomed = Signal(int, float)  # wheel: steps, where
    placed = Signal(float)  # clicked here, or the caught cursor was dragged here
    caught = Signal(int)  # a cursor was taken, by its number
    scaled = Signal(str, float, float)  # plot, new low, new high
    fitted = Signal(str)  # the numbers beside a plot were double-clicked

    def __init__(self) -> None:
        super().__init__()
        self.setAccessibleName("Plots")
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.setMouseTracking(True)
        self._frame = Frame(1)
        self._pressed: QPointF | None = None
        self._dragging = ""  # "cursor", "time" or the key of a plot
        self._moved = False
        self._wheel = 0.0

    @property
    def frame(self) -> Frame:
        """What is shown."""
        return self._frame

    def show_frame(self, frame: Frame) -> None:
        """Show a picture."""
        self._frame = frame
        self.update()

    def columns(self) -> int:
        """How many columns there is room for: one a pixel of the screen."""
        return max(1, math.floor((self.width() - GUTTER - RIGHT) * self.devicePixelRatioF()))

    def room(self, plots: int) -> tuple[float, float]:
        """Width and height of each of so many plots, pixels."""
        each = (self.height() - FOOT) / max(plots, 1) - HEAD
        return self.width() - GUTTER - RIGHT, max(each, LEAST_BODY)

    def bodies(self) -> list[Body]:
        """Where each plot is drawn. The columns lie on the screen's pixels, also where its scale is not whole."""
        plots, ratio = self._frame.plots, self.devicePixelRatioF()
        origin = self.mapTo(self.window(), QPoint(0, 0)).x()
        left = math.ceil((origin + GUTTER) * ratio) / ratio - origin
        each, height = (self.height() - FOOT) / max(len(plots), 1), round(self.room(len(plots))[1])
        rects = [QRectF(left, round(i * each + HEAD), self._width(), height) for i in range(len(plots))]
        return [Body(rect, 1.0 / ratio, *plot.range) for rect, plot in zip(rects, plots, strict=True)]

    def sizeHint(self) -> QSize:
        return QSize(640, 480)

    def minimumSizeHint(self) -> QSize:
        return QSize(320, 200)

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        try:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            bodies = self.bodies()
            for plot, body in zip(self._frame.plots, bodies, strict=True):
                self._paint_plot(painter, plot, body)
            if bodies:
                painter.setFont(theme.font("small"))
                paint.paint_x_words(painter, bodies[-1], self._frame.ticks, self.width() - 2.0)
            self._paint_cursors(painter, bodies)
            if self._frame.note:
                paint.paint_note(painter, QRectF(self.rect()), self._frame.note)
            self._paint_focus(painter)
        finally:
            painter.end()

    # keys and mouse

    def keyPressEvent(self, event: QKeyEvent) -> None:
        shift = Qt.KeyboardModifier.ShiftModifier
        plain = not event.modifiers() & ~Qt.KeyboardModifier.KeypadModifier & ~shift
        action = _KEYS.get(Qt.Key(event.key())) if plain else None
        if action is None or (action[0] in _CURSOR_KEYS and not self._frame.cursors):
            super().keyPressEvent(event)
            return
        name, n = action
        self.asked.emit(name, n * FAR if name == "step" and event.modifiers() & shift else n)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        if event.button() is not Qt.MouseButton.LeftButton:
            super().mousePressEvent(event)
            return
        self._pressed, self._moved = event.position(), False
        self._dragging = self._what_is_at(event.position())
        if self._dragging == "cursor":
            self.caught.emit(self._cursor_at(event.position()))

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        if self._pressed is None:
            self.setCursor(_POINTERS.get(self._what_is_at(event.position()), Qt.CursorShape.SizeVerCursor))
            return
        way = event.position() - self._pressed
        if self._dragging == "cursor":
            self.placed.emit(self._share(event.position()))
        elif self._dragging and (self._moved or way.manhattanLength() > CLICK):
            self._pressed, self._moved = event.position(), True
            if self._dragging == "time":
                self.panned.emit(way.x() / self._width())
            else:
                self._shift(self._dragging, way.y())

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        if self._dragging == "time" and not self._moved:
            self.placed.emit(self._share(event.position()))
        self._pressed, self._dragging = None, ""

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        what = self._what_is_at(event.position())
        if what not in _POINTERS:
            self.fitted.emit(what)

    def wheelEvent(self, event: QWheelEvent) -> None:
        self._wheel -= event.angleDelta().y() / WHEEL_NOTCH
        steps = int(self._wheel)  # a touch pad sends small parts of a notch
        self._wheel -= steps
        what = self._what_is_at(event.position()) if steps else ""
        if what in ("cursor", "time"):
            self.zoomed.emit(steps, self._share(event.position()))
        elif what:
            self._stretch(what, event.position().y(), STRETCH**steps)
        event.accept()

    # parts

    def _paint_plot(self, painter: QPainter, plot: Plot, body: Body) -> None:
        paint.paint_back(painter, body, self._frame.ticks, plot.ticks)
        paint.paint_bands(painter, body, self._frame.bands)
        painter.setFont(theme.font("small"))
        paint.paint_y_words(painter, body, plot.ticks, GUTTER)
        paint.paint_head(painter, body, plot, HEAD)
        painter.save()
        painter.setClipRect(body.rect)
        for curve in plot.curves:
            paint.paint_curve(painter, body, curve)
        painter.restore()
        if plot.note:
            paint.paint_note(painter, body.rect, plot.note)

    def _paint_cursors(self, painter: QPainter, bodies: list[Body]) -> None:
        for cursor in self._frame.cursors:
            for i, body in reversed(list(enumerate(bodies))):
                paint.paint_cursor(painter, body, cursor, top=i == 0)
        for mark in self._frame.marks:
            paint.paint_mark(painter, bodies[mark.plot], mark)

    def _width(self) -> float:
        return self._frame.count / self.devicePixelRatioF()

    def _share(self, place: QPointF) -> float:
        return (place.x() - GUTTER) / self._width()

    def _what_is_at(self, place: QPointF) -> str:
        """ "cursor", "time" inside a plot, the key of the plot beside whose numbers it is, or nothing."""
        row = next((i for i, body in enumerate(self.bodies()) if place.y() <= body.rect.bottom()), -1)
        if row < 0:
            return ""
        if place.x() < GUTTER:
            return self._frame.plots[row].key
        return "time" if self._cursor_at(place) < 0 else "cursor"

    def _cursor_at(self, place: QPointF) -> int:
        """The number of the cursor that can be taken here, or -1."""
        columns = [cursor.column / self.devicePixelRatioF() for cursor in self._frame.cursors]
        near = [(abs(place.x() - GUTTER - x), number) for number, x in enumerate(columns)]
        return min(near)[1] if near and min(near)[0] <= CATCH else -1

    def _body_of(self, key: str) -> Body:
        plots = zip(self._frame.plots, self.bodies(), strict=True)
        return next(body for plot, body in plots if plot.key == key)

    def _shift(self, key: str, pixels: float) -> None:
        """Move the scale of a plot with the hand."""
        body = self._body_of(key)
        way = pixels * (body.high - body.low) / body.rect.height()
        self.scaled.emit(key, body.low + way, body.high + way)

    def _stretch(self, key: str, y: float, factor: float) -> None:
        """Stretch the scale of a plot about a place."""
        body = self._body_of(key)
        share = min(max((body.rect.bottom() - y) / body.rect.height(), 0.0), 1.0)
        about = body.low + share * (body.high - body.low)
        self.scaled.emit(key, about + (body.low - about) * factor, about + (body.high - about) * factor)
