"""A serial port without hardware: a pseudo-terminal whose far end is ours. POSIX systems only."""

from __future__ import annotations

import contextlib
import os
import select
import sys
import threading
from pathlib import Path

NO_PTYS = (
    "This system has no pseudo-terminals, so a virtual board cannot be a serial port here. "
    "Use the simulated board in the window instead, or run this on Linux or macOS."
)


class PtyPort:
    """One pseudo-terminal, in raw mode, optionally under a link with a steady name.

    ``close`` is pulling the plug: readers get an error at once. ``open`` again is plugging in: a new terminal
    under the same link. Writing never waits: what a stalled reader leaves no room for is dropped as whole lines.
    One thread may pull the plug while another writes.
    """

    def __init__(self, link: Path | None = None) -> None:
        self.link = link
        self.name = ""  # the terminal's own path, e.g. /dev/pts/3; "" while unplugged
        self.dropped_bytes = 0
        self._lock = threading.Lock()  # a number just closed may already be another file's
        self._master = -1
        self._rest = b""  # the end of a line of which the beginning is written

    @property
    def path(self) -> str:
        """What to connect to: the link if there is one."""
        return str(self.link) if self.link else self.name

    def open(self) -> None:
        """Plug in. OSError in words: no pseudo-terminals here, or the link cannot be made."""
        if sys.platform == "win32":
            raise OSError(NO_PTYS)
        import tty  # not on Windows

        with self._lock:
            if self._master >= 0:
                return
            self._refuse_taken_link()
            self._master, slave = os.openpty()
            self.name = os.ttyname(slave)
            tty.setraw(slave)
            os.close(slave)  # with our own hold on it gone, a hang-up tells whether anybody has it open
            os.set_blocking(self._master, False)
            self._make_link()

    def close(self) -> None:
        """Pull the plug; the link goes too."""
        with self._lock:
            self._unplug()

    def has_reader(self) -> bool:
        """Whether anybody has the port open."""
        with self._lock:
            if self._master < 0:
                return False
            poll = select.poll()
            poll.register(self._master, 0)
            return not any(event & select.POLLHUP for _, event in poll.poll(0))

    def write(self, chunk: bytes) -> int:
        """Write as many whole lines as fit and drop the others; returns the bytes dropped now."""
        with self._lock:
            self._drain()
            unsent = self._send(self._rest)
            if unsent:
                self._rest, lost = unsent, len(chunk)
            else:
                unsent = self._send(chunk)
                self._rest = _begun_line(chunk, unsent)
                lost = len(unsent) - len(self._rest)
            self.dropped_bytes += lost
            return lost

    def forget(self) -> None:
        """Throw away what the last reader left unread, so that the next one starts with fresh bytes."""
        if sys.platform == "win32":
            return
        import termios  # not on Windows

        with self._lock:
            self._rest = b""
            if self._master >= 0:
                slave = os.open(self.name, os.O_RDWR | os.O_NOCTTY)
                termios.tcflush(slave, termios.TCIFLUSH)
                os.close(slave)

    def _unplug(self) -> None:
        if self._master < 0:
            return
        os.close(self._master)
        if self.link and self.link.is_symlink() and str(self.link.readlink()) == self.name:
            self.link.unlink()
        self._master, self.name, self._rest = -1, "", b""

    def _refuse_taken_link(self) -> None:
        if self.link and self.link.exists() and not self.link.is_symlink():
            raise FileExistsError(f"{self.link} exists and is not a link; choose another name for the port.")

    def _make_link(self) -> None:
        if not self.link:
            return
        fresh = self.link.with_name(f".{self.link.name}.{os.getpid()}")
        try:
            fresh.unlink(missing_ok=True)
            fresh.symlink_to(self.name)
            fresh.replace(self.link)
        except OSError as error:
            self._unplug()
            raise OSError(f"The link {self.link} to the virtual port cannot be made: {error.strerror}.") from error

    def _send(self, chunk: bytes) -> bytes:
        """Write what fits; what did not."""
        with contextlib.suppress(OSError):  # full, or unplugged in this moment
            while chunk and self._master >= 0:
                chunk = chunk[os.write(self._master, chunk) :]
        return chunk

    def _drain(self) -> None:
        """Throw away what a reader sent to the board: no board of ours listens, and the reader must not block."""
        with contextlib.suppress(OSError):
            while self._master >= 0 and os.read(self._master, 4096):
                pass


def _begun_line(chunk: bytes, unsent: bytes) -> bytes:
    """The end of the line in which writing stopped, which must still be written; b"" if it stopped between lines."""
    sent = len(chunk) - len(unsent)
    if not unsent or sent == 0 or chunk[sent - 1 : sent] == b"\n":
        return b""
    return unsent[: unsent.find(b"\n") + 1 or len(unsent)]
