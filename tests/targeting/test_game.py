"""The rules of the game, with a hand that turns exactly: 8 px for each degree, the thesis' axes, no lag."""

from __future__ import annotations

import dataclasses
import math
from math import nan, radians
from typing import Any

import pytest

from imugui.fusion.scalar import Quat, Vector, turned_in_sensor
from imugui.targeting.activation import Input
from imugui.targeting.game import SELECT, Game
from imugui.targeting.game_look import LEFT_ON, PHASES
from imugui.targeting.measures import measure
from imugui.targeting.settings import HOLD, PRESETS
from imugui.targeting.states import State
from imugui.targeting.tally import Labels
from imugui.targeting.tasks import BUTTON, DWELL, RING, Target, Task
from imugui.targeting.trials import Trial
from imugui.targeting.view_pose import View

EXACT = dataclasses.replace(PRESETS["thesis position"], lag_s=0.0)
LEVEL: Quat = (1.0, 0.0, 0.0, 0.0)
STILL: Vector = (0.0, 0.0, 0.0)
DT = 0.01
TARGETS = (Target(80.0, 0.0, 160.0, 80.0), Target(80.0, -40.0, 120.0, 40.0))


class Player:
    """A hand with exact angles about the board's x and y axes, and the card's status byte."""

    def __init__(self, task: Task, targets: tuple[Target, ...] = TARGETS, **labels: Any) -> None:
        self.game = Game(task, EXACT, targets, Labels(**labels))
        self.t, self.status, self.angles = 10.0, 0, (0.0, 0.0)
        self.trials: list[Trial] = []
        self.row(Input("confirm"))

    def row(self, *inputs: Input, quat: Quat | None = None, dt: float = DT) -> View:
        """One row; ``quat`` only for a broken one."""
        self.t += dt
        turned = turned_in_sensor(LEVEL, radians(self.angles[0]), radians(self.angles[1]), 0.0)
        self.trials += self.game.step(self.t, quat or turned, STILL, self.status, inputs)
        return self.game.controller.view

    def wait(self, rows: int) -> None:
        """Hold still."""
        for _ in range(rows):
            self.row()

    def press(self, status: int) -> None:
        """The card's button; the jolt passes."""
        self.status = status
        self.wait(3)

    def turn(self, x: float, y: float = 0.0) -> View:
        """Turn the hand to these angles, deg: 8 px each from where it was when it engaged."""
        self.angles = x, y
        return self.row()


def task(**changes: Any) -> Task:
    """A task of the game."""
    return dataclasses.replace(Task(), **changes)


def test_a_run_by_the_cards_button() -> None:
    player = Player(task(), study="s", participant="P1", condition="c", block=2, run=3)
    player.wait(50)
    player.press(1)  # 3 rows; the clock starts with the first of them
    start = player.t - 0.02
    player.turn(12.0)  # 96 px: past the far edge at 89
    player.turn(10.0)
    player.press(0)
    player.turn(0.0)
    player.press(2)
    assert player.turn(5.0) == View(80.0, 0.0, 160.0)  # size 120 + 40
    assert len(player.trials) == 1
    trial = player.trials[0]
    assert (trial.study, trial.participant, trial.condition, trial.block, trial.run) == ("s", "P1", "c", 2, 3)
    assert (trial.from_x, trial.from_size, trial.to_x, trial.to_size, trial.amplitude_px) == (
        0.0,
        120.0,
        80.0,
        160.0,
        80.0,
    )
    assert (trial.sel_x, trial.sel_y, trial.sel_size) == pytest.approx((80.0, 0.0, 160.0))
    assert (trial.activations, trial.clutches, trial.overshoots, trial.error) == (2, 0, 1, False)
    assert trial.t_start == pytest.approx(start)
    assert trial.movement_time_s == pytest.approx(0.12)
    # pan: from the press to the row that stops; the row itself belongs to what was before
    times = trial.pan_time_s, trial.zoom_time_s, trial.idle_time_s
    assert times == pytest.approx((0.05, 0.03, 0.04))
    assert trial.path_px == pytest.approx(96.0 + 16.0)
    assert trial.zoom_path == pytest.approx(math.log(160.0 / 120.0))
    assert trial.max_deg == pytest.approx((12.0, 0.0, 0.0))
    assert trial.min_deg == pytest.approx((0.0, 0.0, 0.0))
    assert trial.max_rotation_deg == pytest.approx((12.0,))  # the zoom is still on


def test_an_activation_counts_where_it_begins_and_its_rotation_where_it_ends() -> None:
    player = Player(task())
    player.press(1)
    player.turn(10.0)
    player.press(0)
    player.press(2)
    player.turn(15.0)
    assert player.game.look().index == 1
    player.turn(7.0)  # the zoom goes on: size 96
    player.press(0)
    player.press(1)
    player.turn(7.0, -5.0)
    player.press(0)
    player.turn(0.0)
    player.press(2)
    player.turn(3.0)
    first, second = player.trials
    assert (first.activations, second.activations) == (2, 2)
    assert first.max_rotation_deg == pytest.approx((10.0,))
    assert second.max_rotation_deg == pytest.approx((5.0, 5.0, 3.0), abs=0.01)  # small turns nearly add up
    run = measure(player.trials)
    assert run.activations == 4
    assert run.mean_largest_rotation_deg == pytest.approx((10.0 + 5.0 + 5.0 + 3.0) / 4, abs=0.01)
    assert run.min_angle_x_deg == pytest.approx(-3.0)
    assert run.elapsed_time_s == player.trials[1].t_end - player.trials[0].t_start


def test_a_finished_run_takes_nothing_more() -> None:
    player = Player(task(), TARGETS[:1])
    player.press(1)
    player.turn(10.0)
    player.press(0)
    player.press(2)
    view = player.turn(15.0)
    assert player.game.done
    assert player.game.controller.state is State.DISARMED
    assert player.turn(30.0) == view
    player.row(Input("stop"))
    look = player.game.look()
    assert (look.phase, look.remaining, look.index, look.to_do) == ("done", 0, 1, "All targets are done.")
    assert player.game.tick(9.0, (Input("press"),)) == (Input("press"),)


def test_the_same_mode_again_is_a_clutch() -> None:
    player = Player(task())
    player.press(1)
    player.turn(5.0)
    player.press(0)
    player.turn(0.0)
    player.press(1)
    player.row(Input("press", "clutch"))
    player.row(Input("release", "clutch"))
    player.wait(3)
    player.turn(5.0)
    player.press(0)
    player.press(2)
    player.turn(10.0)
    assert player.trials[0].clutches == 2
    assert player.trials[0].activations == 3


def test_a_button_selects_where_the_view_is_right_or_wrong() -> None:
    player = Player(task(selection=BUTTON), (TARGETS[0], TARGETS[0], TARGETS[0]))
    player.row(Input(SELECT))  # the clock does not run yet
    player.press(1)
    player.turn(10.0)
    player.press(0)
    player.press(2)
    player.turn(15.0)
    player.wait(30)
    assert player.trials == []
    assert player.game.look().to_do == "It matches: select."
    player.row(Input(SELECT))
    player.turn(16.13)  # 1 px beyond the tolerance
    player.row(Input(SELECT))
    assert [trial.error for trial in player.trials] == [False, True]
    assert player.trials[1].sel_size == pytest.approx(160.0 + 1.13 * 8.0)
    look = player.game.look()
    assert (look.errors, look.last_missed, look.remaining) == (1, True, 1)


@pytest.mark.parametrize(("break_it", "word"), [("stop", "stopped"), ("nan", "hold")])
def test_nothing_is_selected_while_held_or_stopped(break_it: str, word: str) -> None:
    player = Player(task(selection=BUTTON))
    player.press(1)
    bad = (nan, 0.0, 0.0, 0.0) if break_it == "nan" else None
    player.row(*([Input("stop")] if break_it == "stop" else []), quat=bad)
    player.row(Input(SELECT))
    assert player.trials == []
    look = player.game.look()
    assert look.message == f"Not selected: {word}."
    assert look.phase == {"stopped": "stopped", "hold": "held"}[word]
    assert look.reason in ("emergency stop", "an attitude that is not a number")


def test_a_dwell_has_to_last() -> None:
    player = Player(task(selection=DWELL, dwell_s=0.5), (Target(80.0, 0.0, 120.0),))
    player.press(1)
    player.turn(10.0)
    player.wait(39)
    assert player.game.look().dwell == pytest.approx(0.78)
    player.turn(5.0)
    assert player.game.look().dwell == 0.0
    player.turn(10.0)
    player.wait(49)
    assert not player.game.done
    player.wait(2)
    assert player.game.done
    assert player.trials[0].selection == DWELL


def test_a_dwell_does_not_go_on_over_a_gap() -> None:
    player = Player(task(selection=DWELL, dwell_s=0.5), (Target(80.0, 0.0, 120.0),))
    player.press(1)
    player.turn(10.0)
    player.wait(30)
    player.row(dt=2.0)
    assert player.game.look().phase == "held"
    assert not player.game.done
    player.wait(60)  # the view stays where it is, and that matches
    assert player.game.done


RING_TARGETS = (
    Target(0.0, 80.0, 40.0, nan, True, 0),
    Target(0.0, -80.0, 40.0, 160.0, False, 0),
    Target(80.0, 80.0, 40.0, 160.0, False, 0),
    Target(0.0, 0.0, 40.0, nan, True, 1),
    Target(40.0, 0.0, 40.0, 40.0, False, 1),
)


def test_a_ring_starts_its_clock_with_the_first_target() -> None:
    player = Player(Task(kind=RING, selection=BUTTON), RING_TARGETS)
    player.press(1)
    player.turn(5.0, 0.0)
    player.row(Input(SELECT))
    look = player.game.look()
    assert look.message == "Missed. The first target starts the clock: hit it."
    assert (look.elapsed_s, look.index, look.total) == (0.0, 0, 3)
    assert look.to_do == "Left and up. It starts the clock."
    assert len(look.ring) == 2
    assert look.following == RING_TARGETS[1]
    player.turn(0.0, 10.0)
    player.row(Input(SELECT))
    player.turn(0.0, -8.0)
    player.row(Input(SELECT))
    player.turn(10.0, 13.0)
    player.row(Input(SELECT))
    hit, missed = player.trials
    assert (hit.error, missed.error) == (False, True)
    assert (hit.activations, missed.activations) == (1, 0)
    assert hit.max_rotation_deg == ()
    assert missed.max_rotation_deg == pytest.approx((math.hypot(10.0, 13.0),))  # a sequence ends its activation
    assert (hit.from_y, hit.to_y, hit.sel_y, hit.width_px, hit.amplitude_px) == pytest.approx((80, -80, -64, 40, 160))
    assert hit.movement_time_s == pytest.approx(0.02)
    assert math.isnan(hit.tolerance_px)
    assert math.isnan(hit.to_size)
    assert math.isnan(hit.zoom_path)


def test_each_sequence_has_a_clock_of_its_own() -> None:
    player = Player(Task(kind=RING), RING_TARGETS)
    player.press(1)
    for angles in ((0.0, 10.0), (0.0, -10.0), (10.0, 10.0), (5.0, 5.0), (0.0, 0.0), (5.0, 0.0)):
        player.turn(*angles)
    assert player.game.done
    assert [trial.movement_time_s for trial in player.trials] == pytest.approx([0.01, 0.01, 0.01])
    assert player.trials[2].t_start - player.trials[1].t_end == pytest.approx(0.02)
    assert {trial.selection for trial in player.trials} == {"first-entry"}
    assert sum(trial.activations for trial in player.trials) == sum(len(t.max_rotation_deg) for t in player.trials) == 2


def test_the_phases_and_the_words() -> None:
    game = Game(task(), dataclasses.replace(EXACT, latch=HOLD), TARGETS, Labels(practice=True))
    seen = [game.look()]
    rows = iter(range(1, 100))

    def after(*inputs: Input, angle: float = 0.0) -> None:
        for given in (inputs, (), (), ()):
            game.step(DT * next(rows), turned_in_sensor(LEVEL, radians(angle), 0.0, 0.0), STILL, -1, given)
        seen.append(game.look())

    after(Input("confirm"))
    after(Input("press", "pan"))
    after(angle=10.0)
    after(Input("release", "pan"), angle=10.0)
    after(Input("press", "zoom"), angle=10.0)
    after(Input("press", "clutch"), angle=10.0)
    after(Input("stop"), angle=10.0)
    assert [(look.phase, look.to_do) for look in seen] == [
        ("disarmed", "The view does not follow. Confirm to arm the controller."),
        ("ready", "Press to pan: right."),
        ("pan", "Right."),
        ("pan", "Stop panning, then zoom: larger."),
        ("waiting", "Press to zoom: larger."),
        ("zoom", "Larger."),
        ("clutched", "Let the clutch go to zoom: larger."),
        ("stopped", "Emergency stop. Reset, then confirm."),
    ]
    assert {look.phase for look in seen} <= set(PHASES)
    assert [look.tone for look in seen[-2:]] == ["neutral", "bad"]
    assert seen[3].position_ok
    assert not seen[3].matched
    assert seen[0].practice
    assert seen[0].tolerance_px == 9.0
    assert seen[-1].reason == "emergency stop"


def test_a_button_that_was_left_on_is_noticed() -> None:
    player = Player(task())
    player.status = 1
    player.game = Game(task(), EXACT, TARGETS)
    player.row(Input("confirm"))
    assert player.game.look().to_do == LEFT_ON
    player.press(0)
    assert player.game.look().phase == "ready"
    player.press(1)
    assert player.game.look().phase == "pan"


def test_a_refused_press_says_why() -> None:
    game = Game(task(), EXACT, TARGETS)
    game.step(0.0, LEVEL, STILL, -1, (Input("press", "pan"),))
    game.step(0.01, LEVEL, STILL, -1, (Input("release", "pan"),))
    assert game.look().message == "Pan button pressed: refused, disarmed."


@pytest.mark.parametrize("t", [nan, math.inf, 3.0])
def test_times_that_are_none_or_go_back_never_shorten_a_target(t: float) -> None:
    player = Player(task())
    player.press(1)
    before = player.game.look().elapsed_s
    player.game.step(t, LEVEL, STILL, 1)
    assert player.game.look().elapsed_s == before
    assert player.game.look().phase == "held"
    player.t = t if math.isfinite(t) else player.t
    player.wait(5)
    assert player.game.look().elapsed_s == pytest.approx(before + 0.05)


def test_a_gap_counts_as_idle() -> None:
    player = Player(task())
    player.press(1)
    player.turn(10.0)
    player.row(dt=5.0)  # belongs to the pan, which did not know better; then the view is held
    player.wait(10)
    player.press(0)
    player.press(2)
    player.turn(15.0)
    trial = player.trials[0]
    assert (trial.pan_time_s, trial.idle_time_s) == pytest.approx((5.03, 0.14))
    assert trial.pan_time_s + trial.zoom_time_s + trial.idle_time_s == pytest.approx(trial.movement_time_s)


def test_no_targets_no_run() -> None:
    with pytest.raises(ValueError, match="needs a target"):
        Game(task(), EXACT, ())
