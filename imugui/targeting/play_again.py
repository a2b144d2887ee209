"""A run played again from what was kept of it: its setup, its rows, and what the person did at which row.

The same rows and inputs give the same trials, bit for bit; ``imugui verify`` compares them with the stored ones.
"""

from __future__ import annotations

import csv
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field, fields
from typing import Any, NamedTuple

from imugui.fields import from_mapping
from imugui.fusion.scalar import Quat, Vector
from imugui.samples import Rows
from imugui.targeting.activation import Input
from imugui.targeting.game import Game
from imugui.targeting.settings import Control
from imugui.targeting.states import Transition
from imugui.targeting.tally import Labels
from imugui.targeting.tasks import Task, target_list
from imugui.targeting.trials import COLUMNS, Trial, trial_line
from imugui.targeting.view_pose import View

Row = tuple[float, Quat, Vector, int]
"""What the game takes of a row: t in s, quat, gyr in rad/s, status."""


class Move(NamedTuple):
    """What the person did, and with which row of the run (0 is the first one stepped) the game heard of it."""

    row: int
    kind: str
    value: str = ""


@dataclass(frozen=True)
class Setup:
    """All that a run is made from, besides its rows and moves."""

    task: Task = field(default_factory=Task)
    control: Control = field(default_factory=Control)
    seed: int = 0
    variant: int = 0
    labels: Labels = field(default_factory=Labels)

    def game(self) -> Game:
        """A new run. Raises ValueError, with words for the person, when the targets do not fit into the field."""
        return Game(self.task, self.control, target_list(self.task, self.seed, self.variant), self.labels)

    def as_mapping(self) -> dict[str, Any]:
        """Plain values, for JSON."""
        return asdict(self)


@dataclass(frozen=True)
class Played:
    """What came out: trials, the log of the controller, and where the view was after each row."""

    trials: tuple[Trial, ...]
    log: tuple[Transition, ...]
    views: tuple[View, ...]


def setup_from(values: Mapping[str, Any]) -> tuple[Setup, list[str]]:
    """A setup from ``Setup.as_mapping``, as far as it can be read; one sentence for each value that was not taken."""
    task, problems = from_mapping(Task, _table(values.get("task")))
    control, more = from_mapping(Control, _table(values.get("control")))
    known, labels = _plain(Labels(), _table(values.get("labels")))
    numbers, top = _plain(Setup(), {key: values[key] for key in ("seed", "variant") if key in values})
    return Setup(task, control, labels=Labels(**known), **numbers), [*problems, *more, *labels, *top]


def each_row(rows: Rows) -> Iterator[Row]:
    """Plain floats of ATTITUDE rows (n,), one row after the other."""
    columns = (rows[name].tolist() for name in ("t", "quat", "gyr", "status"))
    for t, quat, gyr, status in zip(*columns, strict=True):
        yield t, tuple(quat), tuple(gyr), status


def play_again(rows: Iterable[Row], moves: Iterable[Move], game: Game) -> Played:
    """Step a new game through rows (see ``each_row``) and the moves made with them, from its row 0."""
    inputs: dict[int, list[Input]] = {}
    for number, kind, value in moves:
        inputs.setdefault(number, []).append(Input(kind, value))
    views = []
    for number, (t, quat, gyr, status) in enumerate(rows):
        game.step(t, quat, gyr, status, inputs.get(number, ()))
        views.append(game.controller.view)
    return Played(tuple(game.trials), tuple(game.controller.log), tuple(views))


def differences(stored: Sequence[Trial], again: Sequence[Trial]) -> list[str]:
    """Where two lists of trials are not the same to the last digit, one sentence each; NaN equals NaN."""
    found = []
    if len(stored) != len(again):
        found.append(f"{len(stored)} trials are stored, {len(again)} come out")
    for number, (one, other) in enumerate(zip(stored, again, strict=False), 1):
        cells = zip(COLUMNS, *csv.reader([trial_line(one), trial_line(other)]), strict=True)
        found += [f"trial {number}: {name} is {a or 'empty'}, not {b or 'empty'}" for name, a, b in cells if a != b]
    return found


def _table(value: Any) -> Mapping[str, Any]:
    return value if isinstance(value, Mapping) else {}


def _plain(default: Any, values: Mapping[str, Any]) -> tuple[dict[str, Any], list[str]]:
    """The values that are of the same type as in ``default``, a dataclass."""
    taken, problems = {}, []
    for item in fields(default):
        if item.name not in values:
            continue
        value, kind = values[item.name], type(getattr(default, item.name))
        if type(value) is kind:
            taken[item.name] = value
        else:
            problems.append(f"{item.name}: expected {kind.__name__}, got {type(value).__name__}")
    return taken, problems
