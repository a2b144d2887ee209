"""Make docs/targeting.md again: .venv/bin/python docs/game_thesis.py

The simulated user plays the study of C. Erat's thesis (tables 6.1 and 6.2) through the same controller as a person,
many times over; what comes out is set beside what was published.
"""

from __future__ import annotations

import dataclasses
import math
import os
import statistics
import sys
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from string import Template

from imugui.targeting import tasks
from imugui.targeting.game import Game
from imugui.targeting.measures import Run, measure
from imugui.targeting.operator import play_run
from imugui.targeting.person import Person, one_of_many
from imugui.targeting.settings import PRESETS, Control
from imugui.targeting.statistics import LEVEL, ratio, welch
from imugui.targeting.tasks import Task, target_list
from imugui.targeting.thesis_tables import TABLES, TAUS_S, Table, lag_test, lines

PAGE = Path(__file__).resolve().parent / "targeting.md"
FRAME = PAGE.with_name("targeting.frame.md")
MAPPINGS = ("position", "speed")
STUDIES, RUNS, PEOPLE = 40, 5, 24
OTHER_RUNS = 20
OTHERS: dict[str, tuple[dict[str, float], Task]] = {
    "nothing": ({}, Task()),
    "reach 25° instead of 35°": ({"reach_deg": 25.0}, Task()),
    "reach 45°": ({"reach_deg": 45.0}, Task()),
    "plans 0.8 s ahead instead of 0.6 s": ({"horizon_s": 0.8}, Task()),
    "corrects every 0.35 s instead of 0.25 s": ({"interval_s": 0.35}, Task()),
    "misjudges angles by 10 % instead of 5 %": ({"misjudge": 0.1}, Task()),
    "sees speeds to 10 % instead of 20 %": ({"see_share": 0.1}, Task()),
    "pans of 200 to 330 px instead of 90 to 250 px": (
        {}, Task(pan_low_px=200.0, pan_high_px=330.0, size_high_px=160.0, zoom_high=1.5)
    ),
}  # fmt: skip
"""Title -> figures of the person, task."""
FIGURES = {
    "elapsed_time_s": ("Elapsed time (s)", 6),
    "activations": ("Activations (button clicks)", 5),
    "mean_largest_rotation_deg": ("Mean of the largest rotation (deg)", 4),
}
"""Measure -> its title, and how many of the thesis' six people had less of it with position."""


@dataclasses.dataclass(frozen=True)
class Job:
    """One run to be played."""

    control: Control
    task: Task
    seed: int
    person: Person


def play(job: Job) -> Run:
    """The measures of a run. Raises RuntimeError when the simulated user did not get through it."""
    game = Game(job.task, job.control, target_list(job.task, job.seed))
    play_run(game, job.person, job.seed)
    if not game.done:
        raise RuntimeError(f"a run was not finished: {job}")
    return measure(game.trials)


def thesis_job(mapping: str, tau_s: float, number: int, person: Person, task: Task) -> Job:
    """A run of one cell of the thesis; every run has targets of its own, as there."""
    cell = MAPPINGS.index(mapping) * len(TAUS_S) + TAUS_S.index(tau_s)
    control = dataclasses.replace(PRESETS[f"thesis {mapping}"], lag_s=tau_s)
    return Job(control, task, number * len(MAPPINGS) * len(TAUS_S) + cell, person)


def studies(play_all: Callable[[Sequence[Job]], list[Run]]) -> list[dict[str, Table]]:
    """Elapsed seconds of whole studies, each as large as that of the thesis."""
    cells = [(mapping, tau) for mapping in MAPPINGS for tau in TAUS_S]
    jobs = [thesis_job(*cell, number, Person(), Task()) for cell in cells for number in range(STUDIES * RUNS)]
    seconds = iter([run.elapsed_time_s for run in play_all(jobs)])
    all_runs = {cell: [next(seconds) for _ in range(STUDIES * RUNS)] for cell in cells}
    return [
        {m: {tau: tuple(all_runs[m, tau][k * RUNS : (k + 1) * RUNS]) for tau in TAUS_S} for m in MAPPINGS}
        for k in range(STUDIES)
    ]


def pattern(study: dict[str, Table]) -> dict[str, bool]:
    """Which parts of the thesis' result a study shows, with the tests used there."""
    found = lines(study["position"], study["speed"])
    ratios = [line.ratio for line in found]
    parts = {
        "position faster at every τ": all(line.ratio > 1.0 for line in found),
        "position faster at every τ, each with p < .05": all(line.ratio > 1.0 and line.test.p < 0.05 for line in found),
    }
    for mapping in MAPPINGS:
        means = [statistics.mean(runs) for runs in study[mapping].values()]
        parts[f"{mapping}: no effect of τ up to 1 s (p > .05)"] = lag_test(study[mapping], 1.0).p > 0.05
        parts[f"{mapping}: an effect of τ up to 2 s (p < .05)"] = lag_test(study[mapping]).p < 0.05
        parts[f"{mapping}: slowest at 2 s"] = means[-1] > max(means[:-1])
    parts["ratio speed / position smallest at 2 s"] = ratios[-1] < min(ratios[:-1])
    return parts


def side_by_side(study: dict[str, Table]) -> list[str]:
    """The runs of the thesis and those of one simulated study."""
    out = [
        "| mapping | τ (s) | thesis: runs (s) | mean (SD) | simulated: runs (s) | mean (SD) |",
        "|---|---|---|---|---|---|",
    ]
    for mapping in MAPPINGS:
        for tau in TAUS_S:
            theirs, ours = (
                f"{_list(table[mapping][tau])} | {mean_sd(table[mapping][tau])}" for table in (TABLES, study)
            )
            out.append(f"| {mapping} | {tau:g} | {theirs} | {ours} |")
    return out


def _list(runs: Sequence[float]) -> str:
    return " ".join(f"{run:.0f}" for run in runs)


def compared(study: dict[str, Table]) -> list[str]:
    """Ratios and tests of the thesis and of one simulated study."""
    out = ["| τ (s) | thesis: speed / position | p | simulated: speed / position | p |", "|---|---|---|---|---|"]
    for ours, theirs in zip(lines(study["position"], study["speed"]), lines(), strict=True):
        out.append(
            f"| {ours.tau_s:g} | {theirs.ratio:.2f} | {p(theirs.test.p)} | {ours.ratio:.2f} | {p(ours.test.p)} |"
        )
    return out


def tested(study: dict[str, Table]) -> list[str]:
    """The effect of the lag in both."""
    out = ["| mapping | τ | thesis: p | simulated: p |", "|---|---|---|---|"]
    for mapping in MAPPINGS:
        for up_to in (1.0, 2.0):
            theirs, ours = lag_test(TABLES[mapping], up_to).p, lag_test(study[mapping], up_to).p
            out.append(f"| {mapping} | 0.25 to {up_to:g} s | {p(theirs)} | {p(ours)} |")
    return out


def pooled(all_studies: Sequence[dict[str, Table]]) -> tuple[dict[str, Table], list[str]]:
    """All runs of all studies, and their means and ratios with 95 % limits."""
    pool: dict[str, Table] = {
        m: {tau: tuple(run for study in all_studies for run in study[m][tau]) for tau in TAUS_S} for m in MAPPINGS
    }
    out = ["| τ (s) | position (s) | speed (s) | speed / position | thesis |", "|---|---|---|---|---|"]
    for tau, theirs in zip(TAUS_S, lines(), strict=True):
        a, b = (pool[m][tau] for m in MAPPINGS)
        logs = welch([math.log(run) for run in a], [math.log(run) for run in b])
        low, middle, high = (math.exp(value) for value in (logs.low, logs.difference, logs.high))
        found = f"{middle:.2f} ({low:.2f} to {high:.2f})"
        out.append(f"| {tau:g} | {mean_ci(a)} | {mean_ci(b)} | {found} | {theirs.ratio:.2f} |")
    return pool, out


def growth(pool: dict[str, Table], tau_s: float) -> str:
    """By how much both mappings are slower at a lag than at 0.25 s."""
    parts = []
    for mapping in MAPPINGS:
        test = welch(*([math.log(run) for run in pool[mapping][tau]] for tau in (TAUS_S[0], tau_s)))
        low, middle, high = (100.0 * (math.exp(value) - 1.0) for value in (test.low, test.difference, test.high))
        parts.append(f"{mapping} {middle:+.0f} % ({low:+.0f} to {high:+.0f})")
    return ", ".join(parts)


def people(play_all: Callable[[Sequence[Job]], list[Run]]) -> list[str]:
    """Different persons at τ = 0.25 s, as in the thesis' comparison of six users."""
    jobs = [
        thesis_job(mapping, 0.25, 1000 + RUNS * k + run, one_of_many(k), Task())
        for mapping in MAPPINGS
        for k in range(PEOPLE)
        for run in range(RUNS)
    ]
    runs = iter(play_all(jobs))
    persons = {m: [[next(runs) for _ in range(RUNS)] for _ in range(PEOPLE)] for m in MAPPINGS}
    means = {
        (m, name): [statistics.mean(getattr(run, name) for run in of_one) for of_one in persons[m]]
        for m in MAPPINGS
        for name in FIGURES
    }
    out = ["| measure | position | speed | people with less in position | thesis, of 6 |", "|---|---|---|---|---|"]
    for name, (title, theirs) in FIGURES.items():
        a, b = (means[m, name] for m in MAPPINGS)
        fewer = sum(x < y for x, y in zip(a, b, strict=True))
        cells = f"{statistics.mean(a):.1f} | {statistics.mean(b):.1f} | {fewer} of {PEOPLE} | {theirs}"
        out.append(f"| {title} | {cells} |")
    found = ratio(means["position", "elapsed_time_s"], means["speed", "elapsed_time_s"])
    limits = f"{found.low:.2f} to {found.high:.2f}"
    return [*out, "", f"Ratio of the elapsed times over people: {found.ratio:.2f} (95 % limits {limits})."]


def others(play_all: Callable[[Sequence[Job]], list[Run]]) -> list[str]:
    """The ratio speed / position when the person or the targets are different ones."""
    out = ["| what is different | " + " | ".join(f"τ = {tau:g} s" for tau in TAUS_S) + " |", "|---|---|---|---|---|"]
    for title, (figures, task) in OTHERS.items():
        person = dataclasses.replace(Person(), **figures)
        jobs = [thesis_job(m, tau, k, person, task) for tau in TAUS_S for m in MAPPINGS for k in range(OTHER_RUNS)]
        logs = iter([math.log(run.elapsed_time_s) for run in play_all(jobs)])
        cells = []
        for _ in TAUS_S:
            a, b = ([next(logs) for _ in range(OTHER_RUNS)] for _ in MAPPINGS)
            cells.append(f"{math.exp(statistics.mean(b) - statistics.mean(a)):.2f}")
        out.append(f"| {title} | {' | '.join(cells)} |")
    return out


def rings(play_all: Callable[[Sequence[Job]], list[Run]]) -> list[str]:
    """Throughput on a ring, without any lag: the check of the simulated user against other people's studies."""
    out = ["| mapping | simulated (bits/s) | errors | Teather & MacKenzie 2014, 16 people |", "|---|---|---|---|"]
    task = tasks.PRESETS["ring, button"]
    for mapping, theirs in zip(MAPPINGS, ("3.3", "1.2"), strict=True):
        runs = play_all([Job(PRESETS[mapping], task, k, one_of_many(k)) for k in range(PEOPLE)])
        rates, errors = [run.throughput for run in runs], statistics.mean(run.error_percent for run in runs)
        out.append(f"| {mapping} | {mean_ci(rates, 2)} | {errors:.1f} % | {theirs} |")
    return out


def mean_sd(values: Sequence[float]) -> str:
    return f"{statistics.mean(values):.1f} ({statistics.stdev(values):.1f})"


def mean_ci(values: Sequence[float], digits: int = 1) -> str:
    """Mean and 95 % limits, normal: the samples are large."""
    half = statistics.NormalDist().inv_cdf(0.5 + 0.5 * LEVEL) * statistics.stdev(values) / math.sqrt(len(values))
    middle = statistics.mean(values)
    return f"{middle:.{digits}f} ({middle - half:.{digits}f} to {middle + half:.{digits}f})"


def p(value: float) -> str:
    return "< .001" if value < 0.001 else f"{value:.3f}".removeprefix("0")


def shares(all_studies: Sequence[dict[str, Table]]) -> list[str]:
    """How many of the studies show each part of the pattern."""
    found, thesis = [pattern(study) for study in all_studies], pattern(TABLES)
    out = ["| part of the pattern | thesis | simulated studies |", "|---|---|---|"]
    for name in thesis:
        count = sum(one[name] for one in found)
        out.append(f"| {name} | {'yes' if thesis[name] else 'no'} | {count} of {len(found)} |")
    return out


def page(play_all: Callable[[Sequence[Job]], list[Run]]) -> str:
    """docs/targeting.md."""
    all_studies = studies(play_all)
    pool, means = pooled(all_studies)
    small = " and ".join(p(lag_test(pool[mapping], 1.0).p) for mapping in MAPPINGS)
    parts = {
        "BY_RUN": side_by_side(all_studies[0]),
        "BY_TAU": compared(all_studies[0]),
        "LAG": tested(all_studies[0]),
        "MEANS": means,
        "GROWTH": [f"Against τ = 0.25 s, at 1 s: {growth(pool, 1.0)}; at 2 s: {growth(pool, 2.0)}."],
        "SMALL": [small],
        "SHARES": shares(all_studies),
        "OTHERS": others(play_all),
        "PEOPLE": people(play_all),
        "RINGS": rings(play_all),
    }
    return Template(FRAME.read_text(encoding="utf-8")).substitute({key: "\n".join(part) for key, part in parts.items()})


def main() -> int:
    with ProcessPoolExecutor(os.cpu_count()) as pool:
        PAGE.write_text(page(lambda jobs: list(pool.map(play, jobs, chunksize=8))), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
