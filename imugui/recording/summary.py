"""What a list shows of a recording: a quick look that never reads more than it must."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from imugui.recording.base import SUFFIX
from imugui.recording.folder import ABOUT, LARGEST_JSON, SAMPLES
from imugui.texts import from_json

COLUMNS = 160  # of the preview
WHOLE_BYTES = 64_000_000  # a larger file is looked at in places
LOOKS, LOOK_BYTES = 800, 2048  # so many, each so long
TAIL_BYTES = 4096
LONGEST_LINE = 1 << 16
GAP_PERIODS, GAP_MIN_S = 3.5, 0.02  # a longer step is a gap, as on the status line
UNKNOWN = -1


@dataclass(frozen=True)
class Summary:
    """One recording. Numbers that are not known are NaN or UNKNOWN."""

    path: Path
    label: str = ""
    note: str = ""
    started_utc: str = ""
    board: str = ""
    complete: bool = False  # it was ended in order
    rows: int = UNKNOWN
    rate_hz: float = math.nan
    length_s: float = math.nan
    gaps: int = UNKNOWN
    size_bytes: int = 0
    problem: str = ""
    preview: NDArray[np.float64] = field(default_factory=lambda: np.empty((0, 3)))
    """(k, 3): time from the start in s, lowest and highest |gyr| in rad/s."""


def recordings_in(folder: Path) -> list[Path]:
    """The recordings of a folder, newest name first; none when it cannot be read."""
    try:
        found = [path for path in folder.iterdir() if path.suffix == SUFFIX and (path / ABOUT).is_file()]
    except OSError:
        return []
    return sorted(found, key=lambda path: path.name, reverse=True)


def summarise(path: Path) -> Summary:
    """Look at a recording; what is wrong with it is told in the summary, not raised."""
    try:
        about = _about(path / ABOUT)
        size = sum(part.stat().st_size for part in path.iterdir())
    except (OSError, ValueError, RecursionError) as error:
        return Summary(path, problem=f"cannot be read: {getattr(error, 'strerror', None) or error}")
    texts = {key: str(about.get(key, "")) for key in ("label", "note", "started_utc", "board")}
    ended = about.get("ended")
    rows = ended.get("rows", UNKNOWN) if isinstance(ended, dict) else UNKNOWN
    common: dict[str, Any] = {**texts, "complete": ended is not None, "size_bytes": size}
    try:
        table, whole = _table(path / SAMPLES)
    except OSError as error:
        return Summary(path, **common, problem=f"cannot be read: {error.strerror}")
    if len(table) < 2:
        return Summary(path, **common, problem="holds no samples")
    return Summary(path, **common, **_numbers(table, whole, rows), preview=_preview(table))


def _about(path: Path) -> dict[str, Any]:
    if path.stat().st_size > LARGEST_JSON:
        raise ValueError("its description is too large")
    about = from_json(path.read_text(encoding="utf-8"))
    if not isinstance(about, dict):
        raise ValueError("its description is damaged")
    return about


def _table(path: Path) -> tuple[NDArray[np.float64], bool]:
    """(time s, |gyr| rad/s) of the samples, shape (n, 2), and whether these are all."""
    size = path.stat().st_size
    with path.open("rb") as stream:
        head = stream.readline(LONGEST_LINE)
        while head.startswith(b"#"):
            head = stream.readline(LONGEST_LINE)
        names = head.decode("ascii", "replace").strip().split(",")
        places = [names.index(name) if name in names else None for name in ("t", "gx", "gy", "gz")]
        whole = size <= WHOLE_BYTES
        lines = stream if whole else _looks(stream, stream.tell(), size)
        values = [row for line in lines if (row := _row(line, places)) is not None]
    return np.array(values, float).reshape(-1, 2), whole


def _looks(stream: Any, start: int, size: int) -> Iterable[bytes]:
    """Whole lines from places spread over the file, and its last."""
    step = (size - TAIL_BYTES - start) / LOOKS
    places = [start + int(i * step) for i in range(LOOKS)]
    for place in (*places, size - TAIL_BYTES):
        stream.seek(place)
        lines = stream.read(TAIL_BYTES if place > places[-1] else LOOK_BYTES).splitlines()
        yield from lines[0 if place == start else 1 : -1]


def _row(line: bytes, places: list[int | None]) -> tuple[float, float] | None:
    cells = line.split(b",")
    try:
        t, *gyr = (float(cells[place]) if place is not None else math.nan for place in places)
    except (ValueError, IndexError):
        return None
    return (t, math.hypot(*gyr)) if math.isfinite(t) else None


def _numbers(table: NDArray[np.float64], whole: bool, rows: int) -> dict[str, Any]:
    length = float(np.ptp(table[:, 0]))
    rows = len(table) if whole else rows
    steps = np.diff(table[:, 0])
    period = float(np.median(steps[steps > 0.0])) if (steps > 0.0).any() else math.nan
    gaps = int((steps > max(GAP_PERIODS * period, GAP_MIN_S)).sum()) if whole else UNKNOWN
    return {"rows": rows, "length_s": length, "rate_hz": 1.0 / period, "gaps": gaps}


def _preview(table: NDArray[np.float64]) -> NDArray[np.float64]:
    starts = np.unique(np.linspace(0, len(table), min(COLUMNS, len(table)), endpoint=False).astype(int))
    low, high = np.fmin.reduceat(table[:, 1], starts), np.fmax.reduceat(table[:, 1], starts)
    return np.column_stack((table[starts, 0] - table[0, 0], low, high))
