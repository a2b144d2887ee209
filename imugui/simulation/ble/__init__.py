"""Emulated Bluetooth LE boards on a real protocol stack, for tests and for trying the program without hardware.

Needs the extra ``ble-test`` (bumble, dbus-fast) and the program ``dbus-daemon``: Linux. Only this package imports
them, and nothing imports this package before it is asked for; ``missing`` tells beforehand what is not there.
"""

from __future__ import annotations

import importlib.util
import shutil

PACKAGES = ("bumble", "dbus_fast")
DAEMON = "dbus-daemon"


def missing() -> str:
    """What the emulation lacks on this machine, in one sentence; empty when it can run."""
    lacking = [name for name in PACKAGES if importlib.util.find_spec(name) is None]
    if lacking:
        return f"The emulated Bluetooth board needs {' and '.join(lacking)}: pip install 'imugui[ble-test]'."
    if shutil.which(DAEMON) is None:
        return f"The emulated Bluetooth board needs the program {DAEMON} (Debian: apt install dbus-daemon)."
    return ""
