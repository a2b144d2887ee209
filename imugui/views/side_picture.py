"""SidePicture: a vertebra seen from behind, with left and right in words, and the tool on the side that is chosen."""

from __future__ import annotations

from PySide6.QtCore import QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QKeyEvent, QMouseEvent, QPainter, QPainterPath, QPaintEvent
from PySide6.QtWidgets import QSizePolicy

from imugui.views import theme
from imugui.views.painted import Painted

WIDE, HIGH = 240.0, 176.0
"""The room of the drawing in its own units; its middle is (0, 0), y down."""
ENTRY = {"left": QPointF(-34.0, -14.0), "right": QPointF(34.0, -14.0)}
"""Where a tool goes in; seen from behind the patient's left is on the left."""
_TIP = "Seen from behind, head up. Click a side, or press the left or right arrow key."
_KEYS = {Qt.Key.Key_Left: "left", Qt.Key.Key_Right: "right"}


class SidePicture(Painted):
    """Shows a side, and where it may be changed says which one was chosen."""

    chosen = Signal(str)  # "left" or "right"

    def __init__(self, editable: bool = True) -> None:
        super().__init__()
        self._side = ""
        self._editable = editable
        policy = Qt.FocusPolicy.StrongFocus if editable else Qt.FocusPolicy.NoFocus
        self.setFocusPolicy(policy)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.setToolTip(_TIP if editable else "Seen from behind, head up.")
        self.setAccessibleName("Side of the entry, seen from behind")

    @property
    def side(self) -> str:
        return self._side

    def show_side(self, side: str) -> None:
        """Show "left", "right", or "" for none."""
        if side != self._side:
            self._side = side
            self.setAccessibleDescription(f"{side or 'no'} side")
            self.update()

    def sizeHint(self) -> QSize:
        return QSize(280, 150)

    def minimumSizeHint(self) -> QSize:
        return QSize(160, 110)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        self._choose("left" if event.position().x() < self.width() / 2.0 else "right")

    def keyPressEvent(self, event: QKeyEvent) -> None:
        side = _KEYS.get(Qt.Key(event.key()))
        if side is None or not self._editable:
            super().keyPressEvent(event)
        else:
            self._choose(side)

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        try:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            painter.save()
            painter.translate(self.width() / 2.0, self.height() / 2.0)
            scale = min(self.width() / WIDE, self.height() / HIGH)
            painter.scale(scale, scale)
            _paint_bone(painter)
            for side, place in ENTRY.items():
                _paint_entry(painter, place, side == self._side)
            painter.restore()
            self._paint_words(painter)
        finally:
            painter.end()

    def _choose(self, side: str) -> None:
        if self._editable:
            self.show_side(side)
            self.chosen.emit(side)

    def _paint_words(self, painter: QPainter) -> None:
        """Left and right at the edges, the chosen one strong and with a tick; which way is up."""
        colours = theme.palette()
        area = QRectF(self.rect()).adjusted(6.0, 2.0, -6.0, -2.0)
        painter.setFont(theme.font("small"))
        painter.setPen(colours.muted)
        painter.drawText(area, Qt.AlignmentFlag.AlignHCenter | Qt.AlignmentFlag.AlignTop, "head")
        painter.drawText(area, Qt.AlignmentFlag.AlignHCenter | Qt.AlignmentFlag.AlignBottom, "from behind")
        edges = {"left": Qt.AlignmentFlag.AlignLeft, "right": Qt.AlignmentFlag.AlignRight}
        for side, edge in edges.items():
            mine = side == self._side
            painter.setFont(theme.font("heading" if mine else "body"))
            painter.setPen(colours.accent if mine else colours.muted)
            text = f"{theme.tone_glyph('good')} {side.upper()}" if mine else side
            painter.drawText(area, edge | Qt.AlignmentFlag.AlignTop, text)
        if self.hasFocus():
            painter.setPen(theme.pen(colours.accent, 1.5))
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.drawRoundedRect(QRectF(self.rect()).adjusted(1, 1, -1, -1), 6.0, 6.0)


def _paint_bone(painter: QPainter) -> None:
    """From front to back: body, transverse processes, laminae with their joints, spinous process."""
    colours = theme.palette()
    bone = theme.mix(colours.panel, colours.grid, 0.16)
    line = theme.mix(colours.grid, colours.text, 0.1)
    layers: tuple[tuple[QPainterPath, float], ...] = (
        (_body(), 0.05), (_wings(), 0.13), (_joints(), 0.2), (_laminae(), 0.26), (_spine(), 0.36),
    )  # fmt: skip
    for path, depth in layers:
        painter.setPen(theme.pen(line, 1.4))
        painter.setBrush(theme.mix(bone, colours.grid, depth))
        painter.drawPath(path)


def _mirrored(half: list[tuple[float, float]], curve: float = 0.0) -> QPainterPath:
    """A closed outline from its right half, top to bottom, (x, y); ``curve`` 0 to 0.5 rounds the corners."""
    points = [QPointF(x, y) for x, y in half] + [QPointF(-x, y) for x, y in reversed(half)]
    path = QPainterPath()
    for i, corner in enumerate(points):
        before, after = points[i - 1], points[(i + 1) % len(points)]
        start, end = corner + (before - corner) * curve, corner + (after - corner) * curve
        if i == 0:
            path.moveTo(start)
        else:
            path.lineTo(start)
        path.quadTo(corner, end)
    path.closeSubpath()
    return path


def _body() -> QPainterPath:
    return _mirrored([(40.0, -38.0), (46.0, -30.0), (40.0, 0.0), (46.0, 34.0), (40.0, 44.0)], 0.4)


def _wings() -> QPainterPath:
    half = [(28.0, -22.0), (60.0, -26.0), (92.0, -34.0), (100.0, -22.0), (92.0, -12.0), (60.0, -6.0), (30.0, 4.0)]
    return _mirrored(half, 0.42)


def _joints() -> QPainterPath:
    """The upper and lower articular processes."""
    half = [(20.0, -30.0), (30.0, -56.0), (46.0, -54.0), (46.0, -26.0), (34.0, 0.0), (38.0, 40.0), (36.0, 58.0)]
    return _mirrored([*half, (22.0, 60.0), (16.0, 36.0)], 0.42)


def _laminae() -> QPainterPath:
    return _mirrored([(10.0, -34.0), (30.0, -26.0), (26.0, 4.0), (30.0, 34.0), (14.0, 42.0)], 0.4)


def _spine() -> QPainterPath:
    return _mirrored([(5.0, -26.0), (8.0, 10.0), (11.0, 48.0), (5.0, 60.0)], 0.45)


def _paint_entry(painter: QPainter, place: QPointF, chosen: bool) -> None:
    """Where a tool may go in: a ring; on the chosen side a filled disc with the tool that leans to the middle."""
    colours = theme.palette()
    if not chosen:
        painter.setPen(theme.pen(colours.muted, 1.6))
        painter.setBrush(colours.panel)
        painter.drawEllipse(place, 6.0, 6.0)
        return
    outward = 1.0 if place.x() > 0.0 else -1.0
    grip = place + QPointF(outward * 52.0, -34.0)
    for colour, width in ((colours.panel, 9.0), (colours.accent, 5.0)):
        painter.setPen(theme.pen(QColor(colour), width))
        painter.drawLine(place, grip)
    painter.setPen(theme.pen(colours.panel, 2.0))
    painter.setBrush(colours.accent)
    painter.drawEllipse(place, 8.5, 8.5)
