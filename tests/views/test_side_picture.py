"""The vertebra from behind: the side by picture, by word, by mouse and by key."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QImage
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from imugui.views import theme
from imugui.views.side_picture import SidePicture


@pytest.fixture(params=("light", "dark"))
def picture(request: pytest.FixtureRequest, qapp: QApplication, shown: Callable[[Any], Any]) -> Iterator[SidePicture]:
    theme.apply(qapp, request.param)
    widget = SidePicture()
    widget.resize(300, 150)
    yield shown(widget)
    theme.apply(qapp, "light")


def accents(widget: SidePicture) -> tuple[int, int]:
    """Pixels in the accent colour in the left and in the right half."""
    image = widget.grab().toImage().convertToFormat(QImage.Format.Format_RGB32)
    goal = theme.palette().accent.rgb()
    half = image.width() // 2
    hits = [x for x in range(image.width()) for y in range(2, image.height() - 2) if image.pixel(x, y) == goal]
    return sum(2 < x < half for x in hits), sum(half <= x < image.width() - 3 for x in hits)


@pytest.mark.parametrize("side", ["left", "right"])
def test_the_patients_left_is_on_the_left(picture: SidePicture, side: str) -> None:
    picture.clearFocus()
    picture.show_side(side)
    left, right = accents(picture)
    assert (left > 200 > right) if side == "left" else (right > 200 > left)
    assert picture.accessibleDescription() == f"{side} side"


def test_no_side_is_marked_before_one_is_chosen(picture: SidePicture) -> None:
    picture.clearFocus()
    assert accents(picture) == (0, 0)


def test_a_click_and_the_arrow_keys_choose(picture: SidePicture, qtbot: QtBot) -> None:
    chosen: list[str] = []
    picture.chosen.connect(chosen.append)
    qtbot.mouseClick(picture, Qt.MouseButton.LeftButton, pos=QPoint(250, 70))
    qtbot.mouseClick(picture, Qt.MouseButton.LeftButton, pos=QPoint(40, 70))
    qtbot.keyClick(picture, Qt.Key.Key_Right)
    qtbot.keyClick(picture, Qt.Key.Key_Left)
    assert chosen == ["right", "left", "right", "left"]
    assert picture.side == "left"


def test_a_picture_that_only_shows_is_not_changed(
    qapp: QApplication, shown: Callable[[Any], Any], qtbot: QtBot
) -> None:
    widget = shown(SidePicture(editable=False))
    widget.show_side("left")
    qtbot.mouseClick(widget, Qt.MouseButton.LeftButton, pos=QPoint(widget.width() - 20, 60))
    assert widget.side == "left"
    assert widget.focusPolicy() == Qt.FocusPolicy.NoFocus
