"""The large numbers, by text and pixels."""

from __future__ import annotations

import math
from collections.abc import Iterator

import pytest
from PySide6.QtGui import QColor
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from imugui.views import theme
from imugui.views.readout import Readout, number_text


@pytest.fixture(autouse=True)
def light(qapp: QApplication) -> Iterator[None]:
    theme.apply(qapp, "light")
    yield
    theme.apply(qapp, "light")


@pytest.fixture
def readout(qtbot: QtBot) -> Readout:
    widget = Readout("Yaw", axis=2)
    qtbot.addWidget(widget)
    widget.resize(widget.sizeHint().width() + 100, widget.sizeHint().height())
    return widget


def columns(widget: Readout, colour: QColor, below: float = 0.4) -> set[int]:
    """Columns with pixels of exactly this colour, in the part of the widget under its label."""
    image = widget.grab().toImage()
    rows = range(int(image.height() * below), image.height())
    return {x for x in range(image.width()) for y in rows if image.pixelColor(x, y) == colour}


@pytest.mark.parametrize(
    ("value", "decimals", "signed", "text"),
    [
        (12.34, 1, True, "+12.3"),
        (-12.36, 1, True, "−12.4"),
        (-0.04, 1, True, "+0.0"),
        (-0.0, 2, False, "0.00"),
        (7.0, 0, False, "7"),
        (-180.0, 1, True, "−180.0"),
    ],
)
def test_number_text(value: float, decimals: int, signed: bool, text: str) -> None:
    assert number_text(value, decimals, signed) == text


@pytest.mark.parametrize("unknown", [None, math.nan, math.inf])
def test_unknown_is_dashes(readout: Readout, unknown: float | None) -> None:
    readout.set_value(4.0)
    assert readout.text() == "+4.0"
    readout.set_value(unknown)
    assert readout.text() == "---.-"
    assert not columns(readout, theme.palette().text)


def test_decimals_and_range_make_the_blank(qtbot: QtBot) -> None:
    whole = Readout("Rate", "Hz", decimals=0, limit=2000, signed=False)
    quat = Readout("qw", "", decimals=4, limit=1.0)
    for widget in (whole, quat):
        qtbot.addWidget(widget)
    assert whole.text() == "----"
    assert quat.text() == "-.----"
    quat.set_value(-0.70711)
    assert quat.text() == "−0.7071"


def test_last_digit_and_size_stay_in_place(readout: Readout) -> None:
    size = readout.sizeHint()
    ends = set()
    for value in (8.8, -8.8, 88.8, -188.8):
        readout.set_value(value)
        ends.add(max(columns(readout, theme.palette().text)))
        assert readout.sizeHint() == size
    assert len(ends) == 1


def test_widest_value_has_room(readout: Readout) -> None:
    readout.resize(readout.minimumSizeHint())
    readout.set_value(-180.0)
    ink = columns(readout, theme.palette().text)
    bar = columns(readout, theme.axis_colour(2))
    assert max(bar) < min(ink)
    assert max(ink) < readout.width() - 1


def test_axis_mark_has_the_axis_colour(readout: Readout, qtbot: QtBot) -> None:
    assert columns(readout, theme.axis_colour(2)) <= {0, 1, 2}
    plain = Readout("Temperature", "°C")
    qtbot.addWidget(plain)
    assert not any(columns(plain, theme.axis_colour(i)) for i in range(3))


def test_doubt_greys_the_number_and_says_why(readout: Readout) -> None:
    readout.set_value(12.0)
    assert columns(readout, theme.palette().text)
    readout.set_value(12.0, "near ±90°")
    assert readout.text() == "+12.0"
    assert readout.doubt() == readout.toolTip() == "near ±90°"
    assert not columns(readout, theme.palette().text)
    assert columns(readout, theme.palette().warn, below=0.0)
    readout.set_value(12.0)
    assert not columns(readout, theme.palette().warn, below=0.0)


def test_dark_scheme(readout: Readout, qapp: QApplication) -> None:
    theme.apply(qapp, "dark")
    readout.set_value(1.0)
    assert columns(readout, theme.palette().text)


def test_label_is_its_accessible_name(readout: Readout) -> None:
    assert readout.accessibleName() == "Yaw"
