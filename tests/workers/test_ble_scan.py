"""Looking for boards, on the emulated radio through unmodified bleak."""

from __future__ import annotations

import math
from collections.abc import Iterator

import pytest

from imugui.formats.ble_profiles import BLE_PROFILES
from imugui.workers.ble_list import found_boards
from imugui.workers.ble_loop import Radio
from imugui.workers.ble_scan import Scan, is_called
from imugui.workers.port_errors import LinkError

LISTING_S = 1.5  # a listing's whole time; a board is heard every 50 ms


@pytest.fixture
def radio() -> Iterator[Radio]:
    one = Radio()
    yield one
    one.stop()
    assert not one.started


def seen(scan: Scan, names: set[str], qtbot) -> None:
    """Look until these names were heard, then no longer."""
    scan.start(60.0)
    qtbot.waitUntil(lambda: {board.name for board in scan.boards} >= names)
    scan.stop()
    qtbot.waitUntil(lambda: not scan.running)


def seen_often(scan: Scan, name: str, qtbot) -> list[str]:
    """The names of all that a scan sees until it has heard this one again and again: others had their time too."""
    times: set[float] = set()

    def heard() -> bool:
        times.update(board.t for board in scan.boards if board.name == name)
        return len(times) > 5

    scan.start(60.0)
    qtbot.waitUntil(heard)
    scan.stop()
    return [board.name for board in scan.boards]


def test_boards_are_listed_with_what_is_known_of_them(ble_lab, radio: Radio, qtbot) -> None:
    far = ble_lab.add_board("motion-card", name="CONTROL.CMR-2")
    ble_lab.set_rssi(far, -80)
    ble_lab.add_board("motion-card")
    ble_lab.add_board("wit-ble")
    scan = Scan(radio)
    seen(scan, {"CONTROL.CMR", "CONTROL.CMR-2", "WT901BLE68"}, qtbot)
    boards = scan.boards
    assert boards[-1].name == "CONTROL.CMR-2"
    assert boards[-1].rssi_dbm == -80.0
    assert boards[-1].address == far.address
    assert {board.family for board in boards} == {"Motion card", "WitMotion WT901BLE"}
    assert all(math.isnan(board.battery_percent) for board in boards)
    assert scan.problem is None


def test_boards_are_filtered_by_name_and_by_service(ble_lab, radio: Radio, qtbot) -> None:
    for kind in ("motion-card", "thingy-52"):
        ble_lab.add_board(kind)
    everything = Scan(radio)
    seen(everything, {"CONTROL.CMR", "Thingy"}, qtbot)
    by_service, by_name = Scan(radio, service=BLE_PROFILES["motion-card"].service.upper()), Scan(radio, name="hing")
    assert seen_often(by_service, "CONTROL.CMR", qtbot) == ["CONTROL.CMR"]
    assert seen_often(by_name, "Thingy", qtbot) == ["Thingy"]


def test_a_switched_off_adapter_is_said(ble_lab, radio: Radio) -> None:
    scan = Scan(radio)
    ble_lab.set_powered(False)
    scan.start(1.0)
    with pytest.raises(LinkError, match="switched off"):
        scan.wait()
    assert scan.problem is not None
    assert scan.problem.kind == "off"


def test_a_service_that_crashed_is_said(ble_lab, card, radio: Radio, qtbot) -> None:
    scan = Scan(radio)
    seen(scan, {card.name}, qtbot)
    ble_lab.kill_service()
    scan.start(1.0)
    with pytest.raises(LinkError, match="service does not answer"):
        scan.wait()


def test_no_bus_at_all_is_said(radio: Radio, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("dbus_fast")
    monkeypatch.setenv("DBUS_SYSTEM_BUS_ADDRESS", "unix:path=/nowhere/bus")
    scan = Scan(radio)
    scan.start(1.0)
    with pytest.raises(LinkError, match="message bus is not there"):
        scan.wait()
    lines, remark = found_boards(1.0, everything=True)
    assert lines == []
    assert remark.startswith("No Bluetooth boards are listed. Bluetooth cannot be reached")


def test_the_listing_counts_what_it_leaves_out(ble_lab) -> None:
    from imugui.simulation.ble.models import MODELS, Model

    other = BLE_PROFILES["wit-ble"]
    stranger = Model(
        type(other)("Watch", other.format, *["0000aaaa-0000-1000-8000-00805f9b34fb"] * 2, ("Watch",)), "Watch", 1.0
    )
    card, watch = ble_lab.add_board("motion-card"), ble_lab.add_board(model=stranger, name="Watch 7")
    assert MODELS["motion-card"].name == card.name
    lines, remark = found_boards(LISTING_S, everything=False)
    assert lines == [f"{card.address}\tCONTROL.CMR\tMotion card, -50 dBm"]
    assert remark == "1 other Bluetooth devices are in reach (--all lists them)."
    lines, remark = found_boards(LISTING_S, everything=True)
    assert lines[1] == f"{watch.address}\tWatch 7\tunknown, -50 dBm"
    assert remark == ""


@pytest.mark.parametrize(
    ("wanted", "fits"), [("CARD", True), ("card", False), ("F0:AA", True), ("f0:aa", True), ("F0", False)]
)
def test_a_board_is_called_by_its_name_or_its_address(wanted: str, fits: bool) -> None:
    assert is_called(wanted, "CARD", "F0:AA") is fits
