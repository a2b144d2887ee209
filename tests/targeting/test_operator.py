"""The simulated user: what it knows, that it plays as people do, and the motion card's whole chain."""

from __future__ import annotations

import dataclasses
import statistics
from math import hypot

import numpy as np
import pytest

from imugui.formats import FORMATS
from imugui.formats.base import Options
from imugui.fusion.pipeline import Pipeline
from imugui.simulation.board import VirtualBoard
from imugui.simulation.errors import PRESETS as ERRORS
from imugui.simulation.path import Floats, Path
from imugui.targeting.game import Game
from imugui.targeting.lag import FirstOrderLag
from imugui.targeting.measures import Run, measure
from imugui.targeting.operator import Operator, play_run
from imugui.targeting.operator_hand import Card
from imugui.targeting.operator_plan import AXES, PositionAxis, SpeedAxis
from imugui.targeting.person import Person, one_of_many, practised
from imugui.targeting.play_again import each_row
from imugui.targeting.settings import POSITION, PRESETS, SPEED, Control
from imugui.targeting.tasks import PRESETS as TASKS
from imugui.targeting.tasks import Task, target_list
from imugui.targeting.thesis_tables import TAUS_S, Table, lag_test, lines

DT = 0.01
STUDY_RUNS = 5
SHARP = dataclasses.replace(
    Person(), see_px=0.0, see_share=0.0, misjudge=0.0, motor=0.0, wander_deg=0.0, jolt_deg=0.0, slip=0.0, form=0.0
)  # fmt: skip


def run_of(control: Control, task: Task, seed: int, person: Person | None = None) -> Run:
    """The measures of one run, which must have been finished."""
    game = Game(task, control, target_list(task, seed))
    play_run(game, person or Person(), seed)
    assert game.done
    return measure(game.trials)


@pytest.fixture(scope="module")
def study() -> dict[str, Table]:
    """Elapsed seconds of a study like that of the thesis; the first one of docs/game_thesis.py."""
    found: dict[str, Table] = {}
    for first, mapping in ((0, POSITION), (4, SPEED)):
        control = PRESETS[f"thesis {mapping}"]
        found[mapping] = {
            tau: tuple(
                run_of(dataclasses.replace(control, lag_s=tau), Task(), 8 * k + first + place).elapsed_time_s
                for k in range(STUDY_RUNS)
            )
            for place, tau in enumerate(TAUS_S)
        }
    return found


def test_position_is_faster_than_speed_at_every_lag(study: dict[str, Table]) -> None:
    found = lines(study[POSITION], study[SPEED])
    assert all(line.ratio > 1.1 and line.test.p < 0.05 for line in found)


def test_no_effect_of_the_lag_is_detected_up_to_one_second(study: dict[str, Table]) -> None:
    assert all(lag_test(study[mapping], 1.0).p > 0.05 for mapping in (POSITION, SPEED))


def test_a_lag_of_two_seconds_makes_both_slower(study: dict[str, Table]) -> None:
    for mapping, most in ((POSITION, 0.05), (SPEED, 0.1)):
        means = [statistics.mean(runs) for runs in study[mapping].values()]
        assert means[-1] > max(means[:-1])
        assert lag_test(study[mapping]).p < most


def test_the_advantage_of_position_shrinks_at_two_seconds(study: dict[str, Table]) -> None:
    ratios = [line.ratio for line in lines(study[POSITION], study[SPEED])]
    assert ratios[-1] < min(ratios[:-1])


@pytest.mark.parametrize(("mapping", "low", "high"), [(POSITION, 2.0, 3.5), (SPEED, 1.0, 1.5)])
def test_throughput_on_the_ring_is_that_of_people(mapping: str, low: float, high: float) -> None:
    runs = [run_of(PRESETS[mapping], TASKS["ring, button"], seed) for seed in range(2)]
    assert low < statistics.mean(run.throughput for run in runs) < high
    assert all(run.sequences == 4 for run in runs)


def test_a_run_is_the_same_again_with_the_same_seed() -> None:
    games = [Game(Task(), PRESETS["speed"], target_list(Task(), 2)) for _ in range(3)]
    runs = [play_run(game, one_of_many(4), seed) for game, seed in zip(games, (9, 9, 10), strict=True)]
    assert runs[0] == runs[1]
    assert runs[0] != runs[2]


def test_every_activation_is_counted_once() -> None:
    game = Game(Task(), PRESETS["position"], target_list(Task(), 3))
    trials = play_run(game, Person(), 3)
    assert sum(trial.activations for trial in trials) == sum(len(trial.max_rotation_deg) for trial in trials)
    assert sum("button" in line.cause or "status" in line.cause for line in game.controller.log) >= 10
    for trial in trials:
        parts = trial.pan_time_s + trial.zoom_time_s + trial.idle_time_s
        assert parts == pytest.approx(trial.movement_time_s)
        assert hypot(trial.sel_x - trial.from_x, trial.sel_y - trial.from_y) <= trial.path_px + 18.0 * 2**0.5


def test_practice_makes_faster() -> None:
    person = Person()
    assert practised(person, 1) == person
    assert practised(person, 4).think_s == pytest.approx(person.think_s * 4.0**-person.learning)
    times = []
    for block in (1, 8):
        runs = [run_of(PRESETS["speed"], Task(), seed, practised(person, block)) for seed in range(3)]
        times.append(statistics.mean(run.elapsed_time_s for run in runs))
    assert times[1] < 0.95 * times[0]


def test_people_differ() -> None:
    people = [one_of_many(seed) for seed in range(40)]
    assert people[3] == one_of_many(3)
    spread = np.std(np.log([person.think_s for person in people]))
    assert 0.08 < spread < 0.17
    assert {person.arm for person in people} == {Person().arm}


@pytest.mark.parametrize("tau_s", [0.0, 0.25, 2.0])
@pytest.mark.parametrize("mapping", [POSITION, SPEED])
def test_a_plan_brings_the_machine_to_the_target(mapping: str, tau_s: float) -> None:
    """Against the lag of the controller itself, with a person who is right about everything."""
    control = Control(mapping=mapping, lag_s=tau_s, smoothing=False)
    person = dataclasses.replace(SHARP, arm=1e9, sight_s=0.0, glance_s=0.0, interval_s=DT)
    axis, lag = AXES[mapping](person, control, 8.0, 10.0, DT), FirstOrderLag(tau_s)
    lag.reset((10.0 if mapping == POSITION else 0.0, 0.0))
    place, speed = 10.0, 0.0
    for _ in range(600):
        axis.follow(place, speed, 110.0, axis.angle)
        out = lag.update((axis.angle * 8.0 + (10.0 if mapping == POSITION else 0.0), 0.0), DT)[0]
        speed = (out - place) / DT if mapping == POSITION else out
        place = out if mapping == POSITION else place + out * DT
    assert place == pytest.approx(110.0, abs=0.5)
    assert abs(speed) < 1.0


def test_a_hand_at_its_end_is_stuck_with_a_place_but_not_with_a_speed() -> None:
    control, person = Control(), dataclasses.replace(SHARP, interval_s=DT)
    for kind, expected in ((PositionAxis, True), (SpeedAxis, False)):
        axis = kind(person, control, 8.0, 0.0, DT)
        for _ in range(100):
            axis.follow(80.0, 0.0, 300.0, axis.angle)
            axis.limit(10.0 / axis.angle)
        assert axis.angle == pytest.approx(10.0)
        assert axis.stuck(300.0, 80.0, 9.0) is expected


@pytest.mark.parametrize(
    ("before", "held_s", "after"), [(0, 0.2, 1), (0, 0.7, 2), (1, 0.2, 0), (2, 0.2, 0), (1, 0.7, 1)]
)
def test_the_cards_button(before: int, held_s: float, after: int) -> None:
    card = Card()
    card.status = before
    for _ in range(round(held_s / DT)):
        card.hold(DT)
    card.release()
    assert card.status == after


class Held(Path):
    """The board in the simulated user's hand."""

    live = True

    def __init__(self, operator: Operator) -> None:
        self._operator = operator
        self.said: list[tuple[int, tuple[object, ...]]] = []  # status and inputs of each row

    def quats(self, t: Floats) -> Floats:
        """Attitude (n, 4): where the hand turned the board."""
        found = []
        for _ in t:
            _, quat, _, status = self._operator.act()
            self.said.append((status, self._operator.inputs))
            found.append(quat)
        return np.array(found)


@pytest.mark.parametrize("mapping", [POSITION, SPEED])
def test_the_motion_card_drives_a_whole_run_over_its_text_stream(mapping: str) -> None:
    """Hand -> sensors -> lines with status bytes -> decoder -> filter -> game -> what the hand's owner sees."""
    task, entry = Task(targets=2), FORMATS["colon-line"]
    game = Game(task, PRESETS[f"thesis {mapping}"], target_list(task, 1))
    hand = Held(Operator(game, Person(), 1))
    board = VirtualBoard(hand, 100.0, ERRORS["mpu9250-calibrated"], seed=1)
    encoder, decoder = entry.encoder(), entry.decoder(Options())
    pipeline, text = Pipeline("mahony", use_mag=False), bytearray()
    while not game.done and board.count < 9000:
        for row in np.split(board.rows(2), 2):  # what a live board makes at once
            status, inputs = hand.said.pop(0)
            row["status"] = status
            line = encoder.encode(row)
            text += line
            for t, quat, gyr, seen in each_row(pipeline.step(decoder.feed(line, float(row["t"][0])))):
                game.step(t, quat, gyr, seen, inputs)  # type: ignore[arg-type]
    assert game.done
    assert decoder.counts.bad_messages == 0
    assert {line.rsplit(b":", 2)[1] for line in bytes(text).splitlines()} == {b"0", b"1", b"2"}
    causes = [line.cause for line in game.controller.log]
    for cause in ("board status 0 to 1", "board status 1 to 0", "board status 0 to 2", "board status 2 to 0"):
        assert cause in causes
    modes = {line.mode for line in game.controller.log if line.cause.startswith("board status 0")}
    assert modes == {"pan", "zoom"}
    assert [trial.error for trial in game.trials] == [False, False]
