"""Plans as a CSV file: read with one sentence for every line that is wrong, written so that it reads back exactly."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from imugui.guidance.plan import CONVENTION, FIELDS, FRAME, Plan, identity, problems, title
from imugui.guidance.plan_text import field_text, parse_field

COLUMNS = {
    "level": "name",
    "side": "side",
    "kind": "kind",
    "axial_deg": "axial_deg",
    "sagittal_deg": "sagittal_deg",
    "yaw_deg": "yaw_deg",
    "pitch_deg": "pitch_deg",
    "roll_deg": "roll_deg",
    "depth_mm": "depth_mm",
    "tolerance_deg": "tolerance_deg",
    "amber_deg": "amber_deg",
    "reference": "reference",
}
"""Column of the file -> field of a plan, in the order in which they are written."""
ALIASES = {"name": "level"}
NEEDED = {"projected": ("side", "axial_deg", "sagittal_deg"), "plain": ("yaw_deg", "pitch_deg")}
"""Columns whose cells may not be empty, beside the level."""
LARGEST = 1 << 20
"""Characters in a file of plans; a longer one is something else."""
DELIMITERS = (",", ";", "\t")

BOMS = {b"\xff\xfe": "utf-16", b"\xfe\xff": "utf-16"}
"""First bytes of a file -> its encoding; spreadsheets write these."""

Lines = Iterator[tuple[int, str]]


def load_plans(path: Path) -> tuple[list[Plan], list[str]]:
    """``read_plans`` of a file in UTF-8, UTF-16 or the Windows code page; raises OSError."""
    with path.open("rb") as stream:
        data = stream.read(2 * LARGEST + 4)
    try:
        return read_plans(data.decode(BOMS.get(data[:2], "utf-8")))
    except UnicodeDecodeError:
        return read_plans(data.decode("cp1252", "replace"))


def read_plans(text: str) -> tuple[list[Plan], list[str]]:
    """The plans of a CSV text, and one sentence for each line (or heading) that could not be taken.

    A header is required; columns come in any order, separated by comma, semicolon or tab. A level and side that was
    there before is named and not taken again. Never raises.
    """
    if len(text) > LARGEST:
        return [], [f"The file has {len(text)} characters: {LARGEST} is the most for a table of plans."]
    lines = _filled(text)
    number, header = next(((n, line) for n, line in lines if not line.startswith("#")), (0, ""))
    if not header:
        return [], ["The file is empty: its first line must name the columns, as in level,side,axial_deg,sagittal_deg."]
    delimiter = max(DELIMITERS, key=header.count)
    columns, complaints = _columns(header, delimiter, number)
    plans: list[Plan] = []
    if "level" in columns:
        complaints += _read_lines(lines, columns, delimiter, plans)
    return plans, complaints


def write_plans(plans: Sequence[Plan]) -> str:
    """CSV text with every field of every plan, and the frame and the convention in words before the header."""
    stream = io.StringIO()
    stream.write(f"# frame: {FRAME}\n# convention: {CONVENTION}\n")
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(COLUMNS)
    writer.writerows([field_text(plan, name) for name in COLUMNS.values()] for plan in plans)
    return stream.getvalue()


def _filled(text: str) -> Lines:
    """Line numbers from 1 and lines that hold more than spaces and separators."""
    for number, line in enumerate(text.removeprefix("\N{ZERO WIDTH NO-BREAK SPACE}").splitlines(), 1):
        if line.strip().strip(",;\t "):
            yield number, line


def _columns(header: str, delimiter: str, number: int) -> tuple[list[str], list[str]]:
    """The columns' names as we know them ("" for one to leave out), and what is wrong with the header."""
    cells, wrong = _cells(header, delimiter)
    if wrong:
        return [], [f"Line {number}: {wrong}"]
    names = [ALIASES.get(cell.strip().casefold(), cell.strip().casefold()) for cell in cells]
    twice = sorted({name for name in names if name and names.count(name) > 1})
    if twice:
        return [], [f"Line {number}: the column {twice[0]} is there twice."]
    unknown = [name for name in names if name and name not in COLUMNS]
    said = [f"Line {number}: the column {name!r:.40} is not known and was left out." for name in unknown]
    if "level" not in names:
        said.append(f"Line {number}: there is no column level; the first line must name the columns.")
    return [name if name in COLUMNS else "" for name in names], said


def _cells(line: str, delimiter: str) -> tuple[list[str], str]:
    """The cells of one line, and what is wrong with it. Read line by line: an open quote loses no other line."""
    try:
        return next(csv.reader([line], delimiter=delimiter, strict=True, skipinitialspace=True), []), ""
    except csv.Error as error:
        return [], f"the line cannot be read ({error}); look for a quote that is not closed."


def _read_lines(lines: Lines, columns: list[str], delimiter: str, plans: list[Plan]) -> list[str]:
    """Append the plans of the lines; returns what is wrong, one sentence a line."""
    complaints = []
    seen: dict[tuple[str, str], int] = {}
    for number, line in lines:
        cells, wrong = _cells(line, delimiter)
        plan, found = (None, [wrong]) if wrong else _plan(cells, columns)
        if plan is not None and identity(plan) in seen:
            found = [f"level: {title(plan)} is already there, in line {seen[identity(plan)]}."]
        if plan is None or found:
            complaints.append(f"Line {number}: {' '.join(found)}")
            continue
        seen[identity(plan)] = number
        plans.append(plan)
    return complaints


def _plan(cells: list[str], columns: list[str]) -> tuple[Plan | None, list[str]]:
    """The plan of one line, or what is wrong with it, each with the name of its column."""
    extra = [cell for cell in cells[len(columns) :] if cell.strip()]
    if extra:
        return None, [f"there are {len(cells)} cells for {len(columns)} columns; a decimal comma needs quotes."]
    texts = {name: cell for name, cell in zip(columns, cells, strict=False) if name}
    values: dict[str, Any] = {"kind": _usual_kind(columns)}
    found: dict[str, str] = {}
    for column, text in texts.items():
        if column == "kind" and not text.strip():
            continue
        try:
            values[COLUMNS[column]] = parse_field(COLUMNS[column], text)
        except ValueError as error:
            found[column] = str(error)
    for column in NEEDED[values["kind"]]:
        if not texts.get(column, "").strip():
            found[column] = f"{FIELDS[COLUMNS[column]].metadata['label']} is missing."
    plan = Plan(**values)
    if not found:
        found = {"level" if name == "name" else name: wrong for name, wrong in problems(plan).items()}
    return (None if found else plan), [f"{column}: {wrong}" for column, wrong in found.items()]


def _usual_kind(columns: list[str]) -> str:
    """The kind of a line that does not say it: what the columns are for."""
    return "plain" if "yaw_deg" in columns and "axial_deg" not in columns else "projected"
