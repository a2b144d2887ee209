"""Where the field of view is: its place and size on the field.

The field is 600 x 600 px with its origin at the centre, x right, y up; painters scale it.
"""

from __future__ import annotations

from typing import NamedTuple

FIELD_PX = 600.0
"""px, the side of the field."""

PAN = "pan"
ZOOM = "zoom"

Pair = tuple[float, float]
"""What one activation steers: (x, y) when panning, (size, 0) when zooming."""

ZERO: Pair = (0.0, 0.0)


class View(NamedTuple):
    """The square that shows the field of view: centre and side, in px."""

    x: float
    y: float
    size: float

    def part(self, mode: str) -> Pair:
        """The numbers that ``mode`` steers, px."""
        return (self.size, 0.0) if mode == ZOOM else (self.x, self.y)

    def moved(self, mode: str, place: Pair) -> View:
        """The view with the numbers that ``mode`` steers replaced, px."""
        return View(self.x, self.y, place[0]) if mode == ZOOM else View(*place, self.size)
