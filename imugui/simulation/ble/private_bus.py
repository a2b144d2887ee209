"""A D-Bus of our own: one dbus-daemon on a socket in a temporary folder, in place of the system's bus."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import tempfile
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from dbus_fast.aio import MessageBus

from imugui.simulation.ble import DAEMON

VARIABLE = "DBUS_SYSTEM_BUS_ADDRESS"
STOP_S = 5.0
CONFIG = """<!DOCTYPE busconfig PUBLIC "-//freedesktop//DTD D-Bus Bus Configuration 1.0//EN"
 "http://www.freedesktop.org/standards/dbus/1.0/busconfig.dtd">
<busconfig>
  <type>session</type>
  <listen>unix:path={socket}</listen>
  <auth>EXTERNAL</auth>
  <policy context="default">
    <allow send_destination="*" eavesdrop="true"/><allow eavesdrop="true"/><allow own="*"/><allow user="*"/>
  </policy>
</busconfig>
"""


class PatientSocket:
    """The sending half of a socket that does not block; a full one takes nothing, which is no error.

    dbus-fast would give the whole connection up: then the service is gone because the daemon was kept waiting.
    """

    def __init__(self, real: socket.socket) -> None:
        self._real = real

    def send(self, data: memoryview) -> int:
        """Send what fits; the number of bytes, 0 when the socket is full."""
        try:
            return self._real.send(data)
        except BlockingIOError:
            return 0

    def sendmsg(self, buffers: Iterable[memoryview], ancillary: Any) -> int:
        """Send with file descriptors, of which this bus has none to pass on."""
        return self._real.sendmsg(buffers, ancillary)


async def connect(address: str) -> MessageBus:
    """A connection to a bus that outlives a daemon which does not read for a while. Written for dbus-fast 5."""
    bus = await MessageBus(bus_address=address, negotiate_unix_fd=True).connect()
    writer: Any = bus._writer
    writer.sock = PatientSocket(writer.sock)
    return bus


class PrivateBus:
    """The daemon, and the variable by which this process takes it for the system bus."""

    def __init__(self, exported: bool = True) -> None:
        """``exported``: set the variable while the bus runs; otherwise pass ``address`` on yourself."""
        self.address = ""
        self._exported = exported
        self._before: str | None = None
        self._folder: tempfile.TemporaryDirectory[str] | None = None
        self._daemon: subprocess.Popen[str] | None = None

    def start(self) -> None:
        """Start the daemon; OSError when it cannot be run."""
        self._folder = tempfile.TemporaryDirectory(prefix="imugui-bus-")
        folder = Path(self._folder.name)
        config = folder / "bus.conf"
        config.write_text(CONFIG.format(socket=folder / "bus"), encoding="utf-8")
        self._daemon = subprocess.Popen(  # noqa: S603
            [DAEMON, f"--config-file={config}", "--nofork", "--print-address=1"],
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
        )
        self.address = self._daemon.stdout.readline().strip() if self._daemon.stdout else ""
        if not self.address:
            self.stop()
            raise OSError(f"{DAEMON} did not start")
        if self._exported:
            self._before = os.environ.get(VARIABLE)
            os.environ[VARIABLE] = self.address

    def pause(self, on: bool) -> None:
        """Stop the daemon where it is, or let it go on; nothing is lost."""
        if self._daemon is not None:
            self._daemon.send_signal(signal.SIGSTOP if on else signal.SIGCONT)

    def kill(self) -> None:
        """Let the bus die as in a crash."""
        if self._daemon is not None:
            self._daemon.kill()
            self._end(self._daemon)

    def stop(self) -> None:
        """End the daemon in order and put the variable back."""
        if self._daemon is not None:
            self.pause(False)
            self._daemon.terminate()
            self._end(self._daemon)
        if self._exported and os.environ.get(VARIABLE) == self.address:
            os.environ.pop(VARIABLE)
            if self._before is not None:
                os.environ[VARIABLE] = self._before
        if self._folder is not None:
            self._folder.cleanup()
        self._folder, self._daemon = None, None

    @staticmethod
    def _end(daemon: subprocess.Popen[str]) -> None:
        daemon.wait(STOP_S)
        if daemon.stdout and not daemon.stdout.closed:
            daemon.stdout.close()
