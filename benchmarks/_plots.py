"""Bar charts as SVG text: the same numbers give the same bytes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from xml.sax.saxutils import escape

WIDTH, LABELS, RIGHT = 760, 230, 70  # px
ROW, TOP, BOTTOM = 22, 44, 30
BAR, LINE, TEXT = "#0072b2", "#d55e00", "#333333"


def bars(title: str, quantity: str, values: Sequence[tuple[str, float]], wanted: float | None = None) -> str:
    """Horizontal bars from 0, each with its number; ``wanted`` is drawn as a line across."""
    good = [(label, value) for label, value in values if isinstance(value, (int, float)) and math.isfinite(value)]
    largest = max([value for _, value in good] + [wanted or 0.0, 1e-12])
    scale = (WIDTH - LABELS - RIGHT) / largest
    height = TOP + ROW * len(good) + BOTTOM
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{height}" font-family="sans-serif" '
        f'font-size="12" fill="{TEXT}">',
        f'<rect width="{WIDTH}" height="{height}" fill="white"/>',
        f'<text x="12" y="22" font-size="15">{escape(title)}: {escape(quantity)}</text>',
    ]
    for row, (label, value) in enumerate(good):
        y = TOP + ROW * row
        parts.append(f'<text x="{LABELS - 8}" y="{y + 14}" text-anchor="end">{escape(label)}</text>')
        parts.append(f'<rect x="{LABELS}" y="{y + 3}" width="{value * scale:.1f}" height="{ROW - 7}" fill="{BAR}"/>')
        parts.append(f'<text x="{LABELS + value * scale + 5:.1f}" y="{y + 14}">{value:g}</text>')
    if wanted is not None:
        x, end = LABELS + wanted * scale, TOP + ROW * len(good)
        parts.append(f'<path d="M{x:.1f} {TOP - 4}V{end}" stroke="{LINE}" stroke-width="2" stroke-dasharray="5 3"/>')
        parts.append(f'<text x="{x:.1f}" y="{end + 16}" text-anchor="middle" fill="{LINE}">wanted: {wanted:g}</text>')
    return "\n".join([*parts, "</svg>"]) + "\n"
