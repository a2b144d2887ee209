"""How to listen to Bluetooth LE boards: one entry of BLE_PROFILES each. A new board is one entry (and its format)."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

BATTERY_SERVICE = "0000180f-0000-1000-8000-00805f9b34fb"
BATTERY_LEVEL = "00002a19-0000-1000-8000-00805f9b34fb"
INFORMATION_SERVICE = "0000180a-0000-1000-8000-00805f9b34fb"
INFORMATION = {
    "maker": "00002a29-0000-1000-8000-00805f9b34fb",
    "model": "00002a24-0000-1000-8000-00805f9b34fb",
    "firmware": "00002a26-0000-1000-8000-00805f9b34fb",
}
"""Characteristics of the device information service that a board may have."""


@dataclass(frozen=True)
class BleProfile:
    """One kind of board. All UUIDs are of 36 characters, small letters."""

    title: str
    format: str  # a key of FORMATS
    service: str  # holds ``notify``
    notify: str  # the characteristic whose notifications are messages
    names: tuple[str, ...]  # how advertised names begin
    advertised: tuple[str, ...] = ()  # services by which it is known in a scan, besides ``service``
    start: tuple[tuple[str, bytes], ...] = ()  # written in this order after subscribing: (characteristic, bytes)
    has_battery: bool = True  # the battery service is there


BLE_PROFILES: dict[str, BleProfile] = {
    "motion-card": BleProfile(
        "Motion card",
        "motion-card",
        "bf470001-767b-467d-a4c0-e8e050c0d96e",
        "bf470002-767b-467d-a4c0-e8e050c0d96e",
        ("CONTROL.CMR",),
    ),
    "thingy-52": BleProfile(
        "Nordic Thingy:52",
        "thingy-motion",
        "ef680400-9b35-4933-9b10-52ffa9740042",
        "ef680406-9b35-4933-9b10-52ffa9740042",
        ("Thingy",),
        advertised=("ef680100-9b35-4933-9b10-52ffa9740042",),
        # intervals of steps, temperature and compass in ms, rate in Hz (100), no waking by motion
        start=(("ef680401-9b35-4933-9b10-52ffa9740042", bytes.fromhex("f401 f401 6400 6400 00")),),
    ),
    "wit-ble": BleProfile(
        "WitMotion WT901BLE",
        "wit-motion",
        "0000ffe5-0000-1000-8000-00805f9a34fb",
        "0000ffe4-0000-1000-8000-00805f9a34fb",
        ("WT901BLE", "BWT901BLE"),
        start=(("0000ffe9-0000-1000-8000-00805f9a34fb", bytes.fromhex("ffaa030900")),),  # 100 messages a second
        has_battery=False,
    ),
}


def known_board(name: str | None, services: Iterable[str] = ()) -> str:
    """The key of the profile that fits an advertised name or service; "" when none does. Services count first."""
    heard = {service.lower() for service in services}
    for key, profile in BLE_PROFILES.items():
        if heard & {profile.service, *profile.advertised}:
            return key
    fitting = (key for key, profile in BLE_PROFILES.items() if (name or "").startswith(profile.names))
    return next(fitting, "")
