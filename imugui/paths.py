"""Where resources and user files are, and how a file is replaced."""

from __future__ import annotations

import os
from pathlib import Path

import platformdirs

_HERE = Path(__file__).resolve().parent


def resources() -> Path:
    """The folder of icons and sample files: inside an installed package, else beside it in a checkout."""
    inside = _HERE / "resources"
    return inside if inside.is_dir() else _HERE.parent / "resources"


def user_folder() -> Path:
    """Where settings and logs of this user live (not created)."""
    return Path(platformdirs.user_data_dir("imugui", appauthor=False))


def documents_folder() -> Path:
    """Where recordings of this user go by default (not created)."""
    return Path(platformdirs.user_documents_dir()) / "imugui"


def replace_file(path: Path, text: str) -> None:
    """Write a text file whole: killed at any moment, there is the old one or the new one. Raises OSError."""
    temporary = path.with_name(f".{path.name[:80]}.{os.getpid()}.tmp")
    try:
        with temporary.open("wb") as stream:
            stream.write(text.encode("utf-8", "surrogateescape"))
            stream.flush()
            os.fsync(stream.fileno())
        temporary.replace(path)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise
