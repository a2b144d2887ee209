"""One foreign table as a guess sees it: its layout, what its names mean, its time column, its triples of axes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from imugui.formats.evidence import Numbers, acc_unit, mag_unit, median_norm, norms, scale, time_base
from imugui.formats.layout import Layout
from imugui.formats.spelling import UNKNOWN, Meaning, read_spelling
from imugui.formats.units import LEVELS, Guessed, judge_time

MOST_KINDS = 4  # kinds of lines that one column may tell apart
FEWEST_LINES = 20
MOST_TEXT = 0.5  # share of cells without a number from which a column holds text
STEADY = 0.3  # spread of a vector's length in its median up to which it can be gravity or the earth's field


@dataclass(frozen=True)
class Triple:
    """Three columns of one sensor."""

    sheet: int
    columns: tuple[int, int, int]
    kind: str  # as in spelling.Meaning
    unit: str  # as written
    lesser: int
    values: Numbers  # shape (n, 3)


@dataclass(frozen=True)
class Sheet:
    """A table's first rows."""

    file: str  # name with its ending, or "" for what comes from a port
    layout: Layout

    @cached_property
    def keep(self) -> tuple[int, float] | None:
        """The column, and its value, that tells the lines to be read from others; None: all are read."""
        values = self.layout.numbers
        first = values[:, 0]
        if self.layout.has_header or len(first) < FEWEST_LINES or not np.isfinite(first).all():
            return None
        kinds, counts = np.unique(first, return_counts=True)
        changes = float((np.diff(first) != 0.0).mean())
        few = 2 <= len(kinds) <= MOST_KINDS and counts.min() > 0.1 * len(first) and changes > 0.2
        whole = bool((first == np.round(first)).all()) and not bool((values[:, 1:] == np.round(values[:, 1:])).all())
        return (0, float(kinds[0])) if few and whole else None

    @cached_property
    def numbers(self) -> Numbers:
        """The rows that are read, shape (n, columns)."""
        if self.keep is None:
            return self.layout.numbers
        return np.asarray(self.layout.numbers[self.layout.numbers[:, self.keep[0]] == self.keep[1]])

    @cached_property
    def meanings(self) -> tuple[Meaning, ...]:
        """What each column seems to be, from its name or, without names, from its numbers."""
        if self.layout.has_header:
            stem = self.file.rpartition(".")[0]
            return tuple(read_spelling(name, stem) for name in self.layout.names)
        return tuple(_meanings_of(self.numbers, first=0 if self.keep is None else 1))

    @cached_property
    def time(self) -> tuple[int, Guessed] | None:
        """The best time column and its unit."""
        found = []
        for column, meaning in enumerate(self.meanings):
            if meaning.kind == "t" and (guessed := judge_time(self.numbers[:, column], meaning.unit)):
                found.append((LEVELS.index(guessed.level), abs(self.numbers[0, column]), column, guessed))
        # of two equally good ones the smaller numbers keep more digits
        best = min(found, key=lambda one: one[:3], default=None)
        return best and (best[2], best[3])

    @property
    def seconds(self) -> Numbers | None:
        """The times of its rows, shape (n,), s."""
        if self.time is None:
            return None
        column, guessed = self.time
        return np.asarray(self.numbers[:, column] * scale("t", guessed.unit))

    def triples(self, number: int) -> list[Triple]:
        """Every complete set of three axes; ``number`` is this table's place among others."""
        groups: dict[tuple[str, str], dict[str, int]] = {}
        for column, meaning in enumerate(self.meanings):
            if meaning.axis:
                groups.setdefault((meaning.kind, meaning.group), {}).setdefault(meaning.axis, column)
        found = []
        for (kind, _), axes in groups.items():
            if len(axes) == 3:
                columns = axes["x"], axes["y"], axes["z"]
                first = self.meanings[columns[0]]
                found.append(Triple(number, columns, kind, first.unit, first.lesser, self.numbers[:, columns]))
        return found


def _meanings_of(numbers: Numbers, first: int) -> list[Meaning]:
    """Columns without names: time where it can be, then triples told apart by their lengths."""
    width = numbers.shape[1]
    meanings = [UNKNOWN] * width
    if np.isnan(numbers).mean(axis=0).max(initial=0.0) > MOST_TEXT:
        return meanings  # sentences of some protocol
    start = first
    if start < width and not time_base(numbers[:, start]).is_counter and judge_time(numbers[:, start], ""):
        meanings[start] = Meaning("t")
        start += 1
    places = range(start, width - 2, 3)
    kinds = _kinds([numbers[:, place : place + 3] for place in places])
    for place, kind in zip(places, kinds, strict=True):
        for offset, axis in enumerate("xyz"):
            meanings[place + offset] = Meaning(kind, axis, group=str(place)) if kind else UNKNOWN
    return meanings


def _kinds(triples: Sequence[Numbers]) -> list[str]:
    """ "a" for a length that is gravity's, "m" for one that is the earth's field's, "g" for the first of the others."""
    kinds = [""] * len(triples)
    _claim(kinds, "a", triples, acc_unit)
    if "a" not in kinds or len(triples) > 2:  # beside an accelerometer alone a gyroscope is likelier
        _claim(kinds, "m", triples, mag_unit)
    if "a" in kinds and "" in kinds:
        kinds[kinds.index("")] = "g"
    return kinds


def _claim(kinds: list[str], kind: str, triples: Sequence[Numbers], unit_of: Callable[[Numbers], str]) -> None:
    """Give a kind to the first free triple whose steady length has a unit."""
    for i, values in enumerate(triples):
        if not kinds[i] and unit_of(values) and _is_steady(values):
            kinds[i] = kind
            return


def _is_steady(values: Numbers) -> bool:
    lengths = norms(values)
    known = lengths[np.isfinite(lengths)]
    return bool(np.std(known) < STEADY * median_norm(values)) if len(known) else False
