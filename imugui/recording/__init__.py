"""Files of samples and attitudes, and recordings."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from imugui.lazy import Lazy
from imugui.recording.base import SUFFIX, UnreadableError
from imugui.recording.events import Event

if TYPE_CHECKING:
    from imugui.recording.csv_files import ATTITUDE_COLUMNS, Capture, read_samples, write_attitude, write_samples
    from imugui.recording.folder import (
        FolderWriter,
        Recording,
        is_recording,
        read_about,
        read_recording,
        samples_file,
    )

__all__ = [
    "ATTITUDE_COLUMNS",
    "SUFFIX",
    "Capture",
    "Event",
    "FolderWriter",
    "Recording",
    "UnreadableError",
    "is_recording",
    "read_about",
    "read_recording",
    "read_samples",
    "samples_file",
    "write_attitude",
    "write_samples",
]

_FILES = ("ATTITUDE_COLUMNS", "Capture", "read_samples", "write_attitude", "write_samples")
_FOLDERS = ("FolderWriter", "Recording", "is_recording", "read_about", "read_recording", "samples_file")
_LATE: Lazy[Any] = Lazy(
    {name: f"imugui.recording.csv_files:{name}" for name in _FILES}
    | {name: f"imugui.recording.folder:{name}" for name in _FOLDERS}
)

if not TYPE_CHECKING:  # which knows them all

    def __getattr__(name: str) -> Any:
        """Import what reads and writes files when it is first asked for: start-up time."""
        if name in _LATE:
            return _LATE[name]
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
