"""PolarTarget: where the tool points as seen from the plan. Rings are true degrees at any tilt."""

from __future__ import annotations

import math

import numpy as np
from PySide6.QtCore import QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QFontMetricsF, QKeyEvent, QMouseEvent, QPainter, QPaintEvent, QPixmap
from PySide6.QtWidgets import QSizePolicy

from imugui.guidance.look import Look
from imugui.guidance.plan import Plan, screen_sign
from imugui.views import polar_labels as labels
from imugui.views import polar_paint as paint
from imugui.views import polar_words as words
from imugui.views import theme
from imugui.views.painted import Painted
from imugui.views.polar_scale import PolarScale

BAND = 78.0
"""Height of the words under the dial, px."""
_MARGIN = 14.0
_EDGE = 30.0  # for the words above and below the dial
_KEY_STEPS = 40.0  # of the arrow keys, across the radius
_MOST_PER_PIXEL = math.radians(0.5)
_KEYS = {
    Qt.Key.Key_Left: (-1.0, 0.0), Qt.Key.Key_Right: (1.0, 0.0), Qt.Key.Key_Up: (0.0, 1.0), Qt.Key.Key_Down: (0.0, -1.0),
}  # fmt: skip
_MOST_TRAIL = 60
HAND_HINT = "drag, or arrow keys"
_HAND_TIP = "Drag, or press the arrow keys, to turn the virtual tool."
_TIP = "Circle: the plan. Cross: the tool, seen along the way of insertion with the head up. Rings are true degrees."


class PolarTarget(Painted):
    """Shows a Look. Colour, shape and word change together; what is not trusted is hatched and says why."""

    tool_turned = Signal(float, float)
    """Hand mode only, rad: how far the tip of the tool is wanted to the right, and up, as on this dial."""
    taken = Signal()
    """Space was pressed: the user wants this reading."""

    def __init__(self) -> None:
        super().__init__()
        self.scale = PolarScale()
        self._plan: Plan | None = None
        self._look: Look | None = None
        self._beat = 0
        self._hand_mode = False
        self._grabbed: QPointF | None = None
        self._still: dict[str, tuple[object, QPixmap]] = {}
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.setAccessibleName("Polar target")
        self.set_hand_mode(False)

    def show_plan(self, plan: Plan | None) -> None:
        """Aim at another plan, or none."""
        if plan != self._plan:
            self._plan = plan
            self.scale.follow(math.nan, self._tolerance_deg, glide=False)
            self.update()

    def show_look(self, look: Look | None, glide: bool = True) -> None:
        """Show what the guide sees, None before there is anything; without ``glide`` the scale jumps to its step."""
        known = look is not None and look.aim is not None and look.colour != "blank"
        error_deg = look.error_deg if known and look is not None else math.nan
        self.scale.follow(error_deg, self._tolerance_deg, glide)
        self._look = look
        self.setAccessibleDescription(self.spoken())
        self.update()

    def beat(self, count: int) -> None:
        """Rows received so far: the mark beside the age moves while they come."""
        self._beat = count

    def spoken(self) -> str:
        """State and sentence in words."""
        if self._look is None:
            return ""
        return f"{words.STATES[self._look.colour][1]}. {words.main_words(self._look)}"

    def cross(self) -> QPointF | None:
        """Where the cross is, px in the widget; None when it is not shown."""
        place = self._place()
        return None if place is None else place + self.centre()

    def centre(self) -> QPointF:
        """Where the plan is, px in the widget, on a pixel's middle."""
        return QPointF(round(self.width() / 2.0) + 0.5, round((self.height() - BAND) / 2.0) + 0.5)

    def radius(self) -> float:
        """Of the dial, px."""
        beside = QFontMetricsF(theme.font("small")).horizontalAdvance("patient's right") + 14.0
        across, along = self.width() / 2.0 - beside, (self.height() - BAND) / 2.0 - _EDGE
        return max(10.0, min(across, along))

    def set_hand_mode(self, on: bool) -> None:
        """While on, a drag and the arrow keys turn the virtual tool (``tool_turned``)."""
        self._hand_mode = on
        self.update()
        self.setToolTip(f"{_TIP}\n{_HAND_TIP}" if on else _TIP)
        self.setCursor(Qt.CursorShape.OpenHandCursor if on else Qt.CursorShape.ArrowCursor)

    @property
    def turned_by_hand(self) -> bool:
        return self._hand_mode

    def sizeHint(self) -> QSize:
        return QSize(700, 700)

    def minimumSizeHint(self) -> QSize:
        return QSize(420, 320)

    # Qt's events

    def mousePressEvent(self, event: QMouseEvent) -> None:
        self._grabbed = event.position()

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        if self._grabbed is None or not self._hand_mode:
            return
        step = (event.position() - self._grabbed) * min(_MOST_PER_PIXEL, self._rad_per_pixel())
        self._grabbed = event.position()
        self.tool_turned.emit(step.x(), -step.y())

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        self._grabbed = None

    def keyPressEvent(self, event: QKeyEvent) -> None:
        way = _KEYS.get(Qt.Key(event.key()))
        if event.key() == Qt.Key.Key_Space and not event.isAutoRepeat():
            self.taken.emit()
        elif self._hand_mode and way is not None:
            step = self._rad_per_pixel() * self.radius() / _KEY_STEPS
            self.tool_turned.emit(way[0] * step, way[1] * step)
        else:
            super().keyPressEvent(event)

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        try:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            dial = self._dial()
            painter.drawPixmap(0, 0, self._layer("dial", (dial, theme.is_dark()), dial))
            painter.save()
            painter.translate(self.centre())
            self._paint_marks(painter, dial)
            painter.restore()
            self._paint_words(painter)
            self._paint_focus(painter)
        finally:
            painter.end()

    # parts

    @property
    def _tolerance_deg(self) -> float:
        return self._plan.tolerance_deg if self._plan is not None else 2.0

    def _rad_per_pixel(self) -> float:
        return math.radians(self.scale.range_deg) / self.radius()

    @property
    def _mirror(self) -> float:
        """Right of the dial is the patient's right: for an entry from the right that is lateral, not medial."""
        return screen_sign(self._plan.side) if self._plan is not None else 1.0

    def _dial(self) -> paint.Dial:
        plan = self._plan
        amber = plan.amber_deg if plan is not None else 5.0
        reach, ring = self.scale.range_deg, self.scale.ring_deg
        limits = (self._tolerance_deg, amber) if plan is not None else (0.0, 1e3)
        return paint.Dial(self.radius(), reach, ring, *limits, words.sides(plan), words.side_notes(plan))

    def _layer(self, name: str, key: object, dial: paint.Dial) -> QPixmap:
        """A picture that is painted again only when what it shows changes."""
        ratio = self.devicePixelRatioF()
        whole = (key, self.size().toTuple(), ratio)
        kept = self._still.get(name)
        if kept is not None and kept[0] == whole:
            return kept[1]
        pixmap = QPixmap(round(self.width() * ratio), round(self.height() * ratio))
        pixmap.setDevicePixelRatio(ratio)
        pixmap.fill(Qt.GlobalColor.transparent)
        painter = QPainter(pixmap)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.translate(self.centre())
        if name == "dial":
            paint.paint_dial(painter, dial)
        else:
            paint.paint_hatching(painter, dial.radius)
        painter.end()
        self._still[name] = (whole, pixmap)
        return pixmap

    def _place(self) -> QPointF | None:
        """The cross, px from the centre; None when nothing is known, or the tool points exactly backwards."""
        look = self._look
        if look is None or look.aim is None or look.colour == "blank":
            return None
        right, up = look.aim.offset
        if not (math.isfinite(right) and math.isfinite(up)):
            return None
        return QPointF(self._mirror * right, -up) / self._rad_per_pixel()

    def _paint_marks(self, painter: QPainter, dial: paint.Dial) -> None:
        look = self._look
        state = look.colour if look is not None else "hatched"
        trusted = look is not None and look.trusted
        colours = theme.palette()
        colour = theme.tone_colour(words.STATES[state][0]) if trusted else colours.muted
        if not trusted:
            painter.drawPixmap(-self.centre(), self._layer("hatching", (dial.radius, theme.is_dark()), dial))
        if self._plan is not None:
            paint.paint_plan(painter, colours.ghost if trusted else colours.muted)
        place = self._place()
        if look is None or place is None:
            return
        self._paint_tool(painter, dial, look, place)
        if trusted and look.hold_progress > 0.0:
            radius = max(dial.pixels(self._tolerance_deg), paint.PLAN_RADIUS + 12.0)
            paint.paint_hold(painter, radius, 1.0 if look.armed else look.hold_progress, colours.good)
        paint.paint_cross(painter, place, colour, state)

    def _paint_tool(self, painter: QPainter, dial: paint.Dial, look: Look, place: QPointF) -> None:
        """What goes with the cross: where it was, how sure it is, which way to go."""
        trusted = look.trusted
        colour = theme.tone_colour(words.STATES[look.colour][0]) if trusted else theme.palette().muted
        trail = np.asarray(look.trail, float).reshape(-1, 2)
        trail = trail[np.isfinite(trail).all(axis=1)] * (self._mirror, -1.0) / self._rad_per_pixel()
        trail = trail[np.hypot(trail[:, 0], trail[:, 1]) < dial.radius]
        paint.paint_trail(painter, trail[:: max(1, len(trail) // _MOST_TRAIL)], colour)
        if math.isfinite(look.sigma_deg) and dial.pixels(look.sigma_deg) > 3.0:
            paint.paint_sigma(painter, place, min(dial.pixels(look.sigma_deg), 2.0 * dial.radius))
        if trusted and look.colour != "green" and math.hypot(*look.arrow) > 0.5:
            paint.paint_arrow(painter, place, QPointF(self._mirror * look.arrow[0], -look.arrow[1]), colour)

    def _paint_words(self, painter: QPainter) -> None:
        room = QRectF(self.rect()).adjusted(_MARGIN, _MARGIN - 4.0, -_MARGIN, -BAND)
        labels.paint_corners(painter, room, self._look, self.scale.ring_deg, HAND_HINT if self._hand_mode else "")
        if self._look is not None:
            labels.paint_age(painter, room, self._look, self._beat)
            band = QRectF(_MARGIN, self.height() - BAND, self.width() - 2 * _MARGIN, BAND)
            labels.paint_band(painter, band, self._look)
