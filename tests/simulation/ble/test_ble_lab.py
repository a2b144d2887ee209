"""The Bluetooth lab through bleak, unmodified: boards that behave."""

from __future__ import annotations

import asyncio
import sys
import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import pytest
from bleak import BleakScanner

from imugui.formats import FORMATS, Options
from imugui.formats.ble_profiles import BATTERY_LEVEL, BLE_PROFILES, INFORMATION, known_board
from imugui.simulation import ble
from imugui.simulation.ble.models import thingy_rate, wit_rate
from imugui.simulation.ble.tree import ADAPTER_PATH, DEVICE
from imugui.simulation.board import VirtualBoard

if TYPE_CHECKING:
    from imugui.simulation.ble.lab import BleLab
    from imugui.simulation.ble.peripheral import Peripheral

Program = Any  # conftest's
PROFILE = BLE_PROFILES["motion-card"]


def test_a_scan_tells_name_service_and_strength(lab: BleLab, card: Peripheral, program: Program) -> None:
    far = lab.add_board("thingy-52", name="Bob")
    lab.set_rssi(card, -41)
    lab.set_rssi(far, -88)

    async def scene() -> None:
        heard = {}
        async with BleakScanner(lambda device, said: heard.update({device.address: said})):
            await program.until(
                lambda: (
                    {card.address, far.address}
                    <= {a for a, said in heard.items() if said.service_uuids and said.local_name}
                )
            )
        near, other = heard[card.address], heard[far.address]
        assert (near.local_name, near.rssi, other.local_name, other.rssi) == ("CONTROL.CMR", -41, "Bob", -88)
        assert near.service_uuids == [PROFILE.service]
        assert known_board(near.local_name, near.service_uuids) == "motion-card"
        assert known_board(other.local_name, other.service_uuids) == "thingy-52"

    program.play(scene())


def test_a_scan_can_ask_for_a_service(lab: BleLab, card: Peripheral, program: Program) -> None:
    other = lab.add_board("wit-ble")
    path = f"{ADAPTER_PATH}/dev_{other.address.replace(':', '_')}"

    async def scene() -> None:
        found: list[str] = []

        async with BleakScanner(lambda device, _: found.append(device.address), service_uuids=[PROFILE.service]):
            await program.until(lambda: DEVICE in program.known(path) and card.address in found)
            before = len(found)
            await program.until(lambda: len(found) >= before + 5)
        assert set(found) == {card.address}

    program.play(scene())


def test_every_notification_arrives_once_and_in_order(lab: BleLab, program: Program) -> None:
    board = lab.add_board(board=VirtualBoard("turns", 100.0, seed=4), speed=6.0)
    sent, received = [], []
    board.on_sent = lambda _t, message: sent.append(message)

    async def scene() -> None:
        async with program.connected(board) as (client, _):
            await client.start_notify(PROFILE.notify, lambda _, data: received.append(bytes(data)))
            await program.until(lambda: len(received) >= 1200)  # twelve seconds of the board's life
            await client.stop_notify(PROFILE.notify)

    program.play(scene())
    lab.remove_board(board)
    truth = VirtualBoard("turns", 100.0, seed=4).rows(board.board.count)
    truth["status"] = 0
    stream = FORMATS["motion-card"].encoder().encode(truth)
    assert received == sent[: len(received)]
    assert b"".join(received) in stream  # without a gap


def test_a_bus_that_does_not_read_for_a_while_loses_nothing(lab: BleLab, card: Peripheral, program: Program) -> None:
    """A machine that is busy elsewhere: the socket to the bus fills up, after some 300 notifications."""
    numbers: list[int] = []

    async def scene() -> None:
        async with program.connected(card) as (client, _):
            await client.start_notify(PROFILE.notify, lambda _, data: numbers.append(int.from_bytes(data)))
            lab.pause_bus(True)
            for number in range(1000):
                await asyncio.to_thread(lab.send, card, number.to_bytes(5))
            lab.pause_bus(False)
            await program.until(lambda: numbers[-1:] == [999])

    card.rate_hz = 1e-6  # nothing of its own
    program.play(scene())
    assert [number for number in numbers if number < 1000] == list(range(1000))


@pytest.mark.parametrize("kind", BLE_PROFILES)
def test_every_kind_of_board_streams_at_its_rate_after_its_start(lab: BleLab, kind: str, program: Program) -> None:
    switched_on = time.monotonic()
    board = lab.add_board(kind, "rest")
    profile = BLE_PROFILES[kind]
    decoder = FORMATS[profile.format].decoder(Options())

    async def scene() -> None:
        async with program.connected(board) as (client, _):
            assert client.services.get_service(profile.service) is not None
            await client.start_notify(profile.notify, lambda _, data: decoder.feed(bytes(data), 0.0))
            for uuid, data in profile.start:
                await client.write_gatt_char(uuid, data, response=True)
            before = board.sent
            await program.until(lambda: board.sent >= before + 50)
            measured = board.board.count
            assert measured <= 100.0 * (time.monotonic() - switched_on) + 1.0  # no faster than 100 Hz
            await program.until(lambda: decoder.counts.messages >= 50)

    program.play(scene())
    assert board.rate_hz == FORMATS[profile.format].rate_hz
    assert decoder.counts.bad_messages == 0
    assert tuple(board.written) == profile.start


def test_a_board_whose_rate_nobody_set_is_slow(lab: BleLab, program: Program) -> None:
    board = lab.add_board("thingy-52", speed=10.0)
    measured: list[int] = []  # by the board, when it sent each message
    board.on_sent = lambda _t, _message: measured.append(board.board.count)

    def later() -> list[int]:
        return [count for count in list(measured) if count > measured[0]]

    async def scene() -> None:
        async with program.connected(board) as (client, _):
            await client.start_notify(BLE_PROFILES["thingy-52"].notify, lambda *_: None)
            await program.until(lambda: len(later()) >= 20)

    program.play(scene())
    assert board.rate_hz == 10.0
    assert len(later()) <= (later()[-1] - measured[0]) / 10 + 1  # each tenth sample of the board's 100 Hz


@pytest.mark.parametrize(
    ("asked", "rate_hz"),
    [
        (thingy_rate(bytes.fromhex("f401 f401 6400 c800 00")), 200.0),
        (thingy_rate(bytes.fromhex("f401 f401 6400 0000 00")), None),
        (thingy_rate(b"too short"[:5]), None),
        (wit_rate(bytes.fromhex("ffaa030800")), 50.0),
        (wit_rate(bytes.fromhex("ffaa273a00")), None),
    ],
)
def test_only_a_known_command_sets_a_rate(asked: float | None, rate_hz: float | None) -> None:
    assert asked == rate_hz


def test_battery_and_information_are_read_and_notified(lab: BleLab, card: Peripheral, program: Program) -> None:
    levels: asyncio.Queue[int] = asyncio.Queue()

    async def scene() -> None:
        async with program.connected(card) as (client, _):
            assert list(await client.read_gatt_char(BATTERY_LEVEL)) == [87]
            assert await client.read_gatt_char(INFORMATION["model"]) == b"emulated motion card"
            await client.start_notify(BATTERY_LEVEL, lambda _, data: levels.put_nowait(data[0]))
            await asyncio.to_thread(lab.set_battery, card, 12)
            assert await levels.get() == 12
            assert list(await client.read_gatt_char(BATTERY_LEVEL)) == [12]

    program.play(scene())


def test_the_button_and_a_damaged_message_come_with_the_stream(lab: BleLab, card: Peripheral, program: Program) -> None:
    decoder = FORMATS["motion-card"].decoder(Options())
    heard: list[int] = []

    async def scene() -> None:
        async with program.connected(card) as (client, _):
            await client.start_notify(
                PROFILE.notify, lambda _, data: heard.extend(decoder.feed(bytes(data), 0.0)["status"].tolist())
            )
            for status in (0, 1, 2, 0):
                await asyncio.to_thread(lab.press, card, status)
                await program.until(lambda now=status: bool(heard) and heard[-1] == now)
            await asyncio.to_thread(lab.send, card, b"\1\2\3")
            await program.until(lambda: decoder.counts.bad_messages == 1)

    program.play(scene())
    changes = [b for a, b in zip([-1, *heard], heard, strict=False) if a != b]
    assert changes == [0, 1, 2, 0]


def test_a_second_client_shares_the_link_and_ends_it(lab: BleLab, card: Peripheral, program: Program) -> None:
    async def scene() -> None:
        device = await program.find(card)
        async with program.connected(card) as (_, gone):
            async with program.client(device) as second:
                assert list(await second.read_gatt_char(BATTERY_LEVEL)) == [87]
            await asyncio.wait_for(gone.wait(), program.LIMIT_S)

    program.play(scene())


def test_two_boards_of_one_name_stream_at_once(lab: BleLab, card: Peripheral, program: Program) -> None:
    twin = lab.add_board(seed=7)
    counts = {card.address: 0, twin.address: 0}

    def counter(address: str) -> Callable[..., None]:
        def count(*_: object) -> None:
            counts[address] += 1

        return count

    async def scene() -> None:
        async with program.connected(card) as (one, _), program.connected(twin) as (other, _):
            await one.start_notify(PROFILE.notify, counter(card.address))
            await other.start_notify(PROFILE.notify, counter(twin.address))
            await program.until(lambda: min(counts.values()) >= 30)

    program.play(scene())


def test_what_is_missing_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    assert ble.missing() == ""
    monkeypatch.setenv("PATH", "")
    assert "needs the program dbus-daemon" in ble.missing()
    monkeypatch.setattr(sys, "path", [])
    monkeypatch.delitem(sys.modules, "bumble", raising=False)
    monkeypatch.delitem(sys.modules, "dbus_fast", raising=False)
    assert "pip install 'imugui[ble-test]'" in ble.missing()
