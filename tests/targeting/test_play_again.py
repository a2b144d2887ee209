"""A run played again gives the same trials to the last bit, whatever happened in it."""

from __future__ import annotations

import dataclasses
import json
import random
from math import nan
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from imugui.samples import ATTITUDE, Rows, empty_rows
from imugui.targeting.activation import Input
from imugui.targeting.game import Game
from imugui.targeting.operator import played
from imugui.targeting.person import Person
from imugui.targeting.play_again import Move, Row, Setup, differences, each_row, play_again, setup_from
from imugui.targeting.settings import PRESETS
from imugui.targeting.tally import Labels
from imugui.targeting.tasks import PRESETS as TASKS
from imugui.targeting.tasks import Task
from imugui.targeting.trials import Trial

SETUP = Setup(Task(targets=2), PRESETS["thesis position"], 7, 3, Labels("s", "P1", "position, slow", 1, True, 2))


def attitudes(rows: list[Row]) -> Rows:
    """The rows as ATTITUDE rows."""
    block = empty_rows(ATTITUDE, len(rows))
    for name, values in zip(("t", "quat", "gyr", "status"), zip(*rows, strict=True), strict=True):
        block[name] = values
    return block


def moves_of(inputs: list[tuple[Input, ...]]) -> list[Move]:
    """What was done, by row."""
    return [Move(number, *item) for number, given in enumerate(inputs) for item in given]


@pytest.mark.parametrize("setup", [SETUP, Setup(TASKS["ring, button"], PRESETS["speed"], 1)])
def test_a_whole_run_comes_out_the_same(setup: Setup) -> None:
    game = setup.game()
    run = list(played(game, Person(), 5))
    rows, inputs = [row for row, _ in run], [given for _, given in run]
    again = play_again(each_row(attitudes(rows)), moves_of(inputs), setup.game())
    assert game.done
    assert len(again.trials) == sum(not one.start for one in game.targets)
    assert differences(game.trials, again.trials) == []
    assert again.trials == tuple(game.trials) or setup.task.kind == "ring"  # NaN is not NaN
    assert again.log == tuple(game.controller.log)
    assert again.views[-1] == game.controller.view
    assert len(again.views) == len(rows)


KINDS = st.sampled_from(
    [Input("press", "pan"), Input("release", "pan"), Input("press", ""), Input("release", ""), Input("press", "zoom"),
     Input("release", "zoom"), Input("press", "clutch"), Input("release", "clutch"), Input("stop"), Input("reset"),
     Input("confirm"), Input("disarm"), Input("select"), Input("nonsense", "x")]
)  # fmt: skip


def noise(seed: int, n: int) -> list[Row]:
    """Rows of a mad board: jumps, gaps, times that go back, numbers that are none, a status byte of any value."""
    draw = random.Random(seed)  # noqa: S311
    t, quat, rows = 0.0, np.array([1.0, 0.0, 0.0, 0.0]), []
    for _ in range(n):
        t += draw.choice([0.01] * 30 + [0.0, 0.3, -0.5])
        quat = quat + draw.choice([0.01] * 9 + [2.0]) * np.array([draw.gauss(0.0, 1.0) for _ in range(4)])
        quat /= np.linalg.norm(quat)
        shown = tuple((quat * draw.choice([1.0] * 30 + [nan, 1.2])).tolist())
        gyr = tuple(draw.choice([0.1] * 30 + [nan, 1e9]) * draw.gauss(0.0, 1.0) for _ in range(3))
        rows.append((draw.choice([t] * 30 + [nan]), shown, gyr, draw.choice([0, 1, 1, 2, -1, 7])))
    return rows


@settings(max_examples=50)
@given(
    st.integers(0, 10**6), st.lists(st.tuples(st.integers(0, 149), KINDS), max_size=40), st.sampled_from(list(TASKS))
)
def test_anything_goes_and_comes_out_the_same(seed: int, done: list[tuple[int, Input]], name: str) -> None:
    setup = Setup(TASKS[name], dataclasses.replace(PRESETS["position"], dead_time_s=0.05), seed)
    rows, game = noise(seed, 150), setup.game()
    inputs: list[tuple[Input, ...]] = [(Input("confirm"),) * (k == 0) for k in range(150)]
    for number, item in done:
        inputs[number] += (item,)
    looks: list[Any] = []
    for number, row in enumerate(rows):
        # a thread that ticks in between, sometimes after the input has become stale
        early = game.tick(0.5 if row[3] == 7 else 0.0, inputs[number])
        game.step(*row, early)
        inputs[number] = early
        looks.append(game.look())
    again = play_again(rows, moves_of(inputs), setup.game())
    assert differences(game.trials, again.trials) == []
    assert again.views == tuple(look.view for look in looks)
    assert repr(again.log) == repr(tuple(game.controller.log))
    for trial in game.trials:
        assert trial.movement_time_s >= 0.0
        parts = trial.pan_time_s + trial.zoom_time_s + trial.idle_time_s
        assert parts == pytest.approx(trial.movement_time_s, abs=1e-9)


def test_a_setup_goes_through_json() -> None:
    text = json.dumps(SETUP.as_mapping())
    assert setup_from(json.loads(text)) == (SETUP, [])


def test_what_cannot_be_read_of_a_setup_is_said() -> None:
    values = {
        "task": {"kind": "golf", "targets": 3},
        "control": {"gain": "much", "lag_s": 1},
        "labels": {"block": "two", "run": 4, "participant": 5},
        "seed": 1.5,
    }
    setup, problems = setup_from(values)
    assert setup == Setup(Task(targets=3), dataclasses.replace(Setup().control, lag_s=1.0), labels=Labels(run=4))
    assert len(problems) == 5
    assert setup_from({"task": 3, "control": None}) == (Setup(), [])


def test_differences_name_what_is_different() -> None:
    one = Trial(participant="A, B", condition="c", movement_time_s=1.0)
    other = dataclasses.replace(one, movement_time_s=1.0000000000000002, sel_x=3.0)
    assert differences([one], [one]) == []
    assert differences([one], [other]) == [
        "trial 1: sel_x is empty, not 3.0",
        "trial 1: movement_time_s is 1.0, not 1.0000000000000002",
    ]
    assert differences([one, one], [one]) == ["2 trials are stored, 1 come out"]


def test_a_missing_move_is_found() -> None:
    game = SETUP.game()
    run = list(played(game, Person(), 5))
    again = play_again([row for row, _ in run], [], SETUP.game())
    assert again.trials == ()
    assert differences(game.trials, again.trials) == ["2 trials are stored, 0 come out"]
    assert isinstance(SETUP.game(), Game)
