"""One target of the game as a row, and its table as CSV: exact digits out, and back in whatever is readable.

The field is 600 x 600 px with its origin at the centre, x right, y up; sizes are sides of squares in px.
"""

from __future__ import annotations

import csv
import dataclasses
import io
import math
import re
import typing
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

TASKS = ("fov", "ring")
SELECTIONS = ("auto", "button", "dwell", "first-entry")
AUTOMATIC = ("auto", "dwell", "first-entry")
"""Selections that cannot miss: their endpoints say nothing about precision."""

Vector = tuple[float, float, float]
UNKNOWN: Vector = (math.nan, math.nan, math.nan)


@dataclass(frozen=True)
class Trial:
    """One target; NaN where a value is not known. ``from`` is the centre of the target before, ``to`` of this one."""

    study: str = ""
    participant: str = ""
    condition: str = ""
    block: int = 0
    practice: bool = False
    run: int = 0
    index: int = 0  # place in the run
    task: str = "fov"
    selection: str = "auto"
    from_x: float = math.nan
    from_y: float = math.nan
    from_size: float = math.nan
    to_x: float = math.nan
    to_y: float = math.nan
    to_size: float = math.nan
    tolerance_px: float = math.nan  # of the game: half the width of what is accepted, in place and size
    width_px: float = math.nan  # of the ring: diameter of the target
    amplitude_px: float = math.nan  # nominal way from centre to centre
    sel_x: float = math.nan
    sel_y: float = math.nan
    sel_size: float = math.nan
    t_start: float = math.nan  # s, time of samples
    t_end: float = math.nan
    movement_time_s: float = math.nan
    pan_time_s: float = math.nan
    zoom_time_s: float = math.nan
    idle_time_s: float = math.nan
    activations: int = 0
    clutches: int = 0
    overshoots: int = 0
    path_px: float = math.nan
    zoom_path: float = math.nan  # sum of |ln(size / size before)|
    min_deg: Vector = UNKNOWN  # smallest and largest angle about x, y, z since activation
    max_deg: Vector = UNKNOWN
    max_rotation_deg: tuple[float, ...] = ()  # the largest rotation of each activation
    error: bool = False  # selected outside of the target. Last: a row that was cut short lacks it

    @property
    def target_width_px(self) -> float:
        """Width of what is accepted: of the ring the diameter, of the game twice the tolerance."""
        return self.width_px if self.task == "ring" else 2.0 * self.tolerance_px

    @property
    def automatic(self) -> bool:
        """The game chose the moment of selection, so a miss was not possible."""
        return self.selection in AUTOMATIC


AXES = ("x", "y", "z")
KINDS: dict[str, Any] = typing.get_type_hints(Trial)
FIELDS = tuple(field.name for field in dataclasses.fields(Trial))
CHOICES = {"task": TASKS, "selection": SELECTIONS}
LARGEST = 2**53
"""of a whole number; a larger one is no float."""
REQUIRED = ("participant", "condition", "movement_time_s")
COLUMNS: tuple[str, ...] = tuple(
    column
    for name in FIELDS
    for column in ([f"{name.removesuffix('_deg')}_{axis}_deg" for axis in AXES] if KINDS[name] == Vector else [name])
)


def trials_csv(trials: Iterable[Trial], metadata: Mapping[str, object] | None = None) -> str:
    """The whole table: ``# key: value`` lines, a header, one row for each trial."""
    comments = [f"# {key}: {' '.join(str(value).split())}\n" for key, value in (metadata or {}).items()]
    return "".join(comments) + csv_line(COLUMNS) + "".join(trial_line(trial) for trial in trials)


def trial_line(trial: Trial) -> str:
    """One row with its newline, to be appended to a table; numbers have all their digits."""
    cells: list[str] = []
    for name in FIELDS:
        value = getattr(trial, name)
        if KINDS[name] == Vector:
            cells += map(_number_text, value)
        elif isinstance(value, tuple):
            cells.append(" ".join(map(_number_text, value)))
        else:
            cells.append(_WRITERS[KINDS[name]](value))
    return csv_line(cells)


def csv_line(cells: Iterable[str]) -> str:
    """Cells as one line of CSV, quoted where it is needed; a line is a row, so that one cut row spoils no other."""
    out = io.StringIO()
    csv.writer(out, lineterminator="").writerow(cells)
    return re.sub(r"[\r\n]+", " ", out.getvalue()) + "\n"


def read_trials(text: str) -> tuple[list[Trial], list[str]]:
    """The trials of a table, and one sentence for each row that was not taken.

    Columns may stand in any order; unknown ones are passed over, missing ones get the default.
    """
    lines = text.removeprefix("\ufeff").split("\n")
    top = next((k for k, line in enumerate(lines) if line.strip() and not line.startswith("#")), len(lines) - 1)
    header = [cell.strip() for cell in _cells(lines[top])]
    missing = [name for name in REQUIRED if name not in header]
    if missing:
        return [], [f"no table of trials: it has no column {', '.join(missing)}"]
    trials: list[Trial] = []
    problems: list[str] = []
    for number, line in enumerate(lines[top + 1 :], top + 2):
        try:
            if line.strip():
                trials.append(_trial(header, _cells(line)))
        except ValueError as error:
            problems.append(f"line {number}: {error}")
    return trials, problems


def _cells(line: str) -> list[str]:
    try:
        return next(csv.reader([line.rstrip("\r")]), [])
    except csv.Error:  # a cell longer than any of ours
        return []


def _trial(header: list[str], cells: list[str]) -> Trial:
    if len(cells) != len(header):
        raise ValueError(f"{len(cells)} cells instead of {len(header)}")
    row = dict(zip(header, cells, strict=True))
    values: dict[str, Any] = {}
    for name in FIELDS:
        if KINDS[name] == Vector:
            columns = [f"{name.removesuffix('_deg')}_{axis}_deg" for axis in AXES]
            values[name] = tuple(_read(column, float, row.get(column, "")) for column in columns)
        elif name in row:
            values[name] = _read(name, KINDS[name], row[name])
    return Trial(**values)


def _read(name: str, kind: Any, text: str) -> Any:
    try:
        value = _READERS.get(kind, _numbers)(text if kind is str else text.strip())
    except (ValueError, KeyError) as error:
        raise ValueError(f"{name}: {text[:40]!r} is not understood") from error
    if name in CHOICES and value not in CHOICES[name]:
        raise ValueError(f"{name}: {text[:40]!r} is none of {', '.join(CHOICES[name])}")
    return value


def _number_text(value: float) -> str:
    return "" if math.isnan(value) else repr(float(value))


def _number(text: str) -> float:
    value = float(text) if text else math.nan
    if math.isinf(value):
        raise ValueError(text)
    return value


def _whole(text: str) -> int:
    value = int(text)
    if abs(value) > LARGEST:
        raise ValueError(text)
    return value


def _numbers(text: str) -> tuple[float, ...]:
    return tuple(_number(word) for word in text.split())


def _flag(text: str) -> bool:
    return {"0": False, "False": False, "1": True, "True": True}[text]


_WRITERS: dict[Any, Callable[[Any], str]] = {str: str, int: str, float: _number_text, bool: lambda flag: str(int(flag))}
_READERS: dict[Any, Callable[[str], Any]] = {str: str, int: _whole, float: _number, bool: _flag}
