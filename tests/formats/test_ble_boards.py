"""The two other Bluetooth LE boards' messages against their public documentation, and the table of all of them."""

from __future__ import annotations

import re
import struct

import numpy as np
import pytest

from imugui.formats import FORMATS, Options
from imugui.formats.ble_profiles import BLE_PROFILES, known_board
from imugui.samples import GRAVITY, SAMPLE, empty_rows

DEG = np.pi / 180
UUID = re.compile(r"[0-9a-f]{8}(-[0-9a-f]{4}){3}-[0-9a-f]{12}")


def test_a_thingy_message_has_ten_five_and_four_binary_places() -> None:
    message = struct.pack("<9h", 512, -1024, 0, 32, -3200, 1, 16, -640, 8)
    row = FORMATS["thingy-motion"].decoder(Options()).feed(message, 0.0)[0]
    assert (row["acc"] / GRAVITY).tolist() == pytest.approx([-0.5, 1.0, 0.0])  # it sends +1 g downwards
    assert (row["gyr"] / DEG).tolist() == pytest.approx([1.0, -100.0, 1 / 32])
    assert row["mag"].tolist() == [1.0, -40.0, 0.5]
    assert np.isnan(row["temp_c"])
    assert row["status"] == -1


def test_a_thingy_at_rest_as_somebody_published_it() -> None:
    """From Nordic's forum: FAFF, F4FF, F603 for x, y, z on a table."""
    message = bytes.fromhex("FAFF F4FF F603") + struct.pack("<6h", 0, 0, 0, 320, 0, -640)
    row = FORMATS["thingy-motion"].decoder(Options()).feed(message, 0.0)[0]
    assert np.linalg.norm(row["acc"]) == pytest.approx(0.99 * GRAVITY, rel=0.002)


def test_a_thingy_whose_compass_was_not_read_has_no_field() -> None:
    message = struct.pack("<9h", 0, 0, 1024, 0, 0, 0, 0, 0, 0)
    row = FORMATS["thingy-motion"].decoder(Options()).feed(message, 0.0)[0]
    assert np.isnan(row["mag"]).all()


def test_an_acceleration_beyond_every_sensor_is_impossible() -> None:
    decoder = FORMATS["thingy-motion"].decoder(Options())
    assert len(decoder.feed(struct.pack("<9h", 32767, 32767, 32767, 0, 0, 0, 0, 0, 0), 0.0)) == 0
    assert decoder.counts.impossible == 1


def test_a_wit_message_has_the_scales_of_its_datasheet() -> None:
    message = b"\x55\x61" + struct.pack("<9h", 2048, -1024, 1, 16384, -32768, 0, 0, 8192, -16384)
    row = FORMATS["wit-motion"].decoder(Options()).feed(message, 0.0)[0]
    assert (row["acc"] / GRAVITY).tolist() == pytest.approx([1.0, -0.5, 16 / 32768])
    assert (row["gyr"] / DEG).tolist() == pytest.approx([1000.0, -2000.0, 0.0])
    assert np.isnan(row["mag"]).all()


def test_a_wit_board_sends_the_angles_of_its_acceleration() -> None:
    rows = empty_rows(SAMPLE, 2)
    rows["gyr"] = 0.0
    rows["acc"] = ((0.0, GRAVITY, 0.0), (-GRAVITY, 0.0, 0.0))  # rolled to the right, then nose up
    sent = FORMATS["wit-motion"].encoder().encode(rows)
    assert sent[:2] == b"\x55\x61"
    assert struct.unpack("<3h", sent[14:20]) == (16384, 0, 0)
    assert struct.unpack("<3h", sent[34:40])[1] == 16384


@pytest.mark.parametrize(("head", "counted"), [(b"\x55\x71", "chatter"), (b"\x55\x51", "bad_messages")])
def test_a_wit_message_of_another_kind_is_no_sample(head: bytes, counted: str) -> None:
    """The answer to a question about a register is in order; anything else is not."""
    decoder = FORMATS["wit-motion"].decoder(Options())
    answer = head + bytes.fromhex("3A00 6801 6900 7A00 0000 0000 0000 0000 0000")
    assert len(decoder.feed(answer, 0.0)) == 0
    assert getattr(decoder.counts, counted) == 1
    assert decoder.counts.chatter + decoder.counts.bad_messages == 1
    assert "3a 00 68 01" in decoder.log.entries()[0][2]


@pytest.mark.parametrize("key", BLE_PROFILES)
def test_profiles_are_complete(key: str) -> None:
    profile = BLE_PROFILES[key]
    assert FORMATS[profile.format].framed
    uuids = (profile.service, profile.notify, *profile.advertised, *(uuid for uuid, _ in profile.start))
    assert all(UUID.fullmatch(uuid) for uuid in uuids), uuids
    assert len(set(uuids)) == len(uuids)
    assert profile.title
    assert profile.names
    assert all(data for _, data in profile.start)


def test_every_framed_format_has_a_board() -> None:
    framed = {name for name, entry in FORMATS.items() if entry.framed}
    assert {profile.format for profile in BLE_PROFILES.values()} == framed


@pytest.mark.parametrize(
    ("name", "services", "board"),
    [
        ("CONTROL.CMR", (), "motion-card"),
        ("CONTROL.CMR-2", (), "motion-card"),
        (None, ("BF470001-767B-467D-A4C0-E8E050C0D96E",), "motion-card"),
        ("Thingy", (), "thingy-52"),
        ("Bob", ("ef680100-9b35-4933-9b10-52ffa9740042",), "thingy-52"),
        ("WT901BLE68", (), "wit-ble"),
        ("Thingy", ("0000ffe5-0000-1000-8000-00805f9a34fb",), "wit-ble"),
        ("WTVB01-BT50", (), ""),
        ("", (), ""),
        (None, ("0000180f-0000-1000-8000-00805f9b34fb",), ""),
    ],
)
def test_a_board_is_known_by_service_or_name(name: str | None, services: tuple[str, ...], board: str) -> None:
    assert known_board(name, services) == board
