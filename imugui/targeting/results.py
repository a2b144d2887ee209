"""What a study found: conditions compared over its people, with everything a reader needs to doubt it.

The first figure is the ratio of geometric means with its 95 % limits; then come the exact test, the people one by one,
order and learning. Practice is left out. Every number follows from the trials alone.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from imugui.fusion.quaternion import Floats
from imugui.targeting.crossover import Crossover, crossover
from imugui.targeting.design import honesty
from imugui.targeting.learning import LearningCurve, learning_curve
from imugui.targeting.measures import MEASURES, Run, runs_of
from imugui.targeting.questionnaires import Answer
from imugui.targeting.sequences import mean_known
from imugui.targeting.statistics import (
    ExactTest,
    Paired,
    Ratio,
    differences,
    holm,
    paired,
    ratio,
    sign_flips,
    wilcoxon,
)
from imugui.targeting.trials import Trial

PRIMARY = "movement_time_s"
FEWEST_PEOPLE = 2
"""To say anything of people who did not take part."""

Orders = Mapping[str, Sequence[str]]
"""Which conditions a person met, in their order."""


@dataclass(frozen=True)
class Comparison:
    """Condition b against a in one measure, for the people who have both."""

    measure: str
    a: str
    b: str
    people: tuple[str, ...]
    values_a: tuple[float, ...]
    values_b: tuple[float, ...]
    ratio: Ratio
    paired: Paired
    permutation: ExactTest  # on the logarithms where there is a ratio
    wilcoxon: ExactTest
    crossover: Crossover  # A - B; on the logarithms where there is a ratio
    geometric: bool  # there is a ratio; else only the differences count
    adjusted_p: float = math.nan  # Holm, over all pairs of conditions in this measure


@dataclass(frozen=True)
class Learning:
    """One condition over the blocks, for the people who have all of them."""

    condition: str
    blocks: tuple[int, ...]
    people: tuple[str, ...]
    values: tuple[tuple[float, ...], ...]  # by person and block
    means: tuple[float, ...]  # geometric, by block
    curve: LearningCurve


@dataclass(frozen=True)
class Results:
    """A study in figures."""

    study: str
    conditions: tuple[str, ...]
    people: tuple[str, ...]
    runs: tuple[Run, ...]  # practice too
    comparisons: tuple[Comparison, ...]  # the primary measure of every pair of conditions first
    settled: tuple[Comparison, ...]  # the primary measure once more, on the blocks after learning
    settled_from: int  # place of the first of these blocks, counted from 0
    learning: tuple[Learning, ...]
    answers: tuple[Answer, ...]
    notes: tuple[str, ...]


def results(
    trials: Sequence[Trial],
    conditions: Sequence[str] = (),
    orders: Orders | None = None,
    answers: Iterable[Answer] = (),
    same_targets: bool = False,
) -> Results:
    """Compare the conditions of a study, by default all in the order in which they first appear.

    Without ``orders`` the order of a person's conditions is that of the trials. ``same_targets``: every condition had
    the same target list, so that lists need no balance.
    """
    named = tuple(conditions) or tuple(dict.fromkeys(trial.condition for trial in trials))
    runs = runs_of(trial for trial in trials if trial.condition in named)
    scored = [run for run in runs if not run.practice]
    people = tuple(dict.fromkeys(run.participant for run in scored))
    orders = orders or _orders(runs)
    learned = tuple(learning(scored, condition) for condition in named)
    start = settled_from(learned)
    places = {one.condition: one.blocks for one in learned}
    late = [run for run in scored if places[run.condition].index(run.block) >= start]
    return Results(
        next((trial.study for trial in trials), ""),
        named,
        people,
        tuple(runs),
        tuple(one for measure in _known_measures(scored) for one in compare_all(scored, named, measure, orders)),
        tuple(compare_all(late, named, PRIMARY, orders)),
        start,
        learned,
        tuple(answers),
        tuple(_notes(runs, named, people, same_targets)),
    )


def compare_all(runs: Sequence[Run], conditions: Sequence[str], measure: str, orders: Orders) -> list[Comparison]:
    """Every pair of conditions in one measure, their p adjusted for the number of pairs."""
    found = [compare(runs, a, b, measure, orders) for a, b in combinations(conditions, 2)]
    adjusted = holm([one.permutation.p for one in found])
    return [dataclasses.replace(one, adjusted_p=p) for one, p in zip(found, adjusted, strict=True)]


def compare(runs: Sequence[Run], a: str, b: str, measure: str = PRIMARY, orders: Orders | None = None) -> Comparison:
    """Condition b against a: one value for each person and condition, from all runs given."""
    cells = {(person, one): cell(runs, person, one, measure) for person in _people(runs) for one in (a, b)}
    people = tuple(p for p in _people(runs) if math.isfinite(cells[p, a]) and math.isfinite(cells[p, b]))
    first, second = (tuple(cells[person, one] for person in people) for one in (a, b))
    found = ratio(first, second) if MEASURES[measure].as_ratio else Ratio(word="n/a: compared by differences")
    logs = not math.isnan(found.ratio)
    scale_a, scale_b = (np.log(values) if logs else np.array(values, float) for values in (first, second))
    d = differences(scale_a, scale_b)
    periods = _periods(people, (a, b), (scale_a, scale_b), orders or {})
    effects = (found, paired(first, second), sign_flips(d), wilcoxon(d), periods, logs)
    return Comparison(measure, a, b, people, first, second, *effects)


def cell(runs: Iterable[Run], person: str, condition: str, measure: str) -> float:
    """One person's value in one condition: the mean of the runs, geometric for times; NaN without any.

    Throughput is a mean of means, so its mean is arithmetic.
    """
    values = [getattr(run, measure) for run in runs if (run.participant, run.condition) == (person, condition)]
    finite = [value for value in values if math.isfinite(value)]
    if MEASURES[measure].log_mean and finite and min(finite) > 0.0:
        return math.exp(mean_known([math.log(value) for value in finite]))
    return mean_known(finite)


def learning(runs: Sequence[Run], condition: str, measure: str = PRIMARY) -> Learning:
    """How a measure went over the blocks of one condition."""
    own = [run for run in runs if run.condition == condition]
    blocks = tuple(sorted({run.block for run in own}))
    rows = {
        p: tuple(cell([r for r in own if r.block == b], p, condition, measure) for b in blocks) for p in _people(own)
    }
    whole = {person: row for person, row in rows.items() if all(value > 0.0 for value in row)}
    means: tuple[float, ...] = ()
    if whole and blocks:
        means = tuple(np.exp(np.log(np.array(list(whole.values()))).mean(axis=0)).tolist())
    return Learning(condition, blocks, tuple(whole), tuple(whole.values()), means, learning_curve(means))


def settled_from(learned: Iterable[Learning]) -> int:
    """The place of the block from which on no condition improves by more than 5 %, as the means have it."""
    return max((one.curve.plateau for one in learned), default=0)


def sentence(comparison: Comparison) -> str:
    """The comparison in one sentence, effect first."""
    one, what = comparison, MEASURES[comparison.measure]
    holm_word = " after Holm" if one.adjusted_p != one.permutation.p and math.isfinite(one.adjusted_p) else ""
    tail = f"p = {p_text(one.adjusted_p if holm_word else one.permutation.p)}{holm_word}, {len(one.people)} people"
    if len(one.people) < FEWEST_PEOPLE:
        tail = "one person: nothing can be said of others"
    if one.geometric:
        found, title = one.ratio, what.title
        limits = _limits(f"{found.low:.2f} to {found.high:.2f}", found.low)
        return f"{title} with {one.b} is {found.ratio:.2f} times that with {one.a} ({limits}{tail})."
    unit = f" {what.unit}".rstrip()
    limits = _limits(f"{one.paired.low:+.2f} to {one.paired.high:+.2f}{unit}", one.paired.low)
    return f"{what.title} with {one.b} is {one.paired.mean:+.2f}{unit} against {one.a} ({limits}{tail})."


def _limits(text: str, low: float) -> str:
    """The limits in words, with what parts them from what follows; empty where there are none."""
    return "" if math.isnan(low) else f"95 % limits {text}; "


def group_mean(values: Sequence[float], geometric: bool) -> float:
    """Mean over people, one at least; a geometric one of values above 0."""
    return math.exp(mean_known([math.log(value) for value in values])) if geometric else mean_known(values)


def p_text(p: float) -> str:
    """A p as it is printed: two digits, never 0."""
    if math.isnan(p):
        return "n/a"
    return f"{p:.2g}" if p >= 0.0001 else "below 0.0001"


def _people(runs: Iterable[Run]) -> tuple[str, ...]:
    return tuple(dict.fromkeys(run.participant for run in runs))


def _orders(runs: Iterable[Run]) -> dict[str, list[str]]:
    met: dict[str, dict[str, None]] = {}
    for run in runs:
        met.setdefault(run.participant, {})[run.condition] = None
    return {person: list(conditions) for person, conditions in met.items()}


def _periods(people: Sequence[str], pair: tuple[str, str], values: tuple[Floats, Floats], orders: Orders) -> Crossover:
    groups: dict[bool, list[tuple[float, float]]] = {True: [], False: []}
    for person, a, b in zip(people, *(one.tolist() for one in values), strict=True):
        met = [condition for condition in orders.get(person, ()) if condition in pair]
        if len(met) == 2:
            groups[met[0] == pair[0]].append((a, b) if met[0] == pair[0] else (b, a))
    return crossover(groups[True], groups[False])


def _known_measures(runs: Sequence[Run]) -> list[str]:
    return [name for name in MEASURES if any(math.isfinite(getattr(run, name)) for run in runs)]


def _notes(runs: Sequence[Run], conditions: Sequence[str], people: Sequence[str], same_targets: bool) -> list[str]:
    scored = [run for run in runs if not run.practice]
    notes = list(honesty(len(people), len(conditions), same_targets))
    practice = sum(run.targets for run in runs if run.practice)
    if practice:
        notes.append(f"{practice} practice targets are left out.")
    notes += _missing(scored, conditions, people)
    outliers, targets = sum(len(run.outliers) for run in scored), sum(run.targets for run in scored)
    notes.append(
        f"{outliers} of {targets} selections are outliers: moved less than half of the way, or ended more than two "
        "widths from the target's centre. Throughput is given without and with them; all other figures keep them."
    )
    words = dict.fromkeys(run.throughput_word for run in scored if run.throughput_word)
    notes += [f"Throughput is {word} (in {_count(scored, word)})." for word in words]
    return notes


def _missing(runs: Sequence[Run], conditions: Sequence[str], people: Sequence[str]) -> list[str]:
    seen = {(run.participant, run.condition) for run in runs}
    lacking = [p for p in people if any((p, condition) not in seen for condition in conditions)]
    return [f"Not all conditions were met by: {', '.join(lacking)}."] if lacking else []


def _count(runs: Sequence[Run], word: str) -> str:
    return f"{sum(run.throughput_word == word for run in runs)} of {len(runs)} runs"
