"""Threads and the session. TRANSPORTS: every way samples can come in."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from imugui.lazy import Lazy

if TYPE_CHECKING:
    from imugui.workers.transport import Transport

TRANSPORTS: Lazy[Callable[..., Transport]] = Lazy(
    {
        "serial": "imugui.workers.serial_transport:SerialTransport",
        "ble": "imugui.workers.ble_transport:BleTransport",
        "replay": "imugui.workers.replay_transport:ReplayTransport",
        "simulator": "imugui.workers.simulator_transport:SimulatorTransport",
    }
)
"""Each is made of a Source; a ``wireless`` one of a Source and the Radio."""
