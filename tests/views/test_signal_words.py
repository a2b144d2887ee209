"""The numbers of the Signals page as text."""

from __future__ import annotations

import math

import numpy as np
import pytest

from imugui.signals.channels import QUANTITIES, UNITS
from imugui.signals.cursors import Cursors, Reading
from imugui.signals.spectrum import welch
from imugui.signals.statistics import NOTHING, Summary
from imugui.views import signal_words as words
from imugui.workers.session import State

ACC = QUANTITIES["acc"].channels[0]
YAW = QUANTITIES["euler"].channels[0]
DEG, MPS2 = UNITS["angle"][0], UNITS["acceleration"][0]


@pytest.mark.parametrize(
    ("value", "decimals", "text"),
    [
        (9.80665, 3, "9.807"),
        (-9.80665, 4, "−9.8066"),
        (0.0, 2, "0.00"),
        (-0.0001, 2, "0.00"),
        (123.456, 4, "123.46"),
        (-1234567.8, 3, "−1234568"),
        (math.nan, 2, "---"),
        (math.inf, 2, "---"),
    ],
)
def test_numbers(value: float, decimals: int, text: str) -> None:
    assert words.number(value, decimals) == text


@pytest.mark.parametrize(
    ("value", "text"),
    [(1234.5, "1234"), (0.0123456, "0.0123"), (0.5, "0.500"), (2.5e-7, "2.50e−7"), (0.0, "---"), (math.nan, "---")],
)
def test_significant_digits(value: float, text: str) -> None:
    assert words.significant(value) == text


def test_the_newest_value_is_folded_and_in_its_unit() -> None:
    assert words.now_cells(math.radians(370.0), YAW, DEG) == ("10.00",)
    assert words.now_cells(9.80665, ACC, UNITS["acceleration"][1]) == ("1.0000",)


def test_statistics() -> None:
    assert words.statistics_cells(Summary(9, 1.0, 0.5, 2.0, 1.25), MPS2) == ("1.0000", "0.5000", "2.0000", "1.2500")
    assert words.statistics_cells(NOTHING, MPS2) == ("---",) * 4
    assert words.statistics_line(10.04, 2000, 200.04, 0) == "10.0 s, 2,000 samples, 200.0 Hz, no gaps"
    assert words.statistics_line(1.0, 10, math.nan, 1).endswith("--- Hz, 1 gap")
    assert words.statistics_line(1.0, 10, 9.0, 3).endswith("3 gaps")


def test_cursors() -> None:
    turned = Reading(math.radians(350.0), math.radians(370.0), math.radians(20.0), math.radians(40.0))
    assert words.cursor_cells(turned, YAW, DEG) == ("−10.00", "10.00", "20.00", "40.00")
    cursors = Cursors()
    assert words.cursors_line(cursors) == ""
    cursors.times = [3.0, 2.5]
    assert words.cursors_line(cursors) == "B − A is −0.500 s (2.00 Hz)"
    cursors.times = [3.0, 3.0]
    assert words.cursors_line(cursors) == "B − A is 0.000 s"


def test_spectrum() -> None:
    found = welch([np.sin(2 * np.pi * 25.0 * np.arange(2000) / 100.0)], 100.0)
    frequency, rms, noise = words.spectrum_cells(found, MPS2)
    assert (frequency, rms) == ("25.00", "0.707")
    assert noise == "---" or "e−" in noise
    assert words.spectrum_cells(None, MPS2) == ("---",) * 3
    assert words.spectrum_line(None) == words.TOO_SHORT
    assert "segments averaged" in words.spectrum_line(found)


@pytest.mark.parametrize(
    ("state", "still", "stale", "replayed", "expected"),
    [
        (State.STREAMING, "", "", False, ("good", "Live")),
        (State.STREAMING, "", "", True, ("good", "Playing")),
        (State.STREAMING, "", "No data for 2 s", False, ("warn", "No data for 2 s")),
        (State.STALLED, "Paused", "Stalled", False, ("neutral", "Paused")),
        (State.IDLE, "", "", False, ("neutral", "Not connected")),
    ],
)
def test_nothing_old_is_called_live(
    state: State, still: str, stale: str, replayed: bool, expected: tuple[str, str]
) -> None:
    assert words.liveness(state, still, stale, replayed) == expected


def test_every_mode_has_its_columns() -> None:
    nothing = Reading(*(math.nan,) * 4)
    made = {
        "now": words.now_cells(1.0, ACC, MPS2),
        "statistics": words.statistics_cells(NOTHING, MPS2),
        "cursors": words.cursor_cells(nothing, ACC, MPS2),
        "spectrum": words.spectrum_cells(None, MPS2),
    }
    assert {name: len(mode.heads) for name, mode in words.MODES.items()} == {
        name: len(cells) for name, cells in made.items()
    }
