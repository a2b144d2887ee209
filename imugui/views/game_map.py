"""Where the game's field lies in a widget: the field is 600 px wide whatever the screen, x right, y up."""

from __future__ import annotations

import functools
from dataclasses import dataclass

from PySide6.QtCore import QPointF, QRectF
from PySide6.QtGui import QPainterPath

from imugui.targeting.view_pose import FIELD_PX, View

TOP, BOTTOM = 46.0, 72.0
"""Heights of the bands for words above and below the picture, px of the widget."""
EDGE = 8.0
ROUND = 0.735
"""Radius of the endoscope's round picture as a part of the field's side: the corners of the field lie inside."""
CORNER = 12.0
SPOT_PX = 130.0
"""Diameter of the spot that a view without a size lights up."""


@dataclass(frozen=True)
class FieldMap:
    """From the field to a widget of this size, px."""

    width: float
    height: float

    @property
    def room(self) -> QRectF:
        """What the picture may take: all but the bands."""
        width, height = self.width - 2.0 * EDGE, self.height - TOP - BOTTOM
        return QRectF(EDGE, TOP, max(width, 1.0), max(height, 1.0))

    @property
    def scale(self) -> float:
        """Pixels of the widget for one of the field."""
        return min(self.room.width(), self.room.height()) / FIELD_PX

    @property
    def centre(self) -> QPointF:
        """The middle of the field."""
        return self.room.center()

    @property
    def field(self) -> QRectF:
        """The whole field."""
        return self.square(0.0, 0.0, FIELD_PX)

    def at(self, x: float, y: float) -> QPointF:
        """A place of the field."""
        return self.centre + QPointF(x, -y) * self.scale

    def square(self, x: float, y: float, side: float) -> QRectF:
        """A square of the field about a place."""
        half = 0.5 * side * self.scale
        middle = self.at(x, y)
        return QRectF(middle.x() - half, middle.y() - half, 2.0 * half, 2.0 * half)

    def lit(self, view: View, sized: bool) -> QPainterPath:
        """What the view lights up: its square; a round spot where it has no size."""
        path = QPainterPath()
        if sized:
            path.addRect(self.square(*view))
        else:
            path.addEllipse(self.square(view.x, view.y, SPOT_PX))
        return path


@functools.lru_cache(maxsize=8)
def picture(place: FieldMap, plain: bool) -> QPainterPath:
    """The outline of the picture: the field itself when plain, else round and cut off where room ends."""
    path = QPainterPath()
    if plain:
        path.addRoundedRect(place.field, CORNER, CORNER)
        return path
    radius = ROUND * FIELD_PX * place.scale
    path.addEllipse(place.centre, radius, radius)
    frame = QPainterPath()
    frame.addRoundedRect(place.room, CORNER, CORNER)
    return path.intersected(frame)
