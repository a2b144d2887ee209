"""A laboratory and a program's side of it: bleak, unmodified, in one event loop."""

from __future__ import annotations

import asyncio
import time
from collections.abc import AsyncIterator, Callable, Coroutine, Iterator
from contextlib import asynccontextmanager
from typing import TYPE_CHECKING, Any

import bleak.backends.bluezdbus.manager as bluez_manager
import pytest
from bleak import BleakClient, BleakScanner
from bleak.backends.device import BLEDevice
from bleak.exc import BleakBluetoothNotAvailableError

from imugui.simulation import ble

if TYPE_CHECKING:
    from imugui.simulation.ble.lab import BleLab
    from imugui.simulation.ble.peripheral import Peripheral


def forgiving_loop() -> asyncio.AbstractEventLoop:
    """A loop that does not print that a bus ended without anybody asking why, which bleak never does."""

    def handle(loop: asyncio.AbstractEventLoop, context: dict[str, Any]) -> None:
        if not isinstance(context.get("exception"), EOFError):
            loop.default_exception_handler(context)

    loop = asyncio.new_event_loop()
    loop.set_exception_handler(handle)
    return loop


class Program:
    """What a program does with bleak. It has one loop, for bleak keeps a connection to the bus for each."""

    LIMIT_S = 30.0  # of any one step, on a busy machine

    def __init__(self) -> None:
        self._runner = asyncio.Runner(loop_factory=forgiving_loop)

    def play(self, scene: Coroutine[Any, Any, None]) -> None:
        """Run a scene to its end."""
        self._runner.run(asyncio.wait_for(scene, 3 * self.LIMIT_S))

    def close(self) -> None:
        """End the loop; the bus is gone, so bleak's connection ends by itself before."""
        self.play(self.until(lambda: len(asyncio.all_tasks(self._runner.get_loop())) <= 2))
        self._runner.close()

    async def until(self, true: Callable[[], bool]) -> None:
        """Wait for a condition, bounded."""
        end = time.monotonic() + self.LIMIT_S
        while not true():
            assert time.monotonic() < end, "it did not come true"
            await asyncio.sleep(0.005)

    async def find(self, board: Peripheral, timeout: float = LIMIT_S) -> BLEDevice | None:
        """The board, when a scan finds it."""
        return await BleakScanner.find_device_by_address(board.address, timeout=timeout)

    def known(self, path: str) -> dict[str, Any]:
        """What bleak believes of an object of the service, by interface: it hears of a change after the lab."""
        manager = bluez_manager._global_instances[asyncio.get_running_loop()]
        return {name: dict(properties) for name, properties in manager._properties.get(path, {}).items()}

    async def found_again(self, board: Peripheral) -> BLEDevice | None:
        """The same, while bleak may not yet have heard that there is an adapter again."""
        end = time.monotonic() + self.LIMIT_S
        while True:
            try:
                return await self.find(board)
            except BleakBluetoothNotAvailableError:
                assert time.monotonic() < end, "the adapter did not come back"
                await asyncio.sleep(0.005)

    def client(self, device: BLEDevice) -> BleakClient:
        """A client, not yet connected."""
        return BleakClient(device, timeout=self.LIMIT_S)

    @asynccontextmanager
    async def connected(self, board: Peripheral) -> AsyncIterator[tuple[BleakClient, asyncio.Event]]:
        """A client of the board, and the event of its link's loss."""
        device = await self.find(board)
        assert device is not None
        gone = asyncio.Event()
        async with BleakClient(device, lambda _: gone.set(), timeout=self.LIMIT_S) as client:
            yield client, gone


@pytest.fixture
def program() -> Iterator[Program]:
    """Closed after the lab. Both are new for each test, so that one that fails spoils no other."""
    running = Program()
    yield running
    running.close()


@pytest.fixture
def lab(program: Program) -> Iterator[BleLab]:
    """With nothing in it."""
    if why := ble.missing():
        pytest.skip(why)
    from imugui.simulation.ble.lab import BleLab

    with BleLab() as running:
        yield running


@pytest.fixture
def card(lab: BleLab) -> Iterator[Peripheral]:
    """A motion card, switched on for one test."""
    board = lab.add_board()
    yield board
    lab.remove_board(board)
