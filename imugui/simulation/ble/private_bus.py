"""A D-Bus of our own: one dbus-daemon on a socket in a temporary folder, in place of the system's bus."""

from __future__ import annotations

import os
import subprocess
import tempfile
from pathlib import Path

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

    def kill(self) -> None:
        """Let the bus die as in a crash."""
        if self._daemon is not None:
            self._daemon.kill()
            self._end(self._daemon)

    def stop(self) -> None:
        """End the daemon in order and put the variable back."""
        if self._daemon is not None:
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
