"""The Bluetooth boards in reach, as lines of text."""

from __future__ import annotations

import math

from imugui.workers.ble_loop import Radio
from imugui.workers.ble_scan import Scan, Sighting
from imugui.workers.port_errors import LinkError


def found_boards(seconds: float, everything: bool) -> tuple[list[str], str]:
    """(a line for each board heard within so many s, a remark on the rest); ``everything``: unknown boards too."""
    radio = Radio()
    scan = Scan(radio)
    try:
        scan.start(seconds)
        heard = scan.wait()
    except LinkError as error:
        return [], f"No Bluetooth boards are listed. {error.problem.sentence}"
    finally:
        radio.stop()
    listed = [board for board in heard if everything or board.family]
    others = len(heard) - len(listed)
    remark = f"{others} other Bluetooth devices are in reach (--all lists them)." if others else ""
    if not listed:
        remark = f"No Bluetooth board found: switch one on, and end its connection to anything else. {remark}".strip()
    return [_line(board) for board in listed], remark


def _line(board: Sighting) -> str:
    facts = [board.family or "unknown", "signal not known"]
    if math.isfinite(board.rssi_dbm):
        facts[1] = f"{board.rssi_dbm:.0f} dBm"
    if math.isfinite(board.battery_percent):
        facts.append(f"battery {board.battery_percent:.0f} %")
    return "\t".join((board.address, board.name or "(no name)", ", ".join(facts)))
