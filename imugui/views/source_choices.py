"""What the list of sources holds: choices under headings, from ports, motions, files and Bluetooth boards."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from imugui.simulation import MOTION_TITLES
from imugui.views import ble_words
from imugui.views.ble_search import BleSearch
from imugui.workers.session import Port

if TYPE_CHECKING:
    from imugui.workers.session import Sighting


@dataclass(frozen=True)
class Choice:
    """An entry of the list. An empty address means: ask the user for it."""

    transport: str
    address: str
    text: str  # in the list
    tip: str = ""
    short: str = ""  # in the closed box, where that differs
    bars: int = -1  # of a wireless signal; -1: it has none
    action: str = ""  # what picking it does to the list, instead of being chosen
    name: str = ""  # of a Bluetooth board

    @property
    def key(self) -> tuple[str, str]:
        """What tells two choices apart."""
        return self.transport, self.address


@dataclass(frozen=True)
class Note:
    """A line of the list that cannot be chosen."""

    text: str
    tone: str = "neutral"


TYPE_ADDRESS = Choice("serial", "", "Type a port address…", "A port by name, or any address that pyserial opens")
OPEN_FILE = Choice("replay", "", "Open a recording…", "A capture of a board's bytes, or a CSV file with samples")
SEARCH_TIP = "Look for Bluetooth boards in reach while the list is open"
SEARCH = Choice("ble", "", "Search for Bluetooth boards…", SEARCH_TIP, action="search")
BLUETOOTH = "BLUETOOTH"

Sections = list[tuple[str, list[Choice]]]


def port_choice(port: Port) -> Choice:
    """A serial port with what is known of the board behind it."""
    about = port.hint or port.description
    return Choice("serial", port.device, f"{port.device}  ({about})" if about else port.device, port.description)


def _motion_choice(name: str, title: str) -> Choice:
    return Choice("simulator", name, title, "A virtual board in this computer", f"Simulated: {title.lower()}")


def bare_choice(transport: str, address: str, name: str = "") -> Choice:
    """A choice the lists do not hold: a typed address, a port that is gone, a file, a board out of reach."""
    if transport == "replay":
        name = Path(address).name
        return Choice(transport, address, name, address, f"Recording: {name}")
    if transport == "ble":
        text = f"{name}  ({address})" if name and name != address else address
        return Choice(transport, address, text, f"Bluetooth board {address}", name or address, name=name)
    return Choice(transport, address, address, address)


def board_choice(board: Sighting) -> Choice:
    """A Bluetooth board in reach."""
    name = board.name or ble_words.NO_NAME
    text = f"{name}  ({ble_words.board_words(board)})"
    bars, _ = ble_words.signal(board.rssi_dbm)
    return Choice("ble", board.address, text, f"{name}, {board.address}", board.name or board.address, bars, "", name)


def sections(ports: list[Port], extra: list[Choice]) -> Sections:
    """The list without Bluetooth: simulated motions, serial ports, recordings; ``extra`` joins those of its kind."""
    known = {port.device for port in ports}
    typed = [one for one in extra if one.transport == "serial" and one.address not in known]
    files = [one for one in extra if one.transport == "replay"]
    return [
        ("SIMULATED BOARD", [_motion_choice(name, title) for name, title in MOTION_TITLES.items()]),
        ("SERIAL PORT", [*map(port_choice, ports), *typed, TYPE_ADDRESS]),
        ("RECORDING", [*files, OPEN_FILE]),
    ]


def bluetooth(search: BleSearch, extra: list[Choice], show_all: bool) -> list[Choice | Note]:
    """The Bluetooth boards in reach and those that are remembered; what the search says; what can be asked of it."""
    boards = ble_words.in_order(search.boards)
    listed = [board for board in boards if board.family or show_all]
    seen = {board.address for board in listed}
    entries: list[Choice | Note] = [board_choice(board) for board in listed]
    entries += [one for one in extra if one.transport == "ble" and one.address not in seen]
    if search.problem:
        entries.append(Note(search.problem, "warn"))
    elif search.running:
        entries.append(Note(ble_words.SEARCHING if not listed else "Searching…"))
    words = ble_words.show_all_words(len(boards) - len(listed), show_all)
    if words:
        entries.append(Choice("ble", "", words, "Devices that imugui does not know, too", action="show_all"))
    return entries if search.running else [*entries, SEARCH]


def names_of(search: BleSearch | None) -> Mapping[str, str]:
    """Names of the boards that were seen, by address."""
    return {board.address: board.name for board in search.boards} if search else {}
