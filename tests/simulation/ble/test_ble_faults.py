"""The Bluetooth lab through bleak, unmodified: what a program sees when things go wrong, as on a real system."""

from __future__ import annotations

import asyncio
import os
import threading
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import pytest
from bleak import BleakClient, BleakScanner
from bleak.exc import (
    BleakBluetoothNotAvailableError,
    BleakCharacteristicNotFoundError,
    BleakDBusError,
    BleakError,
    BleakGATTProtocolError,
)

from imugui.formats.ble_profiles import BATTERY_LEVEL, BLE_PROFILES, INFORMATION
from imugui.simulation.ble.models import MODELS
from imugui.simulation.ble.private_bus import VARIABLE
from imugui.simulation.ble.tree import ADAPTER, ADAPTER_PATH, DEVICE

if TYPE_CHECKING:
    from imugui.simulation.ble.lab import BleLab
    from imugui.simulation.ble.peripheral import Peripheral

Program = Any  # conftest's
PROFILE = BLE_PROFILES["motion-card"]
ABSENT_S = 0.3  # a scan that must not find anything; a board in range is heard every 50 ms


def test_a_dropped_link_is_noticed_and_made_again_unscanned(lab: BleLab, card: Peripheral, program: Program) -> None:
    async def scene() -> None:
        async with program.connected(card) as (client, gone):
            await asyncio.to_thread(lab.drop_link, card)
            await asyncio.wait_for(gone.wait(), program.LIMIT_S)
            assert not client.is_connected
            await client.connect()
            assert list(await client.read_gatt_char(BATTERY_LEVEL)) == [87]
        await program.until(lambda: not card.connected)

    program.play(scene())


def test_a_silent_board_is_not_found_any_more(lab: BleLab, program: Program) -> None:
    board = lab.add_board()

    async def scene() -> None:
        async with program.connected(board) as (_, gone):
            await asyncio.to_thread(lab.drop_link, board, True)
            await asyncio.wait_for(gone.wait(), program.LIMIT_S)
        assert await program.find(board, ABSENT_S) is None
        await asyncio.to_thread(lab.wake, board)
        assert await program.find(board) is not None

    program.play(scene())


def test_out_of_range_the_link_is_lost_and_comes_back_in_range(lab: BleLab, card: Peripheral, program: Program) -> None:
    async def scene() -> None:
        device = await program.find(card)
        async with program.connected(card) as (client, gone):
            await asyncio.to_thread(lab.leave_range, card, 3600.0)
            assert client.is_connected  # silence is noticed only after the supervision time
            await asyncio.to_thread(lab.leave_range, card, 0.0)  # which is over
            await asyncio.wait_for(gone.wait(), program.LIMIT_S)
            assert not card.connected
            again = BleakClient(device, timeout=ABSENT_S)
            with pytest.raises(asyncio.TimeoutError):
                await again.connect()
            await asyncio.to_thread(lab.enter_range, card)
            await client.connect()
            assert card.connected

    program.play(scene())


def test_a_request_during_which_the_link_goes_fails(lab: BleLab, card: Peripheral, program: Program) -> None:
    async def scene() -> None:
        async with program.connected(card) as (client, gone):
            await asyncio.to_thread(lab.leave_range, card, 3600.0)
            asking = asyncio.ensure_future(client.read_gatt_char(BATTERY_LEVEL))
            await program.until(lambda: lab.bluez.serving == 1)
            await asyncio.to_thread(lab.leave_range, card, 0.0)
            with pytest.raises(BleakGATTProtocolError):
                await asking
            await asyncio.wait_for(gone.wait(), program.LIMIT_S)
            with pytest.raises(BleakError, match="Service Discovery"):
                await client.read_gatt_char(BATTERY_LEVEL)

    program.play(scene())


def test_a_board_that_hangs_up_during_discovery(lab: BleLab, card: Peripheral, program: Program) -> None:
    async def scene() -> None:
        device = await program.find(card)
        client = program.client(device)
        lab.hang_up_next(card)
        with pytest.raises(BleakError, match="failed to discover services, device disconnected"):
            await client.connect()
        async with program.client(device):
            assert card.connected

    program.play(scene())


def test_the_adapter_is_switched_off_and_on(lab: BleLab, card: Peripheral, program: Program) -> None:
    async def scene() -> None:
        async with program.connected(card) as (client, gone):
            await asyncio.to_thread(lab.set_powered, False)
            await asyncio.wait_for(gone.wait(), program.LIMIT_S)
            await program.until(lambda: not program.known(ADAPTER_PATH)[ADAPTER]["Powered"])
            with pytest.raises(BleakBluetoothNotAvailableError) as off:
                await BleakScanner.discover(timeout=0.1)
            assert off.value.reason.name == "POWERED_OFF"
            with pytest.raises(BleakDBusError, match="Input/output error"):
                await client.connect()
            await asyncio.to_thread(lab.set_powered, True)
            await client.connect()
            assert card.connected

    program.play(scene())


def test_the_adapter_is_pulled_out_and_put_in(lab: BleLab, card: Peripheral, program: Program) -> None:
    async def scene() -> None:
        async with program.connected(card) as (_, gone):
            await asyncio.to_thread(lab.unplug)
            await asyncio.wait_for(gone.wait(), program.LIMIT_S)
            await program.until(lambda: ADAPTER not in program.known(ADAPTER_PATH))
            with pytest.raises(BleakBluetoothNotAvailableError) as none:
                await BleakScanner.discover(timeout=0.1)
            assert none.value.reason.name == "NO_BLUETOOTH"
            await asyncio.to_thread(lab.plug_in)
            assert await program.found_again(card) is not None

    program.play(scene())


def test_a_crash_of_the_service_is_silent(lab: BleLab, card: Peripheral, program: Program) -> None:
    """Nobody tells the program: only that no data come."""

    async def scene() -> None:
        async with program.connected(card) as (client, gone):
            await asyncio.to_thread(lab.kill_service)
            await program.until(lambda: not card.connected)
            assert client.is_connected
            assert not gone.is_set()
            with pytest.raises(BleakDBusError, match="ServiceUnknown"):
                await client.read_gatt_char(BATTERY_LEVEL)
            with pytest.raises(BleakDBusError, match="ServiceUnknown"):
                await client.disconnect()
            await asyncio.to_thread(lab.start_service)
        async with program.connected(card):
            assert card.connected

    program.play(scene())


def test_a_board_that_somebody_else_holds_is_not_found(lab: BleLab, card: Peripheral, program: Program) -> None:
    lab.seize(card)

    async def scene() -> None:
        assert await program.find(card, ABSENT_S) is None
        await asyncio.to_thread(lab.release, card)
        assert await program.find(card) is not None

    program.play(scene())


def test_a_board_without_the_characteristic(lab: BleLab, program: Program) -> None:
    odd = replace(MODELS["motion-card"], profile=replace(PROFILE, notify=PROFILE.notify.replace("0002", "0003")))
    board = lab.add_board(model=odd)

    async def scene() -> None:
        async with program.connected(board) as (client, _):
            with pytest.raises(BleakCharacteristicNotFoundError):
                await client.start_notify(PROFILE.notify, lambda *_: None)
            with pytest.raises(BleakError):
                await client.start_notify(INFORMATION["model"], lambda *_: None)  # it cannot notify

    program.play(scene())


def test_a_call_that_was_told_to_fail_fails_once(lab: BleLab, card: Peripheral, program: Program) -> None:
    async def scene() -> None:
        device = await program.find(card)
        client = program.client(device)
        lab.fail_next("Connect", "Failed", "Input/output error")
        with pytest.raises(BleakDBusError, match="Input/output error"):
            await client.connect()
        async with program.client(device):
            assert card.connected

    program.play(scene())


def test_without_permission_every_call_is_denied(lab: BleLab, card: Peripheral, program: Program) -> None:
    async def scene() -> None:
        async with program.connected(card) as (client, _):
            await asyncio.to_thread(lab.refuse, True)
            with pytest.raises(BleakDBusError, match="AccessDenied"):
                await client.read_gatt_char(BATTERY_LEVEL)
            await asyncio.to_thread(lab.refuse, False)  # or leaving the board would be denied too

    program.play(scene())


def test_a_board_never_connected_is_forgotten_after_the_scan(lab: BleLab, card: Peripheral, program: Program) -> None:
    lab.bluez.adapter.forget_s = 0.05

    async def scene() -> None:
        device = await program.find(card)
        path = device.details["path"]
        await program.until(lambda: DEVICE not in program.known(path))
        assert path not in lab.bluez.tree.objects
        with pytest.raises(BleakError, match="not found"):
            await program.client(device).connect()

    program.play(scene())


def test_a_bus_that_dies_ends_the_link_and_the_lab_still_stops(lab: BleLab, program: Program) -> None:
    before = {thread.ident for thread in threading.enumerate()}
    variable = os.environ.get(VARIABLE)
    own, doomed = type(program)(), type(lab)()
    doomed.start()
    board = doomed.add_board()

    async def scene() -> None:
        async with own.connected(board) as (_, gone):
            await asyncio.to_thread(doomed.kill_bus)
            await asyncio.wait_for(gone.wait(), own.LIMIT_S)
            with pytest.raises(OSError, match=r"(?i)refused|no such file"):
                await BleakScanner.discover(timeout=0.1)

    try:
        own.play(scene())
    finally:
        doomed.stop()
    own.close()
    assert os.environ.get(VARIABLE) == variable == lab.address
    assert [thread.name for thread in threading.enumerate() if thread.ident not in before] == []
