"""The compass dial, by text and pixels."""

from __future__ import annotations

import math
from collections.abc import Iterator

import pytest
from PySide6.QtCore import QSize
from PySide6.QtGui import QColor, QImage
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from imugui.views import theme
from imugui.views.compass import Compass, heading_text, wind


@pytest.fixture(autouse=True)
def light(qapp: QApplication) -> Iterator[None]:
    theme.apply(qapp, "light")
    yield
    theme.apply(qapp, "light")


@pytest.fixture
def compass(qtbot: QtBot) -> Compass:
    widget = Compass()
    qtbot.addWidget(widget)
    widget.resize(200, 200)
    return widget


def places(widget: Compass, colour: QColor) -> list[tuple[int, int]]:
    """Pixels of about this colour, from the middle of the dial, y up."""
    image = widget.grab().toImage().convertToFormat(QImage.Format.Format_RGB32)
    goal = colour.getRgb()[:3]
    found = []
    for y in range(image.height()):
        for x in range(image.width()):
            parts = image.pixelColor(x, y).getRgb()[:3]
            if max(abs(part - want) for part, want in zip(parts, goal, strict=True)) < 24:
                found.append((x - 100, 100 - y))
    return found


@pytest.mark.parametrize(
    ("heading_deg", "text"),
    [
        (0.0, "000°"),
        (7.4, "007°"),
        (359.6, "000°"),
        (-90.0, "270°"),
        (725.0, "005°"),
        (None, "---°"),
        (math.nan, "---°"),
    ],
)
def test_heading_has_three_digits(heading_deg: float | None, text: str) -> None:
    assert heading_text(heading_deg) == text


@pytest.mark.parametrize(("heading_deg", "name"), [(0, "N"), (44, "NE"), (247, "WSW"), (355, "N"), (-91, "W")])
def test_wind(heading_deg: float, name: str) -> None:
    assert wind(heading_deg) == name


@pytest.mark.parametrize("heading_deg", [0.0, 90.0, 215.0, 300.0])
def test_pointer_is_where_the_heading_says(compass: Compass, heading_deg: float) -> None:
    compass.set_heading(heading_deg)
    spots = places(compass, theme.palette().accent)
    assert len(spots) > 60
    east, north = (sum(spot[i] for spot in spots) / len(spots) for i in range(2))
    assert math.hypot(east, north) > 75.0
    found_deg = math.degrees(math.atan2(east, north))
    assert math.remainder(found_deg - heading_deg, 360.0) == pytest.approx(0.0, abs=2.0)


def test_doubt_greys_the_pointer_and_says_why(compass: Compass) -> None:
    compass.set_heading(120.0)
    assert places(compass, theme.palette().accent)
    assert not places(compass, theme.palette().warn)
    compass.set_heading(120.0, "field disturbed")
    assert not places(compass, theme.palette().accent)
    assert places(compass, theme.palette().warn)
    assert compass.text() == "120°"
    assert compass.accessibleDescription() == "120° field disturbed"


@pytest.mark.parametrize("unknown", [None, math.nan, math.inf])
def test_unknown_heading_has_no_pointer(compass: Compass, unknown: float | None) -> None:
    compass.set_heading(50.0)
    compass.set_heading(unknown)
    assert compass.text() == "---°"
    assert not places(compass, theme.palette().accent)


def test_small_changes_across_north_are_seen(compass: Compass) -> None:
    compass.set_heading(359.9)
    compass.set_heading(1.0)
    assert compass.text() == "001°"


def test_north_is_marked_more_strongly_than_the_rest(compass: Compass) -> None:
    ink = places(compass, theme.palette().text)
    assert ink
    assert all(north > 40 for _, north in ink)


def test_dark_dial_is_light_on_dark(compass: Compass, qapp: QApplication) -> None:
    theme.apply(qapp, "dark")
    compass.set_heading(10.0)
    assert places(compass, theme.palette().accent)
    assert places(compass, theme.palette().text)


def test_dial_stays_square_and_paints_at_any_size(compass: Compass) -> None:
    assert compass.heightForWidth(170) == 170
    for size in (QSize(1, 1), QSize(40, 300), QSize(600, 80)):
        compass.resize(size)
        compass.set_heading(float(size.width()), "no magnetometer")
        assert compass.grab().toImage().size() == size
