"""The radio of a session: made when it is used, shared, stopped by whoever made it. And what every transport has."""

from __future__ import annotations

import pytest

from imugui.workers import TRANSPORTS
from imugui.workers.ble_loop import Radio
from imugui.workers.bluetooth import Bluetooth
from imugui.workers.transport import Transport


async def nothing() -> None:
    """Work that is done at once."""


def test_the_radio_is_one_and_its_maker_stops_it() -> None:
    bluetooth = Bluetooth(None)
    radio = bluetooth.radio
    assert bluetooth.radio is radio
    assert not radio.started
    radio.submit(nothing()).result(timeout=5.0)
    bluetooth.stop()
    assert not radio.started


def test_a_shared_radio_goes_on() -> None:
    radio = Radio()
    bluetooth = Bluetooth(radio)
    assert bluetooth.radio is radio
    bluetooth.stop()
    try:
        radio.submit(nothing()).result(timeout=5.0)
    finally:
        radio.stop()


def test_a_radio_that_was_not_used_before_the_end_is_not_begun_after_it() -> None:
    bluetooth = Bluetooth(None)
    bluetooth.stop()
    with pytest.raises(RuntimeError, match="stopped"):
        bluetooth.scan().start(1.0)


@pytest.mark.parametrize("name", TRANSPORTS)
def test_every_transport_is_one(name: str) -> None:
    kind = TRANSPORTS[name]
    assert isinstance(kind, type)
    assert Transport in kind.mro()
    assert kind.wireless is (name == "ble")
