"""Errors of Bluetooth in words: what happened, why it probably did, what to do next, on each system.

The tables know bleak's errors by name and text, so that nothing of bleak is loaded for them.
"""

from __future__ import annotations

import math
import re
import sys

from imugui.workers.port_errors import Problem

WEAK_DBM = -85.0  # below this, walking away is the likeliest reason of a loss
LOW_PERCENT = 10.0

# (class of the error or one of its bases, pattern in its text, kind); the first that fits
RULES = (
    ("BoardInUseError", "", "ours"),
    ("BleakBluetoothNotAvailableError", "POWERED_OFF", "off"),
    ("BleakBluetoothNotAvailableError", "DENIED", "denied"),
    ("BleakBluetoothNotAvailableError", "NO_BLE_CENTRAL_ROLE", "classic"),
    ("BleakBluetoothNotAvailableError", "", "no_adapter"),
    ("BleakDBusError", r"AccessDenied|NotAuthorized", "denied"),
    ("BleakDBusError", r"ServiceUnknown|Spawn\.|NoReply|NameHasNoOwner", "no_service"),
    ("BleakDBusError", r"NotReady|Input/output error|Resource Not Ready", "off"),
    ("BleakDBusError", r"InProgress", "stuck"),
    ("BleakDBusError", r"Not paired|Authentication", "pairing"),
    ("BleakDBusError", r"NotSupported|NotPermitted", "wrong_board"),
    ("BleakDBusError", r"UnknownObject|DoesNotExist|doesn't exist", "forgotten"),
    ("BleakDBusError", r"abort-by-local|ConnectionAttemptFailed|Page Timeout|Host is down", "away"),
    ("BleakDBusError", r"abort-by-remote|AlreadyConnected|Software caused", "refused"),
    ("BleakDeviceNotFoundError", "", "forgotten"),
    ("BleakCharacteristicNotFoundError", "", "wrong_board"),
    ("BleakGATTProtocolError", "Authentication|Encryption|Authorization", "pairing"),
    ("BleakGATTProtocolError", "", "dropped"),
    ("BleakError", r"failed to discover services|Unreachable|disconnected|Not connected|Discovery has not", "dropped"),
    ("BleakError", r"Access ?Denied", "pairing"),
    ("BleakError", r"device .* not found", "forgotten"),
    ("BleakError", r"requires BlueZ", "old_service"),
    ("BleakError", r"Windows GUI", "thread"),
    ("AuthError", "", "denied"),
    ("PermissionError", "", "denied"),
    ("ImportError", "", "no_library"),
    ("ConnectionError", "", "no_service"),
    ("EOFError", "", "no_service"),
    ("FileNotFoundError", "", "no_bus"),
    ("TimeoutError", "", "timeout"),
    ("OSError", r"-2147020577|not ready for use", "no_adapter"),  # Windows
)

TIMEOUTS = {"scan": "stuck", "connect": "away", "setup": "dropped", "stream": "silent"}
"""What a time limit that ran out means, by what was being done."""

SENTENCES = {
    "off": "Bluetooth is switched off. {remedy} imugui connects by itself.",
    "no_adapter": "This computer has no Bluetooth adapter that answers. {remedy} imugui connects by itself.",
    "classic": "The Bluetooth adapter knows only classic Bluetooth, not Low Energy. "
    "Plug in an adapter for Bluetooth 4.0 or newer.",
    "no_bus": "Bluetooth cannot be reached: the system's message bus is not there. {remedy}",
    "no_service": "The system's Bluetooth service does not answer: it is not installed, was stopped, or crashed. "
    "{remedy}",
    "old_service": "The system's Bluetooth service is too old. {remedy}",
    "no_library": "The Python package bleak, which imugui uses for Bluetooth, is missing. "
    "Run: pip install bleak  and start imugui again.",
    "denied": "No permission to use Bluetooth. {remedy}",
    "stuck": "Bluetooth hangs: a scan could not be started in time. {remedy}",
    "thread": "Bluetooth was used on the window's own thread, which Windows does not allow. "
    "This is a defect in imugui; please report it.",
    "away": "{board} was not found: it is switched off, out of reach, or connected to something else, "
    "for then it does not advertise. Switch it on and bring it closer; end its connection to a phone or another "
    "program. imugui goes on looking.{remedy}",
    "elsewhere": "{board} is connected to this computer already, by another program or by one that crashed. {remedy} "
    "imugui connects as soon as it is free.",
    "several": "Several boards in reach are called {board}: {detail}. Choose one by its address, or switch the others "
    "off and connect again.",
    "ours": "{board} is open in this imugui already: a board can be connected only once. "
    "Disconnect it there, or choose another board.",
    "refused": "{board} refused the connection: it talks to something else, or is just restarting. "
    "End its other connection. imugui tries again.",
    "dropped": "{board} answered, but the link dropped while it was being set up: it is at the edge of its reach, its "
    "battery is weak, or an old pairing is in the way. Bring it closer. imugui tries again.{remedy}",
    "wrong_board": "{board} is connected but has no characteristic that sends motion data: it is another device, "
    "or has another firmware. Choose another board.",
    "unknown_board": "{board} is connected, but imugui does not know what it speaks: none of its services is in "
    "the table of known boards. Choose another board, or add a line to formats/ble_profiles.py.",
    "pairing": "{board} asks for pairing, which the boards imugui knows do not need. {remedy}",
    "lost": "The link to {board} was lost{reason}. {advice} imugui connects again by itself; a recording goes on.",
    "silent": "{board} has gone silent and no longer answers: the system's Bluetooth service or the adapter hangs, or "
    "crashed. imugui connects again by itself; a recording goes on.{remedy}",
    "stopped": "Connecting to {board} was given up.",
    "other": "Bluetooth failed: {detail}. Switch Bluetooth off and on, then the board; imugui tries again.",
}

LINUX, WINDOWS, MAC = "linux", "win32", "darwin"
REMEDIES: dict[str, dict[str, str]] = {
    "off": {
        LINUX: "Switch it on in the system's settings, or run: rfkill unblock bluetooth; bluetoothctl power on.",
        WINDOWS: "Switch it on under Settings, Bluetooth & devices, and leave flight mode.",
        MAC: "Switch it on in the menu bar or under System Settings, Bluetooth.",
    },
    "no_adapter": {
        LINUX: "Plug in a Bluetooth 4.0 adapter; in a virtual machine or WSL there is none.",
        WINDOWS: "Plug in a Bluetooth 4.0 adapter, and look for its driver in the Device Manager.",
        MAC: "Restart the computer; in a virtual machine there is none.",
    },
    "no_bus": {
        LINUX: "In WSL run the Windows version of imugui; in a container give it /run/dbus/system_bus_socket; "
        "otherwise install and start dbus."
    },
    "no_service": {
        LINUX: "Run: sudo apt install bluez; sudo systemctl enable --now bluetooth. imugui connects by itself.",
        WINDOWS: "Start the 'Bluetooth Support Service' in services.msc. imugui connects by itself.",
        MAC: "Switch Bluetooth off and on. imugui connects by itself.",
    },
    "old_service": {LINUX: "Install BlueZ 5.55 or newer (bluetoothctl --version tells it)."},
    "denied": {
        LINUX: "Run: sudo usermod -aG bluetooth $USER, then log out and in again; in a Flatpak allow "
        "--system-talk-name=org.bluez.",
        WINDOWS: "Allow it under Settings, Privacy & security, Radios; then start imugui again.",
        MAC: "Allow it for imugui, or for the terminal it was started from, under System Settings, "
        "Privacy & Security, Bluetooth; then start imugui again.",
    },
    "stuck": {
        LINUX: "Run: bluetoothctl power off; bluetoothctl power on. imugui tries again.",
        WINDOWS: "Switch Bluetooth off and on in the settings. imugui tries again.",
        MAC: "Switch Bluetooth off and on in the menu bar. imugui tries again.",
    },
    "away": {LINUX: " After a crash a board may still be held: bluetoothctl disconnect."},
    "elsewhere": {
        LINUX: "Close that program, or run: bluetoothctl disconnect {address}.",
        WINDOWS: "Close that program, or remove the device under Settings, Bluetooth & devices.",
        MAC: "Close that program, or disconnect the device under System Settings, Bluetooth.",
    },
    "dropped": {WINDOWS: " If it stays so, remove the device under Settings, Bluetooth & devices."},
    "pairing": {
        LINUX: "Run: bluetoothctl pair {address}.",
        WINDOWS: "Remove the device under Settings, Bluetooth & devices, add it again, and retry.",
        MAC: "Forget the device under System Settings, Bluetooth, and retry.",
    },
    "silent": {LINUX: " If it stays so, run: sudo systemctl restart bluetooth."},
}

CAUSES = ("off", "no_adapter", "classic", "no_bus", "no_service", "denied", "stuck", "elsewhere", "ours", "wrong_board")
"""Kinds that explain a loss better than what was said when it happened; they are said when they are found."""


def explain_ble(error: BaseException, board: str, stage: str, address: str = "") -> Problem:
    """The problem behind an exception; ``stage`` is what was being done, a key of TIMEOUTS."""
    kind = kind_of(error)
    kind = {"timeout": TIMEOUTS[stage], "forgotten": "away"}.get(kind, kind)
    return problem(kind, board, address, str(error) or type(error).__name__)


def kind_of(error: BaseException) -> str:
    """A key of SENTENCES, or "timeout", or "forgotten": the system does not know of the board (any more)."""
    names = {one.__name__ for one in type(error).__mro__}
    text = str(error)
    return next((kind for name, pattern, kind in RULES if name in names and re.search(pattern, text)), "other")


def problem(kind: str, board: str, address: str = "", detail: str = "") -> Problem:
    """A problem in this system's words; ``address`` is put into commands that need one."""
    system = sys.platform if sys.platform in (WINDOWS, MAC) else LINUX
    remedy = REMEDIES.get(kind, {}).get(system, "").format(address=address or "ADDRESS")
    text = SENTENCES[kind].format(board=board, remedy=remedy, detail=detail, reason="", advice="")
    return Problem(kind, " ".join(text.split()), kind in CAUSES)


def lost(board: str, rssi_dbm: float, battery_percent: float) -> Problem:
    """The link dropped while data came; signal (dBm) and battery (%) as last known, NaN when they are not."""
    if battery_percent <= LOW_PERCENT:
        reason, advice = f"; its battery was at {battery_percent:.0f} %", "Charge it or change its battery."
    elif rssi_dbm < WEAK_DBM:
        reason, advice = f"; its signal was weak ({rssi_dbm:.0f} dBm)", "Bring it closer."
    else:
        known = "" if math.isnan(battery_percent) else f" (its battery was at {battery_percent:.0f} %)"
        reason, advice = f": it is out of reach or was switched off{known}", "Bring it closer, or switch it on."
    text = SENTENCES["lost"].format(board=board, reason=reason, advice=advice)
    return Problem("lost", text)
