"""The few pieces of SVG that a report's pictures are made of; every text is escaped."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape

COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9")
"""Okabe-Ito, by place of the condition."""
INK, FAINT = "#222", "#bbb"
LONGEST = 30  # letters of a name in a picture
Point = tuple[float, float]


def svg(width: float, height: float, parts: Iterable[str], label: str) -> str:
    """A whole picture, sizes in px; ``label`` is read out and shown as a tip."""
    name = escape(label)
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.0f} {height:.0f}" width="{width:.0f}" '
        f'font-family="system-ui, sans-serif" font-size="12" role="img" aria-label="{name}"><title>{name}</title>'
        f"{''.join(parts)}</svg>"
    )


def text(at: Point, words: str, anchor: str = "start") -> str:
    """Words at a place; ``anchor`` is "start", "middle" or "end"."""
    return f'<text x="{at[0]:.1f}" y="{at[1]:.1f}" text-anchor="{anchor}" fill="{INK}">{escape(words)}</text>'


def line(start: Point, end: Point, colour: str, width: float = 1.0) -> str:
    """A straight line."""
    return (
        f'<line x1="{start[0]:.1f}" y1="{start[1]:.1f}" x2="{end[0]:.1f}" y2="{end[1]:.1f}" '
        f'stroke="{colour}" stroke-width="{width:g}"/>'
    )


def curve(points: Sequence[Point], colour: str, style: str) -> str:
    """A line through points; ``style`` holds further attributes."""
    places = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
    return f'<polyline points="{places}" fill="none" stroke="{colour}" {style}/>'


def marker(kind: int, at: Point, words: str) -> str:
    """The mark of the condition at place ``kind``: its own shape and colour, with words as a tip."""
    x, y = at
    tag, place = (
        ("circle", f'cx="{x:.1f}" cy="{y:.1f}" r="5"'),
        ("rect", f'x="{x - 4.5:.1f}" y="{y - 4.5:.1f}" width="9" height="9"'),
        ("path", f'd="M{x:.1f} {y - 6:.1f} l6 10.5 h-12 z"'),
        ("path", f'd="M{x:.1f} {y - 6:.1f} l6 6 l-6 6 l-6 -6 z"'),
    )[kind % 4]
    colour = COLOURS[kind % len(COLOURS)]
    return f'<{tag} {place} fill="{colour}" stroke="#fff"><title>{escape(words)}</title></{tag}>'


def short(words: str, most: int = LONGEST) -> str:
    """A name that fits into a picture."""
    return words if len(words) <= most else words[: most - 1] + "…"
