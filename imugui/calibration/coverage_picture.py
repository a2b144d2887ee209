"""A small picture of what a calibration has seen, as inline SVG: two halves of the sphere, seen from both ends."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from imugui.calibration.coverage import CELLS, fibonacci
from imugui.calibration.stillness import Floats
from imugui.fusion.correction import Vector

RADIUS, GAP = 70.0, 20.0
SEEN, OPEN, HELD = "#0072b2", "#ffffff", "#d55e00"


def coverage_svg(cells: Iterable[int], positions: Iterable[Vector] = ()) -> str:
    """SVG with a dot for each of the 100 direction cells, filled where the field was, and a square for each position.

    ``positions``: unit vectors that pointed up. Left the side of +z, right that of -z, both with x to the right.
    """
    seen = set(cells)
    dots = [_dot(way, k in seen) for k, way in enumerate(fibonacci(CELLS))] if seen else []
    squares = [_square(np.array(way)) for way in positions]
    width, height = 4 * RADIUS + 3 * GAP, 2 * RADIUS + 2 * GAP
    rings = "".join(
        f'<circle cx="{x:.1f}" cy="{GAP + RADIUS:.1f}" r="{RADIUS + 6:.1f}" fill="none" stroke="#888"/>'
        f'<text x="{x:.1f}" y="12" text-anchor="middle" font-size="11">{name}</text>'
        for x, name in ((_centre(1.0), "+z side"), (_centre(-1.0), "-z side"))
    )
    label = f"{len(seen)} of {CELLS} directions seen, {len(squares)} positions held"
    body = rings + "".join(dots) + "".join(squares)
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.0f} {height:.0f}" width="{width:.0f}" '
        f'role="img" aria-label="{label}"><title>{label}</title>{body}</svg>'
    )


def place(way: Floats) -> tuple[float, float]:
    """Where a unit vector (3,) is drawn: Lambert's projection, equal areas stay equal."""
    x, y, z = way.tolist()
    scale = RADIUS / float(np.sqrt(1.0 + abs(z)))
    return _centre(z) + scale * x, GAP + RADIUS - scale * y


def _centre(z: float) -> float:
    return GAP + RADIUS if z >= 0.0 else 2 * GAP + 3 * RADIUS


def _dot(way: Floats, seen: bool) -> str:
    x, y = place(way)
    return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="4" fill="{SEEN if seen else OPEN}" stroke="#555" stroke-width="0.7"/>'


def _square(way: Floats) -> str:
    x, y = place(way)
    return (
        f'<rect x="{x - 4:.1f}" y="{y - 4:.1f}" width="8" height="8" fill="{HELD}" stroke="#333" stroke-width="0.7"/>'
    )
