"""Targets: the same difficulty from every seed, inside the field, and refused in words where they do not fit."""

from __future__ import annotations

import math
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from imugui.targeting.design import SYMMETRIES
from imugui.targeting.tasks import (
    BUTTON,
    DWELL,
    PRESETS,
    RING,
    Target,
    Task,
    matches,
    pan_bits,
    problems,
    sequences,
    target_list,
    zoom_bits,
)
from imugui.targeting.throughput import pan_difficulty, zoom_difficulty
from imugui.targeting.view_pose import FIELD_PX, View


def bits(task: Task, seed: int, variant: int) -> tuple[list[float], list[float]]:
    """Bits of each pan and of each zoom of a list, from its own places and sizes."""
    course = [Target(*task.start_view), *target_list(task, seed, variant)]
    pans = [pan_difficulty(math.dist(a[:2], b[:2]), task.tolerance_px) for a, b in pairwise(course)]
    return pans, [zoom_difficulty(a.size, b.size, task.tolerance_px) for a, b in pairwise(course)]


@given(st.integers(0, 2**31), st.integers(0, len(SYMMETRIES) - 1), st.sampled_from([1, 5, 12]))
def test_every_list_has_the_same_steps_in_another_order(seed: int, variant: int, n: int) -> None:
    task = Task(targets=n)
    pans, zooms = bits(task, seed, variant)
    assert sorted(pans) == pytest.approx(pan_bits(task), abs=1e-9)
    assert sorted(zooms) == pytest.approx(zoom_bits(task), abs=1e-9)


@given(st.integers(0, 2**31), st.integers(0, len(SYMMETRIES) - 1))
def test_targets_are_inside_the_field_and_the_ranges(seed: int, variant: int) -> None:
    task = Task()
    for target in target_list(task, seed, variant):
        assert max(abs(target.x), abs(target.y)) + 0.5 * target.size <= 0.5 * FIELD_PX
        assert task.size_low_px - 1e-9 <= target.size <= task.size_high_px + 1e-9
        assert task.pan_low_px - 1e-9 <= target.amplitude <= task.pan_high_px + 1e-9


def test_the_seed_decides() -> None:
    assert target_list(Task(), 3) == target_list(Task(), 3)
    assert target_list(Task(), 3) != target_list(Task(), 4)


def test_a_variant_is_the_list_mirrored_or_turned() -> None:
    plain, laid = target_list(Task(), 3), target_list(Task(), 3, 5)  # a quarter turn
    assert [(-one.y, one.x, one.size) for one in plain] == [one[:3] for one in laid]


def test_a_ring_jumps_by_its_amplitude_and_comes_back() -> None:
    task = PRESETS["ring, button"]
    targets = target_list(task, 1)
    assert len(targets) == 4 * (task.ring_targets + 1)
    found = set()
    for number in range(4):
        ring = [one for one in targets if one.sequence == number]
        assert ring[0].start
        assert not any(one.start for one in ring[1:])
        assert ring[0][:2] == pytest.approx(ring[-1][:2])
        assert [math.dist(a[:2], b[:2]) for a, b in pairwise(ring)] == pytest.approx([ring[1].amplitude] * 11)
        found.add((round(ring[1].amplitude), round(ring[1].size)))
    assert found == {(round(a), round(w)) for a, w in sequences(task)} == {(200, 30), (200, 60), (400, 30), (400, 60)}


def test_the_order_of_the_sequences_is_one_of_chance() -> None:
    orders = {tuple(one.size for one in target_list(PRESETS["ring, dwell"], seed) if one.start) for seed in range(20)}
    assert len(orders) > 3


@pytest.mark.parametrize(
    ("task", "words"),
    [
        (Task(pan_high_px=600.0), "fit into the field"),
        (Task(tolerance_px=80.0), "fit into the field"),
        (Task(kind=RING, ring_targets=10), "an odd number"),
        (Task(kind=RING, amplitude_high_px=560.0, width_high_px=100.0), "needs"),
    ],
)
def test_what_does_not_fit_is_said(task: Task, words: str) -> None:
    assert words in problems(task)[0]
    with pytest.raises(ValueError, match=words):
        target_list(task, 0)


@pytest.mark.parametrize("name", PRESETS)
def test_the_presets_fit(name: str) -> None:
    assert problems(PRESETS[name]) == []


@pytest.mark.parametrize("n", [40, 100])
def test_long_runs_fit_too(n: int) -> None:
    assert len(target_list(Task(targets=n), 0)) == n


@pytest.mark.parametrize(
    ("view", "expected"),
    [
        (View(59.0, 21.0, 109.0), (True, True)),
        (View(59.1, 30.0, 100.0), (False, True)),
        (View(50.0, 20.9, 90.9), (False, False)),
    ],
)
def test_the_game_matches_within_a_square(view: View, expected: tuple[bool, bool]) -> None:
    assert matches(Task(), Target(50.0, 30.0, 100.0), view) == expected


def test_a_ring_matches_within_its_circle_whatever_the_size() -> None:
    target, task = Target(50.0, 30.0, 20.0), Task(kind=RING)
    assert matches(task, target, View(56.0, 38.0, 500.0)) == (True, True)
    assert matches(task, target, View(58.0, 37.0, 500.0)) == (False, True)


def test_words_and_widths() -> None:
    assert [task.selection_word for task in PRESETS.values()] == ["auto", BUTTON, BUTTON, DWELL, "first-entry"]
    assert Task().width(Target(0.0, 0.0, 50.0)) == 18.0
    assert Task(kind=RING).width(Target(0.0, 0.0, 50.0)) == 50.0
    assert Task().start_view == View(0.0, 0.0, 120.0)
