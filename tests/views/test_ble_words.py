"""Words of Bluetooth boards: signal and battery in the list and in the status line."""

from __future__ import annotations

import dataclasses
import math

import pytest

from imugui.views.ble_words import board_words, in_order, show_all_words, signal
from imugui.views.live_words import stale_word
from imugui.views.record_control import NOTHING_TO_RECORD
from imugui.views.status_words import PARTS, Phrase
from imugui.workers.ble_scan import Sighting
from imugui.workers.session import State, Status

CARD = Sighting("CONTROL.CMR", "AA", -62.0, (), math.nan, 1.0)
OTHER = Sighting("Headphones", "BB", -40.0, (), 55.0, 1.0)


@pytest.mark.parametrize(
    ("rssi_dbm", "bars", "word"),
    [
        (-30.0, 4, "strong"),
        (-60.0, 4, "strong"),
        (-60.5, 3, "good"),
        (-75.5, 2, "weak"),
        (-85.5, 1, "very weak"),
        (math.nan, 0, "signal not known"),
    ],
)
def test_signal(rssi_dbm: float, bars: int, word: str) -> None:
    assert signal(rssi_dbm) == (bars, word)


def test_boards() -> None:
    assert board_words(CARD) == "Motion card, signal good −62 dBm"
    assert board_words(OTHER) == "unknown kind, signal strong −40 dBm, battery 55 %"
    assert board_words(dataclasses.replace(CARD, rssi_dbm=math.nan)) == "Motion card, signal not known"
    assert in_order([OTHER, CARD]) == [CARD, OTHER]


def test_what_is_hidden_is_said() -> None:
    assert show_all_words(0, False) == ""
    assert show_all_words(1, False) == "Show all: 1 more device of unknown kind"
    assert show_all_words(7, False) == "Show all: 7 more devices of unknown kind"
    assert show_all_words(0, True) == "Show known boards only"


@pytest.mark.parametrize(
    ("name", "values", "phrase"),
    [
        ("signal", {}, Phrase("")),
        ("signal", {"rssi_dbm": -62.0}, Phrase("signal good −62 dBm")),
        ("signal", {"rssi_dbm": -90.0}, Phrase("signal very weak −90 dBm", "warn")),
        ("battery", {}, Phrase("")),
        ("battery", {"battery_percent": 87.0}, Phrase("battery 87 %")),
        ("battery", {"battery_percent": 20.0}, Phrase("battery low 20 %", "warn")),
        ("battery", {"battery_percent": 4.0}, Phrase("battery nearly empty 4 %", "bad")),
        ("gaps", {"overflow": 3}, Phrase("no gaps, 3 messages dropped", "bad")),
    ],
)
def test_status_line(name: str, values: dict[str, float], phrase: Phrase) -> None:
    assert PARTS[name].phrase(dataclasses.replace(Status(), **values)) == phrase


@pytest.mark.parametrize("state", [State.AWAY, State.TAKEN, State.NO_BLUETOOTH])
def test_a_board_that_cannot_be_reached_is_not_alive(state: State) -> None:
    assert stale_word(state, 0.01) == state.word
    assert state in NOTHING_TO_RECORD
