"""The folder of a study. Nothing in it is ever lost: tables are appended to, other files replaced as a whole.

    study.json       the plan; written once, with a copy beside it (study.copy.json)
    trials.csv       every target, appended when it is done; opens in a spreadsheet
    answers.csv      forms, preferences, and the rests that were taken; appended likewise
    report.html      what was found, and runs.csv with one row for each run; made on demand (``study_report``)

The first column of trials.csv marks with 1 the targets of a block that was interrupted and began again: they stay in
the file and do not count. What is done follows from the tables alone, so a killed program leaves no doubt.
"""

from __future__ import annotations

import csv
import hashlib
import json
from collections.abc import Container, Iterable
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from imugui import __version__
from imugui.paths import replace_file
from imugui.targeting.questionnaires import SUS, TLX, Answer
from imugui.targeting.study_files import append, read_text, set_aside
from imugui.targeting.study_plan import StudyPlan, as_mapping, plan_from
from imugui.targeting.trials import COLUMNS, Trial, csv_line, read_trials, trial_line
from imugui.texts import from_json

MARK, VERSION = "imugui_study", 1
PLAN, COPY, TRIALS, ANSWERS = "study.json", "study.copy.json", "trials.csv", "answers.csv"

VALID, INTERRUPTED = "0,", "1,"
"""How the row of a target begins."""

REST = "rest"
LENGTHS = {"tlx": (0, len(TLX)), "sus": (0, len(SUS)), "preference": (0,), REST: (1,)}
"""A kind of answer -> how many values it may have; none: the person did not want to answer."""

ANSWER_COLUMNS = ("participant", "condition", "values", "kind")
"""The kind is last: a row that was cut short has none."""

HEADERS = {TRIALS: csv_line(("interrupted", *COLUMNS)), ANSWERS: csv_line(ANSWER_COLUMNS)}
STARTS = {TRIALS: ("interrupted,", VALID, INTERRUPTED), ANSWERS: ("participant,",)}
"""How a line begins by which a table is known as ours."""

REMARKS = {TRIALS: "# interrupted: 1 marks targets of a block that began again; they do not count\n"}

BlockKey = tuple[str, str, int]
"""Participant, condition, block."""


class StudyError(Exception):
    """The folder holds no study that can go on; the message says why."""


@dataclass(frozen=True)
class Stored:
    """What is in the folder of a study."""

    plan: StudyPlan
    trials: tuple[Trial, ...] = ()  # those that are not marked
    interrupted: int = 0  # how many are marked
    answers: tuple[Answer, ...] = ()  # the rests too
    problems: tuple[str, ...] = ()  # a sentence for each thing that was not taken
    broken: tuple[str, ...] = ()  # the names of files that are of no use


def create(folder: Path, plan: StudyPlan) -> None:
    """Begin a study in a new or an empty folder. Raises StudyError where there is something, and OSError."""
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise StudyError(f"{folder} is not empty: a study needs a folder of its own")
    folder.mkdir(parents=True, exist_ok=True)
    for name in (TRIALS, ANSWERS):
        replace_file(folder / name, table_head(name, plan))
    # the plan last: with it the folder is a study
    for name in (COPY, PLAN):
        _write_plan(folder / name, plan)


def table_head(name: str, plan: StudyPlan) -> str:
    """How a table begins."""
    study = " ".join(plan.name.split())
    about = f"# study: {study}\n# made with: imugui {__version__}, for research and teaching only\n"
    return about + REMARKS.get(name, "") + HEADERS[name]


def load(folder: Path) -> Stored:
    """What is in the folder; nothing is changed. Raises StudyError without a plan, and OSError."""
    plan, said = _load_plan(folder)
    broken = [PLAN] if said else []
    tables: dict[str, list[str]] = {}
    for name in (TRIALS, ANSWERS):
        try:
            tables[name] = _table(folder / name)
        except (FileNotFoundError, ValueError) as error:
            why = "it is missing" if isinstance(error, FileNotFoundError) else error
            said.append(f"{name} is not used: {why}.")
            broken.append(name)
    trials, marked, wrong = _trials_of(tables.get(TRIALS, []))
    answers, more = _answers_of(tables.get(ANSWERS, []))
    said += [*_not_read(TRIALS, wrong), *_not_read(ANSWERS, more)]
    return Stored(plan, tuple(trials), marked, tuple(answers), tuple(said), tuple(broken))


def repair(folder: Path, stored: Stored) -> list[str]:
    """Set the broken files aside and begin them anew; one sentence each. Raises OSError."""
    said = []
    for name in stored.broken:
        if (folder / name).exists():
            said.append(f"The old {name} is kept as {set_aside(folder / name)}.")
        if name == PLAN:
            _write_plan(folder / PLAN, stored.plan)
        else:
            replace_file(folder / name, table_head(name, stored.plan))
    return said


def add_trials(folder: Path, plan: StudyPlan, trials: Iterable[Trial], safe: bool = False) -> None:
    """Append targets; ``safe``: wait until the disk has them. Raises OSError."""
    append(folder / TRIALS, table_head(TRIALS, plan), (VALID + trial_line(trial) for trial in trials), safe)


def add_answer(folder: Path, plan: StudyPlan, answer: Answer) -> None:
    """Append an answer. Raises ValueError for one that could not be read again, and OSError."""
    if len(answer.values) not in LENGTHS.get(answer.kind, ()):
        raise ValueError(f"{answer.kind} with {len(answer.values)} values is no answer")
    values = " ".join(f"{value:g}" for value in answer.values)
    line = csv_line((answer.participant, answer.condition, values, answer.kind))
    append(folder / ANSWERS, table_head(ANSWERS, plan), [line], safe=True)


def mark(folder: Path, blocks: Container[BlockKey]) -> None:
    """Mark every target of these blocks as interrupted; no other byte of the table changes. Raises OSError."""
    lines = read_text(folder / TRIALS).split("\n")
    for number, line in enumerate(lines):
        if line.startswith(VALID) and _block_of(line) in blocks:
            lines[number] = INTERRUPTED + line.removeprefix(VALID)
    replace_file(folder / TRIALS, "\n".join(lines))


def _block_of(line: str) -> BlockKey | None:
    row = dict(zip(_cells(HEADERS[TRIALS]), _cells(line), strict=False))
    try:
        return row["participant"], row["condition"], int(row["block"])
    except (KeyError, ValueError):
        return None


def _write_plan(path: Path, plan: StudyPlan) -> None:
    values = as_mapping(plan)
    head = {MARK: VERSION, "made_with": f"imugui {__version__}", "written": f"{datetime.now(UTC):%Y-%m-%dT%H:%M:%SZ}"}
    whole = {**head, "sha256": _digest(values), "plan": values}
    replace_file(path, json.dumps(whole, indent=1, allow_nan=False) + "\n")


def _digest(plan: Any) -> str:
    return hashlib.sha256(json.dumps(plan, sort_keys=True).encode()).hexdigest()


def _load_plan(folder: Path) -> tuple[StudyPlan, list[str]]:
    """The plan; or that of the copy, and why."""
    said: list[str] = []
    for name in (PLAN, COPY):
        try:
            plan = _plan_of(read_text(folder / name))
        except FileNotFoundError:
            said.append(f"{name} is missing.")
        except ValueError as error:
            said.append(f"{name} is not used: {error}.")
        else:
            return plan, [*said, "The copy of the plan is used."] if said else []
    if not (folder / PLAN).exists() and not (folder / COPY).exists():
        raise StudyError(f"{folder} holds no study: there is no {PLAN}")
    raise StudyError(f"{folder} holds no study that can go on: {' '.join(said)} Its other files were not touched.")


def _plan_of(text: str) -> StudyPlan:
    try:
        values = from_json(text)
    except (ValueError, RecursionError):
        raise ValueError("it is no valid JSON, broken or cut short") from None
    if not isinstance(values, dict) or type(values.get(MARK)) is not int or not isinstance(values.get("plan"), dict):
        raise ValueError("it is no plan of a study")
    if values[MARK] > VERSION:
        raise ValueError(f"it was made by a newer imugui (version {values[MARK]}, this one reads {VERSION})")
    if values.get("sha256") != _digest(values["plan"]):
        raise ValueError("its plan was changed after it was made")
    return plan_from(values["plan"])


def _table(path: Path) -> list[str]:
    """The lines of a table of ours. Raises ValueError where it is none, and OSError."""
    lines = read_text(path).removeprefix("\ufeff").split("\n")
    if not any(line.startswith(STARTS[path.name]) for line in lines):
        raise ValueError("it is no table of ours")
    return lines


def _not_read(name: str, wrong: list[str]) -> list[str]:
    rows = "1 row is" if len(wrong) == 1 else f"{len(wrong)} rows are"
    return [f"{name}: {rows} not read; the first is {wrong[0]}."] if wrong else []


def _trials_of(lines: list[str]) -> tuple[list[Trial], int, list[str]]:
    """The targets that are not marked, how many are, and what is wrong; whatever the head says of the columns."""
    marked = sum(line.startswith(INTERRUPTED) for line in lines)
    known = ("#", *STARTS[TRIALS])
    odd = [f"line {n}: no target" for n, line in enumerate(lines, 1) if line.strip() and not line.startswith(known)]
    # empty lines in place of all others keep the numbers of the rows
    rows = [line if line.startswith(VALID) else "" for line in lines]
    rows[: not rows or not rows[0]] = [HEADERS[TRIALS].rstrip("\n")]
    trials, wrong = read_trials("\n".join(rows))
    return trials, marked, [*wrong, *odd]


def _answers_of(lines: list[str]) -> tuple[list[Answer], list[str]]:
    answers, wrong = [], []
    for number, line in enumerate(lines, 1):
        if not line.strip() or line.startswith(("#", *STARTS[ANSWERS])):
            continue
        try:
            participant, condition, values, kind = _cells(line)
            answer = Answer(participant, condition, kind, tuple(float(value) for value in values.split()))
            if len(answer.values) not in LENGTHS[kind]:
                raise ValueError(kind)
        except (ValueError, KeyError):
            wrong.append(f"line {number}: no answer")
        else:
            answers.append(answer)
    return answers, wrong


def _cells(line: str) -> list[str]:
    try:
        return next(csv.reader([line.rstrip("\r")]), [])
    except csv.Error:
        return []
