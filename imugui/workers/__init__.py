"""Threads and the session. TRANSPORTS: every way samples can come in."""

from __future__ import annotations

from collections.abc import Callable

from imugui.workers.replay_transport import ReplayTransport
from imugui.workers.serial_transport import SerialTransport
from imugui.workers.simulator_transport import SimulatorTransport
from imugui.workers.transport import Source, Transport

TRANSPORTS: dict[str, Callable[[Source], Transport]] = {
    "serial": SerialTransport,
    "replay": ReplayTransport,
    "simulator": SimulatorTransport,
}
