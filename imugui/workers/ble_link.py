"""One link to one Bluetooth board: found, connected, subscribed, watched, left. Runs in the Bluetooth thread."""

from __future__ import annotations

import asyncio
import contextlib
import math
import threading
import time
from collections import deque
from collections.abc import Coroutine
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from imugui.formats.ble_profiles import BATTERY_LEVEL, BLE_PROFILES, INFORMATION, BleProfile, known_board
from imugui.workers.ble_errors import explain_ble, kind_of, lost, problem
from imugui.workers.ble_loop import BoardInUseError, Radio, limited
from imugui.workers.ble_scan import Sighting, is_called, listen
from imugui.workers.port_errors import LinkError, Problem

if TYPE_CHECKING:
    from bleak import BleakClient
    from bleak.backends.characteristic import BleakGATTCharacteristic
    from bleak.backends.device import BLEDevice

SEARCH_S = 4.0
ALIKE_S = 1.5  # how long another board of the same name is listened for; the card advertises once a second
CONNECT_S = 5.0
CANCEL_S = 3.0  # that giving up a connection may take the system
STEP_S = 3.0  # of reading, writing, subscribing
QUIET_S = 1.5  # without a message for so long, the board is asked whether it is there
LOOK_S = 0.25
QUEUE = 1 << 12  # messages that wait for the reader: 40 s at 100 Hz


@dataclass
class BoardFacts:
    """What is known of the board; written in the Bluetooth thread, read by anyone, one attribute at a time."""

    name: str = ""
    address: str = ""
    rssi_dbm: float = math.nan  # as it advertised last: a link's own signal is not told by most systems
    battery_percent: float = math.nan
    about: dict[str, str] = field(default_factory=dict)  # device information: keys of INFORMATION
    overflow: int = 0  # messages that were dropped because nobody took them


class Mailbox:
    """Messages with their arrival times, from the Bluetooth thread to one other; bounded, the oldest give way."""

    def __init__(self, facts: BoardFacts) -> None:
        self.problem: Problem | None = None  # why no more will come
        self._facts = facts
        self._waiting: deque[tuple[float, bytes]] = deque(maxlen=QUEUE)
        self._news = threading.Event()

    def put(self, t: float, message: bytes) -> None:
        """Add what arrived at host time t, s."""
        self._facts.overflow += len(self._waiting) == QUEUE
        self._waiting.append((t, message))
        self._news.set()

    def close(self, why: Problem) -> None:
        """No more will come; the first reason stays."""
        self.problem = self.problem or why
        self._news.set()

    def take(self, wait_s: float) -> list[tuple[float, bytes]]:
        """Everything that waits, after so many s at the most; LinkError when nothing does and no more will come."""
        self._news.wait(wait_s)
        self._news.clear()
        messages = [self._waiting.popleft() for _ in range(len(self._waiting))]
        if not messages and self.problem is not None:
            raise LinkError(self.problem)
        return messages


class Link:
    """A link in the making, then a link. ``device``: as it was found before, to be connected without a search."""

    def __init__(self, radio: Radio, wanted: str, facts: BoardFacts, device: BLEDevice | None = None) -> None:
        """``wanted``: a name, or an address."""
        self.facts = facts
        self.mail = Mailbox(facts)
        self.device = device
        self.profile: BleProfile | None = None
        self._radio, self._wanted = radio, wanted
        self._client: BleakClient | None = None
        self._claimed = ""
        self._services: tuple[str, ...] = ()
        self._stage = "scan"
        self._quiet_since = math.nan
        self._battery_told = False
        self._tasks: set[asyncio.Task[None]] = set()

    async def open(self) -> None:
        """Find the board, connect and subscribe; LinkError in words."""
        try:
            async with self._radio.turn:
                await self._reach()
            await self._set_up()
        except BaseException as error:
            self.leave()
            if isinstance(error, LinkError) or not isinstance(error, Exception):
                raise
            raise LinkError(explain_ble(error, self._who, self._stage, self.facts.address)) from error

    def leave(self) -> None:
        """Disconnect, beside everything else."""
        self.mail.close(problem("stopped", self._who))
        for task in self._tasks:
            task.cancel()
        if self._claimed:
            address, self._claimed = self._claimed, ""
            self._radio.leave(address, self._farewell())

    async def _reach(self) -> None:
        if self.device is not None:
            try:
                await self._connect(self.device)
                return
            except Exception as error:
                if kind_of(error) != "forgotten":
                    raise
        await self._connect(await self._find())

    async def _find(self) -> BLEDevice:
        """Search for the board by its address, or by its name when it was never connected; one name may be several."""
        wanted = self.facts.address or self._wanted
        if self._radio.claimed(wanted) and not self._claimed:
            raise BoardInUseError(wanted)
        found: dict[str, tuple[BLEDevice, Sighting]] = {}

        def take(device: BLEDevice, board: Sighting) -> bool:
            if is_called(wanted, board.name, board.address):
                found[board.address] = device, board
            return bool(found)

        await listen(take, SEARCH_S)
        if not found:
            raise LinkError(await self._why_not_found(wanted))
        if all(wanted.lower() != address.lower() for address in found):
            await listen(lambda device, board: take(device, board) and False, ALIKE_S)
        if len(found) > 1:
            raise LinkError(problem("several", wanted, detail=_listed([board for _, board in found.values()])))
        ((device, board),) = found.values()
        self._meet(board)
        return device

    def _meet(self, board: Sighting) -> None:
        self.facts.name, self.facts.rssi_dbm = board.name, board.rssi_dbm
        if not math.isnan(board.battery_percent):
            self.facts.battery_percent = board.battery_percent
        self._services = board.services

    async def _why_not_found(self, wanted: str) -> Problem:
        """A board that this computer is connected to does not advertise."""
        from bleak import BleakAdapter

        services = [profile.service for profile in BLE_PROFILES.values()]
        with contextlib.suppress(Exception):  # a system that does not tell
            adapter = await limited(BleakAdapter.get(), STEP_S)
            for device in await limited(adapter.get_connected_devices(services), STEP_S):
                if is_called(wanted, device.name, device.address):
                    kind = "ours" if self._radio.claimed(device.address) else "elsewhere"
                    return problem(kind, self._who, device.address)
        return problem("away", self._who, self.facts.address)

    @property
    def _who(self) -> str:
        return self.facts.name or self._wanted

    async def _connect(self, device: BLEDevice) -> None:
        from bleak import BleakClient

        self._stage = "connect"
        if not self._claimed:
            await self._radio.claim(device.address)
        self._claimed = self.facts.address = device.address
        self._client = BleakClient(device, disconnected_callback=self._dropped, timeout=CONNECT_S)
        await limited(self._client.connect(), CONNECT_S + CANCEL_S)
        self.device = device

    async def _set_up(self) -> None:
        self._stage = "setup"
        client = self._connected()
        services = [service.uuid for service in client.services]
        key = known_board(self.facts.name, (*services, *self._services))
        if not key:
            raise LinkError(problem("unknown_board", self._who))
        self.profile = profile = BLE_PROFILES[key]
        await limited(client.start_notify(profile.notify, self._heard), STEP_S)
        for characteristic, data in profile.start:
            await limited(client.write_gatt_char(characteristic, data), STEP_S)
        self._quiet_since = time.perf_counter()
        self._stage = "stream"
        self._begin(self._watch())
        self._begin(self._ask())

    def _begin(self, work: Coroutine[Any, Any, None]) -> None:
        task = asyncio.get_running_loop().create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    def _connected(self) -> BleakClient:
        if self._client is None:
            raise LinkError(problem("dropped", self._who))
        return self._client

    def _heard(self, _: BleakGATTCharacteristic, data: bytearray) -> None:
        now = time.perf_counter()
        self._quiet_since = now
        if data:
            self.mail.put(now, bytes(data))

    def _dropped(self, _: BleakClient) -> None:
        self.mail.close(lost(self._who, self.facts.rssi_dbm, self.facts.battery_percent))

    async def _ask(self) -> None:
        """Battery, now and whenever it changes, and device information; none of it is needed for the stream."""
        client = self._connected()
        with contextlib.suppress(Exception):  # first, so that no change falls between
            await limited(client.start_notify(BATTERY_LEVEL, self._battery), STEP_S)
        with contextlib.suppress(Exception):
            level = await limited(client.read_gatt_char(BATTERY_LEVEL), STEP_S)
            if not self._battery_told:  # a change that was told while the answer was on its way is newer
                self._take_level(level)
        about: dict[str, str] = {}
        for key, uuid in INFORMATION.items():
            with contextlib.suppress(Exception):
                about[key] = bytes(await limited(client.read_gatt_char(uuid), STEP_S)).decode("utf-8", "replace")
        self.facts.about = about or self.facts.about

    def _battery(self, _: BleakGATTCharacteristic, data: bytearray) -> None:
        self._battery_told = True
        self._take_level(data)

    def _take_level(self, data: bytearray) -> None:
        if len(data) == 1 and data[0] <= 100:
            self.facts.battery_percent = float(data[0])

    async def _watch(self) -> None:
        """A Bluetooth service that crashed says nothing: ask it something when the messages stop."""
        while self.mail.problem is None:
            await asyncio.sleep(LOOK_S)
            if time.perf_counter() - self._quiet_since < QUIET_S:
                continue
            try:
                await limited(self._sign_of_life(), STEP_S)
            except Exception as error:
                found = explain_ble(error, self._who, "stream", self.facts.address)
                self.device = None  # what the system told of it is out of date
                self.mail.close(found if found.cause else problem("silent", self._who))
            self._quiet_since = time.perf_counter()

    async def _sign_of_life(self) -> None:
        client = self._connected()
        readable = [one for service in client.services for one in service.characteristics if "read" in one.properties]
        if not readable:
            raise TimeoutError("nothing came, and there is nothing to ask for")
        await client.read_gatt_char(readable[0])

    async def _farewell(self) -> None:
        if self._client is not None:
            await self._client.disconnect()


def _listed(boards: list[Sighting]) -> str:
    return ", ".join(f"{board.address} ({board.rssi_dbm:.0f} dBm)" for board in boards)
