"""Where resources and user files are."""

from __future__ import annotations

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
