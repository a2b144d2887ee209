"""The Tool and Register steps on made attitudes: poses are held, spins turned, refusals said."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from PySide6.QtCore import Qt
from pytestqt.qtbot import QtBot

from imugui.fusion.quaternion import Floats, from_rotation_vector, multiply
from imugui.guidance.registration import Registration
from imugui.guidance.tool_axis import BOX_AXES
from imugui.samples import ATTITUDE, GRAVITY, Rows, empty_rows
from imugui.views.guide_pose import PoseTaker
from imugui.views.guide_register_panel import RegisterPanel
from imugui.views.guide_register_steps import WAYS
from imugui.views.guide_tool_panel import ToolPanel
from imugui.workers.session import Session

RATE_HZ = 100.0
EAST = from_rotation_vector(np.zeros(3))
UP = from_rotation_vector(np.array((0.0, -np.pi / 2, 0.0)))
NORTH = from_rotation_vector(np.array((0.0, 0.0, np.pi / 2)))
DOWN = from_rotation_vector(np.array((0.0, np.pi / 2, 0.0)))


class Stream:
    """Rows one after the other, numbered as in the ring."""

    def __init__(self) -> None:
        self.count = 0
        self._noise = np.random.default_rng(4)

    def rows(self, quats: Floats) -> tuple[Rows, int]:
        """ATTITUDE rows of these attitudes (n, 4), and the number of the first."""
        rows = empty_rows(ATTITUDE, len(quats))
        rows["t"] = rows["t_arrival"] = (self.count + np.arange(len(quats))) / RATE_HZ
        rows["quat"], rows["gyr"], rows["acc"] = quats, 0.0, (0.0, 0.0, GRAVITY)
        first, self.count = self.count, self.count + len(quats)
        return rows, first

    def held(self, quat: Floats, seconds: float = 1.5, tremor: float = 0.002) -> tuple[Rows, int]:
        """A pose with a hand's tremor, rad."""
        shaken = from_rotation_vector(self._noise.normal(0.0, tremor, (int(seconds * RATE_HZ), 3)))
        return self.rows(multiply(quat, shaken))


def turning(axis: tuple[float, float, float], angle: float, seconds: float, start: Floats) -> Floats:
    turns = from_rotation_vector(np.linspace(0.0, angle, int(seconds * RATE_HZ))[:, None] * np.array(axis))
    return multiply(start, turns)


@pytest.fixture
def stream() -> Stream:
    return Stream()


@pytest.fixture
def register(session: Session, shown: Callable[[Any], Any]) -> RegisterPanel:
    panel = RegisterPanel(session)
    panel.resize(940, 520)
    return shown(panel)


@pytest.fixture
def tool(session: Session, shown: Callable[[Any], Any]) -> ToolPanel:
    panel = ToolPanel(session)
    panel.resize(940, 520)
    return shown(panel)


def test_a_pose_is_taken_when_the_tool_is_held(stream: Stream) -> None:
    taker = PoseTaker((1.0, 0.0, 0.0))
    assert taker.feed(*stream.held(EAST)) is None, "nobody has asked"
    taker.begin((1.0, 0.0, 0.0))
    assert taker.feed(*stream.rows(turning((0.0, 0.0, 1.0), 1.5, 2.0, EAST))) is None
    assert taker.waiting and taker.progress == 0.0
    pose = taker.feed(*stream.held(NORTH))
    assert pose is not None and not taker.waiting
    assert pose.rows[1] == stream.count - 1
    assert len(pose.quats) == pose.rows[1] - pose.rows[0] + 1 == 51
    assert pose.t == pytest.approx((stream.count - 1) / RATE_HZ)


def test_a_gap_in_the_stream_breaks_the_hold(stream: Stream) -> None:
    taker = PoseTaker((1.0, 0.0, 0.0))
    taker.begin((1.0, 0.0, 0.0))
    assert taker.feed(*stream.held(EAST, 0.8)) is None
    assert taker.progress > 0.2
    stream.count += 100
    assert taker.feed(*stream.held(EAST, 0.1)) is None
    assert taker.progress == 0.0


def test_two_axes_make_a_registration(register: RegisterPanel, stream: Stream, qtbot: QtBot) -> None:
    made: list[Registration] = []
    started: list[bool] = []
    register.registered.connect(made.append)
    register.started.connect(started.append)
    assert "back to front" in register.stage.sentence.text()
    qtbot.keyClick(register.take_button, Qt.Key.Key_Space)
    assert started == [False], "without the magnetometer, as the box says"
    assert register.stage.sentence.text().endswith("Hold it still…")
    register.feed(*stream.held(EAST))
    assert register.steps.text().startswith("✓")
    assert "head" in register.stage.sentence.text()
    assert made == []
    register.take()
    register.feed(*stream.held(UP))
    (found,) = made
    assert found.method == "axes"
    assert found.residual_deg < 0.2
    assert np.array(found.matrix)[:, 1] == pytest.approx((1.0, 0.0, 0.0), abs=0.01)
    assert np.array(found.matrix)[:, 2] == pytest.approx((0.0, 0.0, 1.0), abs=0.01)
    register.show_registration(found)
    assert register.chip.text() == "Registered"
    assert found.id in register.residual.text()
    register.show_registration(found, "The stream has begun anew.")
    assert register.chip.text() == "No longer good"
    assert not register.next_button.isEnabled()
    register.show_registration(None)
    assert register.chip.text() == "Not registered"


def test_axes_that_are_not_square_are_refused_with_the_reason(register: RegisterPanel, stream: Stream) -> None:
    made: list[Registration] = []
    register.registered.connect(made.append)
    for pose in (EAST, from_rotation_vector(np.array((0.0, 0.0, 1.0)))):
        register.take()
        register.feed(*stream.held(pose))
    assert made == []
    assert "57° apart" in register.trouble.text()
    assert "○" in register.steps.text(), "and it begins anew"


@pytest.mark.parametrize("method", ["mark", "origin"])
def test_one_pose_is_enough_for_the_other_ways(register: RegisterPanel, stream: Stream, method: str) -> None:
    made: list[Registration] = []
    register.registered.connect(made.append)
    register.choose(method)
    assert register.position.isVisible() == (method == "mark")
    register.take()
    register.feed(*stream.held(NORTH))
    (found,) = made
    assert found.method == method
    assert len(found.rows) == 1


def test_a_mark_that_is_not_level_is_refused(register: RegisterPanel, stream: Stream) -> None:
    register.choose("mark")
    register.take()
    register.feed(*stream.held(UP))
    assert "horizon" in register.trouble.text()


def test_taking_can_be_stopped_and_begun_again(register: RegisterPanel, stream: Stream) -> None:
    register.take()
    assert register.take_button.text() == "Stop"
    register.take()
    register.feed(*stream.held(EAST))
    assert "✓" not in register.steps.text()
    register.take()
    register.feed(*stream.held(EAST))
    assert "✓" in register.steps.text()
    register.show_tool(BOX_AXES["-y"])
    assert "✓" not in register.steps.text(), "poses of another tool axis are worth nothing"


def test_every_way_says_what_to_do() -> None:
    for way in WAYS.values():
        assert way.title and way.words and way.steps
        assert all(name and words.endswith(".") for name, words in way.steps)


def test_a_spin_finds_the_axis(tool: ToolPanel, stream: Stream, qtbot: QtBot) -> None:
    chosen: list[tuple[Any, float]] = []
    tool.chosen.connect(lambda axis, quality: chosen.append((axis, quality)))
    axis = np.array((1.0, 0.1, -0.05)) / np.linalg.norm((1.0, 0.1, -0.05))
    qtbot.keyClick(tool.spin_button, Qt.Key.Key_Space)
    assert tool.measuring
    quats = turning(tuple(axis), 4.0, 3.0, DOWN)
    tool.feed(stream.rows(quats[:150])[0])
    assert 0 < tool.stage.bar.value() < 1000
    tool.feed(stream.rows(quats[150:])[0])
    ((found, quality_deg),) = chosen
    assert found == pytest.approx(axis, abs=1e-3)
    assert quality_deg < 0.5
    assert not tool.measuring
    tool.show_axis(found, quality_deg)
    assert tool.chip.text() == "Measured"
    assert tool.box.currentText() == "measured"


def test_what_was_no_spin_is_refused(tool: ToolPanel, stream: Stream) -> None:
    chosen: list[Any] = []
    tool.chosen.connect(lambda axis, _: chosen.append(axis))
    tool.take()
    first = turning((1.0, 0.0, 0.0), 2.0, 1.0, DOWN)
    second = turning((0.0, 1.0, 0.3), 2.0, 1.0, first[-1])
    tool.feed(stream.rows(np.concatenate((first, second)))[0])
    tool.feed(stream.rows(turning((1.0, 0.0, 0.0), 5.0, 1.0, second[-1]))[0])
    assert chosen == []
    assert "not turned about one axis" in tool.trouble.text()
    assert not tool.measuring


def test_a_box_axis_is_chosen_at_once(tool: ToolPanel) -> None:
    chosen: list[tuple[Any, float]] = []
    tool.chosen.connect(lambda axis, quality: chosen.append((axis, quality)))
    row = tool.box.findData("-z")
    tool.box.setCurrentIndex(row)
    tool.box.activated.emit(row)
    assert chosen == [(BOX_AXES["-z"], 0.0)]
    tool.show_axis(*chosen[0])
    assert "-z" in tool.words.text()
    tool.take()
    tool.take()
    assert not tool.measuring, "a spin can be given up"


def test_the_scene_is_turned_finely_with_ctrl(register: RegisterPanel, qtbot: QtBot) -> None:
    turns: list[tuple[float, float]] = []
    scene = register.stage.scene
    scene.set_hand_mode(True)
    scene.turn_board = lambda dx, dy: turns.append((round(np.degrees(dx), 3), round(np.degrees(dy), 3)))
    qtbot.keyClick(scene, Qt.Key.Key_Up)
    qtbot.keyClick(scene, Qt.Key.Key_Right, Qt.KeyboardModifier.ControlModifier)
    assert turns == [(0.0, -3.0), (0.5, 0.0)]
