"""The 3D scene, drawn with QPainter: the board over a compass rose, a target's ghost, a point cloud."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

from PySide6.QtCore import QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import (
    QColor,
    QFontMetricsF,
    QKeyEvent,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QPixmap,
    QWheelEvent,
    qGray,
)
from PySide6.QtWidgets import QSizePolicy, QWidget

from imugui.fusion import quaternion
from imugui.views import theme
from imugui.views.geometry import Camera, camera_from, unit_quat
from imugui.views.painted import Painted
from imugui.views.scene_axes import paint_axes, paint_ghost, tip
from imugui.views.scene_body import Pose, paint_board, shadow_outline
from imugui.views.scene_cloud import Cloud, make_cloud, paint_cloud
from imugui.views.scene_ground import paint_ground, paint_shadow
from imugui.views.scene_lens import Lens

Quat = tuple[float, float, float, float]

_PIXEL_STEP = 0.15  # a corner that moved less is not worth a repaint
_ORBIT_STEP = math.radians(5.0)
_ZOOM_STEP = 0.9
_TURN_KEYS = {
    Qt.Key.Key_Left: (-1, 0), Qt.Key.Key_Right: (1, 0), Qt.Key.Key_Up: (0, 1), Qt.Key.Key_Down: (0, -1),
}  # fmt: skip
_ZOOM_KEYS = {Qt.Key.Key_Plus: 1, Qt.Key.Key_Equal: 1, Qt.Key.Key_Minus: -1}
_VIEW_KEYS = {Qt.Key.Key_X: "x", Qt.Key.Key_Y: "y", Qt.Key.Key_Z: "z", Qt.Key.Key_Home: "default"}
_TIP = "Drag to orbit, wheel to zoom, double click for the default view.\nKeys: arrows, + and −, X, Y, Z, Home."
_HAND_TIP = "Drag to turn the virtual board, with the right button to orbit, wheel to zoom.\n" + _TIP.splitlines()[1]


class Scene3D(Painted):
    """Shows an attitude. The camera is the user's; the board, the ghost and the points are the program's."""

    hand_turned = Signal(float, float)
    """Hand mode only, rad: turn about the vertical, and about the axis to the viewer's right (right-handed)."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._camera = Camera()
        self._quat: Quat = (1.0, 0.0, 0.0, 0.0)
        self._ghost: Quat | None = None
        self._cloud = Cloud()
        self._north = True
        self._dimmed: str | None = None
        self._hand_mode = False
        self._grabbed: QPointF | None = None
        self._still = QPixmap()
        self._still_key: object = None
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.setAttribute(Qt.WidgetAttribute.WA_OpaquePaintEvent)
        self.setAccessibleName("3D view of the board's attitude")
        self.set_hand_mode(False)

    def set_quat(self, quat: Any) -> None:
        """Turn the board: (w, x, y, z), sensor -> earth (ENU). What is no rotation (NaN, zero) is ignored."""
        new = unit_quat(quat)
        if new is not None and self._is_visible_turn(self._quat, new):
            self._quat = new
            self.update()

    def set_ghost(self, quat: Any | None) -> None:
        """Show a target attitude (w, x, y, z) as an outline, or None for none."""
        new = None if quat is None else unit_quat(quat)
        if new is None or self._ghost is None:
            changed = new is not self._ghost
        else:
            changed = self._is_visible_turn(self._ghost, new)
        if changed:
            self._ghost = new
            self.update()

    def set_points(self, points: Any, colours: Any = None, *, turning: bool = True) -> None:
        """A cloud (n, 3) in scene units (axes are 1 long), coloured (n, 3) 0 to 255, or all in the accent.

        ``turning`` points are in sensor axes and move with the board, others in the earth frame. Rows with
        NaN are left out. Raises ValueError when the shapes do not fit.
        """
        self._cloud = make_cloud(points, colours, turning)
        self.update()

    def set_dimmed(self, reason: str | None) -> None:
        """Grey the board and say why, because its attitude is not live; None brings the colours back."""
        if reason != self._dimmed:
            self._dimmed = reason
            self.setAccessibleDescription(reason or "")
            self.update()

    def set_north(self, known: bool) -> None:
        """Name the directions on the ground, or not: relative to an origin, the ground's y is not north."""
        if known != self._north:
            self._north = known
            self.update()

    def set_hand_mode(self, on: bool) -> None:
        """While on, the left button turns the virtual board (``hand_turned``) and the right one orbits."""
        self._hand_mode = on
        self.setToolTip(_HAND_TIP if on else _TIP)
        self.setCursor(Qt.CursorShape.OpenHandCursor if on else Qt.CursorShape.ArrowCursor)

    def view_from(self, view: str) -> None:
        """Look along the earth's "x", "y" or "z" axis towards the origin, or from the "default" place."""
        self._look(camera_from(view))

    def orbit(self, right: float, up: float) -> None:
        """Move the camera around the board by angles in rad."""
        self._look(self._camera.orbited(right, up))

    def zoom(self, factor: float) -> None:
        """Put the camera at ``factor`` times its distance, within bounds."""
        self._look(self._camera.zoomed(factor))

    def camera(self) -> Camera:
        """Where the scene is looked at from."""
        return self._camera

    def axis_tip(self, axis: int) -> QPointF:
        """Where the arrow of axis 0 (x), 1 (y) or 2 (z) ends, in widget pixels."""
        return tip(self._pose(self._quat), axis)

    def sizeHint(self) -> QSize:
        return QSize(600, 600)

    def minimumSizeHint(self) -> QSize:
        return QSize(200, 200)

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        try:
            painter.drawPixmap(0, 0, self._still_part())
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            self._paint_moving(painter)
            self._paint_frame(painter)
        finally:
            painter.end()

    def mousePressEvent(self, event: QMouseEvent) -> None:
        self._grabbed = event.position()
        if self._hand_mode:
            self.setCursor(Qt.CursorShape.ClosedHandCursor)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        if self._grabbed is None:
            return
        # a drag across the whole picture is half a turn
        step = (event.position() - self._grabbed) * (math.pi / max(1, min(self.width(), self.height())))
        self._grabbed = event.position()
        if self._hand_mode and event.buttons() & Qt.MouseButton.LeftButton:
            self.hand_turned.emit(step.x(), step.y())
        else:
            self.orbit(-step.x(), step.y())

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        self._grabbed = None
        self.set_hand_mode(self._hand_mode)

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        self.view_from("default")

    def wheelEvent(self, event: QWheelEvent) -> None:
        self.zoom(_ZOOM_STEP ** (event.angleDelta().y() / 120.0))

    def keyPressEvent(self, event: QKeyEvent) -> None:
        key = Qt.Key(event.key())
        if event.modifiers() & ~Qt.KeyboardModifier.KeypadModifier & ~Qt.KeyboardModifier.ShiftModifier:
            super().keyPressEvent(event)
        elif key in _TURN_KEYS:
            right, up = _TURN_KEYS[key]
            self.orbit(right * _ORBIT_STEP, up * _ORBIT_STEP)
        elif key in _ZOOM_KEYS:
            self.zoom(_ZOOM_STEP ** _ZOOM_KEYS[key])
        elif key in _VIEW_KEYS:
            self.view_from(_VIEW_KEYS[key])
        else:
            super().keyPressEvent(event)

    def _look(self, camera: Camera) -> None:
        if camera != self._camera:
            self._camera = camera
            self.update()

    def _lens(self) -> Lens:
        return Lens(self._camera, float(max(1, self.width())), float(max(1, self.height())))

    def _pose(self, quat: Quat) -> Pose:
        return Pose(self._lens(), quaternion.to_matrix(quat))

    def _is_visible_turn(self, old: Quat, new: Quat) -> bool:
        """A turn by an angle is twice the distance between the quaternions, for small angles; q and -q are one."""
        gap = min(math.dist(old, new), math.dist(old, [-value for value in new]))
        return 2.0 * gap * self._lens().scale() > _PIXEL_STEP

    def _still_part(self) -> QPixmap:
        """Background, grid and rose: painted again only when camera, size or scheme change."""
        ratio = self.devicePixelRatioF()
        key = (self._camera, self.size().toTuple(), ratio, theme.is_dark(), self._north)
        if key != self._still_key:
            self._still = QPixmap(round(self.width() * ratio), round(self.height() * ratio))
            self._still.setDevicePixelRatio(ratio)
            painter = QPainter(self._still)
            paint_ground(painter, self._lens(), self._north)
            painter.end()
            self._still_key = key
        return self._still

    def _paint_moving(self, painter: QPainter) -> None:
        pose = self._pose(self._quat)
        look = _greyed(theme.palette()) if self._dimmed is not None else theme.palette()
        paint_shadow(painter, pose.lens, shadow_outline(pose))
        paint_axes(painter, pose, look, front=False)
        paint_cloud(painter, pose, self._cloud, near=False)
        paint_board(painter, pose, look)
        paint_axes(painter, pose, look, front=True)
        paint_cloud(painter, pose, self._cloud, near=True)
        if self._ghost is not None:
            paint_ghost(painter, self._pose(self._ghost), theme.palette())

    def _paint_frame(self, painter: QPainter) -> None:
        """The word for a dimmed board, and a border when the keyboard steers the camera."""
        if self._dimmed:
            _paint_note(painter, QRectF(self.rect()), self._dimmed)
        self._paint_focus(painter)


def _paint_note(painter: QPainter, area: QRectF, text: str) -> None:
    """A pill at the lower edge: shape and words, cut short where there is no room."""
    colours = theme.palette()
    painter.setFont(theme.font("body"))
    metrics = QFontMetricsF(painter.font())
    words = f"{theme.tone_glyph('warn')}  {text}"
    words = metrics.elidedText(words, Qt.TextElideMode.ElideRight, area.width() - 56.0)
    width, height = metrics.horizontalAdvance(words) + 32.0, metrics.height() + 14.0
    pill = QRectF(area.center().x() - width / 2.0, area.bottom() - height - 18.0, width, height)
    painter.setPen(theme.pen(colours.line))
    painter.setBrush(colours.panel)
    painter.drawRoundedRect(pill, height / 2.0, height / 2.0)
    painter.setPen(colours.warn)
    painter.drawText(pill, Qt.AlignmentFlag.AlignCenter, words)


def _greyed(colours: theme.Palette) -> theme.Palette:
    """The board's colours without their colour."""
    names = ("axis_x", "axis_y", "axis_z", "plate_x", "plate_y", "plate_z", "gold", "print", "chip")
    dull = {name: theme.mix(_grey(getattr(colours, name)), colours.housing, 0.55) for name in names}
    return dataclasses.replace(colours, **dull)


def _grey(colour: QColor) -> QColor:
    level = qGray(colour.rgb())
    return QColor(level, level, level)
