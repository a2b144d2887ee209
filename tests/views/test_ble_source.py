"""Bluetooth boards in the list of sources, on the emulated radio through unmodified bleak."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import pytest
from PySide6.QtCore import Qt
from pytestqt.qtbot import QtBot

from imugui.formats.ble_profiles import BLE_PROFILES
from imugui.simulation.ble import missing
from imugui.simulation.ble.models import Model
from imugui.views.ble_search import FORGET_S, BleSearch
from imugui.views.connection_bar import ConnectionBar
from imugui.views.main_window import MainWindow
from imugui.views.settings_store import SettingsStore
from imugui.views.source_box import Choice, SourceBox
from imugui.views.source_choices import BLUETOOTH, SEARCH
from imugui.workers.session import Session, Source, State

if TYPE_CHECKING:
    from imugui.simulation.ble.lab import BleLab

STRANGE = replace(
    BLE_PROFILES["motion-card"],
    service="0000aaaa-0000-1000-8000-00805f9b34fb",
    notify="0000aaab-0000-1000-8000-00805f9b34fb",
    has_battery=False,
)


@pytest.fixture
def lab() -> Iterator[BleLab]:
    if lacking := missing():
        pytest.skip(lacking)
    from imugui.simulation.ble.lab import BleLab

    with BleLab() as one:
        yield one


@pytest.fixture
def ble_session(lab: BleLab, qapp: object) -> Iterator[Session]:
    one = Session()
    yield one
    one.close()
    assert not one.radio.started


@pytest.fixture
def bar(ble_session: Session, settings_store: SettingsStore, shown: Callable[[Any], Any]) -> Iterator[ConnectionBar]:
    one = shown(ConnectionBar(ble_session, settings_store))
    yield one
    one.source.hidePopup()


def boards(box: SourceBox) -> list[Choice]:
    return [one for one in box.choices() if one.transport == "ble" and not one.action]


def notes(box: SourceBox) -> list[str]:
    """Lines of the Bluetooth section that are no entries, with their line breaks taken out."""
    first = box.findText(BLUETOOTH) + 1
    rows = range(first, box.findText("RECORDING"))
    return [box.itemText(row).replace("\n", " ") for row in rows if box.itemData(row) is None]


def pick(box: SourceBox, row: int) -> None:
    """Choose an entry as a click in the open list does."""
    box.hidePopup()
    box.setCurrentIndex(row)
    box.activated.emit(row)


def search(bar: ConnectionBar, qtbot: QtBot, until: Callable[[], bool]) -> None:
    pick(bar.source, bar.source.findText(SEARCH.text))
    qtbot.waitUntil(lambda: bar.source.view().isVisible() and until())


def row_of(box: SourceBox, start: str) -> int:
    return box.findText(start, Qt.MatchFlag.MatchStartsWith)


def test_bluetooth_is_left_alone_until_somebody_asks(bar: ConnectionBar, qtbot: QtBot) -> None:
    bar.source.showPopup()
    qtbot.waitUntil(bar.source.view().isVisible)
    assert bar.source.findText(SEARCH.text) > bar.source.findText(BLUETOOTH) > 0
    assert boards(bar.source) == []
    assert not bar.search.running
    assert not bar.search.used


def test_an_empty_page_leads_to_the_boards(lab: BleLab, bar: ConnectionBar, qtbot: QtBot) -> None:
    lab.add_board("motion-card")
    bar.connect_to("ble", "")
    qtbot.waitUntil(lambda: bar.source.view().isVisible() and len(boards(bar.source)) == 1)


def test_the_open_list_grows_with_what_is_said(bar: ConnectionBar, qtbot: QtBot) -> None:
    bar.connect_to("ble", "")
    qtbot.waitUntil(bar.source.view().isVisible)
    said = "Bluetooth is switched off, as far as this computer tells, and so on and on. Switch it on. " * 2
    bar.search.problem = said
    bar.search.changed.emit()
    row = next(row for row in range(bar.source.count()) if "and so on" in bar.source.itemText(row))
    widest = max(map(bar.source.fontMetrics().horizontalAdvance, bar.source.itemText(row).split("\n")))
    assert bar.source.view().width() >= widest


def test_boards_are_listed_while_the_list_is_open(lab: BleLab, bar: ConnectionBar, qtbot: QtBot) -> None:
    box = bar.source
    near, far = lab.add_board("motion-card"), lab.add_board("wit-ble")
    lab.set_rssi(near, -55)
    lab.set_rssi(far, -90)
    lab.add_board(model=Model(STRANGE, "Headphones", 100.0))
    search(bar, qtbot, lambda: len(boards(box)) == 2 and row_of(box, "Show all: 1 more device") > 0)
    found = {one.name: one for one in boards(box)}
    assert found["CONTROL.CMR"].text == "CONTROL.CMR  (Motion card, signal strong −55 dBm)"
    assert found["CONTROL.CMR"].address == near.address
    assert found["WT901BLE68"].text == "WT901BLE68  (WitMotion WT901BLE, signal very weak −90 dBm)"
    assert [found[name].bars for name in ("CONTROL.CMR", "WT901BLE68")] == [4, 1]
    assert not box.itemIcon(row_of(box, "CONTROL.CMR")).isNull()
    assert notes(box) == ["● Searching…"]
    pick(box, row_of(box, "Show all"))
    qtbot.waitUntil(lambda: "Headphones" in {one.name for one in boards(box)})
    assert boards(box)[-1].text.startswith("Headphones  (unknown kind, signal")
    assert box.choice().transport == "simulator"
    box.hidePopup()
    assert not bar.search.running
    qtbot.waitUntil(lambda: box.findText(SEARCH.text) > 0)


def test_an_open_list_keeps_what_stands_in_it(lab: BleLab, bar: ConnectionBar, qtbot: QtBot) -> None:
    box = bar.source
    lab.add_board("wit-ble")
    search(bar, qtbot, lambda: len(boards(box)) == 1)
    row = row_of(box, "WT901BLE68")
    card = lab.add_board("motion-card")
    lab.set_rssi(card, -40)
    qtbot.waitUntil(lambda: len(boards(box)) == 2)
    assert row_of(box, "WT901BLE68") == row
    assert box.currentData().key == box.choice().key


def test_a_board_is_connected_and_remembered(
    lab: BleLab, bar: ConnectionBar, ble_session: Session, settings_store: SettingsStore, owned: Any, qtbot: QtBot
) -> None:
    card = lab.add_board("motion-card")
    bar.format.choose("triplets")
    search(bar, qtbot, lambda: len(boards(bar.source)) == 1)
    pick(bar.source, row_of(bar.source, "CONTROL.CMR"))
    bar.refresh(ble_session.status())
    assert not bar.format.isEnabled()
    assert bar.baud.isHidden()
    bar.button.click()
    qtbot.waitUntil(lambda: ble_session.status().state is State.STREAMING)
    assert ble_session.source == Source("ble", card.address)
    assert ble_session.status().format == "motion-card"
    kept = settings_store.settings
    assert (kept.transport, kept.address, kept.source_name) == ("ble", card.address, "CONTROL.CMR")
    again = owned(ConnectionBar(ble_session, settings_store))
    assert again.source.choice().key == ("ble", card.address)
    assert again.source.choice().text == f"CONTROL.CMR  ({card.address})"
    assert again.source.choice().short == "CONTROL.CMR"


def test_bluetooth_that_is_off_is_said_with_what_to_do(lab: BleLab, bar: ConnectionBar, qtbot: QtBot) -> None:
    lab.add_board("motion-card")
    lab.set_powered(False)
    search(bar, qtbot, lambda: any("Bluetooth is switched off. Switch it on" in note for note in notes(bar.source)))
    assert all(note.startswith("▲") for note in notes(bar.source))
    lab.set_powered(True)
    qtbot.waitUntil(lambda: len(boards(bar.source)) == 1)
    assert notes(bar.source) == ["● Searching…"]


def test_forbidden_bluetooth_is_said(lab: BleLab, bar: ConnectionBar, qtbot: QtBot) -> None:
    lab.refuse(True)
    search(bar, qtbot, lambda: any("No permission to use Bluetooth" in note for note in notes(bar.source)))


def test_a_board_that_is_heard_no_more_is_forgotten(
    lab: BleLab, ble_session: Session, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert FORGET_S > 3.0  # a scan's length: a board is not forgotten between two scans
    monkeypatch.setattr("imugui.views.ble_search.FORGET_S", 0.5)
    card = lab.add_board("motion-card")
    looking = BleSearch(ble_session)
    looking.start()
    qtbot.waitUntil(lambda: len(looking.boards) == 1)
    lab.remove_board(card)
    looking.stop()
    looking.start()
    qtbot.waitUntil(lambda: not looking.boards)
    looking.stop()


def test_the_window_says_that_the_link_is_lost_and_back(
    lab: BleLab, ble_session: Session, settings_store: SettingsStore, shown: Callable[[Any], Any], qtbot: QtBot
) -> None:
    card = lab.add_board("motion-card")
    window = shown(MainWindow(ble_session, settings_store))
    ble_session.connect_to(Source("ble", card.address))
    labels = window.status_line.labels
    qtbot.waitUntil(lambda: "battery 87 %" in labels["battery"].text())
    assert "signal" in labels["signal"].text()
    lab.set_battery(card, 15)
    qtbot.waitUntil(lambda: "battery low 15 %" in labels["battery"].text())
    lab.leave_range(card)
    qtbot.waitUntil(lambda: "The link to CONTROL.CMR was lost" in window.bar.verdict.sentence())
    lab.enter_range(card)
    qtbot.waitUntil(lambda: window.banner.text() == "CONTROL.CMR is back.")
    lab.leave_range(card)
    qtbot.waitUntil(lambda: window.banner.text() == "")
    told = [text for _, _, text in ble_session.link_log()]
    assert told[0] == "CONTROL.CMR is open"
    assert told[1].startswith("The link to CONTROL.CMR was lost")
