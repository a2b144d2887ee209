"""What the emulated boards are like beyond their profile: name, address, set-up by writing, other services."""

from __future__ import annotations

import struct
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from imugui.formats.ble_profiles import BLE_PROFILES, BleProfile

WIT_RATES_HZ = {6: 10.0, 7: 20.0, 8: 50.0, 9: 100.0, 11: 200.0}
"""By the value of WitMotion's register 3."""


@dataclass(frozen=True)
class Model:
    """One kind of emulated board."""

    profile: BleProfile
    name: str  # as advertised
    rate_hz: float  # until somebody sets another one
    asked_rate: Callable[[bytes], float | None] | None = None  # the rate that a write of the start asks for, Hz
    information: Mapping[str, str] = field(default_factory=dict)  # keys of INFORMATION


def thingy_rate(written: bytes) -> float | None:
    """The rate in a Thingy's motion configuration, Hz; None when it is none."""
    if len(written) != 9:
        return None
    rate_hz = float(struct.unpack("<4HB", written)[3])
    return rate_hz if 1 <= rate_hz <= 200 else None


def wit_rate(written: bytes) -> float | None:
    """The rate in a WitMotion command, Hz; None when it sets something else."""
    if len(written) != 5 or not written.startswith(b"\xff\xaa\x03"):
        return None
    return WIT_RATES_HZ.get(written[3])


MODELS: dict[str, Model] = {
    "motion-card": Model(
        BLE_PROFILES["motion-card"],
        "CONTROL.CMR",
        100.0,
        information={"maker": "imugui", "model": "emulated motion card", "firmware": "1.0"},
    ),
    "thingy-52": Model(BLE_PROFILES["thingy-52"], "Thingy", 10.0, thingy_rate),
    "wit-ble": Model(BLE_PROFILES["wit-ble"], "WT901BLE68", 10.0, wit_rate),
}
"""By the key of BLE_PROFILES."""
