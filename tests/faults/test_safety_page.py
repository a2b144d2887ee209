"""docs/safety.md promises nothing that no test proves."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parents[2]
TEXT = (REPOSITORY / "docs" / "safety.md").read_text(encoding="utf-8")
NAMED = re.findall(r"`(tests/[\w/]+\.py)::(\w+)`", TEXT)
HAZARDS = ("wrong side", "stale heading", "frozen display", "mirrored axis", "unit error", "jump on engage")
FAULTS = (
    "in the middle of a line", "another name", "ten times the rate", "stall for a minute", "time jumps", "all NaN",
    "saturated", "wrong baud", "disk full", "read-only", "profile from another board", "newer version",
    "two programs on one port", "closed while recording", "closed while calibrating", "closed while a port opens",
    "suspend and resume",
)  # fmt: skip


def rows() -> list[list[str]]:
    """The cells of every row of every table, without heads."""
    lines = [line for line in TEXT.splitlines() if line.startswith("| ")]
    cells = [[cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]] for line in lines]
    return [row for row in cells if row[0] not in ("hazard", "fault", "rule")]


@pytest.mark.parametrize("path", sorted({path for path, _ in NAMED}))
def test_every_test_that_is_named_exists(path: str) -> None:
    tree = ast.parse((REPOSITORY / path).read_text(encoding="utf-8"))
    there = {node.name for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)}
    assert {name for other, name in NAMED if other == path} <= there


def test_every_row_names_a_test() -> None:
    assert len(rows()) > 40
    for row in rows():
        assert re.search(r"`tests/[\w/]+\.py::test_\w+`", row[-1]), row[0]


@pytest.mark.parametrize("what", [*HAZARDS, *FAULTS])
def test_what_was_asked_for_has_a_row(what: str) -> None:
    assert any(what in row[0] for row in rows())


def test_every_fault_test_stands_on_the_page() -> None:
    """A test that was written for a fault is found from the page, by its file at least."""
    files = {path.name for path in Path(__file__).parent.glob("test_*.py")} - {Path(__file__).name}
    assert files <= {Path(path).name for path, _ in NAMED}
