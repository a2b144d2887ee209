"""The Bluetooth lab: a private D-Bus, a small org.bluez on it, a radio, and emulated boards. One thread of its own.

    with BleLab() as lab:                       # from here on the private bus is this process's system bus
        card = lab.add_board("motion-card")     # also "thingy-52", "wit-ble": the keys of BLE_PROFILES
        ...                                     # any program using bleak, unmodified, in its own thread and loop
        lab.press(card, 1)                      # the button: its byte comes with the samples
        lab.set_battery(card, 15)               # read, and notified
        lab.drop_link(card)                     # the board disconnects; silent=True: and is heard no more until
        lab.wake(card)
        lab.leave_range(card); lab.enter_range(card)
        lab.hang_up_next(card)                  # drops the next connection during the discovery of services
        lab.send(card, b"any bytes")            # one notification
        lab.seize(card); lab.release(card)      # somebody else's phone connects: the card advertises no more
        lab.set_powered(False); lab.set_powered(True)
        lab.unplug(); lab.plug_in()             # the adapter
        lab.kill_service(); lab.start_service() # bluetoothd crashes; starts again
        lab.refuse(True); lab.refuse(False)     # no permission: every call is denied
        lab.fail_next("Connect", "Failed", "Input/output error")
        lab.set_rssi(card, -80)                 # dBm
        lab.pause_bus(True); lab.pause_bus(False)
        lab.kill_bus()                          # the bus itself; only the end of the lab can follow
        lab.remove_board(card)

``card.sent`` counts notifications, ``card.connected`` tells the link, ``card.written`` what was written to it,
``card.on_sent`` can hear each (host time s, message). ``add_board(..., board=VirtualBoard(...))`` gives the motion
and the errors; ``speed=6.0`` runs six times as fast as real; ``address``, ``name`` and ``model`` may be given too.
``start`` and ``stop`` do what ``with`` does. Every call waits until the thing has happened (at most CALL_S).
``BleLab(exported=False)`` leaves the environment alone: then set DBUS_SYSTEM_BUS_ADDRESS to ``lab.address``, for
instance in a child process. ``imugui.simulation.ble.missing()`` says what is not installed.

bleak holds a connection to the bus for each event loop and never closes it: run one loop for all of a program, and
let it turn until the bus is gone (``stop``) before it ends.

Times: discovery by program and lab together about 0.1 s, a lost link is noticed after 0.5 s (``leave_range``),
``lab.bluez.devices.disconnect_s = 2.0`` makes disconnecting as slow as the real service does.
"""

from __future__ import annotations

import asyncio
import contextlib
import logging
import threading
from collections.abc import Callable, Coroutine
from dataclasses import replace
from types import TracebackType
from typing import Any, Self, TypeVar

from bumble.core import BaseBumbleError
from bumble.device import Connection, Device
from bumble.hci import Address
from dbus_fast import Message

from imugui.formats import FORMATS
from imugui.simulation.ble.airlink import SUPERVISION_S, AirLink, make_controller
from imugui.simulation.ble.bluez import DENIED, NAME, Bluez
from imugui.simulation.ble.models import MODELS, Model
from imugui.simulation.ble.peripheral import Peripheral
from imugui.simulation.ble.private_bus import PrivateBus, connect
from imugui.simulation.ble.tree import BluezError
from imugui.simulation.board import VirtualBoard
from imugui.simulation.errors import PRESETS

CALL_S = 30.0
OURS, THEIRS = "C0:00:00:00:00:01", "C0:00:00:00:00:02"
SERVICE_IS_THERE = Message(
    destination="org.freedesktop.DBus",
    path="/org/freedesktop/DBus",
    interface="org.freedesktop.DBus",
    member="NameHasOwner",
    signature="s",
    body=[NAME],
)
T = TypeVar("T")


class BleLab:
    """See the module."""

    def __init__(self, exported: bool = True) -> None:
        """``exported``: the private bus becomes this process's system bus."""
        self._bus = PrivateBus(exported)
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._loop.run_forever, name="ble-lab", daemon=True)
        self._boards: list[Peripheral] = []
        self._seized: dict[Peripheral, Connection] = {}
        self._made = 0

    def __enter__(self) -> Self:
        self.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.stop()

    @property
    def address(self) -> str:
        """Of the private bus."""
        return self._bus.address

    def start(self) -> None:
        """Start bus, radio and service; OSError when the bus cannot be run."""
        try:
            self._bus.start()
        except OSError:
            self._loop.close()
            raise
        self._thread.start()
        try:
            self.run(self._set_up())
        except BaseException:
            self.stop()
            raise

    def stop(self) -> None:
        """End everything; no thread, task, socket or process is left."""
        try:
            self.run(self._tear_down())
        finally:
            self._loop.call_soon_threadsafe(self._loop.stop)
            self._thread.join(CALL_S)
            self._loop.close()
            self._bus.stop()

    def run(self, work: Coroutine[Any, Any, T]) -> T:
        """The result of a coroutine that runs in the lab's loop."""
        return asyncio.run_coroutine_threadsafe(work, self._loop).result(CALL_S)

    def call(self, function: Callable[..., T], *args: Any) -> T:
        """The result of a function that is called in the lab's loop."""

        async def called() -> T:
            return function(*args)

        return self.run(called())

    def add_board(
        self,
        kind: str = "motion-card",
        motion: str = "turns",
        *,
        board: VirtualBoard | None = None,
        speed: float = 1.0,
        name: str = "",
        address: str = "",
        model: Model | None = None,
        seed: int = 0,
    ) -> Peripheral:
        """Switch a board on. ``model`` changes what it is; ``board`` what it measures (in place of ``motion``)."""
        self._made += 1
        what = model or MODELS[kind]
        what = replace(what, name=name or what.name)
        rate_hz = FORMATS[what.profile.format].rate_hz
        moving = board or VirtualBoard(motion, rate_hz, PRESETS["mpu9250"], seed)
        where = address or f"F0:F1:F2:F3:{self._made >> 8:02X}:{self._made & 255:02X}"
        return self.run(self._add(what, where, moving, speed))

    def remove_board(self, board: Peripheral) -> None:
        """Switch a board off."""
        self._boards.remove(board)
        self.run(board.stop())

    def press(self, board: Peripheral, status: int) -> None:
        """Set the status byte that comes with the next samples, as its button does."""
        self.call(setattr, board, "status", status)

    def set_battery(self, board: Peripheral, percent: int) -> None:
        """Change the battery's level; subscribers are told."""
        self.run(board.set_battery(percent))

    def set_rssi(self, board: Peripheral, rssi_dbm: int) -> None:
        """How strongly the board is heard."""
        self.call(self.link.rssi.__setitem__, board.controller, rssi_dbm)

    def send(self, board: Peripheral, message: bytes) -> None:
        """Notify any bytes."""
        self.run(board.send(message))

    def drop_link(self, board: Peripheral, silent: bool = False) -> None:
        """The board disconnects; ``silent``: and is heard no more."""
        self.run(board.drop_link(silent))

    def wake(self, board: Peripheral) -> None:
        """It is heard again after a silence."""
        self.run(board.wake())

    def hang_up_next(self, board: Peripheral) -> None:
        """The board drops its next connection during the discovery of services."""
        self.call(board.hang_up_next)

    def leave_range(self, board: Peripheral, after_s: float = SUPERVISION_S) -> None:
        """Carry the board away; the link counts as lost after ``after_s`` s of silence."""
        self.call(self.link.leave_range, board.controller, after_s)

    def enter_range(self, board: Peripheral) -> None:
        """Carry it back."""
        self.call(self.link.enter_range, board.controller)

    def seize(self, board: Peripheral) -> None:
        """Somebody else connects to the board, which then advertises no more."""
        self._seized[board] = self.run(self._other.connect(Address(board.address)))

    def release(self, board: Peripheral) -> None:
        """That somebody lets go."""
        self.run(self._let_go(self._seized.pop(board)))

    def set_powered(self, on: bool) -> None:
        """Switch the adapter on or off."""
        self.run(self.bluez.adapter.set_powered(on))

    def unplug(self) -> None:
        """Pull the adapter out."""
        self.run(self.bluez.adapter.unplug())

    def plug_in(self) -> None:
        """Put the adapter in again."""
        self.call(self.bluez.adapter.plug_in)

    def kill_service(self) -> None:
        """The Bluetooth service crashes; the bus stays, and knows it."""
        self.run(self._kill_service())

    def start_service(self) -> None:
        """Start the Bluetooth service (again): it knows no board."""
        self.run(self._start_service())

    def pause_bus(self, on: bool) -> None:
        """The bus does nothing for a while, as on a machine that is busy; then it catches up."""
        self._bus.pause(on)

    def kill_bus(self) -> None:
        """The bus crashes, and with it the service."""
        self._bus.kill()

    def refuse(self, on: bool) -> None:
        """The user may not use Bluetooth: every call is denied."""
        self.call(setattr, self.bluez, "refused", DENIED if on else None)

    def fail_next(self, member: str, name: str, text: str = "") -> None:
        """The next call of a D-Bus member, such as "Connect", is answered with an error of org.bluez."""
        self.call(self.bluez.fail_next.__setitem__, member, BluezError(name, text))

    async def _set_up(self) -> None:
        logging.getLogger("bumble").setLevel(logging.ERROR)  # what is on its way when a link goes is lost, as on air
        self.link = AirLink()
        self._ours, self._other = [await self._central(address) for address in (OURS, THEIRS)]
        await self._start_service()

    async def _central(self, address: str) -> Device:
        controller = make_controller(f"central {address}", self.link)
        central = Device.with_hci("central", Address(address), controller, controller)
        await central.power_on()
        return central

    async def _start_service(self) -> None:
        bus = await connect(self.address)
        self.bluez = Bluez(bus, self._ours)
        await self.bluez.start()

    async def _kill_service(self) -> None:
        await self.bluez.stop()
        asking = await connect(self.address)
        while (answer := await asking.call(SERVICE_IS_THERE)) and answer.body[0]:
            await asyncio.sleep(0.001)
        asking.disconnect()

    async def _add(self, model: Model, address: str, board: VirtualBoard, speed: float) -> Peripheral:
        peripheral = Peripheral(model, self.link, address, board, speed)
        await peripheral.start()
        self._boards.append(peripheral)
        return peripheral

    @staticmethod
    async def _let_go(connection: Connection) -> None:
        with contextlib.suppress(BaseBumbleError):  # lost meanwhile
            await connection.disconnect()

    async def _tear_down(self) -> None:
        for board in self._boards:
            await board.stop()
        await self.bluez.stop()
        tasks = asyncio.all_tasks() - {asyncio.current_task()}
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)
