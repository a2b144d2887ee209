"""The attitude CSV with all digits: what was shown, to be compared bit for bit."""

from __future__ import annotations

import itertools
from array import array
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from imugui.fusion.attitude import euler
from imugui.recording.csv_files import ATTITUDE_COLUMNS
from imugui.samples import ATTITUDE, Rows, empty_rows

COLUMNS = ATTITUDE_COLUMNS.count(",") + 1
LONGEST_LINE = 4096
"""bytes; ours have about 150, the description before them about 1000."""


def attitude_lines(rows: Rows) -> str:
    """One line for each ATTITUDE row, shape (n,): time and quaternion with all digits, angles for reading."""
    yaw, pitch, roll = np.rad2deg(euler(rows["quat"])).reshape(-1, 3).T.tolist()
    times, quats = rows["t"].tolist(), rows["quat"].tolist()
    flags = zip(rows["rest"].tolist(), rows["disturbed"].tolist(), strict=True)
    return "".join(
        f"{t!r},{w!r},{x!r},{y!r},{z!r},{r:.4f},{p:.4f},{h:.4f},{rest:d},{disturbed:d}\n"
        for t, (w, x, y, z), r, p, h, (rest, disturbed) in zip(times, quats, roll, pitch, yaw, flags, strict=True)
    )


def bounded_lines(path: Path, longest: int) -> Iterator[str]:
    """The lines of a text file with their ends; of a line of more bytes than ``longest`` pieces without. OSError."""
    with path.open("rb") as stream:
        while line := stream.readline(longest):
            yield line.decode("utf-8", "replace")


def read_attitude(path: Path) -> tuple[Rows, int]:
    """ATTITUDE rows, shape (n,), with time, quaternion and flags; how many lines were damaged. No file, no rows."""
    values = array("d")  # flat: hours of tuples would not fit in memory
    bad = 0
    try:
        for line in itertools.dropwhile(lambda text: text.startswith(("#", "t,")), bounded_lines(path, LONGEST_LINE)):
            row = _row(line)
            bad += row is None
            values.extend(row or ())
    except OSError:
        return empty_rows(ATTITUDE, 0), 1
    table = np.frombuffer(values, float).reshape(-1, COLUMNS)
    rows = empty_rows(ATTITUDE, len(table))
    rows["t"], rows["quat"] = table[:, 0], table[:, 1:5]
    rows["rest"], rows["disturbed"] = table[:, 8] != 0.0, table[:, 9] != 0.0
    return rows, bad


def _row(line: str) -> tuple[float, ...] | None:
    if not line.endswith("\n"):
        return None
    try:
        row = tuple(map(float, line.split(",")))
    except ValueError:
        return None
    return row if len(row) == COLUMNS else None
