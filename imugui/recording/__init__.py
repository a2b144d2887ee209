"""Files of samples and attitudes, and recordings."""

from __future__ import annotations

from imugui.recording import raw
from imugui.recording.csv_files import (
    ATTITUDE_COLUMNS,
    Capture,
    UnreadableError,
    read_samples,
    write_attitude,
    write_samples,
)
from imugui.recording.events import Event
from imugui.recording.folder import SUFFIX, Recording, is_recording, read_recording, samples_file

__all__ = [
    "ATTITUDE_COLUMNS",
    "SUFFIX",
    "Capture",
    "Event",
    "Recording",
    "UnreadableError",
    "is_recording",
    "raw",
    "read_recording",
    "read_samples",
    "samples_file",
    "write_attitude",
    "write_samples",
]
