"""The attitude CSV with all digits: what was shown, to be compared bit for bit."""

from __future__ import annotations

import itertools
from pathlib import Path

import numpy as np

from imugui.fusion.attitude import euler
from imugui.recording.csv_files import ATTITUDE_COLUMNS
from imugui.samples import ATTITUDE, Rows, empty_rows

COLUMNS = ATTITUDE_COLUMNS.count(",") + 1


def attitude_lines(rows: Rows) -> str:
    """One line for each ATTITUDE row, shape (n,): time and quaternion with all digits, angles for reading."""
    yaw, pitch, roll = np.rad2deg(euler(rows["quat"])).reshape(-1, 3).T.tolist()
    times, quats = rows["t"].tolist(), rows["quat"].tolist()
    flags = zip(rows["rest"].tolist(), rows["disturbed"].tolist(), strict=True)
    return "".join(
        f"{t!r},{w!r},{x!r},{y!r},{z!r},{r:.4f},{p:.4f},{h:.4f},{rest:d},{disturbed:d}\n"
        for t, (w, x, y, z), r, p, h, (rest, disturbed) in zip(times, quats, roll, pitch, yaw, flags, strict=True)
    )


def read_attitude(path: Path) -> tuple[Rows, int]:
    """ATTITUDE rows, shape (n,), with time, quaternion and flags; how many lines were damaged. No file, no rows."""
    values: list[tuple[float, ...]] = []
    bad = 0
    try:
        with path.open(encoding="utf-8", errors="replace") as stream:
            for line in itertools.dropwhile(lambda text: text.startswith(("#", "t,")), stream):
                row = _row(line)
                bad += row is None
                if row is not None:
                    values.append(row)
    except OSError:
        return empty_rows(ATTITUDE, 0), 1
    table = np.array(values, float).reshape(-1, COLUMNS)
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
