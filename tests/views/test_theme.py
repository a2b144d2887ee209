"""Colours, fonts and icons: readable by number, not by taste."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QColor, QFontMetricsF, QImage
from PySide6.QtWidgets import QApplication, QPushButton

from imugui import paths
from imugui.views import stylesheet, theme

ICONS = sorted((paths.resources() / "icons").glob("*.svg"))
FIXED_COLOURS = {"imugui", "arrow-up", "arrow-down", "tick"}


@pytest.fixture(params=["light", "dark"])
def scheme(request: pytest.FixtureRequest, qapp: QApplication) -> Iterator[str]:
    theme.apply(qapp, request.param)
    yield request.param
    theme.apply(qapp, "light")


def luminance(colour: QColor) -> float:
    """Relative luminance, WCAG 2.2."""
    parts = (colour.redF(), colour.greenF(), colour.blueF())
    linear = [part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in parts]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(a: QColor, b: QColor) -> float:
    """Contrast ratio, WCAG 2.2: 1 to 21."""
    low, high = sorted((luminance(a), luminance(b)))
    return (high + 0.05) / (low + 0.05)


def test_contrast_measure_knows_its_ends() -> None:
    assert contrast(QColor("black"), QColor("white")) == pytest.approx(21.0)
    assert contrast(QColor("red"), QColor("red")) == pytest.approx(1.0)


@pytest.mark.parametrize("name", ["text", "muted", "accent", "good", "warn", "bad"])
def test_text_is_readable(scheme: str, name: str) -> None:
    colours = theme.palette()
    for ground in (colours.window, colours.panel, colours.raised, colours.scene_top, colours.scene_bottom):
        assert contrast(getattr(colours, name), ground) >= 4.5


def test_text_on_the_accent_is_readable(scheme: str) -> None:
    assert contrast(theme.palette().on_accent, theme.palette().accent) >= 4.5


def test_axes_and_ghost_stand_out(scheme: str) -> None:
    colours = theme.palette()
    for colour in (*(theme.axis_colour(i) for i in range(3)), colours.ghost):
        for ground in (colours.scene_top, colours.scene_bottom, colours.panel, colours.window):
            assert contrast(colour, ground) >= 3.0


def test_plates_carry_their_white_letters(scheme: str) -> None:
    colours = theme.palette()
    for plate in (colours.plate_x, colours.plate_y, colours.plate_z):
        assert contrast(plate, colours.print) >= 3.0


def test_axes_are_okabe_ito_unless_too_dark_on_screen(scheme: str) -> None:
    names = [theme.axis_colour(i).name().upper() for i in range(3)]
    assert names[:2] == ["#D55E00", "#009E73"]
    if scheme == "light":
        assert names[2] == "#0072B2"
    else:
        assert contrast(QColor("#0072B2"), theme.palette().panel) < contrast(
            theme.axis_colour(2), theme.palette().panel
        )


def test_scheme_is_on_screen(scheme: str, qapp: QApplication) -> None:
    assert theme.is_dark() == (scheme == "dark")
    assert qapp.palette().window().color() == theme.palette().window
    assert theme.palette() is theme.palette()


def test_system_scheme_follows_the_desktop_and_a_chosen_one_does_not(qapp: QApplication) -> None:
    desktop_changed = qapp.styleHints().colorSchemeChanged
    theme.apply(qapp, "system")
    assert not theme.is_dark()  # the offscreen desktop has no opinion
    desktop_changed.emit(Qt.ColorScheme.Dark)
    assert theme.is_dark()
    theme.apply(qapp, "light")
    desktop_changed.emit(Qt.ColorScheme.Dark)
    assert not theme.is_dark()


def test_unknown_scheme_is_refused(qapp: QApplication) -> None:
    with pytest.raises(ValueError, match="sepia"):
        theme.apply(qapp, "sepia")


def test_style_sheet_is_complete_and_its_pictures_exist(scheme: str) -> None:
    folder = paths.resources() / "icons"
    sheet = stylesheet.render(theme.palette(), folder)
    assert "$" not in sheet
    pictures = [part.split('"')[0] for part in sheet.split('url("')[1:]]
    assert len(pictures) >= 3
    assert all(Path(picture).is_file() for picture in pictures)


def test_primary_button_wears_the_accent(scheme: str, qapp: QApplication) -> None:
    button = QPushButton("Connect")
    button.setProperty("role", "primary")
    button.resize(120, 32)
    assert button.grab().toImage().pixelColor(8, 16) == theme.palette().accent


@pytest.mark.parametrize("role", ["small", "body", "heading", "number", "huge"])
def test_digits_are_of_one_width(qapp: QApplication, role: str) -> None:
    metrics = QFontMetricsF(theme.font(role))
    assert len({metrics.horizontalAdvance(digit) for digit in "0123456789"}) == 1


def test_font_sizes_rise(qapp: QApplication) -> None:
    sizes = [theme.font(role).pointSizeF() for role in ("small", "body", "heading", "number", "huge")]
    assert sizes == sorted(set(sizes))
    assert sizes[1] >= 10.0


def ink(image: QImage) -> list[QColor]:
    """Colours of the pixels that are fully covered."""
    pixels = (image.pixelColor(x, y) for x in range(image.width()) for y in range(image.height()))
    return [colour for colour in pixels if colour.alpha() == 255]


@pytest.mark.parametrize("path", ICONS, ids=lambda path: path.stem)
def test_icon_is_drawn_in_the_colour_asked_for(qapp: QApplication, path: Path) -> None:
    image = theme.icon(path.stem, QColor("#12AB34")).pixmap(QSize(24, 24), 2.0).toImage()
    assert image.size() == QSize(48, 48)  # sharp at 200 %
    covered = ink(image)
    assert len(covered) >= 40
    if path.stem not in FIXED_COLOURS:
        parts = [(colour.red() - 0x12, colour.green() - 0xAB, colour.blue() - 0x34) for colour in covered]
        assert max(abs(part) for colour in parts for part in colour) <= 1  # overlapping strokes round once more
        assert "#" not in path.read_text(encoding="utf-8")


def test_an_icon_is_sharp_in_its_size_on_this_screen_and_a_finer_one(qapp: QApplication) -> None:
    own = math.ceil(26 * qapp.primaryScreen().devicePixelRatio())
    assert {size.width() for size in theme.icon("record", side=26).availableSizes()} == {own, 52}


def test_icons_of_the_contract_are_there() -> None:
    wanted = (
        "live calibrate guide target signals settings connect disconnect record origin log view-x view-y view-z "
        "view-home play pause open warning ok board imugui"
    )
    assert set(wanted.split()) <= {path.stem for path in ICONS}


def test_disabled_icon_is_fainter(qapp: QApplication) -> None:
    theme.apply(qapp, "light")
    icon = theme.icon("record")
    faint = ink(icon.pixmap(QSize(48, 48), 1.0, icon.Mode.Disabled).toImage())
    strong = ink(icon.pixmap(QSize(48, 48), 1.0).toImage())
    assert min(luminance(colour) for colour in faint) > max(luminance(colour) for colour in strong)


def test_states_differ_in_shape_and_colour(scheme: str) -> None:
    assert len({theme.tone_glyph(tone) for tone in theme.TONES}) == 4
    assert len({theme.tone_colour(tone).name() for tone in theme.TONES}) == 4


def test_mixing_and_shading() -> None:
    black, white = QColor("black"), QColor("white")
    assert theme.mix(black, white, 0.5).name() == "#808080"
    assert theme.shade(QColor(100, 50, 0), 0.5).getRgb()[:3] == (50, 25, 0)
    assert theme.shade(QColor(100, 50, 0), 2.0) == white
    assert theme.faded(white, 0.5).alpha() == 128


def test_palettes_have_only_valid_colours(scheme: str) -> None:
    values = dataclasses.asdict(theme.palette()).values()
    assert all(isinstance(colour, QColor) and colour.isValid() for colour in values)
