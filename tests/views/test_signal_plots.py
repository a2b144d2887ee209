"""The stack of plots: what is painted, and what keys and mouse ask for."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtGui import QColor, QImage, QWheelEvent
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from imugui.signals.channels import PLAIN
from imugui.signals.strokes import Strokes
from imugui.views import theme
from imugui.views.signal_frame import CursorLine, Curve, Frame, Mark, Plot, Ticks
from imugui.views.signal_plots import GUTTER, PlotStack

LEFT = Qt.MouseButton.LeftButton
NO_TICKS = Ticks(np.empty(0), ())


def plot(key: str, *curves: Curve, note: str = "", limits: tuple[float, float] = (-1.0, 1.0)) -> Plot:
    return Plot(key, key, "u", limits, Ticks(np.array([-1.0, 0.0, 1.0]), ("−1", "0", "1")), curves, note)


@pytest.fixture
def stack(shown: Callable[[Any], Any], qapp: QApplication) -> PlotStack:
    theme.apply(qapp, "dark")
    widget = PlotStack()
    widget.resize(500, 320)
    return shown(widget)


def show(stack: PlotStack, *plots: Plot, **values: Any) -> QImage:
    stack.show_frame(Frame(stack.columns(), plots, **values))
    return stack.grab().toImage()


def count(image: QImage, colour: QColor, x: int | None = None) -> int:
    """Pixels of about this colour, in the whole picture or in one column."""
    image = image.convertToFormat(QImage.Format.Format_RGB32)
    pixels = np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), image.width(), 4)[:, :, :3]
    near = (np.abs(pixels - np.array((colour.blue(), colour.green(), colour.red()), int)) < 40).all(axis=2)
    return int(near.sum() if x is None else near[:, x].sum())


def spike(stack: PlotStack, column: int) -> Curve:
    marks = np.column_stack((np.arange(stack.columns()), *np.zeros((2, stack.columns()))))
    marks[column, 2] = 0.9
    return Curve("x", 0, Strokes(marks))


@pytest.mark.parametrize("column", [0, 211, 423])
def test_a_spike_of_one_column_is_painted(stack: PlotStack, column: int) -> None:
    image = show(stack, plot("a", spike(stack, column)))
    body = stack.bodies()[0]
    x = int(body.x(column))
    assert count(image, theme.axis_colour(0), x) > 0.4 * body.rect.height()
    assert count(image, theme.axis_colour(0), x + 3 if column < 400 else x - 3) < 6


@pytest.mark.parametrize("tone", [0, 1, 2, PLAIN])
def test_curves_have_the_colour_of_their_axis(stack: PlotStack, tone: int) -> None:
    empty = show(stack, plot("a"))
    lines = Strokes(np.array([[10.0, -0.8, 60.0, 0.8], [60.0, 0.8, 200.0, -0.5]]))
    image = show(stack, plot("a", Curve("c", tone, lines)))
    colour = theme.palette().text if tone == PLAIN else theme.axis_colour(tone)
    assert count(image, colour) > count(empty, colour) + 50


def test_nothing_is_painted_outside_its_plot(stack: PlotStack) -> None:
    wild = Strokes(np.array([[0.0, -1e30, 400.0, 1e30], [-500.0, 0.0, 900.0, 0.5]]))
    image = show(stack, plot("a"), plot("b", Curve("", 0, wild)))
    upper = stack.bodies()[0].rect
    top = image.copy(0, 0, image.width(), int(upper.bottom()))
    assert count(top, theme.axis_colour(0)) == 0
    assert count(image.copy(0, 0, int(GUTTER) - 2, image.height()), theme.axis_colour(0)) == 0


def test_a_sample_that_stands_alone_is_a_dot(stack: PlotStack) -> None:
    image = show(stack, plot("a", Curve("", 1, Strokes(np.array([[50.0, 0.5, 50.0, 0.5]])))))
    assert 6 <= count(image, theme.axis_colour(1)) <= 60


def test_notes_stand_where_there_is_nothing_to_see(stack: PlotStack) -> None:
    assert show(stack, plot("a", note="Not sent")) != show(stack, plot("a"))
    assert show(stack, note="Nothing is chosen") != show(stack)


def test_cursors_and_marks_are_painted(stack: PlotStack) -> None:
    cursors = (CursorLine("A", 100.0, True), CursorLine("B", 300.0, False), CursorLine("C", -9.0, False))
    image = show(stack, plot("a"), cursors=cursors, marks=(Mark(0, 100.0, 0.5, 2), Mark(0, 100.0, 50.0, 2)))
    body = stack.bodies()[0]
    assert count(image, theme.palette().accent, int(body.x(100.0))) > 0.5 * body.rect.height()
    dashes = count(image, theme.palette().accent, int(body.x(300.0)))
    assert 20 < dashes < count(image, theme.palette().accent, int(body.x(100.0)))


def test_both_schemes(stack: PlotStack, qapp: QApplication) -> None:
    dark = show(stack, plot("a", spike(stack, 50)))
    theme.apply(qapp, "light")
    light = stack.grab().toImage()
    centre = stack.bodies()[0].rect.center().toPoint() + QPoint(20, 20)
    assert dark.pixelColor(centre).lightness() < 128 < light.pixelColor(centre).lightness()


def test_plots_share_the_height(stack: PlotStack) -> None:
    show(stack, *(plot(name) for name in "abcdefghi"))
    bodies = stack.bodies()
    assert len({body.rect.height() for body in bodies}) == 1
    assert all(upper.rect.bottom() < lower.rect.top() for upper, lower in itertools.pairwise(bodies))
    assert bodies[-1].rect.bottom() <= stack.height()


@pytest.mark.parametrize(
    ("key", "asked"),
    [
        (Qt.Key.Key_Space, ["pause", 0]),
        (Qt.Key.Key_Plus, ["zoom", 1]),
        (Qt.Key.Key_Minus, ["zoom", -1]),
        (Qt.Key.Key_Left, ["step", -1]),
        (Qt.Key.Key_Right, ["step", 1]),
        (Qt.Key.Key_PageUp, ["pan", -1]),
        (Qt.Key.Key_B, ["cursor", 1]),
    ],
)
def test_keys(stack: PlotStack, qtbot: QtBot, key: Qt.Key, asked: list[Any]) -> None:
    show(stack, plot("a"), cursors=(CursorLine("A", 100.0, True),))
    with qtbot.waitSignal(stack.asked) as signal:
        qtbot.keyClick(stack, key)
    assert signal.args == asked


def test_shift_makes_large_steps(stack: PlotStack, qtbot: QtBot) -> None:
    show(stack, plot("a"), cursors=(CursorLine("A", 100.0, True),))
    with qtbot.waitSignal(stack.asked) as signal:
        qtbot.keyClick(stack, Qt.Key.Key_Left, Qt.KeyboardModifier.ShiftModifier)
    assert signal.args == ["step", -10]


def test_without_cursors_the_arrows_are_left_to_others(stack: PlotStack, qtbot: QtBot) -> None:
    show(stack, plot("a"))
    with qtbot.assertNotEmitted(stack.asked):
        qtbot.keyClick(stack, Qt.Key.Key_Left)
        qtbot.keyClick(stack, Qt.Key.Key_Space, Qt.KeyboardModifier.ControlModifier)


def at(stack: PlotStack, share: float, row: int = 0) -> QPoint:
    rect = stack.bodies()[row].rect
    return QPoint(round(rect.left() + share * rect.width()), round(rect.center().y()))


def test_dragging_pans(stack: PlotStack, qtbot: QtBot) -> None:
    show(stack, plot("a"))
    shares: list[float] = []
    stack.panned.connect(shares.append)
    qtbot.mousePress(stack, LEFT, pos=at(stack, 0.2))
    for share in (0.3, 0.4, 0.5):
        qtbot.mouseMove(stack, at(stack, share))
    with qtbot.assertNotEmitted(stack.placed):
        qtbot.mouseRelease(stack, LEFT, pos=at(stack, 0.5))
    assert sum(shares) == pytest.approx(0.3, abs=0.01)


def test_a_click_places_the_cursor(stack: PlotStack, qtbot: QtBot) -> None:
    show(stack, plot("a"))
    with qtbot.waitSignal(stack.placed) as signal:
        qtbot.mouseClick(stack, LEFT, pos=at(stack, 0.25))
    assert signal.args[0] == pytest.approx(0.25, abs=0.01)


def test_a_cursor_is_caught_and_dragged(stack: PlotStack, qtbot: QtBot) -> None:
    columns = stack.columns()
    cursors = (CursorLine("A", 0.2 * columns, True), CursorLine("B", 0.8 * columns, False))
    show(stack, plot("a"), cursors=cursors)
    places: list[float] = []
    stack.placed.connect(places.append)
    with qtbot.waitSignal(stack.caught) as signal:
        qtbot.mousePress(stack, LEFT, pos=at(stack, 0.8) + QPoint(3, 0))
    assert signal.args == [1]
    qtbot.mouseMove(stack, at(stack, 0.6))
    qtbot.mouseRelease(stack, LEFT, pos=at(stack, 0.6))
    assert places == pytest.approx([0.6], abs=0.01)


def wheel(stack: PlotStack, place: QPoint, delta: int) -> None:
    event = QWheelEvent(
        QPointF(place), QPointF(stack.mapToGlobal(place)), QPoint(), QPoint(0, delta),
        Qt.MouseButton.NoButton, Qt.KeyboardModifier.NoModifier, Qt.ScrollPhase.NoScrollPhase, False,
    )  # fmt: skip
    QApplication.sendEvent(stack, event)


def test_the_wheel_zooms_where_it_points(stack: PlotStack, qtbot: QtBot) -> None:
    show(stack, plot("a"))
    zooms: list[tuple[int, float]] = []
    stack.zoomed.connect(lambda steps, share: zooms.append((steps, share)))
    wheel(stack, at(stack, 0.5), 120)
    for _ in range(4):
        wheel(stack, at(stack, 0.25), -30)
    assert [steps for steps, _ in zooms] == [-1, 1]
    assert [share for _, share in zooms] == pytest.approx([0.5, 0.25], abs=0.01)


def test_the_numbers_beside_a_plot_move_and_stretch_its_scale(stack: PlotStack, qtbot: QtBot) -> None:
    show(stack, plot("a"), plot("b", limits=(0.0, 10.0)))
    place = QPoint(20, at(stack, 0.0, row=1).y())
    scales: list[tuple[str, float, float]] = []
    stack.scaled.connect(lambda *values: scales.append(values))
    wheel(stack, place, 120)
    qtbot.mousePress(stack, LEFT, pos=place)
    qtbot.mouseMove(stack, place + QPoint(0, round(0.1 * stack.bodies()[1].rect.height())))
    qtbot.mouseRelease(stack, LEFT, pos=place)
    assert scales[0] == ("b", pytest.approx(1.0, abs=0.1), pytest.approx(9.0, abs=0.1))
    assert scales[1] == ("b", pytest.approx(1.0, abs=0.1), pytest.approx(11.0, abs=0.1))
    with qtbot.waitSignal(stack.fitted) as signal:
        qtbot.mouseDClick(stack, LEFT, pos=place)
    assert signal.args == ["b"]


def test_the_mouse_finds_nothing_where_there_are_no_plots(stack: PlotStack, qtbot: QtBot) -> None:
    show(stack)
    with qtbot.assertNotEmitted(stack.placed), qtbot.assertNotEmitted(stack.scaled):
        qtbot.mouseClick(stack, LEFT, pos=QPoint(200, 100))
        wheel(stack, QPoint(10, 100), 120)
        qtbot.mouseDClick(stack, LEFT, pos=QPoint(10, 100))
