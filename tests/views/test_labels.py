"""Chips, phrases in a tone, lines cut with dots, buttons with icons."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from PySide6.QtGui import QColor, QImage
from PySide6.QtWidgets import QApplication

from imugui.views import theme
from imugui.views.controls import Button, StillBox
from imugui.views.labels import Chip, ElidedLabel, ToneLabel


def has(image: QImage, colour: QColor) -> bool:
    """Whether a pixel is nearly of this colour; thin strokes never reach it quite."""
    pixels = (image.pixelColor(x, y) for x in range(image.width()) for y in range(image.height()))
    return any(distance(pixel, colour) < 40 for pixel in pixels)


def distance(a: QColor, b: QColor) -> int:
    return abs(a.red() - b.red()) + abs(a.green() - b.green()) + abs(a.blue() - b.blue())


@pytest.mark.parametrize("tone", theme.TONES)
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_a_chip_has_the_colour_of_its_tone(
    shown: Callable[[Any], Any], qapp: QApplication, tone: str, scheme: str
) -> None:
    theme.apply(qapp, scheme)
    chip = shown(Chip(name="State"))
    chip.show_state(tone, "HHHH")
    chip.resize(chip.sizeHint() * 3)
    image = chip.grab().toImage()
    assert has(image, theme.tone_colour(tone))
    assert chip.accessibleName() == "State: HHHH"


def test_a_chip_keeps_its_width(shown: Callable[[Any], Any]) -> None:
    chip = shown(Chip(("Moving", "At rest")))
    widths = set()
    for word in ("Moving", "At rest"):
        chip.show_state("neutral", word)
        widths.add(chip.sizeHint().width())
    assert len(widths) == 1
    chip.show_state("neutral", "a word that nobody expected")
    assert chip.sizeHint().width() > max(widths)


def test_a_phrase_has_a_shape_unless_neutral(shown: Callable[[Any], Any]) -> None:
    label = shown(ToneLabel("x" * 30))
    width = label.sizeHint().width()
    for tone, text in (("neutral", "fine"), ("warn", "▲ fine"), ("bad", "✕ fine")):
        label.show_phrase(tone, "fine")
        assert (label.text(), label.tone) == (text, tone)
        assert label.sizeHint().width() == width
    assert has(label.grab().toImage(), theme.tone_colour("bad"))


def test_a_long_line_is_cut_and_its_whole_is_the_tip(shown: Callable[[Any], Any]) -> None:
    label = shown(ElidedLabel("short"))
    label.resize(300, 20)
    assert (label.text(), label.toolTip()) == ("short", "")
    label.show_line("long " * 40)
    assert label.text().endswith("…")
    assert label.toolTip() == label.whole == "long " * 40
    label.resize(4000, 20)
    assert label.text() == "long " * 40


def test_an_icon_follows_the_scheme(shown: Callable[[Any], Any], qapp: QApplication) -> None:
    button = shown(Button("", "Open", icon="open"))
    button.resize(60, 40)
    for scheme in ("light", "dark"):
        theme.apply(qapp, scheme)
        assert has(button.icon().pixmap(64).toImage(), theme.palette().text)


def test_a_box_shows_the_short_text_but_lists_the_long_one(shown: Callable[[Any], Any]) -> None:
    box = shown(StillBox("Format", "How"))
    box.add("A very long title of a format", "a", short="a", words="More")
    plain = StillBox("Format", "How")
    plain.add("a", "a")
    for one in (box, plain):
        one.resize(200, 34)
    assert box.grab().toImage() == shown(plain).grab().toImage()
    assert box.itemText(0) == "A very long title of a format"
    box.choose("there is none")
    assert box.currentData() == "a"
