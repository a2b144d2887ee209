"""Where the results on screen come from: what was played in this window, a study's folder, or a table of targets."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

from imugui.targeting import study_store
from imugui.targeting.results import PRIMARY, Comparison, Results, results, sentence
from imugui.targeting.results_report import report_html
from imugui.targeting.study_files import read_text
from imugui.targeting.study_report import study_results
from imugui.targeting.trials import Trial, read_trials, trials_csv

FREE = "Played in this window"
NOTHING = "Nobody has met two conditions yet: there is nothing to compare."


@dataclass(frozen=True)
class Shown:
    """Results with the targets they come from."""

    title: str
    found: Results
    trials: tuple[Trial, ...]
    folder: Path | None = None  # of a study
    problems: tuple[str, ...] = ()
    simulated: bool = False  # nobody took part

    @property
    def headline(self) -> str:
        """The comparison of every pair of conditions, effect first."""
        first = [one for one in self.found.comparisons if one.measure == PRIMARY and one.people]
        words = " ".join(sentence(one) if len(one.people) > 1 else _alone(one) for one in first)
        return f"{'Simulated people: ' * self.simulated}{words}" if words else NOTHING

    def html(self) -> str:
        """The report as one page."""
        return report_html(self.found, datetime.now(UTC))

    def csv(self) -> str:
        """Every target."""
        about = {"source": self.title, "made with": "imugui, for research and teaching only"}
        return trials_csv(self.trials, about)


def _alone(one: Comparison) -> str:
    """What one person did with two conditions: no more than that."""
    (a,), (b,) = one.values_a, one.values_b
    return f"{one.people[0]}: {a:.2f} s per target with {one.a}, {b:.2f} s with {one.b}. One person tests nothing."


def of_trials(title: str, trials: Sequence[Trial], problems: Sequence[str] = ()) -> Shown:
    """The results of plain targets."""
    return Shown(title, results(trials), tuple(trials), problems=tuple(problems))


def of_study(folder: Path) -> Shown:
    """The results of a study as far as it has come. Raises StudyError and OSError."""
    stored = study_store.load(folder)
    found = study_results(stored)
    return Shown(f"Study {stored.plan.name}", found, stored.trials, folder, stored.problems, stored.plan.simulated)


def of_file(path: Path) -> Shown:
    """The results of a table of targets, or of the study in whose folder a file is.

    Raises StudyError, ValueError with words for the person, and OSError.
    """
    if (path.parent / study_store.PLAN).exists():
        return of_study(path.parent)
    trials, problems = read_trials(read_text(path))
    if not trials:
        raise ValueError(problems[0] if problems else "it holds no targets")
    return of_trials(path.name, trials, problems)
