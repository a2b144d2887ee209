"""From histories to a Frame: the curves over time, their scales, ticks, cursors."""

from __future__ import annotations

import math
from collections import defaultdict

import numpy as np

from imugui.signals.channels import CHANNELS, HALF_CIRCLE, QUANTITIES, Channel, Unit, fold
from imugui.signals.choice import Choice
from imugui.signals.columns import Grid
from imugui.signals.cursors import NAMES, Cursors
from imugui.signals.feed import Feed
from imugui.signals.history import History
from imugui.signals.scale import Range, tick_words, ticks
from imugui.signals.scope import Scope
from imugui.signals.strokes import Strokes, make_strokes
from imugui.signals.viewport import edge_after
from imugui.views.signal_frame import CursorLine, Curve, Frame, Mark, Plot, Ticks
from imugui.views.signal_words import NO_CHANNEL, NO_PLOT, NO_ROWS, NOT_SENT, NOTHING_HERE

LABEL_ROOM = 96  # pixels between two numbers along x
LABEL_HEIGHT = 20  # pixels between two numbers along y
MOST_LABELS = 6

Shown = dict[str, tuple[Channel, ...]]


def time_frame(scope: Scope, columns: int, size: tuple[float, float]) -> Frame:
    """The picture of the window on ``columns`` columns; ``size`` is a plot's width and height in pixels."""
    feed, choice, cursors = scope.feed, scope.choice, scope.cursors
    grid = scope.viewport.grid(scope.last_t, columns)
    shown = choice.shown()
    strokes = all_strokes(feed, choice, grid, shown)
    plots = []
    for key, channels in shown.items():
        unit = choice.unit(QUANTITIES[key])
        curves = tuple(Curve(one.label, one.tone, strokes[one.key].scaled(unit.scale)) for one in channels)
        limits = choice.range_of(key, *extremes(curves))
        note = "" if any(len(curve.strokes.marks) for curve in curves) else why_empty(key, channels, choice, feed)
        plots.append(Plot(key, choice.title(key), unit.name, limits, y_ticks(limits, size[1], unit), curves, note))
    return Frame(
        columns,
        tuple(plots),
        time_ticks(grid, scope.last_t, size[0]),
        cursor_lines(cursors, grid),
        cursor_marks(feed, choice, cursors, grid, shown),
        "" if plots else NO_PLOT,
        masked_bands(feed.corrected, grid),
    )


def masked_bands(history: History, grid: Grid) -> tuple[tuple[float, float], ...]:
    """From column to column, where the spike mask left the accelerometer out; each reaches to the next sample."""
    inside = history.span(grid.start, grid.end)
    rows = slice(max(inside.start - 1, 0), inside.stop + 1)
    masked = history.values("button.masked")[rows] == 1.0
    if not masked.any():
        return ()
    columns = (history.t[rows] - grid.start) / grid.step
    edges = np.flatnonzero(np.diff(masked, prepend=False, append=False))
    last = len(columns) - 1
    return tuple(
        (float(columns[start]), float(columns[min(end, last)])) for start, end in edges.reshape(-1, 2).tolist()
    )


def all_strokes(feed: Feed, choice: Choice, grid: Grid, shown: Shown) -> dict[str, Strokes]:
    """Strokes of every channel shown, SI; those of one history are made together."""
    wanted: dict[int, list[tuple[str, float]]] = defaultdict(list)
    histories: dict[int, History] = {}
    for key, channels in shown.items():
        history = choice.history(QUANTITIES[key], feed)
        histories[id(history)] = history
        wanted[id(history)] += [(one.key, one.period) for one in channels]
    made: dict[str, Strokes] = {}
    for number, channels_of in wanted.items():
        made |= make_strokes(histories[number], grid, channels_of)
    return made


def extremes(curves: tuple[Curve, ...]) -> Range:
    """Least and greatest value of all curves; NaN when there is none."""
    ends = [curve.strokes.extremes() for curve in curves if len(curve.strokes.marks)]
    if not ends:
        return math.nan, math.nan
    return min(low for low, _ in ends), max(high for _, high in ends)


def is_sent(history: History, channels: tuple[Channel, ...]) -> bool:
    """False when the board sends rows but never these channels."""
    if len(history) == 0:
        return True
    return any(bool(np.isfinite(history.values(one.key)).any()) for one in channels)


def why_empty(key: str, channels: tuple[Channel, ...], choice: Choice, feed: Feed) -> str:
    """Why a plot shows nothing."""
    history = choice.history(QUANTITIES[key], feed)
    if len(history) == 0:
        return NO_ROWS
    if not is_sent(history, QUANTITIES[key].channels):
        return NOT_SENT.capitalize()
    return NOTHING_HERE if channels else NO_CHANNEL


def y_ticks(limits: Range, height: float, unit: Unit) -> Ticks:
    """Ticks of a scale in the unit shown."""
    values, step = ticks(
        *limits, min(max(1, int(height / LABEL_HEIGHT)), MOST_LABELS), angles=unit.limit == HALF_CIRCLE
    )
    return Ticks(values, tuple(tick_words(value, step) for value in values.tolist()))


def time_ticks(grid: Grid, last_t: float, width: float) -> Ticks:
    """Ticks in columns, their words in seconds from the newest sample."""
    if math.isnan(last_t):
        return Ticks(np.empty(0), ())
    zero = edge_after(last_t, grid.step)
    values, step = ticks(grid.start - zero, grid.end - zero, max(1, int(width / LABEL_ROOM)))
    words = tuple(f"{tick_words(value, step)} s" for value in values.tolist())
    return Ticks((values + zero - grid.start) / grid.step, words)


def cursor_lines(cursors: Cursors, grid: Grid) -> tuple[CursorLine, ...]:
    """The cursors on the columns."""
    if not cursors.shown:
        return ()
    places = enumerate(zip(NAMES, cursors.times, strict=True))
    return tuple(CursorLine(name, (t - grid.start) / grid.step, i == cursors.active) for i, (name, t) in places)


def cursor_marks(feed: Feed, choice: Choice, cursors: Cursors, grid: Grid, shown: Shown) -> tuple[Mark, ...]:
    """Where cursors and curves meet."""
    if not cursors.shown:
        return ()
    marks = []
    for number, (key, channels) in enumerate(shown.items()):
        history, scale = choice.history(QUANTITIES[key], feed), choice.unit(QUANTITIES[key]).scale
        for channel in channels:
            for t in cursors.times:
                value = fold(history.at(channel.key, t), CHANNELS[channel.key].period) * scale
                if math.isfinite(value):
                    marks.append(Mark(number, (t - grid.start) / grid.step, value, channel.tone))
    return tuple(marks)
