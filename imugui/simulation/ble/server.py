"""What an emulated board offers: its services and characteristics, and how it advertises them."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from bumble.att import Attribute
from bumble.core import UUID, AdvertisingData
from bumble.device import Device, DeviceConfiguration
from bumble.gatt import Characteristic, CharacteristicValue, Service
from bumble.hci import Address

from imugui.formats.ble_profiles import BATTERY_LEVEL, BATTERY_SERVICE, INFORMATION, INFORMATION_SERVICE
from imugui.simulation.ble.airlink import AirController
from imugui.simulation.ble.models import Model

ADVERTISING_MS = 50.0
"""The card does it once a second; tests need not wait so long."""

Bytes = Characteristic[bytes]
Has = Characteristic.Properties


def make_device(controller: AirController, model: Model, address: str) -> Device:
    """The board's host; name and service do not fit into one advertisement, so the service is in the answer."""
    config = DeviceConfiguration(
        name=model.name,
        address=Address(address),
        advertising_interval_min=ADVERTISING_MS,
        advertising_interval_max=ADVERTISING_MS,
    )
    device = Device.from_config_with_hci(config, controller, controller)
    kinds = AdvertisingData.Type
    name = [(kinds.FLAGS, b"\x06"), (kinds.COMPLETE_LOCAL_NAME, model.name.encode())]
    service = (*model.profile.advertised, model.profile.service)[0]
    uuids = [(kinds.COMPLETE_LIST_OF_128_BIT_SERVICE_CLASS_UUIDS, bytes(UUID(service)))]
    device.advertising_data, device.scan_response_data = bytes(AdvertisingData(name)), bytes(AdvertisingData(uuids))
    return device


def messages_of(model: Model) -> Bytes:
    """The characteristic that notifies messages."""
    return Characteristic(model.profile.notify, Has.NOTIFY, Attribute.READABLE)


def level_of(battery: Callable[[], int]) -> Bytes:
    """The characteristic of the battery's level."""
    value = CharacteristicValue(read=lambda _connection: bytes([battery()]))
    return Characteristic(BATTERY_LEVEL, Has.READ | Has.NOTIFY, Attribute.READABLE, value)


def services_of(
    model: Model, messages: Bytes, level: Bytes, on_write: Callable[[str, bytes], None]
) -> Iterator[Service]:
    """All services; ``on_write`` hears (characteristic, bytes) of what is written."""
    written = dict.fromkeys(uuid for uuid, _ in model.profile.start)
    yield Service(model.profile.service, [messages, *(_writable(uuid, on_write) for uuid in written)])
    if model.profile.has_battery:
        yield Service(BATTERY_SERVICE, [level])
    told = [
        Characteristic(INFORMATION[key], Has.READ, Attribute.READABLE, text.encode())
        for key, text in model.information.items()
    ]
    if told:
        yield Service(INFORMATION_SERVICE, told)


def _writable(uuid: str, on_write: Callable[[str, bytes], None]) -> Bytes:
    value = CharacteristicValue(write=lambda _connection, data: on_write(uuid, bytes(data)))
    return Characteristic(uuid, Has.WRITE | Has.WRITE_WITHOUT_RESPONSE, Attribute.WRITEABLE, value)
