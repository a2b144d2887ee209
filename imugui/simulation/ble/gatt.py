"""The GATT part of the emulated Bluetooth service: a board's services as objects, reads, writes, notifications."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import Coroutine
from typing import Any, TypeVar

from bumble.core import UUID
from bumble.device import Connection, Peer
from bumble.gatt import GATT_GENERIC_ACCESS_SERVICE
from bumble.gatt_client import CharacteristicProxy, DescriptorProxy, ServiceProxy
from dbus_fast import Message, Variant

from imugui.simulation.ble.tree import (
    CHARACTERISTIC,
    DESCRIPTOR,
    DEVICE,
    SERVICE,
    BluezError,
    Methods,
    ObjectTree,
    Properties,
    Reply,
)

WANTED_MTU = 517
FLAGS = (
    "broadcast",
    "read",
    "write-without-response",
    "write",
    "notify",
    "indicate",
    "authenticated-signed-writes",
    "extended-properties",
)
"""BlueZ's words for the bits of a characteristic's properties."""

Proxy = CharacteristicProxy[Any] | DescriptorProxy
T = TypeVar("T")


def full_uuid(uuid: UUID) -> str:
    """A UUID in its 36-character form, small letters."""
    digits = uuid.to_bytes(force_128=True)[::-1].hex()
    return "-".join((digits[:8], digits[8:12], digits[12:16], digits[16:20], digits[20:]))


class Gatt:
    """The attributes of all connected boards."""

    def __init__(self, tree: ObjectTree) -> None:
        self._tree = tree
        self._peers: dict[str, Peer] = {}  # by device path
        self._attributes: dict[str, Proxy] = {}  # by object path
        self._listeners: dict[str, set[str]] = {}  # characteristic path -> the D-Bus names that want its values
        self.methods: Methods = {
            (CHARACTERISTIC, "ReadValue"): self._read,
            (DESCRIPTOR, "ReadValue"): self._read,
            (CHARACTERISTIC, "WriteValue"): self._write,
            (DESCRIPTOR, "WriteValue"): self._write,
            (CHARACTERISTIC, "StartNotify"): self._start_notify,
            (CHARACTERISTIC, "StopNotify"): self._stop_notify,
        }

    async def resolve(self, device: str, connection: Connection) -> None:
        """Discover all a board has and show it; BluezError when the link goes meanwhile."""
        peer = self._peers[device] = Peer(connection)
        await self._while_linked(connection, self._discover(peer))
        for service in peer.services:
            if service.uuid != GATT_GENERIC_ACCESS_SERVICE:  # BlueZ keeps that one to itself
                self._show_service(device, service, peer.connection.att_mtu)
        uuids = [full_uuid(service.uuid) for service in peer.services]
        resolved = {"UUIDs": Variant("as", uuids), "ServicesResolved": Variant("b", True)}
        self._tree.change(device, DEVICE, resolved)

    def lose(self, device: str) -> None:
        """The link to a board is gone, and with it all it had."""
        self._peers.pop(device, None)
        for path in self._tree.below(device):
            if self._listeners.pop(path, None):
                self._tree.change(path, CHARACTERISTIC, {"Notifying": Variant("b", False)})
        self._tree.change(device, DEVICE, {"ServicesResolved": Variant("b", False)})
        for path in self._tree.below(device):
            self._attributes.pop(path, None)
            self._tree.remove(path)

    async def forget_client(self, sender: str) -> None:
        """A program left the bus: its subscriptions end."""
        for path, senders in list(self._listeners.items()):
            if sender in senders:
                with contextlib.suppress(BluezError):
                    await self._unsubscribe(path, sender)

    @staticmethod
    async def _discover(peer: Peer) -> None:
        await peer.request_mtu(WANTED_MTU)
        await peer.discover_services()
        for service in peer.services:
            await service.discover_characteristics()
            for characteristic in service.characteristics:
                await characteristic.discover_descriptors()

    def _show_service(self, device: str, service: ServiceProxy, mtu: int) -> None:
        path = f"{device}/service{service.handle:04x}"
        properties = {
            "UUID": Variant("s", full_uuid(service.uuid)),
            "Device": Variant("o", device),
            "Primary": Variant("b", True),
            "Includes": Variant("ao", []),
        }
        self._tree.add(path, SERVICE, properties)
        for characteristic in service.characteristics:
            self._show_characteristic(path, characteristic, mtu)

    def _show_characteristic(self, service: str, characteristic: CharacteristicProxy[Any], mtu: int) -> None:
        path = f"{service}/char{characteristic.handle - 1:04x}"
        flags = [word for bit, word in enumerate(FLAGS) if int(characteristic.properties) >> bit & 1]
        properties: Properties = {
            "UUID": Variant("s", full_uuid(characteristic.uuid)),
            "Service": Variant("o", service),
            "Value": Variant("ay", b""),
            "Flags": Variant("as", flags),
            "MTU": Variant("q", mtu),
        }
        if {"notify", "indicate"} & set(flags):
            properties["Notifying"] = Variant("b", False)
        self._attributes[path] = characteristic
        self._tree.add(path, CHARACTERISTIC, properties)
        for descriptor in characteristic.descriptors:
            below = f"{path}/desc{descriptor.handle:04x}"
            self._attributes[below] = descriptor
            said: Properties = {
                "UUID": Variant("s", full_uuid(descriptor.type)),
                "Characteristic": Variant("o", path),
                "Value": Variant("ay", b""),
            }
            self._tree.add(below, DESCRIPTOR, said)

    async def _read(self, message: Message) -> Reply:
        path = str(message.path)
        value = await self._while_linked(self._peer(path).connection, self._attribute(path).read_value())
        self._tree.change(path, str(message.interface), {"Value": Variant("ay", bytes(value))})
        return "ay", [bytes(value)]

    async def _write(self, message: Message) -> Reply:
        path, (value, options) = str(message.path), message.body
        kind = options.get("type")
        acknowledged = not (kind and kind.value == "command")
        writing = self._attribute(path).write_value(bytes(value), with_response=acknowledged)
        await self._while_linked(self._peer(path).connection, writing)
        return None

    async def _start_notify(self, message: Message) -> Reply:
        path = str(message.path)
        proxy = self._attribute(path)
        flags = self._tree.value(path, CHARACTERISTIC, "Flags") or []
        if not isinstance(proxy, CharacteristicProxy) or not {"notify", "indicate"} & set(flags):
            raise BluezError("NotSupported", "Operation is not supported")
        senders = self._listeners.setdefault(path, set())
        first = not senders
        senders.add(str(message.sender))  # asking twice is answered with success
        if first:
            subscribing = proxy.subscribe(lambda value: self._pass_on(path, value), prefer_notify="notify" in flags)
            await self._while_linked(self._peer(path).connection, subscribing)
            self._tree.change(path, CHARACTERISTIC, {"Notifying": Variant("b", True)})
        return None

    async def _stop_notify(self, message: Message) -> Reply:
        path, sender = str(message.path), str(message.sender)
        if sender not in self._listeners.get(path, ()):
            raise BluezError("Failed", "No notify session started")
        await self._unsubscribe(path, sender)
        return None

    async def _unsubscribe(self, path: str, sender: str) -> None:
        senders = self._listeners.get(path, set())
        senders.discard(sender)
        if senders:
            return
        self._listeners.pop(path, None)
        proxy = self._attributes.get(path)
        if isinstance(proxy, CharacteristicProxy):
            await self._while_linked(self._peer(path).connection, proxy.unsubscribe(force=True))
        self._tree.change(path, CHARACTERISTIC, {"Notifying": Variant("b", False)})

    def _pass_on(self, path: str, value: bytes) -> None:
        self._tree.change(path, CHARACTERISTIC, {"Value": Variant("ay", bytes(value))})

    def _attribute(self, path: str) -> Proxy:
        if path not in self._attributes:
            raise BluezError("Failed", "Not connected")
        return self._attributes[path]

    def _peer(self, path: str) -> Peer:
        for device, peer in self._peers.items():
            if path.startswith(f"{device}/"):
                return peer
        raise BluezError("Failed", "Not connected")

    @staticmethod
    async def _while_linked(connection: Connection, request: Coroutine[Any, Any, T]) -> T:
        """The answer to a request; when the link goes first, the error that BlueZ gives then."""
        lost = asyncio.get_running_loop().create_future()

        def lose(_reason: int) -> None:
            if not lost.done():
                lost.set_result(None)

        connection.on(connection.EVENT_DISCONNECTION, lose)
        asking = asyncio.ensure_future(request)
        try:
            await asyncio.wait({asking, lost}, return_when=asyncio.FIRST_COMPLETED)
            if not asking.done() or asking.cancelled():  # bumble cancels what a lost link leaves open
                raise BluezError("Failed", "Operation failed with ATT error: 0x0e")
            return asking.result()
        finally:
            asking.cancel()
            connection.remove_listener(connection.EVENT_DISCONNECTION, lose)
