"""The plan of a study, and the steps that follow from it."""

from __future__ import annotations

import json
from collections import Counter
from dataclasses import replace
from typing import Any

import pytest

from imugui.targeting.settings import PRESETS, Control
from imugui.targeting.study_plan import (
    ONE_ORDER,
    SAME,
    SIMULATED,
    WILLIAMS,
    StudyPlan,
    as_mapping,
    before_it_starts,
    codes,
    orders,
    plan_from,
    problems,
)
from imugui.targeting.study_steps import (
    PLAYED,
    PRACTICE,
    PREFERENCE,
    REST,
    RUN,
    SUS,
    TLX,
    game_of,
    place_words,
    setup_of,
    steps_of,
    targets_in_run,
    what_next,
)
from imugui.targeting.tasks import RING, Task

PLAN = StudyPlan(codes(6), name="pilot")
FOUR = {name: Control(gain=gain) for name, gain in (("a", 4.0), ("b", 8.0), ("c", 12.0), ("d", 16.0))}


def test_the_default_plan_has_two_mappings_and_nothing_wrong() -> None:
    assert problems(PLAN) == []
    assert {name: control.mapping for name, control in PLAN.conditions.items()} == {
        "position": "position",
        "speed": "speed",
    }


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"participants": ()}, "1 to 500 participants"),
        ({"participants": ("P01", "P02", "P01")}, "The code P01 is there twice."),
        ({"participants": ("Ada Lovelace",)}, "'Ada Lovelace' is no code"),
        ({"participants": ("P,1",)}, "is no code"),
        ({"name": "  "}, "A name of 1 to 60"),
        ({"conditions": {}}, "needs a condition"),
        ({"conditions": {"": Control(), "b": Control()}}, "Each condition has a name"),
        ({"conditions": {"a\nb": Control(), "b": Control()}}, "Each condition has a name"),
        ({"conditions": FOUR}, "AB/BA is for two conditions, and there are 4"),
        ({"conditions": {str(k): Control() for k in range(9)}, "order": WILLIAMS, "same_targets": False}, "At most 8"),
        ({"conditions": {"fast": Control(gain=1e6), "b": Control()}}, "fast: gain: 1000000.0 is outside"),
        ({"blocks": 0}, "blocks: 0 is outside 1 to 50"),
        ({"rest_s": float("nan")}, "rest_s: not a number"),
        ({"order": "random"}, "order: 'random' is none of"),
        ({"task": Task(targets=0)}, "targets: 0 is outside"),
        ({"task": Task(kind=RING, amplitude_high_px=560.0, width_high_px=200.0)}, "does not fit into the field"),
    ],
)
def test_what_is_wrong_with_a_plan_is_said(change: dict[str, Any], words: str) -> None:
    said = problems(replace(PLAN, **change))
    assert any(words in one for one in said), said


def test_every_second_person_begins_with_the_other_condition() -> None:
    met = orders(PLAN)
    assert [met[person] for person in PLAN.participants] == [["position", "speed"], ["speed", "position"]] * 3


def test_williams_orders_put_each_condition_equally_often_everywhere_and_after_each_other() -> None:
    plan = replace(PLAN, participants=codes(8), conditions=FOUR, order=WILLIAMS)
    met = list(orders(plan).values())
    assert {Counter(one[place] for one in met)[name] for place in range(4) for name in FOUR} == {2}
    after = Counter((one[k], one[k + 1]) for one in met for k in range(3))
    assert set(after.values()) == {2}
    assert len(after) == 12


def test_the_same_order_for_all_is_possible_and_its_price_is_named() -> None:
    plan = replace(PLAN, order=SAME)
    assert set(map(tuple, orders(plan).values())) == {("position", "speed")}
    said = before_it_starts(replace(plan, participants=codes(7)))
    assert said[-1] == ONE_ORDER
    assert not any("balanced" in one for one in said)


def test_before_it_starts_it_says_what_the_number_of_people_can_show() -> None:
    said = " ".join(before_it_starts(PLAN))
    assert "smallest possible p of the exact test is 0.031" in said
    assert "1.43 times as large as its spread" in said
    four = " ".join(before_it_starts(replace(PLAN, participants=codes(4))))
    assert "is 0.12" in four
    assert "no result can fall below 0.05" in four
    five = before_it_starts(replace(PLAN, participants=codes(5)))
    assert five[-1] == "Orders are balanced for 2 people or a multiple; 1 of the 5 are over."
    assert SIMULATED in before_it_starts(replace(PLAN, simulated=True))


def test_a_plan_comes_back_from_json_as_it_was() -> None:
    plan = replace(PLAN, conditions={"β, “quoted”": PRESETS["thesis speed"], "b": Control()}, tlx=True, seed=7)
    assert plan_from(json.loads(json.dumps(as_mapping(plan)))) == plan


@pytest.mark.parametrize(
    "change",
    [
        {"participants": "P01"},
        {"participants": [1]},
        {"conditions": None},
        {"conditions": {"position": {"gain": "high"}, "speed": {}}},
        {"task": {"kind": "maze"}},
        {"task": None},
        {"blocks": 0},
        {"seed": "one"},
    ],
)
def test_a_plan_that_is_not_whole_is_refused_not_completed(change: dict[str, Any]) -> None:
    with pytest.raises(ValueError, match=r"\w"):
        plan_from({**as_mapping(PLAN), **change})


def test_the_steps_of_a_person() -> None:
    plan = replace(PLAN, blocks=2, runs=2, tlx=True, sus=True)
    kinds = [step.kind for step in steps_of(plan, "P02")]
    one = [PRACTICE, REST, RUN, RUN, REST, RUN, RUN, TLX, SUS]
    assert kinds == [*one, REST, *one, PREFERENCE]
    steps = steps_of(plan, "P02")
    assert [step.number for step in steps] == list(range(len(steps)))
    assert [step.condition for step in steps if step.kind == TLX] == ["speed", "position"]
    assert steps_of(plan, "nobody") == ()


def test_no_practice_no_rests_no_questions() -> None:
    plan = replace(PLAN, practice_runs=0, rest_s=0.0, preference=False)
    assert [(step.kind, step.condition, step.block) for step in steps_of(plan, "P01")] == [
        (RUN, condition, block) for condition in ("position", "speed") for block in (1, 2, 3)
    ]


def test_nobody_is_asked_to_prefer_the_only_condition() -> None:
    plan = replace(PLAN, conditions={"only": Control()}, order=WILLIAMS)
    assert PREFERENCE not in {step.kind for step in steps_of(plan, "P01")}


def test_a_step_becomes_the_game_with_its_settings_and_labels() -> None:
    step = next(step for step in steps_of(PLAN, "P02") if step.block == 2 and step.kind == RUN)
    game = game_of(PLAN, step)
    labels = game.labels
    assert (labels.study, labels.participant, labels.condition) == ("pilot", "P02", "speed")
    assert (labels.block, labels.run, labels.practice) == (2, 1, False)
    assert game.controller.control == PLAN.conditions["speed"]
    practice = next(step for step in steps_of(PLAN, "P02") if step.kind == PRACTICE)
    assert game_of(PLAN, practice).labels.practice


def targets_by_condition(plan: StudyPlan, person: str) -> dict[tuple[str, int, int], tuple[Any, ...]]:
    played = [step for step in steps_of(plan, person) if step.kind in PLAYED]
    return {(step.condition, step.block, step.run): game_of(plan, step).targets for step in played}


def test_both_conditions_have_the_same_targets_and_no_two_runs_do() -> None:
    found = targets_by_condition(replace(PLAN, runs=2), "P01")
    assert len(set(found.values())) == len(found) // 2
    assert all(found["position", block, run] == found["speed", block, run] for _, block, run in found)


def test_lists_of_their_own_are_mirrored_and_change_places_between_people() -> None:
    plan = replace(PLAN, same_targets=False)
    first, third = (targets_by_condition(plan, person) for person in ("P01", "P03"))
    assert first["position", 1, 1] != first["speed", 1, 1]
    assert [one.amplitude for one in first["position", 1, 1]] == [one.amplitude for one in first["speed", 1, 1]]
    assert [one.size for one in first["position", 1, 1]] == [one.size for one in first["speed", 1, 1]]
    assert first["position", 1, 1] == third["speed", 1, 1]


def test_another_seed_has_other_targets() -> None:
    step = steps_of(PLAN, "P01")[0]
    assert setup_of(PLAN, step) != setup_of(replace(PLAN, seed=2), step)
    assert game_of(PLAN, step).targets != game_of(replace(PLAN, seed=2), step).targets


def test_what_comes_next_in_words() -> None:
    plan = replace(PLAN, runs=2, tlx=True, sus=True)
    steps = {(step.kind, step.block, step.run): step for step in reversed(steps_of(plan, "P01"))}
    assert what_next(plan, steps[PRACTICE, 0, 1]).startswith("Practice with “position”: 5 targets. It does not count")
    assert what_next(plan, steps[RUN, 2, 1]) == "Block 2 of 3, run 1 of 2 with “position”: 5 targets."
    assert what_next(plan, steps[REST, 2, 0]) == "Rest for 30 s. Then comes block 2 of 3."
    assert what_next(plan, steps[REST, 0, 0]) == "Rest for 30 s. Then comes practice with the next condition."
    assert what_next(plan, steps[TLX, 0, 0]) == "Six questions about the work load with “position”."
    assert what_next(plan, steps[SUS, 0, 0]) == "Ten sentences about “position”: how far do you agree?"
    assert what_next(plan, steps[PREFERENCE, 0, 0]).endswith("did you prefer “position” or “speed”?")
    assert what_next(plan, None) == "That was all. Thank you."
    assert place_words(plan, steps[RUN, 2, 1]) == "Block 2 of 3, run 1 of 2"
    assert place_words(PLAN, steps_of(PLAN, "P01")[0]) == "Practice"


def test_the_target_that_starts_a_ring_does_not_count() -> None:
    assert targets_in_run(PLAN) == 5
    assert targets_in_run(replace(PLAN, task=Task(kind=RING))) == 4 * 11
