"""The pictures of a study's report as inline SVG: ratios with their limits, people as dots, learning over blocks.

A condition is told by shape, word and colour (Okabe-Ito), never by colour alone.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from imugui.signals.scale import tick_words, ticks
from imugui.targeting.measures import MEASURES
from imugui.targeting.results import Comparison, Learning, group_mean
from imugui.targeting.svg_parts import COLOURS, FAINT, INK, Point, curve, line, marker, short, svg, text

Scale = Callable[[float], float]
RATIOS = (0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1.0, 1.5, 2.0, 3.0, 5.0, 10.0, 20.0, 50.0, 100.0)
FOOT, HEAD, GUTTER = 40.0, 28.0, 60.0


def ratios_svg(comparisons: Sequence[Comparison]) -> str:
    """A line for each ratio with its 95 % limits, on a logarithmic axis; empty without any.

    Of one pair of conditions all measures, of several pairs the first measure only.
    """
    shown = [one for one in comparisons if one.geometric and math.isfinite(one.ratio.low)]
    several = len({(one.a, one.b) for one in shown}) > 1
    if several:
        shown = [one for one in shown if one.measure == shown[0].measure]
    if not shown:
        return ""
    ends = [end for one in shown for end in (one.ratio.low, one.ratio.high)]
    low, high = math.log(min([0.65, *ends])), math.log(max([1.6, *ends]))
    height, left, right = 26 * len(shown) + 44, 300.0, 580.0

    def across(value: float) -> float:
        return left + (math.log(value) - low) / (high - low) * (right - left)

    parts = []
    for value in (value for value in RATIOS if low - 1e-9 <= math.log(value) <= high + 1e-9):
        parts.append(line((across(value), 8), (across(value), height - 32), INK if value == 1.0 else "#ddd"))
        parts.append(text((across(value), height - 16), f"{value:g}", "middle"))
    for row, one in enumerate(shown):
        y, found = 22.0 + 26 * row, one.ratio
        title = f"{short(one.b, 20)} / {short(one.a, 20)}" if several else MEASURES[one.measure].title
        parts.append(text((left - 10, y + 4), title, "end"))
        parts.append(line((across(found.low), y), (across(found.high), y), INK, 2))
        parts.append(marker(0, (across(found.ratio), y), title))
        parts.append(text((right + 12, y + 4), f"{found.ratio:.2f} ({found.low:.2f} to {found.high:.2f})"))
    return svg(740, height, parts, "Ratios of geometric means with 95 % limits")


def paired_svg(comparison: Comparison, kinds: tuple[int, int] = (0, 1)) -> str:
    """A line for each person from one condition to the other, and a bar at the mean of each; empty without people.

    ``kinds``: places of the two conditions in the study, which choose their marks.
    """
    one, what = comparison, MEASURES[comparison.measure]
    if not one.people:
        return ""
    width, height = 320.0, 260.0
    up, parts = _y_axis([*one.values_a, *one.values_b], width, height, _with_unit(what.title, what.unit))
    places = (120.0, 250.0)
    for person, values in zip(one.people, zip(one.values_a, one.values_b, strict=True), strict=True):
        start, end = ((x, up(value)) for x, value in zip(places, values, strict=True))
        words = f"{person}: {values[0]:.{what.digits}f} and {values[1]:.{what.digits}f} {what.unit}"
        parts += [line(start, end, FAINT), marker(kinds[0], start, words), marker(kinds[1], end, words)]
    for x, name, column in zip(places, (one.a, one.b), (one.values_a, one.values_b), strict=True):
        y = up(group_mean(column, one.geometric))
        parts.append(line((x - 22, y), (x + 22, y), INK, 3))
        parts.append(text((x, height - 10), short(name, 18), "middle"))
    return svg(width, height, parts, f"{what.title}, person by person")


def learning_svg(learned: Sequence[Learning], title: str, unit: str) -> str:
    """Means over the blocks with a thin line for each person, and the fitted curve dashed; empty without blocks."""
    shown = [(k, one) for k, one in enumerate(learned) if one.means]
    if not shown:
        return ""
    width, height = 520.0, 260.0
    count = max(len(one.means) for _, one in shown)
    values = [value for _, one in shown for row in (*one.values, one.means) for value in row]
    up, parts = _y_axis(values, width - 150, height, _with_unit(title, unit))

    def across(block: float) -> float:
        return 80.0 + (block - 1.0) / max(1, count - 1) * (width - 260.0)

    for block in range(1, count + 1):
        parts.append(text((across(block), height - 22), str(block), "middle"))
    parts.append(text((0.5 * (across(1) + across(count)), height - 6), "block", "middle"))
    for k, one in shown:
        colour = COLOURS[k % len(COLOURS)]
        parts += [curve(_points(row, across, up), colour, 'stroke-width="1" opacity="0.35"') for row in one.values]
        fit = [one.curve.first * b**-one.curve.exponent for b in range(1, len(one.means) + 1)]
        if math.isfinite(sum(fit)):
            parts.append(curve(_points(fit, across, up), colour, 'stroke-width="1.5" stroke-dasharray="5 4"'))
        points = _points(one.means, across, up)
        parts.append(curve(points, colour, 'stroke-width="2.5"'))
        parts += [marker(k, point, f"{one.condition}") for point in points]
        parts.append(marker(k, (width - 150, 30.0 + 22 * k), one.condition))
        parts.append(text((width - 138, 34.0 + 22 * k), short(one.condition, 20)))
    return svg(width, height, parts, f"{title} over the blocks")


def _with_unit(title: str, unit: str) -> str:
    return f"{title}, {unit}" if unit else title


def _points(values: Sequence[float], across: Scale, up: Scale) -> list[Point]:
    return [(across(k), up(value)) for k, value in enumerate(values, 1)]


def _y_axis(values: Sequence[float], width: float, height: float, title: str) -> tuple[Scale, list[str]]:
    """The scale from a value to its height in the picture, from 0, and the lines and words of the axis."""
    most = max([0.0, *values]) or 1.0
    least = min([0.0, *values])
    marks, step = ticks(least, most * 1.02, 5)

    def up(value: float) -> float:
        return height - FOOT - (value - least) / (1.02 * most - least) * (height - FOOT - HEAD)

    parts = [text((8.0, 16.0), title)]
    for mark in marks.tolist():
        parts.append(line((GUTTER, up(mark)), (width - 10.0, up(mark)), "#ddd"))
        parts.append(text((GUTTER - 6.0, up(mark) + 4.0), tick_words(mark, step), "end"))
    return up, parts
