"""An emulated board: a real GATT server in the room, fed by the virtual board through its format's encoder."""

from __future__ import annotations

import asyncio
import contextlib
import time
from collections.abc import Callable, Coroutine
from typing import Any

from bumble.core import BaseBumbleError
from bumble.device import Connection

from imugui.formats import FORMATS
from imugui.simulation.ble.airlink import AirLink, make_controller
from imugui.simulation.ble.models import Model
from imugui.simulation.ble.server import level_of, make_device, messages_of, services_of
from imugui.simulation.board import VirtualBoard
from imugui.simulation.pacing import Pacer

START_BATTERY = 87


class Peripheral:
    """One board, which moves on whether or not somebody has subscribed. Use it through the lab, from any thread."""

    def __init__(self, model: Model, link: AirLink, address: str, board: VirtualBoard, speed: float = 1.0) -> None:
        """``speed``: times the real pace."""
        self.model, self.board, self.address = model, board, address
        self.name = model.name
        self.sent = 0  # notifications
        self.status = 0  # the button's byte
        self.battery = START_BATTERY  # %
        self.rate_hz = model.rate_hz  # of its messages; below the virtual board's, only each so many-th sample is sent
        self.written: list[tuple[str, bytes]] = []  # what was written to it: (characteristic, bytes)
        self.on_sent: Callable[[float, bytes], None] | None = None  # hears (host time s, message)
        self._form = FORMATS[model.profile.format]
        self._speed = speed
        self._link = link
        self._hangs_up = False
        self._silent = False
        self._tasks: set[asyncio.Task[None]] = set()
        self.controller = make_controller(f"board {address}", link)
        self.device = make_device(self.controller, model, address)
        self._messages = messages_of(model)
        self._level = level_of(lambda: self.battery)
        for service in services_of(model, self._messages, self._level, self._on_write):
            self.device.add_service(service)

    @property
    def connected(self) -> bool:
        """Whether anybody is connected."""
        return bool(self.device.connections)

    async def start(self) -> None:
        """Switch the board on: it advertises, and streams to whoever subscribes."""
        await self.device.power_on()
        self.device.on(self.device.EVENT_CONNECTION, self._on_connection)
        await self.device.start_advertising()
        self._spawn(self._stream())

    async def stop(self) -> None:
        """Switch the board off."""
        for task in self._tasks:
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)
        await self.drop_link(silent=True)
        self._link.remove_controller(self.controller)

    async def drop_link(self, silent: bool = False) -> None:
        """Disconnect whoever is connected; ``silent``: and be heard no more, as with an empty battery."""
        self._silent = silent
        for connection in list(self.device.connections.values()):
            with contextlib.suppress(BaseBumbleError):
                await connection.disconnect()
        if silent:
            await self.device.stop_advertising()

    async def wake(self) -> None:
        """Advertise again after a silence."""
        self._silent = False
        if not self.connected:
            await self.device.start_advertising()

    def hang_up_next(self) -> None:
        """Drop the next connection at the first request of the discovery of services."""
        self._hangs_up = True

    async def set_battery(self, percent: int) -> None:
        """Change the level, and tell subscribers."""
        self.battery = percent
        await self.device.notify_subscribers(self._level, bytes([percent]))

    async def send(self, message: bytes) -> None:
        """Notify any bytes as a message, also such as no board would send."""
        await self.device.notify_subscribers(self._messages, message)

    def _on_write(self, uuid: str, value: bytes) -> None:
        self.written.append((uuid, value))
        asked = self.model.asked_rate
        self.rate_hz = (asked(value) if asked else None) or self.rate_hz

    def _on_connection(self, connection: Connection) -> None:
        connection.once(connection.EVENT_DISCONNECTION, lambda _reason: self._on_disconnection())
        if self._hangs_up:
            self._hangs_up = False
            connection.once(connection.EVENT_CONNECTION_ATT_MTU_UPDATE, lambda: self._spawn(self.drop_link()))

    def _on_disconnection(self) -> None:
        if not self._silent:
            self._spawn(self.device.start_advertising())

    def _spawn(self, work: Coroutine[Any, Any, None]) -> None:
        task = asyncio.get_running_loop().create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    async def _stream(self) -> None:
        pacer = Pacer(self.board.rate_hz * self._speed, time.monotonic())
        while True:
            await asyncio.sleep(pacer.wait_s(time.monotonic()))
            n = pacer.due(time.monotonic())
            if n:
                await self._say(n)

    async def _say(self, n: int) -> None:
        """Send what falls due among the next n samples."""
        first = self.board.count
        rows = self.board.rows(n)
        every = max(1, round(self.board.rate_hz / self.rate_hz))
        rows = rows[-first % every :: every]
        rows["status"] = self.status
        data, size = self._form.encoder().encode(rows), self._form.message_bytes
        for at in range(0, len(data), size):
            message = data[at : at + size]
            if self._is_heard():
                self.sent += 1
                if self.on_sent is not None:
                    self.on_sent(time.monotonic(), message)
                await self.send(message)

    def _is_heard(self) -> bool:
        subscriptions = self.device.gatt_server.subscribers.values()
        return any(any(cccds.get(self._messages.handle, b"")) for cccds in subscriptions)
