"""Errors of a port in words: what happened, why it probably did, what to do next."""

from __future__ import annotations

import errno
import getpass
import re
import sys
from dataclasses import dataclass

from serial import SerialException

try:
    from termios import error as _TermiosError  # noqa: N812
except ImportError:  # Windows

    class _TermiosError(Exception):  # type: ignore[no-redef]
        """Stands in where there is no termios."""


PORT_ERRORS = (SerialException, OSError, _TermiosError, ValueError)
"""Everything that opening or reading a port was seen to raise; ValueError: a URL or rate pyserial refuses."""


@dataclass(frozen=True)
class Problem:
    """``kind`` is a key of SENTENCES, here or in ble_errors."""

    kind: str
    sentence: str
    cause: bool = False  # it explains a loss that was said before, and is said itself when it is found


class LinkError(OSError):
    """A failure that is known in words where it is raised."""

    def __init__(self, problem: Problem) -> None:
        super().__init__(problem.sentence)
        self.problem = problem


SENTENCES = {
    "missing": "There is no port {port}. The board is not plugged in, or the cable only charges. "
    "Plug it in; imugui connects by itself.",
    "busy": "Port {port} is in use by another program (an Arduino serial monitor, or a second imugui). "
    "Close it; imugui connects by itself.",
    "denied": "No permission to use {port}. {remedy}",
    "gone": "Port {port} is gone: the cable was pulled or the board was switched off. "
    "Plug it in again; imugui carries on by itself.",
    "address": "{port} is not a port that can be opened: {detail}. Choose one from the list.",
    "other": "Port {port} does not work: {detail}. Unplug the board, plug it in again.",
}

_KINDS = {
    errno.ENOENT: "missing",
    errno.ENODEV: "missing",
    errno.ENXIO: "missing",
    errno.EBUSY: "busy",
    errno.EAGAIN: "busy",  # our own exclusive lock, held by a second imugui
    errno.EACCES: "denied",
    errno.EPERM: "denied",
    errno.EIO: "gone",
    errno.EBADF: "gone",
}

_WINDOWS_KINDS = {2: "missing", 3: "missing", 5: "busy", 22: "gone", 31: "gone", 121: "missing", 433: "gone"}


def explain(error: BaseException, port: str, *, opening: bool) -> Problem:
    """The problem behind an exception that opening (or, if not ``opening``, reading) ``port`` raised."""
    if isinstance(error, LinkError):
        return error.problem
    kind = _kind(error, opening)
    text = SENTENCES[kind].format(port=port, remedy=_remedy(port), detail=str(error) or type(error).__name__)
    return Problem(kind, text)


def explain_file(error: BaseException, path: str) -> Problem:
    """The problem behind an exception that opening a file, or making the virtual board, raised."""
    if isinstance(error, LinkError):
        return error.problem
    if isinstance(error, ValueError):
        return Problem("file", str(error))
    detail = getattr(error, "strerror", None) or str(error)
    return Problem("file", f"{path} cannot be read: {detail}. Choose another file.")


def _kind(error: BaseException, opening: bool) -> str:
    if isinstance(error, ValueError):
        return "address"
    if sys.platform == "win32":
        found = re.findall(r"[,(]\s*(\d+)\)", str(error))
        return _WINDOWS_KINDS.get(int(found[-1]), "other") if found else "other"
    number = getattr(error, "errno", None)
    if number is None and error.args and isinstance(error.args[0], int):
        number = error.args[0]
    if number in _KINDS:
        return _KINDS[number]
    return "other" if opening else "gone"


def _remedy(port: str) -> str:
    if sys.platform.startswith("linux"):
        return f"Run: sudo usermod -aG dialout {_user()}  (on Arch: uucp), then log out and in again."
    return "Close other programs that use it, or allow access in the system's settings."


def _user() -> str:
    try:
        return getpass.getuser()
    except (KeyError, OSError):
        return "$USER"
