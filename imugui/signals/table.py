"""The data on screen as a CSV table: one line a sample, names with units, what is missing left empty."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from imugui.signals.channels import QUANTITIES, Channel, Unit
from imugui.signals.choice import Choice
from imugui.signals.feed import Feed
from imugui.signals.history import History

Floats = NDArray[np.float64]

LINES = 4000  # made at once


@dataclass(frozen=True)
class Table:
    """``columns`` are (name, values (n,)); the first is the time."""

    columns: tuple[tuple[str, Floats], ...]

    def __len__(self) -> int:
        return len(self.columns[0][1])


def make_table(feed: Feed, choice: Choice, start: float, end: float) -> Table:
    """The channels shown from start to end (s), in the units shown; raw and corrected rows meet by their times."""
    shown = [(QUANTITIES[key], channel) for key, channels in choice.shown().items() for channel in channels]
    parts = [(choice.history(quantity, feed), channel, choice.unit(quantity)) for quantity, channel in shown]
    times = [_times(history, start, end) for history in {id(part[0]): part[0] for part in parts}.values()]
    t = np.unique(np.concatenate(times)) if times else np.empty(0)
    columns = [(column_name(channel, unit), _values(history, channel, unit, t)) for history, channel, unit in parts]
    return Table((("t_s", t), *columns))


def column_name(channel: Channel, unit: Unit) -> str:
    """Quantity, channel and unit, as imugui's own import reads them: "acc_x_m/s2"."""
    return "_".join(part for part in (*channel.key.split("."), unit.ascii) if part)


def csv_pieces(table: Table, header: Mapping[str, str]) -> Iterator[str]:
    """The text of the file in pieces: ``# key: value`` lines, the names, the rows."""
    yield "".join(f"# {key}: {value}\n" for key, value in header.items())
    yield ",".join(name for name, _ in table.columns) + "\n"
    for start in range(0, len(table), LINES):
        columns = [_texts(values[start : start + LINES], i) for i, (_, values) in enumerate(table.columns)]
        yield "\n".join(map(",".join, zip(*columns, strict=True))) + "\n"


def _texts(values: Floats, column: int) -> Sequence[str]:
    """Numbers as text: times to the microsecond, values with nine digits, nothing for NaN."""
    form = "%.6f" if column == 0 else "%.9g"
    return ["" if value != value else form % value for value in values.tolist()]


def _times(history: History, start: float, end: float) -> Floats:
    return history.t[history.span(start, end)]


def _values(history: History, channel: Channel, unit: Unit, t: Floats) -> Floats:
    """A channel at the times t (n,), NaN where it has no row."""
    values = np.full(len(t), np.nan)
    own = history.t
    places = np.searchsorted(own, t)
    there = places < len(own)
    there[there] = own[places[there]] == t[there]
    found = history.values(channel.key)[places[there]]
    if channel.period:
        found = found - channel.period * np.floor(found / channel.period + 0.5)
    values[there] = found * unit.scale
    return values
