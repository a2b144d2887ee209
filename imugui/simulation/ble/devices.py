"""The boards as the emulated Bluetooth service knows them: seen, connected, lost, forgotten."""

from __future__ import annotations

import asyncio
import contextlib

from bumble.core import UUID, AdvertisingData, BaseBumbleError
from bumble.device import Advertisement, Connection, Device
from bumble.hci import Address
from dbus_fast import Message, Variant

from imugui.simulation.ble.gatt import Gatt, full_uuid
from imugui.simulation.ble.tree import (
    ADAPTER,
    ADAPTER_PATH,
    DEVICE,
    BluezError,
    Methods,
    ObjectTree,
    Properties,
    Reply,
)

CONNECT_S = 20.0
GIVE_UP_S = 1.0
ABORTED = "le-connection-abort-by-local"
UUID_LISTS = {
    AdvertisingData.Type.COMPLETE_LIST_OF_128_BIT_SERVICE_CLASS_UUIDS: 16,
    AdvertisingData.Type.INCOMPLETE_LIST_OF_128_BIT_SERVICE_CLASS_UUIDS: 16,
    AdvertisingData.Type.COMPLETE_LIST_OF_16_BIT_SERVICE_CLASS_UUIDS: 2,
    AdvertisingData.Type.INCOMPLETE_LIST_OF_16_BIT_SERVICE_CLASS_UUIDS: 2,
}
"""The advertised lists of services, with the bytes of one entry."""


def advertised(data: AdvertisingData) -> Properties:
    """The device properties that BlueZ makes of advertising data."""
    kinds = AdvertisingData.Type
    properties: Properties = {}
    for kind in (kinds.SHORTENED_LOCAL_NAME, kinds.COMPLETE_LOCAL_NAME):
        for raw in data.get_all(kind, raw=True):
            name = bytes(raw).decode("utf-8", "replace")
            properties |= {"Name": Variant("s", name), "Alias": Variant("s", name)}
    uuids = [
        full_uuid(UUID.from_bytes(raw[at : at + size]))
        for kind, size in UUID_LISTS.items()
        for raw in data.get_all(kind, raw=True)
        for at in range(0, len(raw), size)
    ]
    if uuids:
        properties["UUIDs"] = Variant("as", uuids)
    return properties


class Devices:
    """One object for each board; boards that were connected once are kept, the others only for a while."""

    def __init__(self, tree: ObjectTree, central: Device, gatt: Gatt) -> None:
        self._tree, self._central, self._gatt = tree, central, gatt
        self._links: dict[str, Connection] = {}
        self._connecting: dict[str, asyncio.Task[None]] = {}
        self._known: set[str] = set()
        self._turn = asyncio.Lock()  # the radio makes one link at a time
        self._trying = ""  # the board it is looking for
        self.disconnect_s = 0.0  # the real service waits 2 s before it drops a link
        self.methods: Methods = {(DEVICE, "Connect"): self._connect, (DEVICE, "Disconnect"): self._disconnect}

    def paths(self) -> list[str]:
        """Of all boards."""
        return [path for path, interfaces in self._tree.objects.items() if DEVICE in interfaces]

    def see(self, advertisement: Advertisement) -> None:
        """A board was heard: add it, or tell its new strength."""
        address = advertisement.address.to_string(False).upper()
        path = f"{ADAPTER_PATH}/dev_{address.replace(':', '_')}"
        news = {"RSSI": Variant("n", advertisement.rssi)} | advertised(advertisement.data)
        if path in self._tree.objects:
            self._tree.change(path, DEVICE, news)
            return
        flags = ("Paired", "Bonded", "Trusted", "Blocked", "LegacyPairing", "Connected", "ServicesResolved")
        properties: Properties = {
            "Address": Variant("s", address),
            "AddressType": Variant("s", "random" if advertisement.address.is_random else "public"),
            "Alias": Variant("s", address.replace(":", "-")),
            "Adapter": Variant("o", ADAPTER_PATH),
            "UUIDs": Variant("as", []),
        }
        self._tree.add(path, DEVICE, properties | {flag: Variant("b", False) for flag in flags} | news)

    def forget_strangers(self) -> None:
        """Drop the boards that were seen but never connected."""
        for path in self.paths():
            if path not in self._known and path not in self._connecting:
                self._tree.remove(path)

    async def remove(self, path: str) -> None:
        """Drop one board, connected or not."""
        if path not in self._tree.objects:
            raise BluezError("DoesNotExist", "Does Not Exist")
        await self._drop(path)
        self._known.discard(path)
        self._tree.remove(path)

    async def drop_all(self) -> None:
        """Disconnect every board and give up every attempt."""
        for path in list(self._connecting):
            await self._give_up(path)
        for path in list(self._links):
            await self._drop(path)

    async def _connect(self, message: Message) -> Reply:
        path = str(message.path)
        if not self._tree.value(ADAPTER_PATH, ADAPTER, "Powered"):
            raise BluezError("Failed", "Input/output error")
        if path in self._links:
            return None  # a second program shares the link
        if path in self._connecting:
            raise BluezError("InProgress", "Operation already in progress")
        task = self._connecting[path] = asyncio.ensure_future(self._link(path))
        try:
            await asyncio.wait({task})
            if task.cancelled():
                raise BluezError("Failed", ABORTED)
            task.result()
        finally:
            del self._connecting[path]
        return None

    async def _link(self, path: str) -> None:
        random = self._tree.value(path, DEVICE, "AddressType") == "random"
        kind = Address.RANDOM_DEVICE_ADDRESS if random else Address.PUBLIC_DEVICE_ADDRESS
        address = Address(self._tree.value(path, DEVICE, "Address"), kind)
        async with self._turn:
            self._trying = path
            try:
                connection = await self._central.connect(address, timeout=CONNECT_S)
            except (BaseBumbleError, TimeoutError):
                raise BluezError("Failed", ABORTED) from None
            finally:
                self._trying = ""
        self._known.add(path)
        self._links[path] = connection
        connection.on(connection.EVENT_DISCONNECTION, lambda _reason: self._lost(path))
        self._tree.change(path, DEVICE, {"Connected": Variant("b", True)})
        try:
            await self._gatt.resolve(path, connection)
        except (BluezError, BaseBumbleError):
            if path in self._links:  # otherwise answered with success: the program sees that the link is gone
                raise

    async def _disconnect(self, message: Message) -> Reply:
        path = str(message.path)
        if path not in self._links and path not in self._connecting:
            raise BluezError("NotConnected", "Not Connected")
        await self._give_up(path)
        await asyncio.sleep(self.disconnect_s)
        await self._drop(path)
        return None

    async def _give_up(self, path: str) -> None:
        """End an attempt to connect; one that has its link already ends with the link."""
        task = self._connecting.get(path)
        if task is None or path in self._links:
            return
        if path == self._trying:
            with contextlib.suppress(BaseBumbleError):
                await self._central.cancel_connection()  # type: ignore[no-untyped-call]
        else:
            task.cancel()
        await asyncio.wait({task}, timeout=GIVE_UP_S)  # until the radio has said that it stopped

    async def _drop(self, path: str) -> None:
        connection = self._links.get(path)
        if connection is not None:
            with contextlib.suppress(BaseBumbleError):  # gone by itself in this moment
                await connection.disconnect()

    def _lost(self, path: str) -> None:
        if self._links.pop(path, None) is not None:
            self._gatt.lose(path)
            self._tree.change(path, DEVICE, {"Connected": Variant("b", False)})
