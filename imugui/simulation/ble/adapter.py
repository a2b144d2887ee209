"""The adapter of the emulated Bluetooth service: power, discovery, and its being there at all."""

from __future__ import annotations

import asyncio

from bumble.device import Advertisement, Device
from dbus_fast import Message, Variant

from imugui.simulation.ble.devices import Devices
from imugui.simulation.ble.tree import ADAPTER, ADAPTER_PATH, DEVICE, BluezError, Methods, ObjectTree, Reply

FORGET_S = 30.0
"""The real service forgets a board that was never connected so long after the scan."""


class Adapter:
    """One adapter, hci0."""

    def __init__(self, tree: ObjectTree, central: Device, devices: Devices) -> None:
        self._tree, self._central, self._devices = tree, central, devices
        self._scanners: set[str] = set()  # D-Bus names
        self._forgetting: asyncio.TimerHandle | None = None
        self.forget_s = FORGET_S
        self.methods: Methods = {
            (ADAPTER, "SetDiscoveryFilter"): self._set_filter,
            (ADAPTER, "StartDiscovery"): self._start,
            (ADAPTER, "StopDiscovery"): self._stop,
            (ADAPTER, "RemoveDevice"): self._remove,
        }

    def plug_in(self) -> None:
        """The adapter appears, switched on."""
        properties = {
            "Address": Variant("s", self._central.random_address.to_string(False)),
            "AddressType": Variant("s", "random"),
            "Name": Variant("s", "virtual"),
            "Alias": Variant("s", "virtual"),
            "Class": Variant("u", 0),
            "Powered": Variant("b", True),
            "Discoverable": Variant("b", False),
            "Pairable": Variant("b", True),
            "Discovering": Variant("b", False),
            "UUIDs": Variant("as", []),
            "Roles": Variant("as", ["central", "peripheral"]),
        }
        self._tree.add(ADAPTER_PATH, ADAPTER, properties)

    async def unplug(self) -> None:
        """The adapter disappears, and with it all boards."""
        await self.set_powered(False)
        self._tree.remove(ADAPTER_PATH)

    async def set_powered(self, on: bool) -> None:
        """Switch it on or off; off ends all links and the discovery."""
        if not on:
            await self.rest()
        self._tree.change(ADAPTER_PATH, ADAPTER, {"Powered": Variant("b", on)})

    async def rest(self) -> None:
        """End all links and the discovery."""
        await self._devices.drop_all()
        if self._scanners:
            self._scanners.clear()
            await self._quiet()

    def close(self) -> None:
        """Forget the timer."""
        if self._forgetting is not None:
            self._forgetting.cancel()

    def see(self, advertisement: Advertisement) -> None:
        """A board was heard."""
        if self._scanners:
            self._devices.see(advertisement)

    async def forget_client(self, sender: str) -> None:
        """A program left the bus: its discovery ends."""
        if sender in self._scanners:
            await self._end(sender)

    async def _set_filter(self, _message: Message) -> Reply:
        self._need_power()
        return None

    async def _start(self, message: Message) -> Reply:
        self._need_power()
        if message.sender in self._scanners:
            raise BluezError("InProgress", "Operation already in progress")
        self._scanners.add(str(message.sender))
        if len(self._scanners) == 1:
            await self._central.start_scanning(legacy=True)
            self._tree.change(ADAPTER_PATH, ADAPTER, {"Discovering": Variant("b", True)})
        return None

    async def _stop(self, message: Message) -> Reply:
        self._need_power()
        if message.sender not in self._scanners:
            raise BluezError("Failed", "No discovery started")
        await self._end(str(message.sender))
        return None

    async def _remove(self, message: Message) -> Reply:
        await self._devices.remove(message.body[0])
        return None

    async def _end(self, sender: str) -> None:
        self._scanners.discard(sender)
        if not self._scanners:
            await self._quiet()

    async def _quiet(self) -> None:
        await self._central.stop_scanning(legacy=True)
        for path in self._devices.paths():
            self._tree.change(path, DEVICE, {}, gone=("RSSI", "TxPower"))
        self._tree.change(ADAPTER_PATH, ADAPTER, {"Discovering": Variant("b", False)})
        self.close()
        self._forgetting = asyncio.get_running_loop().call_later(self.forget_s, self._forget)

    def _forget(self) -> None:
        if not self._scanners:
            self._devices.forget_strangers()

    def _need_power(self) -> None:
        if not self._tree.value(ADAPTER_PATH, ADAPTER, "Powered"):
            raise BluezError("NotReady", "Resource Not Ready")
