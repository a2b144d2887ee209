"""Files that survive a killed program: appended to line by line, or replaced whole (paths.replace_file)."""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path

LARGEST = 256 << 20
"""bytes; a target of a study has about five hundred."""


def read_text(path: Path) -> str:
    """A whole text file; what is no UTF-8 in it is kept as it is (see ``to_bytes``). Raises OSError and ValueError."""
    with path.open("rb") as stream:
        data = stream.read(LARGEST + 1)
    if len(data) > LARGEST:
        raise ValueError(f"it is larger than {LARGEST >> 20} MB")
    return data.decode("utf-8", "surrogateescape")


def to_bytes(text: str) -> bytes:
    """The bytes that ``read_text`` found."""
    return text.encode("utf-8", "surrogateescape")


def append(path: Path, head: str, lines: Iterable[str], safe: bool = False) -> None:
    """Append whole lines to a table that begins with ``head``; ``safe``: wait until the disk has them. OSError."""
    with path.open("a+b") as stream:
        start = head if not stream.seek(0, os.SEEK_END) else ""
        if not start:
            stream.seek(-1, os.SEEK_END)
            # a row that was cut short must not spoil the next one
            start = "" if stream.read(1) == b"\n" else "\n"
        stream.write(to_bytes(start + "".join(lines)))
        stream.flush()
        if safe:
            os.fsync(stream.fileno())


def set_aside(path: Path) -> str:
    """Give a file a name that is free, and tell it. Raises OSError."""
    number = 1
    while (other := path.with_name(f"{path.stem}.broken-{number}{path.suffix}")).exists():
        number += 1
    path.replace(other)
    return other.name
