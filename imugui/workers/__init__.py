"""Threads and the session. TRANSPORTS: every way samples can come in."""

from __future__ import annotations

from collections.abc import Callable

from imugui.workers.ble_loop import Radio
from imugui.workers.ble_transport import BleTransport
from imugui.workers.replay_transport import ReplayTransport
from imugui.workers.serial_transport import SerialTransport
from imugui.workers.simulator_transport import SimulatorTransport
from imugui.workers.transport import Source, Transport

TRANSPORTS: dict[str, Callable[[Source, Radio], Transport]] = {
    "serial": lambda source, _: SerialTransport(source),
    "ble": BleTransport,
    "replay": lambda source, _: ReplayTransport(source),
    "simulator": lambda source, _: SimulatorTransport(source),
}
