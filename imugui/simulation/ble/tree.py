"""The D-Bus objects of the emulated Bluetooth service: properties, and the signals that tell of their change."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Iterable, Mapping
from typing import Any

from dbus_fast import Message, Variant
from dbus_fast.aio import MessageBus

ADAPTER = "org.bluez.Adapter1"
DEVICE = "org.bluez.Device1"
SERVICE = "org.bluez.GattService1"
CHARACTERISTIC = "org.bluez.GattCharacteristic1"
DESCRIPTOR = "org.bluez.GattDescriptor1"
PROPERTIES = "org.freedesktop.DBus.Properties"
OBJECT_MANAGER = "org.freedesktop.DBus.ObjectManager"
ADAPTER_PATH = "/org/bluez/hci0"

Properties = dict[str, Variant]
Reply = tuple[str, list[Any]] | None
"""Signature and body of an answer; None is an empty one."""
Method = Callable[[Message], Awaitable[Reply]]
Methods = dict[tuple[str, str], Method]
"""By interface and member."""


class BluezError(Exception):
    """An error as the service answers it: a D-Bus name, short for org.bluez's own, and a text."""

    def __init__(self, name: str, text: str = "") -> None:
        super().__init__(text)
        self.name = name if name.startswith("org.") else f"org.bluez.Error.{name}"


class ObjectTree:
    """What GetManagedObjects shows."""

    def __init__(self, bus: MessageBus) -> None:
        self.objects: dict[str, dict[str, Properties]] = {}
        self._bus = bus

    def value(self, path: str, interface: str, name: str) -> Any:
        """The value of a property; None when there is none."""
        variant = self.objects.get(path, {}).get(interface, {}).get(name)
        return None if variant is None else variant.value

    def below(self, path: str) -> list[str]:
        """The paths under ``path``, deepest first."""
        return sorted((other for other in self.objects if other.startswith(f"{path}/")), reverse=True)

    def add(self, path: str, interface: str, properties: Properties) -> None:
        """A new object."""
        self.objects[path] = {interface: properties}
        self._signal("/", OBJECT_MANAGER, "InterfacesAdded", "oa{sa{sv}}", [path, self.objects[path]])

    def remove(self, path: str) -> None:
        """Take an object away, after all that is below it."""
        for each in (*self.below(path), path):
            interfaces = self.objects.pop(each, None)
            if interfaces is not None:
                self._signal("/", OBJECT_MANAGER, "InterfacesRemoved", "oas", [each, list(interfaces)])

    def change(self, path: str, interface: str, changed: Mapping[str, Variant], gone: Iterable[str] = ()) -> None:
        """Set and drop properties; nothing happens when the object is gone."""
        properties = self.objects.get(path, {}).get(interface)
        if properties is None:
            return
        properties.update(changed)
        dropped = [name for name in gone if properties.pop(name, None) is not None]
        if changed or dropped:
            body = [interface, dict(changed), dropped]
            self._signal(path, PROPERTIES, "PropertiesChanged", "sa{sv}as", body)

    def _signal(self, path: str, interface: str, member: str, signature: str, body: list[Any]) -> None:
        if self._bus.connected:
            self._bus.send(Message.new_signal(path, interface, member, signature, body))
