"""What people can show, who meets what when, and that mirrored targets are as hard."""

from __future__ import annotations

import math
from collections import Counter
from itertools import pairwise

import numpy as np
import pytest

from imugui.targeting.design import SYMMETRIES, honesty, laid, people_for_balance, plan, shuffled, williams
from imugui.targeting.power import dz_needed, people_needed, power, smallest_p
from imugui.targeting.throughput import pan_difficulty


@pytest.mark.parametrize(
    ("n", "dz"), [(6, 1.43), (8, 1.16), (10, 1.00), (12, 0.89), (16, 0.75), (20, 0.66), (24, 0.60)]
)
def test_the_published_honesty_table(n: int, dz: float) -> None:
    assert round(dz_needed(n), 2) == dz
    assert power(n, dz_needed(n)) == pytest.approx(0.80, rel=1e-9)


@pytest.mark.parametrize(("n", "p"), [(1, 1.0), (4, 0.125), (5, 0.0625), (6, 0.03125), (8, 0.0078125)])
def test_the_smallest_p(n: int, p: float) -> None:
    assert smallest_p(n) == p


def test_power_is_what_a_simulated_study_has() -> None:
    random = np.random.default_rng(11)
    d = random.normal(1.0, 1.0, (40_000, 8))
    t = d.mean(axis=1) / (d.std(axis=1, ddof=1) / math.sqrt(8))
    assert power(8, 1.0) == pytest.approx(float((np.abs(t) > 2.364624).mean()), abs=0.01)


def test_power_without_an_effect_is_alpha_and_without_people_nothing() -> None:
    assert power(6, 0.0) == pytest.approx(0.05, rel=1e-9)
    assert power(1, 5.0) == 0.0
    assert math.isnan(dz_needed(1))


def test_people_needed_turns_the_table_round() -> None:
    assert [people_needed(dz) for dz in (1.4346, 1.0, 0.5)] == [6, 10, 34]
    assert people_needed(0.001, most=50) == 0


def test_two_conditions_are_ab_and_ba() -> None:
    assert williams(2) == ((0, 1), (1, 0))
    assert williams(1) == ((0,),)
    assert williams(4)[0] == (0, 1, 3, 2)


@pytest.mark.parametrize("k", range(2, 9))
def test_each_condition_stands_everywhere_and_after_each_other_equally_often(k: int) -> None:
    orders = williams(k)
    assert len(orders) == (k if k % 2 == 0 else 2 * k)
    assert all(sorted(order) == list(range(k)) for order in orders)
    places = Counter((place, one) for order in orders for place, one in enumerate(order))
    pairs = Counter(pair for order in orders for pair in pairwise(order))
    assert len(places) == k * k
    assert len(pairs) == k * (k - 1)
    assert len(set(places.values())) == len(set(pairs.values())) == 1


def test_a_study_without_conditions_is_refused() -> None:
    with pytest.raises(ValueError, match="condition"):
        williams(0)


@pytest.mark.parametrize("k", [2, 3, 4])
def test_every_order_meets_every_list_equally_often(k: int) -> None:
    people = [f"P{n}" for n in range(people_for_balance(k))]
    turns = plan(people, k)
    assert len(turns) == len(people) * k
    seen = Counter((turn.condition, turn.place, turn.targets) for turn in turns)
    assert len(seen) == k**3
    assert len(set(seen.values())) == 1
    for person in people:
        own = [turn for turn in turns if turn.participant == person]
        assert [turn.place for turn in own] == list(range(k))
        assert len({turn.targets for turn in own}) == k


def test_the_same_targets_for_all_need_fewer_people() -> None:
    assert {turn.targets for turn in plan("ABCD", 2, same_targets=True)} == {0}
    assert (people_for_balance(2), people_for_balance(2, same_targets=True)) == (4, 2)


def test_every_variant_of_a_list_is_as_hard_and_stays_on_the_field() -> None:
    centres = np.random.default_rng(5).uniform(-250.0, 250.0, (20, 2))
    seen = set()
    for variant in range(len(SYMMETRIES)):
        moved = laid(centres, variant)
        bits = [[pan_difficulty(float(d), 9.0) for d in np.hypot(*np.diff(xy, axis=0).T)] for xy in (centres, moved)]
        assert bits[1] == pytest.approx(bits[0], rel=1e-12)
        assert np.abs(moved).max() <= 250.0
        seen.add(tuple(moved[0].tolist()))
    assert len(seen) == 8
    assert laid(centres, 0).tolist() == centres.tolist()


def test_orders_of_sequences_are_fixed_by_seed_and_place() -> None:
    assert shuffled(9, 3, 1, 2) == shuffled(9, 3, 1, 2)
    assert len({shuffled(9, 3, person, block) for person in range(5) for block in range(3)}) == 15
    assert sorted(shuffled(9, 3)) == list(range(9))


def test_honest_words() -> None:
    six = " ".join(honesty(6, 2))
    assert "smallest possible p of the exact test is 0.031" in six
    assert "1.43 times" in six
    assert "no result can fall below" not in six
    assert "2 of the 6 are over" in six
    assert "no result can fall below 0.05, even if" in " ".join(honesty(5, 2))
    assert "Holm's correction for 3 comparisons" in " ".join(honesty(6, 3))
    assert not any("are over" in sentence for sentence in honesty(8, 2))
    assert "compares nothing" in honesty(1, 2)[0]
    assert "compares nothing" in honesty(9, 1)[0]
