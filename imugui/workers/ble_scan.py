"""Looking for Bluetooth boards: what is in reach, with name, address, signal, kind and battery."""

from __future__ import annotations

import asyncio
import contextlib
import math
import time
from collections.abc import Callable
from concurrent.futures import CancelledError, Future
from dataclasses import dataclass
from typing import TYPE_CHECKING

from imugui.formats.ble_profiles import BATTERY_SERVICE, BLE_PROFILES, known_board
from imugui.workers.ble_errors import explain_ble
from imugui.workers.ble_loop import Radio, limited
from imugui.workers.port_errors import LinkError, Problem

if TYPE_CHECKING:
    from bleak.backends.device import BLEDevice
    from bleak.backends.scanner import AdvertisementData

START_S = 5.0
STOP_S = 5.0
NO_SIGNAL_DBM = -127  # what bleak says when it does not know


@dataclass(frozen=True)
class Sighting:
    """A board as it advertised itself last."""

    name: str
    address: str  # on macOS a UUID that only this computer uses
    rssi_dbm: float  # NaN when it is not known
    services: tuple[str, ...]
    battery_percent: float  # NaN when it is not advertised
    t: float  # host time, s

    @property
    def known(self) -> str:
        """The key of BLE_PROFILES that fits; "" for none."""
        return known_board(self.name, self.services)

    @property
    def family(self) -> str:
        """What kind of board it is, in words; "" when it is none that imugui knows."""
        return BLE_PROFILES[self.known].title if self.known else ""


def is_called(wanted: str, name: str | None, address: str) -> bool:
    """Whether a board with this name and address is the one that is wanted by name or address."""
    return wanted == name or wanted.lower() == address.lower()


Take = Callable[["BLEDevice", Sighting], bool]
"""Told of each advertisement; True when that was enough."""


async def listen(take: Take, seconds: float) -> None:
    """Scan until ``take`` has enough, or for so many s; raises what bleak raises. The caller holds the radio's turn."""
    from bleak import BleakScanner  # imported when used: start-up time

    enough = asyncio.Event()

    def heard(device: BLEDevice, advertisement: AdvertisementData) -> None:
        if take(device, sighting(device, advertisement)):
            enough.set()

    scanner = BleakScanner(heard)
    await limited(scanner.start(), START_S)
    try:
        with contextlib.suppress(TimeoutError):
            await limited(enough.wait(), seconds)
    finally:
        await limited(scanner.stop(), STOP_S)


def sighting(device: BLEDevice, advertisement: AdvertisementData) -> Sighting:
    """What one advertisement says."""
    battery = advertisement.service_data.get(BATTERY_SERVICE, b"")
    return Sighting(
        name=advertisement.local_name or device.name or "",
        address=device.address,
        rssi_dbm=float(advertisement.rssi) if advertisement.rssi > NO_SIGNAL_DBM else math.nan,
        services=tuple(service.lower() for service in advertisement.service_uuids),
        battery_percent=float(battery[0]) if len(battery) == 1 and battery[0] <= 100 else math.nan,
        t=time.perf_counter(),
    )


class Scan:
    """Boards in reach, gathered beside the caller: start it, look at ``boards`` now and then, stop it."""

    def __init__(self, radio: Radio, service: str = "", name: str = "") -> None:
        """Only boards that advertise this ``service`` (UUID) and have this ``name`` in theirs; "" for all."""
        self._radio = radio
        self._service, self._name = service.lower(), name.lower()
        self._seen: dict[str, Sighting] = {}
        self._task: Future[None] | None = None

    def start(self, seconds: float) -> None:
        """Look for so many s, from nothing; RuntimeError when the radio was stopped."""
        self.stop()
        self._seen = {}
        self._task = self._radio.submit(self._look(seconds))

    def stop(self) -> None:
        """Look no further; what was seen stays."""
        if self._task is not None:
            self._task.cancel()

    @property
    def running(self) -> bool:
        """Whether it still looks."""
        return self._task is not None and not self._task.done()

    @property
    def problem(self) -> Problem | None:
        """Why nothing can be seen."""
        task = self._task
        error = None if task is None or not task.done() or task.cancelled() else task.exception()
        return error.problem if isinstance(error, LinkError) else None

    @property
    def boards(self) -> list[Sighting]:
        """What was seen so far: known boards first, then the strongest."""
        return sorted(self._seen.copy().values(), key=_order)

    def wait(self) -> list[Sighting]:
        """The boards, when the time is over; LinkError when Bluetooth does not work."""
        if self._task is not None:
            with contextlib.suppress(CancelledError):
                self._task.result()
        return self.boards

    async def _look(self, seconds: float) -> None:
        try:
            async with self._radio.turn:
                await listen(self._take, seconds)
        except Exception as error:
            raise LinkError(explain_ble(error, "The board", "scan")) from error

    def _take(self, _: BLEDevice, board: Sighting) -> bool:
        if self._service in (*board.services, "") and self._name in board.name.lower():
            self._seen[board.address] = board
        return False


def _order(board: Sighting) -> tuple[bool, bool, float, str]:
    rssi = board.rssi_dbm
    return not board.family, not board.name, -rssi if math.isfinite(rssi) else math.inf, board.address
