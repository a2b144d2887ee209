"""Small target pictures for a report: where the tool was, seen from the plan, as SVG."""

from __future__ import annotations

import math

from imugui.guidance.plan import screen_sign
from imugui.guidance.reading import Reading
from imugui.guidance.report_numbers import COMPONENTS, component_words

SIZE = 168.0
RIM = 62.0
"""Radius of the outer ring in the picture's units."""
SCALES_DEG = (2.5, 5.0, 10.0, 20.0, 45.0, 90.0, 180.0)
"""What the outer ring may stand for."""
GREEN, AMBER, INK, FAINT = "#009e73", "#e69f00", "#111", "#bbb"


def scale_deg(reading: Reading) -> float:
    """The smallest scale that holds the tool and the tolerance, degrees."""
    wanted = max(1.1 * reading.error_deg, 1.2 * reading.plan.tolerance_deg)
    return next((scale for scale in SCALES_DEG if scale >= wanted), SCALES_DEG[-1])


def target_svg(reading: Reading) -> str:
    """The target of one reading: circle for the plan, cross for the tool, its expected error as a dashed ring.

    One looks along the tool, cranial up; rings are true degrees from the plan.
    """
    scale, plan = scale_deg(reading), reading.plan
    rings = [(scale, FAINT, f"{scale:g}°")]
    rings += [
        (deg, colour, "") for deg, colour in ((plan.amber_deg, AMBER), (plan.tolerance_deg, GREEN)) if deg < scale
    ]
    body = "".join(_ring(deg / scale * RIM, colour, text) for deg, colour, text in rings)
    label = f"{component_words(reading)}; outer ring {scale:g}°"
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {SIZE:g} {SIZE:g}" width="{SIZE:g}" height="{SIZE:g}" '
        f'role="img" aria-label="{label}"><title>{label}</title>{body}{_words(reading)}'
        f'<circle cx="{SIZE / 2:g}" cy="{SIZE / 2:g}" r="5" fill="none" stroke="#0072b2" stroke-width="2"/>'
        f"{_cross(reading, RIM / scale)}</svg>"
    )


def place(reading: Reading, per_deg: float) -> tuple[float, float]:
    """Where the cross is, x to the right and y down, for so many units per degree."""
    across = screen_sign(reading.plan.side) * reading.medial_deg
    return SIZE / 2 + per_deg * across, SIZE / 2 - per_deg * reading.cranial_deg


def _ring(radius: float, colour: str, text: str) -> str:
    middle = SIZE / 2
    said = f'<text x="{middle + radius * 0.72:.1f}" y="{middle - radius * 0.78:.1f}" font-size="9">{text}</text>'
    ring = (
        f'<circle cx="{middle:g}" cy="{middle:g}" r="{radius:.1f}" fill="none" stroke="{colour}" stroke-width="1.5"/>'
    )
    return ring + (said if text else "")


def _words(reading: Reading) -> str:
    (right, left), (up, down) = COMPONENTS[reading.plan.kind]
    if screen_sign(reading.plan.side) < 0.0:
        right, left = left, right
    middle, edge = SIZE / 2, 10.0
    spots = (
        (middle, edge, 0, up),
        (middle, SIZE - 4, 0, down),
        (edge, middle, -90, left),
        (SIZE - 4, middle, -90, right),
    )
    return "".join(
        f'<text x="{x:g}" y="{y:g}" font-size="10" fill="#444" text-anchor="middle" '
        f'transform="rotate({turn} {x:g} {y:g})">{word}</text>'
        for x, y, turn, word in spots
    )


def _cross(reading: Reading, per_deg: float) -> str:
    x, y = place(reading, per_deg)
    if not (math.isfinite(x) and math.isfinite(y)):
        return ""
    arms = f"M{x - 6:.1f} {y:.1f}H{x + 6:.1f}M{x:.1f} {y - 6:.1f}V{y + 6:.1f}"
    cross = f'<path d="{arms}" stroke="{INK}" stroke-width="2" fill="none"/>'
    if not math.isfinite(reading.sigma_deg):
        return cross
    radius = per_deg * reading.sigma_deg
    dashed = 'fill="none" stroke="#555" stroke-dasharray="3 2"'
    return f'{cross}<circle cx="{x:.1f}" cy="{y:.1f}" r="{radius:.1f}" {dashed}/>'
