"""Measures of a run: the thesis' and ours, by hand from a few trials."""

from __future__ import annotations

import csv
import dataclasses
import io
import math

import numpy as np
import pytest

from imugui.targeting.measures import MEASURES, Run, measure, runs_csv, runs_of
from imugui.targeting.sequences import NOMINAL, effective, nominal_bits, outlier_flags, run_throughput
from imugui.targeting.throughput import pan_difficulty, ring, throughput, zoom_difficulty
from imugui.targeting.trials import Trial

TIMES = (0.9, 0.95, 0.87, 1.01, 0.99, 0.93, 0.88, 1.02, 0.94, 0.91, 0.96)
ERRORS = (1.0, -2.0, 0.5, 3.0, -1.5, 0.0, 2.5, -3.0, 1.5, -0.5, 2.0)


def ring_trials(diameter: float = 200.0, width: float = 20.0, errors: tuple[float, ...] = ERRORS) -> list[Trial]:
    """TV-A1 as trials that were confirmed by button."""
    centres = ring(11, diameter)
    found, t = [], 5.0
    for k, (time, error) in enumerate(zip(TIMES, errors, strict=True)):
        start, goal = centres[k], centres[k + 1]
        a = float(np.hypot(*(goal - start)))
        end = goal + (goal - start) / a * error
        found.append(
            Trial(
                "s", "P1", "position", 1, False, 2, k, "ring", "button",
                from_x=start[0], from_y=start[1], to_x=goal[0], to_y=goal[1], sel_x=end[0], sel_y=end[1],
                width_px=width, amplitude_px=a, t_start=t, t_end=t + time, movement_time_s=time, path_px=1.25 * a,
                error=abs(error) > 0.5 * width,
            )
        )  # fmt: skip
        t += time
    return found


GAME = [
    Trial(
        "s", "P1", "speed", 1, index=0, from_x=0.0, from_y=0.0, from_size=200.0, to_x=60.0, to_y=80.0, to_size=100.0,
        tolerance_px=9.0, sel_x=57.0, sel_y=76.0, sel_size=104.0, t_start=10.0, t_end=14.0, movement_time_s=4.0,
        pan_time_s=2.0, zoom_time_s=1.5, idle_time_s=0.5, activations=2, clutches=1, overshoots=1, path_px=190.0,
        zoom_path=1.0, min_deg=(-5.0, -2.0, 0.0), max_deg=(3.0, 9.0, 0.5), max_rotation_deg=(9.0, 5.0),
    ),
    Trial(
        "s", "P1", "speed", 1, index=1, from_x=60.0, from_y=80.0, from_size=100.0, to_x=60.0, to_y=-20.0,
        to_size=200.0, tolerance_px=9.0, sel_x=60.0, sel_y=-15.0, sel_size=195.0, t_start=14.0, t_end=17.0,
        movement_time_s=3.0, pan_time_s=1.0, zoom_time_s=1.0, idle_time_s=1.0, activations=3, path_px=95.0,
        zoom_path=math.log(2.0), min_deg=(-1.0, -12.0, -4.0), max_deg=(2.0, 1.0, 0.0),
        max_rotation_deg=(12.0, 2.0, 1.0),
    ),
]  # fmt: skip


def test_the_measures_of_the_thesis_under_its_names() -> None:
    run = measure(GAME)
    assert run.elapsed_time_s == 7.0
    assert (run.min_angle_x_deg, run.min_angle_y_deg, run.min_angle_z_deg) == (-5.0, -12.0, -4.0)
    assert (run.max_angle_x_deg, run.max_angle_y_deg, run.max_angle_z_deg) == (3.0, 9.0, 0.5)
    assert run.activations == 5
    assert run.mean_largest_rotation_deg == pytest.approx((9 + 5 + 12 + 2 + 1) / 5)
    titles = {one.title for one in MEASURES.values() if one.thesis}
    assert {"Elapsed time", "Activations (button clicks)", "Mean of the largest rotation per activation"} <= titles
    assert {f"{side} angle about {axis}" for side in ("Minimum", "Maximum") for axis in "xyz"} <= titles


def test_our_measures() -> None:
    run = measure(GAME)
    assert run.movement_time_s == 3.5
    assert (run.clutches, run.overshoots, run.error_percent) == (1, 0.5, 0.0)
    assert (run.pan_time_s, run.zoom_time_s, run.idle_time_s) == (3.0, 2.5, 1.5)
    assert run.path_efficiency == pytest.approx((95.0 + 95.0) / (190.0 + 95.0))
    zooms = math.log(200.0 / 104.0) + math.log(195.0 / 100.0)
    assert run.zoom_efficiency == pytest.approx(zooms / (1.0 + math.log(2.0)))


def test_automatic_selection_has_a_nominal_throughput_only_and_says_so() -> None:
    run = measure(GAME)
    bits = [pan_difficulty(100.0, 9.0) + zoom_difficulty(a, b, 9.0) for a, b in ((200.0, 100.0), (100.0, 200.0))]
    assert [nominal_bits(trial) for trial in GAME] == pytest.approx(bits)
    assert run.nominal_throughput == pytest.approx(sum(bits) / 7.0)
    assert math.isnan(run.throughput)
    assert math.isnan(run.throughput_all)
    assert run.throughput_word == NOMINAL


def test_a_ring_has_the_throughput_of_its_sequence() -> None:
    run = measure(ring_trials())
    assert run.throughput == pytest.approx(4.985747902, rel=1e-9)
    assert run.throughput_all == run.throughput
    assert (run.sequences, run.outliers, run.throughput_word) == (1, (), "")
    nominal = math.log2(197.964288376 / 20.0 + 1.0) / 0.941818182
    assert run.nominal_throughput == pytest.approx(nominal, rel=1e-9)


def test_sequences_are_never_pooled_their_throughputs_are_averaged() -> None:
    small, large = ring_trials(100.0, 20.0), ring_trials(200.0, 40.0)
    run = measure([*small, *large])
    single = [measure(one).throughput for one in (small, large)]
    assert run.sequences == 2
    assert single[0] != pytest.approx(single[1], rel=0.05)
    assert run.throughput == pytest.approx(sum(single) / 2, rel=1e-12)


def test_an_outlier_is_flagged_kept_and_left_out_of_one_figure() -> None:
    errors = (*ERRORS[:5], -150.0, *ERRORS[6:])
    trials = ring_trials(errors=errors)
    run = measure(trials)
    assert np.flatnonzero(outlier_flags(trials)).tolist() == [5]
    assert run.outliers == (5,)
    assert run.throughput > 2.0 * run.throughput_all
    assert run.targets == 11
    assert run.error_percent == pytest.approx(100.0 / 11)


def confirmed_game(n: int = 8, zoom: bool = True, pan: bool = True) -> list[Trial]:
    random = np.random.default_rng(8)
    places = random.uniform(-200.0, 200.0, (n + 1, 2)) if pan else np.zeros((n + 1, 2))
    sizes = np.where(np.arange(n + 1) % 2, 90.0, 180.0) if zoom else np.full(n + 1, 100.0)
    ends, last = places[1:] + random.normal(0.0, 4.0, (n, 2)), sizes[1:] + random.normal(0.0, 3.0, n)
    return [
        Trial(
            index=k, task="fov", selection="button", from_x=places[k, 0], from_y=places[k, 1], from_size=sizes[k],
            to_x=places[k + 1, 0], to_y=places[k + 1, 1], to_size=sizes[k + 1], tolerance_px=9.0, sel_x=ends[k, 0],
            sel_y=ends[k, 1], sel_size=last[k], movement_time_s=2.0 + 0.1 * k,
        )
        for k in range(n)
    ]  # fmt: skip


def parts(trials: list[Trial]) -> tuple[float, float, float]:
    """Effective bits of pan and zoom by the formulas, and the mean time."""
    xy = [np.array([(getattr(t, f"{e}_x"), getattr(t, f"{e}_y")) for t in trials]) for e in ("from", "to", "sel")]
    logs = [np.log([getattr(t, f"{e}_size") for t in trials]) for e in ("from", "to", "sel")]
    found = []
    for start, goal, end in (xy, [np.column_stack((one, 0 * one)) for one in logs]):
        way = goal - start
        a = np.hypot(*way.T)
        dx = ((end - goal) * way).sum(axis=1) / a
        found.append(math.log2((a + dx).mean() / (math.sqrt(2 * math.pi * math.e) * dx.std(ddof=1)) + 1.0))
    return found[0], found[1], float(np.mean([t.movement_time_s for t in trials]))


def test_bits_of_pan_and_zoom_add_up_when_the_game_is_confirmed_by_hand() -> None:
    trials = confirmed_game()
    pan, zoom, time = parts(trials)
    assert run_throughput(trials).effective == pytest.approx((pan + zoom) / time, rel=1e-9)
    assert run_throughput(trials).word == ""


def test_a_game_without_zoom_or_without_pan_counts_the_other() -> None:
    pan, _, time = parts(confirmed_game())
    flat = confirmed_game(zoom=False)
    assert run_throughput(flat).effective == pytest.approx(pan / time, rel=1e-9)
    still = confirmed_game(pan=False)
    keep = ~outlier_flags(still)
    found = effective(still, keep)
    logs = [
        np.column_stack((np.log([getattr(t, f"{e}_size") for t in still]), np.zeros(8))) for e in ("from", "to", "sel")
    ]
    expected = throughput(*logs, [t.movement_time_s for t in still], 1.0, serial=False)
    assert found.bits_per_s == pytest.approx(expected.bits_per_s, rel=1e-9)


def test_a_size_that_was_never_set_is_an_outlier() -> None:
    trials = confirmed_game()
    trials[2] = dataclasses.replace(trials[2], sel_size=trials[2].from_size)
    assert np.flatnonzero(outlier_flags(trials)).tolist() == [2]


def test_a_run_with_too_few_targets_says_why_it_has_no_throughput() -> None:
    found = run_throughput(confirmed_game(2))
    assert math.isnan(found.effective)
    assert found.word == "n/a: fewer than 3 trials"
    assert math.isfinite(found.nominal)


def test_unknown_values_stay_unknown() -> None:
    run = measure([Trial(participant="P1", condition="speed")])
    for name in MEASURES:
        value = getattr(run, name)
        assert math.isnan(value) or value == 0
    assert math.isnan(run.elapsed_time_s)
    assert math.isnan(run.nominal_throughput)


def test_times_that_are_not_above_zero_do_not_count() -> None:
    trials = [dataclasses.replace(GAME[0], movement_time_s=-1.0), GAME[1]]
    assert measure(trials).movement_time_s == 3.0


def test_runs_are_told_apart_in_their_order() -> None:
    practice = [dataclasses.replace(one, practice=True, block=0) for one in GAME]
    runs = runs_of([*practice, *GAME, *ring_trials()])
    assert [(run.condition, run.practice, run.targets) for run in runs] == [
        ("speed", True, 2),
        ("speed", False, 2),
        ("position", False, 11),
    ]


def test_the_same_trials_give_the_same_bits() -> None:
    trials = [*GAME, *ring_trials(), *confirmed_game()]
    assert repr(runs_of(trials)) == repr(runs_of(list(trials)))


def test_the_table_of_runs_has_every_digit() -> None:
    runs = runs_of([*GAME, *ring_trials(errors=(*ERRORS[:5], -150.0, *ERRORS[6:]))])
    rows = list(csv.DictReader(io.StringIO(runs_csv(runs))))
    assert list(rows[0]) == [one.name for one in dataclasses.fields(Run)]
    assert float(rows[1]["throughput"]) == runs[1].throughput
    assert rows[0]["throughput"] == ""
    assert rows[1]["outliers"] == "5"
    assert rows[0]["practice"] == "0"
