"""A small org.bluez: the part of Linux's Bluetooth service that a program connecting to boards uses.

Every call of a program turns into traffic of a real host and controller stack (bumble); every notification that
comes from a board turns into a D-Bus signal. Answers and errors are those of BlueZ 5.66, compared case by case.
Pairing, passive scanning and the server side are not here.
"""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import Coroutine
from typing import Any

from bumble.core import BaseBumbleError, ProtocolError
from bumble.device import Device
from dbus_fast import Message, MessageType
from dbus_fast.aio import MessageBus

from imugui.simulation.ble.adapter import Adapter
from imugui.simulation.ble.devices import Devices
from imugui.simulation.ble.gatt import Gatt
from imugui.simulation.ble.tree import ADAPTER, OBJECT_MANAGER, PROPERTIES, BluezError, Methods, ObjectTree, Reply

NAME = "org.bluez"
DENIED = BluezError("org.freedesktop.DBus.Error.AccessDenied", "Rejected send message, 2 matched rules")
ATT_ERRORS = {
    2: ("NotPermitted", "Read not permitted"),
    3: ("NotPermitted", "Write not permitted"),
    5: ("NotPermitted", "Not paired"),
    6: ("NotSupported", "Operation is not supported"),
    8: ("NotAuthorized", "Operation Not Authorized"),
}
ANSWERED_BY_LIBRARY = ("org.freedesktop.DBus.Introspectable", "org.freedesktop.DBus.Peer")
LOST_CLIENTS = Message(
    destination="org.freedesktop.DBus",
    path="/org/freedesktop/DBus",
    interface="org.freedesktop.DBus",
    member="AddMatch",
    signature="s",
    body=["type='signal',member='NameOwnerChanged',arg2=''"],
)


class Bluez:
    """The service on a bus, with one adapter whose radio is ``central``. All of it runs in the bus's event loop."""

    def __init__(self, bus: MessageBus, central: Device) -> None:
        self.tree = ObjectTree(bus)
        self.gatt = Gatt(self.tree)
        self.devices = Devices(self.tree, central, self.gatt)
        self.adapter = Adapter(self.tree, central, self.devices)
        self.fail_next: dict[str, BluezError] = {}  # by member: the next such call is answered with this error
        self.refused: BluezError | None = None  # every call is answered with this error
        self._bus, self._central = bus, central
        self._running = False
        self._tasks: set[asyncio.Task[None]] = set()
        properties: Methods = {
            (OBJECT_MANAGER, "GetManagedObjects"): self._all,
            (PROPERTIES, "Get"): self._get,
            (PROPERTIES, "GetAll"): self._get_all,
            (PROPERTIES, "Set"): self._set,
        }
        self._methods = properties | self.adapter.methods | self.devices.methods | self.gatt.methods

    @property
    def serving(self) -> int:
        """How many calls are not answered yet."""
        return len(self._tasks)

    async def start(self) -> None:
        """Appear on the bus, with the adapter plugged in and switched on."""
        self._running = True
        self._bus.add_message_handler(self._on_message)
        self._central.on(self._central.EVENT_ADVERTISEMENT, self.adapter.see)
        self.tree.objects["/org/bluez"] = {"org.bluez.AgentManager1": {}}
        self.adapter.plug_in()
        await self._bus.call(LOST_CLIENTS)
        await self._bus.request_name(NAME)

    async def stop(self) -> None:
        """Leave the bus without a word, as in a crash; then the radio drops its links."""
        if not self._running:
            return
        self._running = False
        self._bus.disconnect()
        with contextlib.suppress(OSError, EOFError):  # the bus may have died before
            await self._bus.wait_for_disconnect()  # type: ignore[no-untyped-call]
        self._central.remove_listener(self._central.EVENT_ADVERTISEMENT, self.adapter.see)
        for task in self._tasks:
            task.cancel()
        await self.adapter.rest()
        self.adapter.close()

    def _on_message(self, message: Message) -> bool | None:
        if message.message_type is MessageType.SIGNAL and message.member == "NameOwnerChanged":
            name, _, owner = message.body
            if not owner:
                self._spawn(self._forget_client(name))
        elif message.message_type is MessageType.METHOD_CALL and message.interface not in ANSWERED_BY_LIBRARY:
            self._spawn(self._serve(message))
            return True
        return None

    def _spawn(self, work: Coroutine[Any, Any, None]) -> None:
        task = asyncio.get_running_loop().create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    async def _forget_client(self, name: str) -> None:
        await self.adapter.forget_client(name)
        await self.gatt.forget_client(name)

    async def _serve(self, message: Message) -> None:
        try:
            reply = await self._answer(message)
            answer = Message.new_method_return(message, *(reply or ()))
        except BluezError as error:
            answer = Message.new_error(message, error.name, str(error))
        except ProtocolError as error:
            code = error.error_code or 0
            name, text = ATT_ERRORS.get(code, ("Failed", f"Operation failed with ATT error: 0x{code:02x}"))
            answer = Message.new_error(message, f"org.bluez.Error.{name}", text)
        except (BaseBumbleError, TimeoutError) as error:
            answer = Message.new_error(message, "org.bluez.Error.Failed", f"{type(error).__name__}: {error}")
        if self._bus.connected:
            await self._bus.send(answer)

    async def _answer(self, message: Message) -> Reply:
        error = self.refused or self.fail_next.pop(str(message.member), None)
        if error is not None:
            raise error
        method = self._methods.get((str(message.interface), str(message.member)))
        known = message.path == "/" or message.path in self.tree.objects
        if method is None or not known:
            what = f'Method "{message.member}" with signature "{message.signature}" on interface'
            kind = "UnknownMethod" if known else "UnknownObject"
            raise BluezError(f"org.freedesktop.DBus.Error.{kind}", f'{what} "{message.interface}" doesn\'t exist')
        return await method(message)

    async def _all(self, _message: Message) -> Reply:
        return "a{oa{sa{sv}}}", [self.tree.objects]

    async def _get(self, message: Message) -> Reply:
        interface, name = message.body
        variant = self.tree.objects[str(message.path)].get(interface, {}).get(name)
        if variant is None:
            raise BluezError("org.freedesktop.DBus.Error.InvalidArgs", f"No such property '{name}'")
        return "v", [variant]

    async def _get_all(self, message: Message) -> Reply:
        return "a{sv}", [self.tree.objects[str(message.path)].get(message.body[0], {})]

    async def _set(self, message: Message) -> Reply:
        interface, name, value = message.body
        if (interface, name) == (ADAPTER, "Powered"):
            await self.adapter.set_powered(value.value)
        else:
            self.tree.change(str(message.path), interface, {name: value})
        return None
