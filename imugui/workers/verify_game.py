"""Runs of the game in a recording, played again from the attitudes that were computed again."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

from imugui.recording import Event
from imugui.samples import Rows
from imugui.targeting.game import Game
from imugui.targeting.play_again import Move, differences, each_row, play_again, setup_from
from imugui.targeting.tasks import Target
from imugui.targeting.trials import Trial

MOST_SAID = 5


@dataclass
class Run:
    """What a recording tells of one run; rows are numbered in the attitude ring."""

    begun: dict[str, Any]
    moves: list[Move] = field(default_factory=list)
    trials: list[Trial] = field(default_factory=list)
    end: int | None = None  # the row that ended it; None: the recording ended first

    @property
    def first(self) -> int:
        """The first row of the run."""
        return int(self.begun["row"])


@dataclass(frozen=True)
class GameCheck:
    """What came out of the runs that were found."""

    runs: int = 0
    recomputed: int = 0  # the others began before the recording
    trials: int = 0
    problems: tuple[str, ...] = ()

    @property
    def sentence(self) -> str:
        """What to tell the user; empty without a run."""
        if not self.runs:
            return ""
        text = f"{self.recomputed} of {self.runs} runs of the game played again, {self.trials} targets: "
        if not self.problems:
            return text + "the same to the last digit."
        return text + "; ".join(self.problems[:MOST_SAID]) + "."


def verify_games(events: list[Event], fused: Rows) -> GameCheck:
    """Play every run again from ATTITUDE rows (n,) and compare its targets with those that were recorded."""
    problems: list[str] = []
    runs = list(_runs([event for event in events if event.kind == "game"], problems))
    recomputed = trials = 0
    for number, run in enumerate(runs, 1):
        try:
            found = _played(run, fused)
        except (KeyError, TypeError, ValueError, OverflowError) as error:
            problems.append(f"run {number} is damaged ({error})")
            continue
        if found is not None:
            recomputed, trials = recomputed + 1, trials + len(run.trials)
            problems += [f"run {number}, {text}" for text in found]
    return GameCheck(len(runs), recomputed, trials, tuple(problems))


def _runs(events: list[Event], problems: list[str]) -> Iterator[Run]:
    run: Run | None = None
    for event in events:
        if event.text == "start":
            run = Run(event.data)
            yield run
        elif run is not None:
            try:
                _TAKE[event.text](run, event.data)
            except (KeyError, TypeError, ValueError, OverflowError) as error:
                problems.append(f"an event of the game is damaged ({error})")


def _take_inputs(run: Run, data: dict[str, Any]) -> None:
    row = int(data["row"]) - run.first
    run.moves += [Move(row, str(kind), str(value)) for kind, value in data["inputs"]]


def _take_trial(run: Run, data: dict[str, Any]) -> None:
    values: dict[str, Any] = {
        key: tuple(value) if isinstance(value, list) else value for key, value in data["trial"].items()
    }
    run.trials.append(Trial(**values))


def _take_end(run: Run, data: dict[str, Any]) -> None:
    run.end = int(data["row"]) if run.end is None else run.end


_TAKE = {"inputs": _take_inputs, "trial": _take_trial, "done": _take_end, "left": _take_end}


def _played(run: Run, fused: Rows) -> list[str] | None:
    """Where the targets differ, in words; None when the run began before the recording."""
    begin = run.first - int(run.begun["first_attitude"])
    if begin < 0:
        return None
    setup, wrong = setup_from(run.begun)
    if wrong:
        raise ValueError(wrong[0])
    targets = [_target(*values) for values in run.begun["targets"]]
    end = len(fused) if run.end is None else run.end - run.first + begin + 1
    game = Game(setup.task, setup.control, targets, setup.labels)
    return differences(run.trials, play_again(each_row(fused[begin:end]), run.moves, game).trials)


def _target(x: float, y: float, size: float, amplitude: float, start: bool, sequence: int) -> Target:
    return Target(float(x), float(y), float(size), float(amplitude), bool(start), int(sequence))
