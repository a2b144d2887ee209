"""What a recording is called, and what is raised when a file cannot be read."""

from __future__ import annotations

SUFFIX = ".imugui"


class UnreadableError(Exception):
    """A file that holds no samples; the message says why and what to do."""
