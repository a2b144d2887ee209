"""The 3D scene under mouse, wheel and keys; and when it repaints."""

from __future__ import annotations

import math

import pytest
from PySide6.QtCore import QEvent, QObject, QPoint, QPointF, Qt
from PySide6.QtGui import QFocusEvent, QImage, QMouseEvent, QWheelEvent
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from imugui.views import theme
from imugui.views.geometry import camera_from
from imugui.views.scene3d import Scene3D

SIZE = 400
IDENTITY = (1.0, 0.0, 0.0, 0.0)


def turn(axis: str, angle_deg: float) -> tuple[float, ...]:
    """Quaternion of a turn about one axis."""
    half = math.radians(angle_deg) / 2.0
    return (math.cos(half), *(math.sin(half) * (axis == name) for name in "xyz"))


@pytest.fixture
def scene(qtbot: QtBot) -> Scene3D:
    widget = Scene3D()
    qtbot.addWidget(widget)
    widget.resize(SIZE, SIZE)
    return widget


def picture(scene: Scene3D) -> QImage:
    """What is painted."""
    image = QImage(scene.size(), QImage.Format.Format_RGB32)
    scene.render(image)
    return image


class Paints(QObject):
    """Counts the repaints of a widget."""

    count = 0

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        self.count += event.type() == QEvent.Type.Paint
        return False


def shown(scene: Scene3D) -> Paints:
    """The scene as if on screen, with its repaints counted."""
    paints = Paints(scene)
    scene.installEventFilter(paints)
    scene.setAttribute(Qt.WidgetAttribute.WA_DontShowOnScreen)
    scene.show()
    QApplication.processEvents()
    return paints


def test_repaint_only_when_something_moved(scene: Scene3D) -> None:
    paints = shown(scene)
    start = paints.count
    for _ in range(5):
        scene.set_quat(IDENTITY)
        scene.set_quat((-1.0, 0.0, 0.0, 0.0))
        scene.set_quat(turn("z", 0.01))
        scene.set_ghost(None)
        scene.set_dimmed(None)
        QApplication.processEvents()
    assert paints.count == start
    scene.set_quat(turn("z", 1.0))
    QApplication.processEvents()
    assert paints.count == start + 1


def test_slow_drift_is_not_lost(scene: Scene3D) -> None:
    paints = shown(scene)
    start = paints.count
    for step in range(100):
        scene.set_quat(turn("z", 0.01 * step))
        QApplication.processEvents()
    assert 5 < paints.count - start < 50


def test_same_ghost_is_not_painted_again(scene: Scene3D) -> None:
    paints = shown(scene)
    for quat, more in ((turn("x", 10.0), 1), (turn("x", 10.0), 0), (turn("x", 20.0), 1), (None, 1), (None, 0)):
        before = paints.count
        scene.set_ghost(quat)
        QApplication.processEvents()
        assert paints.count == before + more


def test_drag_orbits_the_camera(scene: Scene3D, qtbot: QtBot) -> None:
    turned: list[tuple[float, float]] = []
    scene.hand_turned.connect(lambda *angles: turned.append(angles))
    before = scene.camera()
    drag(scene, qtbot, Qt.MouseButton.LeftButton, QPoint(40, 20))
    after = scene.camera()
    assert after.azimuth - before.azimuth == pytest.approx(-40 * math.pi / SIZE)
    assert after.elevation - before.elevation == pytest.approx(20 * math.pi / SIZE)
    assert turned == []


def drag(scene: Scene3D, qtbot: QtBot, button: Qt.MouseButton, step: QPoint) -> None:
    start = QPoint(150, 150)
    qtbot.mousePress(scene, button, pos=start)
    move(scene, start + step, button)
    qtbot.mouseRelease(scene, button, pos=start + step)


def move(scene: Scene3D, pos: QPoint, buttons: Qt.MouseButton) -> None:
    place = QPointF(pos)
    none = Qt.MouseButton.NoButton
    event = QMouseEvent(QEvent.Type.MouseMove, place, place, none, buttons, Qt.KeyboardModifier.NoModifier)
    QApplication.sendEvent(scene, event)


def test_hand_mode_turns_the_board_with_left_and_orbits_with_right(scene: Scene3D, qtbot: QtBot) -> None:
    turned: list[tuple[float, float]] = []
    scene.hand_turned.connect(lambda *angles: turned.append(angles))
    scene.set_hand_mode(True)
    before = scene.camera()
    drag(scene, qtbot, Qt.MouseButton.LeftButton, QPoint(20, -10))
    assert scene.camera() == before
    assert turned == [pytest.approx((20 * math.pi / SIZE, -10 * math.pi / SIZE))]
    drag(scene, qtbot, Qt.MouseButton.RightButton, QPoint(20, 0))
    assert scene.camera() != before
    assert len(turned) == 1
    assert "virtual board" in scene.toolTip()


def test_pointer_without_a_button_does_nothing(scene: Scene3D) -> None:
    before = scene.camera()
    move(scene, QPoint(10, 10), Qt.MouseButton.NoButton)
    assert scene.camera() == before


def test_wheel_zooms_and_double_click_comes_home(scene: Scene3D, qtbot: QtBot) -> None:
    home = scene.camera()
    place = QPointF(200, 200)
    no_button, no_key = Qt.MouseButton.NoButton, Qt.KeyboardModifier.NoModifier
    phase = Qt.ScrollPhase.NoScrollPhase
    wheel = QWheelEvent(place, place, QPoint(), QPoint(0, 120), no_button, no_key, phase, False)
    QApplication.sendEvent(scene, wheel)
    assert scene.camera().distance < home.distance
    qtbot.mouseDClick(scene, Qt.MouseButton.LeftButton, pos=QPoint(200, 200))
    assert scene.camera() == home


def test_keys_steer_the_camera(scene: Scene3D, qtbot: QtBot) -> None:
    home = scene.camera()
    qtbot.keyClick(scene, Qt.Key.Key_Right)
    assert scene.camera().azimuth > home.azimuth
    qtbot.keyClick(scene, Qt.Key.Key_Down)
    assert scene.camera().elevation < home.elevation
    qtbot.keyClick(scene, Qt.Key.Key_Plus)
    assert scene.camera().distance < home.distance
    for key, view in ((Qt.Key.Key_X, "x"), (Qt.Key.Key_Y, "y"), (Qt.Key.Key_Z, "z"), (Qt.Key.Key_Home, "default")):
        qtbot.keyClick(scene, key)
        assert scene.camera() == camera_from(view)
    qtbot.keyClick(scene, Qt.Key.Key_X, Qt.KeyboardModifier.ControlModifier)
    assert scene.camera() == home


def test_keyboard_focus_is_shown(scene: Scene3D) -> None:
    plain = picture(scene)
    QApplication.sendEvent(scene, QFocusEvent(QEvent.Type.FocusIn, Qt.FocusReason.TabFocusReason))
    assert picture(scene).pixelColor(2, SIZE // 2) == theme.palette().accent
    QApplication.sendEvent(scene, QFocusEvent(QEvent.Type.FocusOut, Qt.FocusReason.TabFocusReason))
    assert picture(scene) == plain


def test_mouse_focus_needs_no_border(scene: Scene3D) -> None:
    plain = picture(scene)
    QApplication.sendEvent(scene, QFocusEvent(QEvent.Type.FocusIn, Qt.FocusReason.MouseFocusReason))
    assert picture(scene) == plain


def test_scene_has_words_for_those_who_cannot_see_it(scene: Scene3D) -> None:
    assert scene.accessibleName()
    assert "orbit" in scene.toolTip()
    assert scene.focusPolicy() == Qt.FocusPolicy.StrongFocus
