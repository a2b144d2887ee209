"""Recordings in words: names that sort, lengths, sizes, and how long the disk will last."""

from __future__ import annotations

import datetime
import math
import re
from pathlib import Path

from imugui.recording import SUFFIX
from imugui.workers.session import LOW_DISK, RecordingStatus

LABEL_LENGTH = 40
SOON_S = 2.0  # a rate of writing that was watched for less is not known yet
SIZES = ((1e9, "GB"), (1e6, "MB"), (1e3, "kB"))
LONG_TIMES = ((86400.0, "d"), (3600.0, "h"), (60.0, "min"), (1.0, "s"))


def file_label(label: str) -> str:
    """A label as every system takes it in a file name: letters, digits, "-" and "_"."""
    return re.sub(r"[\W-]+", "-", label.strip()).strip("-_")[:LABEL_LENGTH].strip("-_")


def recording_path(folder: Path, label: str, now: datetime.datetime) -> Path:
    """A new name in the folder that sorts by local time: YYYY-MM-DD_HH-MM-SS_LABEL.imugui."""
    stem = "_".join(filter(None, (now.strftime("%Y-%m-%d_%H-%M-%S"), file_label(label))))
    path, number = folder / f"{stem}{SUFFIX}", 2
    while path.exists():
        path, number = folder / f"{stem}-{number}{SUFFIX}", number + 1
    return path


def elapsed_words(seconds: float) -> str:
    """Time since a start: "0:07", "12:34", "1:02:03"."""
    minutes, rest = divmod(int(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02}:{rest:02}" if hours else f"{minutes}:{rest:02}"


def length_words(seconds: float) -> str:
    """A length: "12.3 s", "2 min 05 s", "1 h 02 min"."""
    if math.isnan(seconds):
        return "? s"
    if seconds < 59.95:
        return f"{seconds:.1f} s"
    minutes, rest = divmod(round(seconds), 60)
    if minutes < 60:
        return f"{minutes} min {rest:02} s"
    return f"{minutes // 60} h {minutes % 60:02} min"


def size_words(size_bytes: float) -> str:
    """A size in three digits: "980 B", "1.2 MB", "12.3 GB"."""
    for scale, unit in SIZES:
        if size_bytes >= 0.9995 * scale:
            value = size_bytes / scale
            return f"{value:.0f} {unit}" if value >= 99.95 else f"{value:.1f} {unit}"
    return f"{size_bytes:.0f} B"


def is_low(status: RecordingStatus) -> bool:
    """Whether the disk is nearly full."""
    return status.free_bytes < LOW_DISK


def free_words(status: RecordingStatus) -> str:
    """What is free on the disk, and how long that lasts at the present rate."""
    words = f"{size_words(status.free_bytes)} free"
    if status.elapsed_s < SOON_S or status.size_bytes == 0:
        return words
    left_s = status.free_bytes * status.elapsed_s / status.size_bytes
    scale, unit = next((one for one in LONG_TIMES if left_s >= 2 * one[0]), LONG_TIMES[-1])
    return f"{words}, enough for about {left_s / scale:.0f} {unit}"


def ended_words(status: RecordingStatus) -> str:
    """What was recorded."""
    words = f"Recorded {length_words(status.elapsed_s)}, {size_words(status.size_bytes)}: {status.path.name}"
    return f"{words}. {status.missed_rows} rows could not be written in time." if status.missed_rows else words
