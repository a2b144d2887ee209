"""Colours of what is drawn into the game's picture; the endoscope's is as dark by day as by night."""

from __future__ import annotations

from dataclasses import dataclass

from PySide6.QtGui import QColor

from imugui.views import theme


@dataclass(frozen=True)
class Colours:
    """By use."""

    target: QColor
    view: QColor
    good: QColor
    on_tag: QColor  # letters on the tags of target and view
    casing: QColor  # around lines, so that they stand out from any ground
    guide: QColor  # the way from view to target, circles that wait


_ENDOSCOPE = Colours(
    target=QColor("#FF4B42"),
    view=QColor("#63CDFF"),
    good=QColor("#63E6A0"),
    on_tag=QColor("#12060A"),
    casing=QColor("#C0160609"),
    guide=QColor("#E6FFFFFF"),
)


def colours(plain: bool) -> Colours:
    """For the plain picture those of the theme, else those of the endoscope."""
    if not plain:
        return _ENDOSCOPE
    now = theme.palette()
    casing = theme.faded(now.panel, 0.75)
    return Colours(now.bad, now.axis_z, now.good, now.panel, casing, theme.faded(now.muted, 0.9))
