"""The picture of the game, by pixels and by events."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator

import numpy as np
import pytest
from numpy.typing import NDArray
from PySide6.QtCore import QEvent, QPoint, QPointF, Qt
from PySide6.QtGui import QColor, QImage, QKeyEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QLineEdit, QVBoxLayout, QWidget
from pytestqt.qtbot import QtBot

from imugui.fusion.scalar import Quat
from imugui.targeting.activation import Input
from imugui.targeting.game import Game
from imugui.targeting.game_look import GameLook
from imugui.targeting.play_again import Setup
from imugui.targeting.settings import Control
from imugui.targeting.tally import Labels
from imugui.targeting.tasks import DWELL, PRESETS, Target, Task
from imugui.targeting.view_pose import View
from imugui.views import theme
from imugui.views.game_colours import colours
from imugui.views.game_map import FieldMap
from imugui.views.game_scene import GameScene
from imugui.views.game_words import Plate, plate

SIZE = (700, 640)
LEVEL: Quat = (1.0, 0.0, 0.0, 0.0)
STILL = (0.0, 0.0, 0.0)
Pixels = NDArray[np.int16]


@pytest.fixture(params=["light", "dark"], autouse=True)
def scheme(request: pytest.FixtureRequest, qapp: QApplication) -> Iterator[str]:
    theme.apply(qapp, request.param)
    yield request.param
    theme.apply(qapp, "light")


@pytest.fixture
def scene(qtbot: QtBot) -> GameScene:
    widget = GameScene()
    qtbot.addWidget(widget)
    widget.resize(*SIZE)
    return widget


def game(task: Task, *inputs: str) -> Game:
    """A run after one row for each of these inputs."""
    one = Setup(task, Control(mask_s=0.0), 3, labels=Labels(practice=False)).game()
    one.step(0.0, LEVEL, STILL, -1)
    for number, name in enumerate(inputs, 1):
        kind, _, value = name.partition(" ")
        one.step(0.01 * number, LEVEL, STILL, -1, (Input(kind, value),))
    return one


def looked(task: Task | None = None, *inputs: str) -> GameLook:
    """How such a run looks; the game's target and view lie far apart."""
    look = game(task or PRESETS["thesis"], *(inputs or ("confirm",))).look()
    if not look.task.sized:
        return look
    return dataclasses.replace(look, target=Target(-120.0, -60.0, 140.0), view=View(100.0, 80.0, 110.0))


def near_target(look: GameLook) -> GameLook:
    """The same with the view on the target."""
    view = View(look.target.x + 2.0, look.target.y - 3.0, look.target.size + 3.0)
    return dataclasses.replace(look, view=view, position_ok=True, size_ok=True)


def picture(scene: GameScene, ratio: float = 1.0) -> Pixels:
    """What is painted, (rows, columns, 3) red, green, blue."""
    image = QImage(round(scene.width() * ratio), round(scene.height() * ratio), QImage.Format.Format_RGB32)
    image.setDevicePixelRatio(ratio)
    scene.render(image)
    raw = np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), image.width(), 4)
    return raw[:, :, 2::-1].astype(np.int16)


def share(pixels: Pixels, at: QPointF, colour: QColor, reach: int = 4, tolerance: int = 40) -> float:
    """How much of the pixels around a place have about this colour."""
    row, column = round(at.y()), round(at.x())
    part = pixels[row - reach : row + reach + 1, column - reach : column + reach + 1]
    goal = np.array((colour.red(), colour.green(), colour.blue()))
    return float((np.abs(part - goal) <= tolerance).all(axis=-1).mean())


@pytest.mark.parametrize("plain", [False, True])
def test_target_and_view_are_where_they_are(scene: GameScene, plain: bool) -> None:
    look = looked()
    scene.set_plain(plain)
    scene.show_look(look)
    place, pixels, paints = scene.place(), picture(scene), colours(plain)
    for corner in (place.square(*look.target[:3]).topLeft(), place.square(*look.target[:3]).bottomRight()):
        assert share(pixels, corner, paints.target) > 0.15
    frame = place.square(*look.view)
    for side in (QPointF(frame.left(), frame.center().y()), QPointF(frame.center().x(), frame.top())):
        assert share(pixels, side, paints.view) > 0.2
    assert share(pixels, place.at(look.view.x, look.view.y), paints.view, 2) > 0.6


def test_the_view_moves_the_frame(scene: GameScene) -> None:
    look, view = looked(), View(-120.0, 150.0, 150.0)
    scene.show_look(look)
    scene.show_look(dataclasses.replace(look, view=view))
    corner = scene.place().square(*view).topLeft()
    assert share(picture(scene), corner, colours(False).view) > 0.12


def test_tissue_is_lit_inside_the_view(scene: GameScene) -> None:
    look = dataclasses.replace(looked(), view=View(0.0, 160.0, 200.0), target=looked().target._replace(x=0.0, y=-200.0))
    scene.show_look(look)
    place, pixels = scene.place(), picture(scene)
    inside, outside = place.at(-40.0, 200.0), place.at(-140.0, 200.0)
    spots = [(round(one.y()), round(one.x())) for one in (inside, outside)]
    means = [pixels[row - 8 : row + 8, column - 8 : column + 8].mean() for row, column in spots]
    assert means[0] > 1.3 * means[1]


def test_the_plain_picture_has_no_tissue(scene: GameScene) -> None:
    scene.set_plain(True)
    scene.show_look(looked())
    at = scene.place().at(-250.0, 130.0)
    assert share(picture(scene), at, theme.palette().panel, 5, 4) > 0.9


@pytest.mark.parametrize("plain", [False, True])
def test_a_match_changes_the_colour_of_the_view(scene: GameScene, plain: bool) -> None:
    look = near_target(looked())
    scene.set_plain(plain)
    scene.show_look(look)
    frame = scene.place().square(*look.view)
    at = QPointF(frame.left(), frame.center().y() + 25.0)
    pixels, paints = picture(scene), colours(plain)
    assert share(pixels, at, paints.good) > 0.2
    assert share(pixels, at, paints.view) < 0.05


def test_the_dwell_closes_an_arc(scene: GameScene) -> None:
    look = near_target(looked(dataclasses.replace(PRESETS["thesis"], selection=DWELL)))
    for dwell, covered in ((0.1, False), (0.9, True)):
        scene.show_look(dataclasses.replace(look, dwell=dwell))
        at = scene.place().at(look.view.x, look.view.y) + QPointF(0.0, 30.0)  # half way round
        assert (share(picture(scene), at, colours(False).good, 2) > 0.5) is covered


def test_a_ring_shows_all_circles_and_fills_one(scene: GameScene) -> None:
    look = looked(PRESETS["ring, button"])
    scene.show_look(look)
    place, pixels, paints = scene.place(), picture(scene), colours(False)
    assert len(look.ring) == look.task.ring_targets
    rims = [place.at(one.x, one.y) + QPointF(0.5 * one.size * place.scale, 0.0) for one in look.ring]
    marked = [share(pixels, rim, paints.target) > 0.15 for rim in rims]
    assert marked == [(one.x, one.y) == (look.target.x, look.target.y) for one in look.ring]
    # the other circles have a dark casing and a bright line
    assert all(np.ptp(pixels[round(rim.y()), round(rim.x()) - 3 : round(rim.x()) + 4]) > 40 for rim in rims)


@pytest.mark.parametrize(
    ("inputs", "tone", "title"),
    [(("confirm", "stop"), "bad", "Stopped"), (("confirm", "press pan", "stale"), "warn", "Hold")],
)
def test_what_is_wrong_frames_the_picture(scene: GameScene, inputs: tuple[str, ...], tone: str, title: str) -> None:
    look = looked(None, *inputs)
    shown = plate(look)
    assert shown is not None
    assert (shown.tone, shown.title) == (tone, title)
    scene.show_look(looked())
    edge = QPointF(scene.place().room.left() + 1.0, scene.place().centre.y())
    assert share(picture(scene), edge, theme.tone_colour(tone), 2) < 0.1
    scene.show_look(look)
    pixels = picture(scene)
    framed = [share(pixels, edge + QPointF(dx, 0.0), theme.tone_colour(tone), 2) for dx in range(60)]
    assert max(framed) > 0.5
    assert title in scene.accessibleDescription() or look.phase_word in scene.accessibleDescription()


def test_two_steps_lead_out_of_a_stop() -> None:
    stopped, reset = looked(None, "confirm", "stop"), looked(None, "confirm", "stop", "reset")
    assert plate(stopped).lines[1:] == ("1. Reset: Backspace", "2. Confirm: Enter")
    assert plate(reset).title == "Not armed"
    assert plate(looked(None, "confirm", "stop", "reset", "confirm")) is None


def test_the_state_stands_above_in_its_colour(scene: GameScene) -> None:
    scene.show_look(looked(None, "confirm", "press pan"))
    top = picture(scene)[:44, :200]
    goal = theme.tone_colour("good")
    found = (np.abs(top - np.array((goal.red(), goal.green(), goal.blue()))) < 40).all(axis=-1)
    assert found.sum() > 60


def test_twice_the_pixels_show_the_same_place(scene: GameScene) -> None:
    look = looked()
    scene.show_look(look)
    corner = scene.place().square(*look.target[:3]).topLeft()
    assert share(picture(scene, 2.0), corner * 2.0, colours(False).target, 8) > 0.2


@pytest.mark.parametrize(("width", "height"), [(360, 320), (1600, 500), (500, 1400)])
def test_the_whole_field_is_inside_the_widget(width: int, height: int) -> None:
    place = FieldMap(width, height)
    field = place.field
    assert field.left() >= 0.0
    assert field.right() <= width
    assert field.top() >= 0.0
    assert field.bottom() <= height
    assert place.at(10.0, 20.0) - place.centre == QPointF(10.0, -20.0) * place.scale


def test_without_a_run_there_is_an_invitation(scene: GameScene) -> None:
    bare = picture(scene)
    scene.invite(Plate("neutral", "Ready", ("Bring the blue view onto the red target.",)))
    middle = picture(scene)[SIZE[1] // 2 - 60 : SIZE[1] // 2 + 20, 200:500]
    assert (middle != bare[SIZE[1] // 2 - 60 : SIZE[1] // 2 + 20, 200:500]).any()


# keys and mouse


def heard(scene: GameScene) -> list[tuple[object, ...]]:
    """Everything the scene emits."""
    said: list[tuple[object, ...]] = []
    scene.pressed.connect(lambda button: said.append(("press", button)))
    scene.released.connect(lambda button: said.append(("release", button)))
    scene.turned.connect(lambda right, up: said.append(("turn", round(right, 6), round(up, 6))))
    scene.go_on.connect(lambda: said.append(("go on",)))
    scene.reset_wanted.connect(lambda: said.append(("reset",)))
    return said


def test_keys_are_the_games_while_it_is_played(scene: GameScene) -> None:
    said = heard(scene)
    for key in (Qt.Key.Key_Space, Qt.Key.Key_Z, Qt.Key.Key_Backspace):
        QTest.keyClick(scene, key)
    assert said == []
    scene.set_playing(True)
    for key in (Qt.Key.Key_Space, Qt.Key.Key_Z, Qt.Key.Key_X, Qt.Key.Key_Return, Qt.Key.Key_Backspace):
        QTest.keyClick(scene, key)
    assert said == [
        ("press", ""), ("release", ""), ("press", "zoom"), ("release", "zoom"), ("press", "clutch"),
        ("release", "clutch"), ("go on",), ("reset",),
    ]  # fmt: skip


def test_enter_starts_a_run(scene: GameScene) -> None:
    said = heard(scene)
    QTest.keyClick(scene, Qt.Key.Key_Enter)
    assert said == [("go on",)]


def test_a_key_that_repeats_itself_is_held(scene: GameScene) -> None:
    scene.set_playing(True)
    said = heard(scene)
    none = Qt.KeyboardModifier.NoModifier
    for kind in (QEvent.Type.KeyPress, QEvent.Type.KeyRelease, QEvent.Type.KeyPress):
        for key in (Qt.Key.Key_Space, Qt.Key.Key_Return):
            QApplication.sendEvent(scene, QKeyEvent(kind, key, none, "", True))
    assert said == []


def test_no_shortcut_takes_a_key_from_the_game(scene: GameScene) -> None:
    override = QKeyEvent(QEvent.Type.ShortcutOverride, Qt.Key.Key_Z, Qt.KeyboardModifier.NoModifier)
    override.ignore()
    QApplication.sendEvent(scene, override)
    assert not override.isAccepted()
    scene.set_playing(True)
    QApplication.sendEvent(scene, override)
    assert override.isAccepted()


def test_losing_the_keys_lets_go(qtbot: QtBot, scheme: str) -> None:
    box, scene, other = QWidget(), GameScene(), QLineEdit()
    column = QVBoxLayout(box)
    column.addWidget(scene)
    column.addWidget(other)
    qtbot.addWidget(box)
    box.show()
    box.activateWindow()
    scene.setFocus()
    qtbot.waitUntil(scene.hasFocus)
    scene.set_playing(True)
    said = heard(scene)
    QTest.keyPress(scene, Qt.Key.Key_Space)
    other.setFocus()
    assert said == [("press", ""), ("release", "")]


def test_a_key_and_a_mouse_button_may_hold_the_same(scene: GameScene) -> None:
    scene.set_playing(True)
    said = heard(scene)
    at = QPoint(300, 300)
    QTest.keyPress(scene, Qt.Key.Key_Z)
    QTest.mousePress(scene, Qt.MouseButton.RightButton, pos=at)
    QTest.keyRelease(scene, Qt.Key.Key_Z)
    assert said == [("press", "zoom")]
    QTest.mouseRelease(scene, Qt.MouseButton.RightButton, pos=at)
    assert said == [("press", "zoom"), ("release", "zoom")]


def test_mouse_buttons_press_and_a_drag_turns_the_board(scene: GameScene) -> None:
    scene.set_playing(True, hand=True)
    said = heard(scene)
    scale, start = scene.place().scale, QPoint(300, 300)
    QTest.mousePress(scene, Qt.MouseButton.LeftButton, pos=start)
    QTest.mouseMove(scene, start + QPoint(40, -20))
    QTest.mouseRelease(scene, Qt.MouseButton.LeftButton, pos=start)
    QTest.mouseMove(scene, start + QPoint(90, 0))
    turns = [one for one in said if one[0] == "turn"]
    assert said[0] == ("press", "pan")
    assert said[-1] == ("release", "pan")
    assert turns == [("turn", round(40.0 / scale, 6), round(20.0 / scale, 6))]


def test_the_mouse_only_turns_where_buttons_latch(scene: GameScene) -> None:
    scene.set_playing(True, hand=True, mouse_presses=False)
    said = heard(scene)
    QTest.mousePress(scene, Qt.MouseButton.LeftButton, pos=QPoint(300, 300))
    QTest.mouseMove(scene, QPoint(310, 300))
    assert [one[0] for one in said] == ["turn"]


def test_the_middle_button_selects(scene: GameScene) -> None:
    scene.set_playing(True)
    said = heard(scene)
    QTest.mouseClick(scene, Qt.MouseButton.MiddleButton, pos=QPoint(300, 300))
    assert said == [("go on",)]


def test_arrow_keys_turn_the_board_a_little_and_then_on(scene: GameScene) -> None:
    said = heard(scene)
    scene.set_playing(True)
    QTest.keyClick(scene, Qt.Key.Key_Left)
    assert said == []  # a real board is not turned by keys
    scene.set_playing(True, hand=True)
    QTest.keyPress(scene, Qt.Key.Key_Left)
    assert said == [("turn", -4.0, 0.0)]
    for _ in range(10):
        scene.carry_on(0.05)
    QTest.keyRelease(scene, Qt.Key.Key_Left)
    moved = len(said)
    assert moved > 3
    assert all(one[1] < 0.0 for one in said)
    scene.carry_on(0.05)
    assert len(said) == moved
