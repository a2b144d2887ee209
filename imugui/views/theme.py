"""The only place with colours, pens and fonts. Widgets ask here at paint time and follow the scheme by themselves.

Axis colours are Okabe-Ito (Color Universal Design, 2008), brighter in the dark only where contrast asks for it.
"""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass

from PySide6.QtCore import QByteArray, QRectF, Qt
from PySide6.QtGui import (
    QColor,
    QFont,
    QFontDatabase,
    QGuiApplication,
    QIcon,
    QImage,
    QPainter,
    QPalette,
    QPen,
    QPixmap,
)
from PySide6.QtSvg import QSvgRenderer
from PySide6.QtWidgets import QApplication

from imugui import paths
from imugui.views import stylesheet

SCHEMES = ("system", "light", "dark")
AXES = ("x", "y", "z")
_SCHEME_PROPERTY = "imugui_scheme"


@dataclass(frozen=True)
class Palette:
    """Every colour of one scheme, by use."""

    window: QColor  # behind everything
    panel: QColor  # cards, fields, lists
    raised: QColor  # buttons, hovered rows
    text: QColor
    muted: QColor  # labels, units, notes
    line: QColor  # separators and borders
    accent: QColor  # the one accent: selection, focus, the primary button
    on_accent: QColor  # text on the accent
    good: QColor
    warn: QColor
    bad: QColor
    axis_x: QColor
    axis_y: QColor
    axis_z: QColor
    plate_x: QColor  # the same three on the drawn board, which looks the same by day and night
    plate_y: QColor
    plate_z: QColor
    scene_top: QColor  # 3D background, upper and lower edge
    scene_bottom: QColor
    grid: QColor  # earth grid and compass rose
    shadow: QColor  # see-through black
    housing: QColor  # body of the drawn board
    print: QColor  # lettering on the board's coloured plates
    chip: QColor
    gold: QColor  # the board's contacts
    ghost: QColor  # target attitude


def _colours(**names: str) -> Palette:
    return Palette(**{name: QColor(value) for name, value in names.items()})


@functools.cache
def _palette_of(dark: bool) -> Palette:
    x, y, z = "#D55E00", "#009E73", "#0072B2"
    common = {
        "axis_x": x, "axis_y": y, "axis_z": z, "plate_x": x, "plate_y": y, "plate_z": z,
        "print": "#FFFFFF", "gold": "#E6BC66", "chip": "#1C2228",
    }  # fmt: skip
    light = common | {
        "window": "#F3F5F7", "panel": "#FFFFFF", "raised": "#EAEEF2", "text": "#171D24", "muted": "#56626E",
        "line": "#D3DAE1", "accent": "#4350C4", "on_accent": "#FFFFFF", "good": "#17744A", "warn": "#865800",
        "bad": "#B82C2C", "scene_top": "#FFFFFF", "scene_bottom": "#EEF1F5", "grid": "#7C8A98", "shadow": "#3A000000",
        "housing": "#DCE2E8", "ghost": "#A63A86",
    }  # fmt: skip
    night = common | {
        "axis_z": "#3A96D4", "window": "#13171C", "panel": "#1A1F26", "raised": "#272E37", "text": "#E8EDF2",
        "muted": "#9AA6B2", "line": "#323B45", "accent": "#96A2FF", "on_accent": "#10141B", "good": "#52CB8D",
        "warn": "#E8B755", "bad": "#FF8A80", "scene_top": "#1B2128", "scene_bottom": "#12161B", "grid": "#7F8D9B",
        "shadow": "#80000000", "housing": "#C3CBD4", "ghost": "#EC9BD3",
    }  # fmt: skip
    return _colours(**(night if dark else light))


def is_dark() -> bool:
    """True when the scheme on screen is dark."""
    return QGuiApplication.palette().color(QPalette.ColorRole.Window).lightness() < 128


def palette() -> Palette:
    """The colours of the scheme on screen."""
    return _palette_of(is_dark())


def apply(app: QApplication, scheme: str) -> None:
    """Give the whole program one look; scheme "system" keeps following the desktop. Raises ValueError on others."""
    if scheme not in SCHEMES:
        raise ValueError(f"scheme is one of {', '.join(SCHEMES)}, not {scheme!r}")
    followed = app.property(_SCHEME_PROPERTY) is not None
    app.setProperty(_SCHEME_PROPERTY, scheme)
    hints = app.styleHints()
    wanted = {"light": Qt.ColorScheme.Light, "dark": Qt.ColorScheme.Dark}.get(scheme)
    if wanted is None:
        hints.unsetColorScheme()
    else:
        hints.setColorScheme(wanted)
    if not followed:
        app.setStyle("Fusion")
        app.setFont(font("body"))
        hints.colorSchemeChanged.connect(lambda desktop: _follow(app, desktop))
    _dress(app, dark=(wanted or hints.colorScheme()) == Qt.ColorScheme.Dark)


def _follow(app: QApplication, desktop: Qt.ColorScheme) -> None:
    """The desktop changed between light and dark."""
    if app.property(_SCHEME_PROPERTY) == "system":
        _dress(app, dark=desktop == Qt.ColorScheme.Dark)


def _dress(app: QApplication, dark: bool) -> None:
    colours = _palette_of(dark)
    app.setPalette(_qt_palette(colours))
    app.setStyleSheet(stylesheet.render(colours, paths.resources() / "icons"))


def _qt_palette(colours: Palette) -> QPalette:
    role = QPalette.ColorRole
    table = {
        role.Window: colours.window, role.WindowText: colours.text, role.Base: colours.panel,
        role.AlternateBase: colours.window, role.Text: colours.text, role.Button: colours.raised,
        role.ButtonText: colours.text, role.BrightText: colours.bad, role.ToolTipBase: colours.panel,
        role.ToolTipText: colours.text, role.PlaceholderText: colours.muted, role.Highlight: colours.accent,
        role.HighlightedText: colours.on_accent, role.Accent: colours.accent, role.Link: colours.accent,
        role.LinkVisited: colours.accent, role.Mid: colours.line, role.Midlight: colours.raised,
        role.Light: colours.panel, role.Dark: colours.line, role.Shadow: colours.shadow,
    }  # fmt: skip
    result = QPalette()
    for name, colour in table.items():
        result.setColor(name, colour)
    faint = mix(colours.muted, colours.window, 0.4)
    for name in (role.WindowText, role.Text, role.ButtonText):
        result.setColor(QPalette.ColorGroup.Disabled, name, faint)
    return result


_FONTS: dict[str, tuple[float, QFont.Weight]] = {
    "small": (0.88, QFont.Weight.Normal),
    "body": (1.0, QFont.Weight.Normal),
    "heading": (1.2, QFont.Weight.DemiBold),
    "number": (1.6, QFont.Weight.Medium),
    "huge": (2.8, QFont.Weight.Medium),
}
_SMALLEST_BODY_PT = 10.0  # bare X11 answers 9 pt, too small for reading numbers at arm's length


def font(role: str) -> QFont:
    """The system's interface font in the size of a role; digits all of one width where the font can do it."""
    scale, weight = _FONTS[role]
    result = QFontDatabase.systemFont(QFontDatabase.SystemFont.GeneralFont)
    result.setPointSizeF(max(result.pointSizeF(), _SMALLEST_BODY_PT) * scale)
    result.setWeight(weight)
    result.setFeature(QFont.Tag("tnum"), 1)
    return result


_FINEST = 2.0  # a screen of 200 % may be plugged in later; any other shows a smaller picture of this one


def icon(name: str, colour: QColor | None = None, side: int = 24) -> QIcon:
    """resources/icons/NAME.svg in one colour (the text colour when none is given).

    It is sharp where it is shown ``side`` logical pixels wide, on every screen that is there now.
    """
    plain = colour or palette().text
    ratios = {_FINEST, *(screen.devicePixelRatio() for screen in QGuiApplication.screens())}
    sizes = tuple(sorted({math.ceil(side * ratio) for ratio in ratios}))
    result = QIcon()
    for mode, shown in ((QIcon.Mode.Normal, plain), (QIcon.Mode.Disabled, mix(plain, palette().window, 0.6))):
        for image in _drawn(name, shown.name(), sizes):
            result.addPixmap(QPixmap.fromImage(image), mode)
    return result


@functools.cache  # a window has two hundred icons, most of them alike, and drawing all sizes takes milliseconds
def _drawn(name: str, colour: str, sizes: tuple[int, ...]) -> tuple[QImage, ...]:
    text = (paths.resources() / "icons" / f"{name}.svg").read_text(encoding="utf-8")
    renderer = QSvgRenderer(QByteArray(text.replace("currentColor", colour).encode()))
    images = []
    for size in sizes:
        image = QImage(size, size, QImage.Format.Format_ARGB32_Premultiplied)
        image.fill(Qt.GlobalColor.transparent)
        painter = QPainter(image)
        renderer.render(painter, QRectF(0, 0, size, size))
        painter.end()
        images.append(image)
    return tuple(images)


def mix(a: QColor, b: QColor, share: float) -> QColor:
    """Colour between a (share 0) and b (share 1), opaque."""
    keep = 1.0 - share
    return QColor(
        round(a.red() * keep + b.red() * share),
        round(a.green() * keep + b.green() * share),
        round(a.blue() * keep + b.blue() * share),
    )


def shade(colour: QColor, light: float) -> QColor:
    """Colour under light 0 (none) to 1 (its own) to 2 (white)."""
    goal = Qt.GlobalColor.black if light < 1 else Qt.GlobalColor.white
    return mix(colour, QColor(goal), abs(1 - light))


def faded(colour: QColor, alpha: float) -> QColor:
    """The same colour, see-through: alpha 0 to 1."""
    result = QColor(colour)
    result.setAlphaF(alpha)
    return result


def axis_colour(i: int) -> QColor:
    """Colour of axis 0 (x), 1 (y) or 2 (z)."""
    return (palette().axis_x, palette().axis_y, palette().axis_z)[i]


def pen(colour: QColor, width: float = 1.0) -> QPen:
    """A round solid pen; its width in logical pixels grows with the screen's scale."""
    return QPen(colour, width, Qt.PenStyle.SolidLine, Qt.PenCapStyle.RoundCap, Qt.PenJoinStyle.RoundJoin)


TONES = {"neutral": "●", "good": "✓", "warn": "▲", "bad": "✕"}


def tone_colour(tone: str) -> QColor:
    """Colour of a state: "neutral", "good", "warn" or "bad"."""
    colours = palette()
    return {"neutral": colours.muted, "good": colours.good, "warn": colours.warn, "bad": colours.bad}[tone]


def tone_glyph(tone: str) -> str:
    """Shape of a state, so that it reads without colour: circle, tick, triangle, cross."""
    return TONES[tone]
