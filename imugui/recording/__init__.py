"""Files of samples and attitudes."""

from __future__ import annotations

from imugui.recording.csv_files import (
    ATTITUDE_COLUMNS,
    Capture,
    UnreadableError,
    read_samples,
    write_attitude,
    write_samples,
)

__all__ = ["ATTITUDE_COLUMNS", "Capture", "UnreadableError", "read_samples", "write_attitude", "write_samples"]
