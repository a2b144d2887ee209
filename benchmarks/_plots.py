"""Charts as SVG text: the same numbers give the same bytes."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from xml.sax.saxutils import escape

WIDTH, LABELS, RIGHT = 760, 230, 70  # px
ROW, TOP, BOTTOM = 22, 44, 30
HEIGHT, LEFT = 240, 60  # of a chart with curves
BAR, LIMIT, TEXT, GRID = "#0072b2", "#d55e00", "#333333", "#dddddd"
CURVES = (BAR, "#009e73", "#cc79a7")

Bar = tuple[str, float, float | None]
"""Label, value, and the value that is wanted, if any."""


def bars(title: str, values: Sequence[Bar]) -> str:
    """Horizontal bars from 0, each with its number; what is wanted of a bar is drawn across it."""
    good = [bar for bar in values if isinstance(bar[1], (int, float)) and math.isfinite(bar[1])]
    limits = [wanted for _, _, wanted in good if wanted is not None]
    scale = (WIDTH - LABELS - RIGHT) / max([value for _, value, _ in good] + limits + [1e-12])
    parts = []
    for row, (label, value, wanted) in enumerate(good):
        y = TOP + ROW * row
        parts.append(_text(LABELS - 8, y + 14, label, "end"))
        parts.append(f'<rect x="{LABELS}" y="{y + 3}" width="{value * scale:.1f}" height="{ROW - 7}" fill="{BAR}"/>')
        beyond = value if wanted is None else max(value, wanted if wanted < 1.25 * value else value)
        parts.append(_text(LABELS + beyond * scale + 5, y + 14, f"{value:g}"))
        if wanted is not None:
            x = LABELS + wanted * scale
            parts.append(f'<path d="M{x:.1f} {y}V{y + ROW}" stroke="{LIMIT}" stroke-width="2"/>')
    end = TOP + ROW * len(good)
    if limits:
        parts.append(_text(LABELS, end + 18, "across a bar: what is wanted", colour=LIMIT))
    return _svg(title, end + BOTTOM, parts)


def curves(title: str, series: Mapping[str, Sequence[float]]) -> str:
    """Curves over the course of a run, all from its begin to its end, from 0 up."""
    top, bottom, right = TOP, HEIGHT - BOTTOM, WIDTH - RIGHT
    highest = max((value for values in series.values() for value in values), default=1.0) * 1.1
    parts = [_text(LEFT, bottom + 18, "begin"), _text(right, bottom + 18, "end", "end")]
    for step in range(5):
        y = bottom - (bottom - top) * step / 4
        parts.append(f'<path d="M{LEFT} {y:.1f}H{right}" stroke="{GRID}"/>')
        parts.append(_text(LEFT - 8, y + 4, f"{highest * step / 4:.0f}", "end"))
    for number, (label, values) in enumerate(series.items()):
        colour = CURVES[number % len(CURVES)]
        xs = [LEFT + (right - LEFT) * place / max(1, len(values) - 1) for place in range(len(values))]
        ys = [bottom - (bottom - top) * value / highest for value in values]
        points = " ".join(f"{x:.1f},{y:.1f}" for x, y in zip(xs, ys, strict=True))
        parts.append(f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="2"/>')
        parts.append(_text(LEFT + 90 + 130 * number, bottom + 18, label, colour=colour))
    return _svg(title, HEIGHT, parts)


def _text(x: float, y: float, words: str, anchor: str = "start", colour: str = TEXT) -> str:
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" fill="{colour}">{escape(words)}</text>'


def _svg(title: str, height: int, parts: Sequence[str]) -> str:
    head = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{height}" font-family="sans-serif" '
        'font-size="12">',
        f'<rect width="{WIDTH}" height="{height}" fill="white"/>',
        f'<text x="12" y="22" font-size="15" fill="{TEXT}">{escape(title)}</text>',
    ]
    return "\n".join([*head, *parts, "</svg>"]) + "\n"
