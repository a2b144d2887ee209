"""A study's figures, computed again from the raw trials by other means, and its report."""

from __future__ import annotations

import dataclasses
import math
import re
from datetime import UTC, datetime
from xml.etree import ElementTree

import numpy as np
import pytest

from imugui.calibration.certificate import NOTE
from imugui.targeting.measures import MEASURES
from imugui.targeting.questionnaires import Answer
from imugui.targeting.results import PRIMARY, Results, compare, p_text, results, sentence
from imugui.targeting.results_plots import learning_svg, paired_svg, ratios_svg
from imugui.targeting.results_report import report_html
from imugui.targeting.throughput import ring
from imugui.targeting.trials import Trial, read_trials, trials_csv

NOW = datetime(2026, 11, 20, 12, 0, tzinfo=UTC)
EVIL = "<script>alert('x')</script>&\"'"
SLOWNESS = (1.0, 1.5, 1.2)


def study(
    people: int = 6, names: tuple[str, ...] = ("position", "speed"), blocks: int = 3, selection: str = "button"
) -> list[Trial]:
    """Rings of 11 in AB and BA order with a practice block, times that fall over the blocks, and seeded noise."""
    random, trials = np.random.default_rng(6), []
    centres = ring(11, 400.0)
    for person in range(people):
        skill, t = math.exp(random.normal(0.0, 0.2)), 0.0
        for place in range(len(names)):
            k = (place + person) % len(names)
            for block in range(blocks + 1):
                for index in range(11):
                    start, goal = centres[index], centres[index + 1]
                    end = goal + random.normal(0.0, 8.0, 2)
                    time = skill * SLOWNESS[k] * (block + 1) ** -0.3 * math.exp(random.normal(0.0, 0.1))
                    trials.append(
                        Trial(
                            "pilot", f"P{person + 1}", names[k], block, block == 0, block, index, "ring", selection,
                            from_x=start[0], from_y=start[1], to_x=goal[0], to_y=goal[1], sel_x=end[0], sel_y=end[1],
                            width_px=50.0, amplitude_px=float(np.hypot(*(goal - start))), t_start=t, t_end=t + time,
                            movement_time_s=time, pan_time_s=time, activations=1 + index % 2, path_px=450.0,
                            overshoots=int(random.integers(0, 2)), max_rotation_deg=(float(random.uniform(5, 20)),),
                        )
                    )  # fmt: skip
                    t += time
    return trials


@pytest.fixture(scope="module")
def pilot() -> Results:
    said = [Answer(f"P{k}", c, "tlx", (5 * k,) * 6) for k in range(1, 7) for c in ("position", "speed")]
    said += [Answer(f"P{k}", "speed" if k < 3 else "position", "preference") for k in range(1, 7)]
    return results(study(), answers=said)


def by_hand(trials: list[Trial], person: str, condition: str) -> float:
    """Mean over the blocks, on the logarithm, of the mean movement time of a block."""
    own = [one for one in trials if (one.participant, one.condition, one.practice) == (person, condition, False)]
    blocks = sorted({one.block for one in own})
    return float(np.mean([np.log(np.mean([one.movement_time_s for one in own if one.block == b])) for b in blocks]))


def test_the_first_comparison_is_that_of_the_raw_trials(pilot: Results) -> None:
    trials = study()
    logs = np.array([[by_hand(trials, f"P{k}", c) for c in ("position", "speed")] for k in range(1, 7)])
    d = logs[:, 1] - logs[:, 0]
    first = pilot.comparisons[0]
    assert (first.measure, first.a, first.b) == (PRIMARY, "position", "speed")
    assert first.people == tuple(f"P{k}" for k in range(1, 7))
    assert first.ratio.ratio == pytest.approx(math.exp(d.mean()), rel=1e-9)
    half = 2.570581835636314 * d.std(ddof=1) / math.sqrt(6)
    assert (first.ratio.low, first.ratio.high) == pytest.approx((math.exp(d.mean() - half), math.exp(d.mean() + half)))
    assert 1.4 < first.ratio.ratio < 1.6
    assert first.permutation.p == first.adjusted_p == first.wilcoxon.p == 0.03125
    # AB is P1, P3, P5
    effect = (-d[0::2].mean() - d[1::2].mean()) / 2
    period = (-d[0::2].mean() + d[1::2].mean()) / 2
    assert (first.crossover.n_ab, first.crossover.n_ba) == (3, 3)
    assert (first.crossover.effect.value, first.crossover.period.value) == pytest.approx((effect, period))


def test_throughput_is_a_mean_of_means(pilot: Results) -> None:
    found = next(one for one in pilot.comparisons if one.measure == "throughput")
    own = [
        run.throughput for run in pilot.runs if (run.participant, run.condition, run.practice) == ("P1", "speed", False)
    ]
    assert len(own) == 3
    assert found.values_b[0] == pytest.approx(sum(own) / 3, rel=1e-12)
    assert found.ratio.ratio < 1.0


def test_learning_is_fitted_to_the_means_of_the_blocks(pilot: Results) -> None:
    position = pilot.learning[0]
    assert position.blocks == (1, 2, 3)
    assert len(position.people) == len(position.values) == 6
    own = [r for r in pilot.runs if r.condition == "position" and r.block == 1]
    assert position.means[0] == pytest.approx(math.exp(np.mean([math.log(run.movement_time_s) for run in own])))
    # blocks 2, 3, 4 of a power law with exponent 0.3, counted from 1 again
    assert 0.1 < position.curve.exponent < 0.3
    assert position.curve.rate < 1.0


def test_the_settled_blocks_are_compared_once_more() -> None:
    trials = [
        dataclasses.replace(one, movement_time_s=one.movement_time_s * (5.0 if one.block == 1 else 1.0))
        for one in study(blocks=4)
    ]
    found = results(trials)
    late = [one for one in trials if one.block - 1 >= found.settled_from]
    assert found.settled_from >= 1
    again = results(late, conditions=("position", "speed"))
    assert found.settled[0].ratio == again.comparisons[0].ratio
    assert found.settled[0].values_a != found.comparisons[0].values_a


def test_practice_is_left_out_of_everything_but_the_list_of_runs(pilot: Results) -> None:
    slow = [dataclasses.replace(one, movement_time_s=99.0) if one.practice else one for one in study()]
    assert results(slow).comparisons[0] == pilot.comparisons[0]
    assert sum(run.practice for run in pilot.runs) == 12
    assert any("132 practice targets are left out" in note for note in pilot.notes)


def test_the_notes_say_what_the_study_can_show_and_what_was_dropped(pilot: Results) -> None:
    notes = " ".join(pilot.notes)
    assert "smallest possible p of the exact test is 0.031" in notes
    assert "0 of 396 selections are outliers" in notes
    automatic = " ".join(results(study(selection="dwell")).notes)
    assert "Throughput is nominal: the game selects by itself" in automatic
    assert "(in 36 of 36 runs)" in automatic


def test_three_conditions_are_compared_in_pairs_and_corrected() -> None:
    found = results(study(names=("position", "speed", "mixed")))
    primary = [one for one in found.comparisons if one.measure == PRIMARY]
    assert [(one.a, one.b) for one in primary] == [("position", "speed"), ("position", "mixed"), ("speed", "mixed")]
    assert [one.permutation.p for one in primary] == [0.03125] * 3
    assert [one.adjusted_p for one in primary] == [0.09375] * 3
    assert "p = 0.094 after Holm" in sentence(primary[0])


def test_a_person_who_lacks_a_condition_is_named_and_not_compared() -> None:
    trials = [one for one in study() if (one.participant, one.condition) != ("P2", "speed")]
    found = results(trials)
    assert found.comparisons[0].people == ("P1", "P3", "P4", "P5", "P6")
    assert "Not all conditions were met by: P2." in found.notes


def test_conditions_and_orders_can_be_given() -> None:
    orders = {f"P{k}": ("speed", "position") for k in range(1, 7)}
    found = results(study(), conditions=("speed", "position"), orders=orders)
    assert (found.comparisons[0].a, found.comparisons[0].b) == ("speed", "position")
    assert (found.comparisons[0].crossover.n_ab, found.comparisons[0].crossover.n_ba) == (6, 0)
    assert "both orders" in found.comparisons[0].crossover.word


def test_a_measure_with_zeros_is_compared_by_differences() -> None:
    found = results(study()).runs
    scored = [run for run in found if not run.practice]
    zeros = [dataclasses.replace(run, pan_time_s=0.0) if run.condition == "speed" else run for run in scored]
    one = compare(zeros, "position", "speed", "pan_time_s")
    assert not one.geometric
    assert math.isnan(one.ratio.ratio)
    assert one.paired.mean < 0.0
    assert "against position" in sentence(one)
    assert not compare(scored, "position", "speed", "overshoots").geometric


def test_the_same_trials_read_from_their_table_give_the_same_results(pilot: Results) -> None:
    back, problems = read_trials(trials_csv(study()))
    assert problems == []
    assert repr(results(back, answers=pilot.answers)) == repr(pilot)


@pytest.mark.parametrize("n", [0, 1, 12, 44, 88])
def test_any_beginning_of_a_study_has_results_and_a_page(n: int) -> None:
    page = report_html(results(study()[:n]), NOW)
    parsed(page)
    if n < 88:
        assert "nothing to compare" in page


def test_a_sentence_leads_with_the_effect(pilot: Results) -> None:
    said = sentence(pilot.comparisons[0])
    found = pilot.comparisons[0].ratio
    assert said.startswith(f"Movement time per target with speed is {found.ratio:.2f} times that with position")
    assert f"95 % limits {found.low:.2f} to {found.high:.2f}; p = 0.031, 6 people" in said
    assert (p_text(0.00001), p_text(0.25), p_text(math.nan)) == ("below 0.0001", "0.25", "n/a")


def parsed(page: str) -> ElementTree.Element:
    """The elements of a page; fails when a tag is left open."""
    text = page.replace("<!DOCTYPE html>", "").replace('<meta charset="utf-8">', "")
    return ElementTree.fromstring(text)  # noqa: S314  (made by ourselves a line before)


def test_the_page_is_whole_and_self_contained(pilot: Results) -> None:
    page = report_html(pilot, NOW)
    assert not re.search(r"https?://(?!www\.w3\.org/2000/svg)|<script|<link|<img|@import|url\(", page)
    assert NOTE in page
    assert "Made 2026-11-20 12:00" in page
    root = parsed(page)
    headings = [one.text for one in root.iter("h2")]
    assert headings[:3] == ["Effect", "Person by person", "How far to trust it"]
    assert {"Learning", "Order", "What people said", "Runs: measures of the thesis", "Runs: our measures"} <= set(
        headings
    )
    text = " ".join(root.itertext())
    assert sentence(pilot.comparisons[0]) in text
    assert all(note in text for note in pilot.notes)
    # each run is in both of the tables of runs
    assert len(list(root.iter("tr"))) >= 2 * len(pilot.runs)
    assert page.index("with speed is") < page.index("<table")


def test_every_measure_that_is_known_is_in_the_table(pilot: Results) -> None:
    text = " ".join(parsed(report_html(pilot, NOW)).itertext())
    for name in {one.measure for one in pilot.comparisons}:
        assert MEASURES[name].title in text
    assert "Zoom efficiency" not in text


@pytest.mark.parametrize("place", ["study", "participant", "condition"])
def test_text_from_outside_is_escaped(place: str) -> None:
    trials = [dataclasses.replace(one, **{place: EVIL + str(getattr(one, place))}) for one in study(people=3)]
    said = [Answer(trials[0].participant, trials[0].condition, "sus", (3,) * 10)]
    page = report_html(results(trials, answers=said), NOW)
    assert "<script" not in page
    assert "&lt;script&gt;" in page
    parsed(page)


def svg_of(text: str) -> ElementTree.Element:
    return ElementTree.fromstring(text)  # noqa: S314  (made by ourselves)


def names_in(root: ElementTree.Element) -> list[str]:
    return [one.tag.rpartition("}")[2] for one in root.iter()]


def test_the_picture_of_people_has_a_mark_for_each_person_and_condition(pilot: Results) -> None:
    root = svg_of(paired_svg(pilot.comparisons[0]))
    assert (names_in(root).count("circle"), names_in(root).count("rect")) == (6, 6)
    other = svg_of(paired_svg(pilot.comparisons[0], (2, 0)))
    assert (names_in(other).count("circle"), names_in(other).count("path")) == (6, 6)


def test_the_picture_of_ratios_has_a_row_for_each_ratio_and_its_figures(pilot: Results) -> None:
    shown = [one for one in pilot.comparisons if one.geometric and math.isfinite(one.ratio.low)]
    root = svg_of(ratios_svg(pilot.comparisons))
    assert names_in(root).count("circle") == len(shown)
    text = " ".join(root.itertext())
    for one in shown:
        assert f"{one.ratio.ratio:.2f} ({one.ratio.low:.2f} to {one.ratio.high:.2f})" in text
    spots = [float(one.get("cx", "nan")) for one in root.iter() if one.tag.endswith("circle")]
    ratios = [one.ratio.ratio for one in shown]
    right_of = [(i, j) for i in range(len(shown)) for j in range(len(shown)) if ratios[i] > 1.01 * ratios[j]]
    assert len(right_of) > 3
    assert all(spots[i] > spots[j] for i, j in right_of)
    assert ratios_svg([]) == ""


def test_the_picture_of_learning_has_a_mark_for_each_block_and_one_in_the_legend(pilot: Results) -> None:
    root = svg_of(learning_svg(pilot.learning, "Movement time", "s"))
    assert (names_in(root).count("circle"), names_in(root).count("rect")) == (3 + 1, 3 + 1)
    # six people, a fit and the means, for both conditions
    assert names_in(root).count("polyline") == 2 * (6 + 2)
    assert learning_svg([], "Movement time", "s") == ""


def test_everything_that_is_drawn_lies_inside_its_picture(pilot: Results) -> None:
    pictures = (ratios_svg(pilot.comparisons), paired_svg(pilot.comparisons[0]), learning_svg(pilot.learning, "T", "s"))
    for picture in pictures:
        root = svg_of(picture)
        _, _, width, height = map(float, root.get("viewBox", "").split())
        for one in root.iter():
            for across, up in (("x", "y"), ("cx", "cy"), ("x1", "y1"), ("x2", "y2")):
                if one.get(across):
                    assert 0.0 <= float(one.get(across, "nan")) <= width
                    assert 0.0 <= float(one.get(up, "nan")) <= height
