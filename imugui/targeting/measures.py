"""What a run amounts to: the measures of the thesis under its own names, and those of pointing studies.

Thesis: C. Erat, Izmir Institute of Technology 2018, chapter 6. A run is the targets between two rests; of a ring it
holds one sequence for each amplitude and width.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from imugui.fusion.quaternion import Floats
from imugui.targeting.sequences import centres, column, known, log_sizes, mean_known, run_throughput
from imugui.targeting.trials import Trial, csv_line


@dataclass(frozen=True)
class Measure:
    """How a figure of a run is called and read."""

    title: str
    unit: str
    digits: int
    thesis: bool = False
    as_ratio: bool = True  # compared as a ratio; else by differences
    log_mean: bool = False  # a person's value is the geometric mean of the runs; else the arithmetic
    more_is_better: bool = False


MEASURES: dict[str, Measure] = {
    "movement_time_s": Measure("Movement time per target", "s", 2, log_mean=True),
    "throughput": Measure("Throughput", "bits/s", 2, more_is_better=True),
    "throughput_all": Measure("Throughput with outliers", "bits/s", 2, more_is_better=True),
    "nominal_throughput": Measure("Nominal throughput", "bits/s", 2, more_is_better=True),
    "elapsed_time_s": Measure("Elapsed time", "s", 1, thesis=True, log_mean=True),
    "activations": Measure("Activations (button clicks)", "", 1, thesis=True),
    "mean_largest_rotation_deg": Measure("Mean of the largest rotation per activation", "deg", 1, thesis=True),
    "error_percent": Measure("Error rate", "%", 1, as_ratio=False),
    "overshoots": Measure("Overshoots per target", "", 2, as_ratio=False),
    "path_efficiency": Measure("Path efficiency", "", 2, more_is_better=True),
    "zoom_efficiency": Measure("Zoom efficiency", "", 2, more_is_better=True),
    "clutches": Measure("Clutches", "", 1, as_ratio=False),
    "pan_time_s": Measure("Time panning", "s", 1, log_mean=True),
    "zoom_time_s": Measure("Time zooming", "s", 1, log_mean=True),
    "idle_time_s": Measure("Time idle", "s", 1, as_ratio=False),
    **{
        f"{side}_angle_{axis}_deg": Measure(f"{word} angle about {axis}", "deg", 1, thesis=True, as_ratio=False)
        for axis in "xyz"
        for side, word in (("min", "Minimum"), ("max", "Maximum"))
    },
}


@dataclass(frozen=True)
class Run:
    """One run of one person in one condition; NaN where a figure is not known."""

    study: str
    participant: str
    condition: str
    block: int
    practice: bool
    run: int
    targets: int = 0
    elapsed_time_s: float = math.nan
    min_angle_x_deg: float = math.nan
    max_angle_x_deg: float = math.nan
    min_angle_y_deg: float = math.nan
    max_angle_y_deg: float = math.nan
    min_angle_z_deg: float = math.nan
    max_angle_z_deg: float = math.nan
    activations: int = 0
    mean_largest_rotation_deg: float = math.nan
    movement_time_s: float = math.nan  # mean over the targets
    throughput: float = math.nan  # effective, mean of the sequences, outliers left out
    throughput_all: float = math.nan  # the same with them
    nominal_throughput: float = math.nan  # sum of the nominal bits / sum of the times
    throughput_word: str = ""  # why there is no effective one
    sequences: int = 0
    outliers: tuple[int, ...] = ()  # ``index`` of the trials
    error_percent: float = math.nan
    overshoots: float = math.nan  # per target
    path_efficiency: float = math.nan
    zoom_efficiency: float = math.nan
    clutches: int = 0
    pan_time_s: float = math.nan
    zoom_time_s: float = math.nan
    idle_time_s: float = math.nan


def runs_of(trials: Iterable[Trial]) -> list[Run]:
    """Every run in the order in which it first appears."""
    groups: dict[tuple[object, ...], list[Trial]] = {}
    for trial in trials:
        key = (trial.study, trial.participant, trial.condition, trial.block, trial.practice, trial.run)
        groups.setdefault(key, []).append(trial)
    return [measure(group) for group in groups.values()]


def measure(trials: Sequence[Trial]) -> Run:
    """The figures of one run; ``trials`` are its targets in their order, one at least."""
    one, n = trials[0], len(trials)
    rates = run_throughput(trials)
    times = column(trials, "movement_time_s")
    way = centres(trials, "sel") - centres(trials, "from")
    zoom = log_sizes(trials, "sel") - log_sizes(trials, "from")
    return Run(
        one.study,
        one.participant,
        one.condition,
        one.block,
        one.practice,
        one.run,
        n,
        elapsed_time_s=_largest(column(trials, "t_end")) + _largest(-column(trials, "t_start")),
        **_angles(trials),
        activations=sum(trial.activations for trial in trials),
        mean_largest_rotation_deg=mean_known([angle for trial in trials for angle in trial.max_rotation_deg]),
        movement_time_s=mean_known(times[times > 0.0]),
        throughput=rates.effective,
        throughput_all=rates.with_outliers,
        nominal_throughput=rates.nominal,
        throughput_word=rates.word,
        sequences=rates.sequences,
        outliers=rates.outliers,
        error_percent=100.0 * sum(trial.error for trial in trials) / n,
        overshoots=sum(trial.overshoots for trial in trials) / n,
        path_efficiency=_share(np.hypot(way[:, 0], way[:, 1]), column(trials, "path_px")),
        zoom_efficiency=_share(np.abs(zoom), column(trials, "zoom_path")),
        clutches=sum(trial.clutches for trial in trials),
        pan_time_s=_sum(column(trials, "pan_time_s")),
        zoom_time_s=_sum(column(trials, "zoom_time_s")),
        idle_time_s=_sum(column(trials, "idle_time_s")),
    )


def runs_csv(runs: Iterable[Run]) -> str:
    """A table with one row for each run, all digits; the columns are the fields of Run."""
    names = [field.name for field in dataclasses.fields(Run)]
    rows = ([_cell(getattr(run, name)) for name in names] for run in runs)
    return csv_line(names) + "".join(map(csv_line, rows))


def _angles(trials: Sequence[Trial]) -> dict[str, Any]:
    found = {}
    for k, axis in enumerate("xyz"):
        found[f"min_angle_{axis}_deg"] = -_largest([-trial.min_deg[k] for trial in trials])
        found[f"max_angle_{axis}_deg"] = _largest([trial.max_deg[k] for trial in trials])
    return found


def _share(part: Floats, whole: Floats) -> float:
    good = np.isfinite(part) & (whole > 0.0)
    return float(part[good].sum() / whole[good].sum()) if good.any() else math.nan


def _sum(values: Floats) -> float:
    return float(known(values).sum()) if len(known(values)) else math.nan


def _largest(values: Sequence[float] | Floats) -> float:
    return float(known(values).max()) if len(known(values)) else math.nan


def _cell(value: object) -> str:
    if isinstance(value, float):
        return "" if math.isnan(value) else repr(value)
    if isinstance(value, bool):
        return str(int(value))
    return " ".join(map(str, value)) if isinstance(value, tuple) else str(value)
