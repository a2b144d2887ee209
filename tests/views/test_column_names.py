"""Columns as the user names them, and as the csv-line format reads them."""

from __future__ import annotations

import numpy as np
import pytest

from imugui.formats import FORMATS, Options
from imugui.samples import GRAVITY
from imugui.views.column_names import MEANINGS, QUANTITIES, Meaning, bare_lines, cells, guess, meaning_of, width_of

SIX = ("ax", "ay", "az", "gx", "gy", "gz")


def test_named_columns_decode_to_si() -> None:
    meaning = Meaning(
        ("t", *SIX, ""), {"a": "g", "g": "dps", "m": "ut", "t": "ms"}, {"a": 16384, "g": 1, "m": 1, "t": 1}
    )
    assert meaning.problem() == ""
    decoder = FORMATS["csv-line"].decoder(Options(columns=meaning.names()))
    rows = decoder.feed(b"10,0,0,16384,90,0,0,77\n20,0,0,16384,90,0,0,77\n30,0,0,16384,90,0,0,77\n", 0.0)
    assert len(rows) >= 2
    np.testing.assert_allclose(rows["acc"][-1], (0, 0, GRAVITY), rtol=1e-9)
    np.testing.assert_allclose(rows["gyr"][-1], (np.pi / 2, 0, 0), rtol=1e-9)
    assert rows["t"][-1] == pytest.approx(0.03)


@pytest.mark.parametrize("quantity", QUANTITIES)
def test_every_unit_offered_is_understood(quantity: str) -> None:
    for unit in QUANTITIES[quantity].units:
        meaning = Meaning(("t", *SIX, "mx", "my", "mz"))
        meaning.units[quantity] = unit
        assert meaning.problem() == "", unit


def test_every_slot_offered_is_understood() -> None:
    slots = tuple(slot for slot in MEANINGS if slot)
    assert Meaning(slots).problem() == ""


@pytest.mark.parametrize(
    ("slots", "said"),
    [((), "ax"), (SIX[:5], "gz"), ((*SIX, "ax"), "Acceleration x is named twice"), (("", ""), "ax")],
)
def test_what_is_missing_is_said(slots: tuple[str, ...], said: str) -> None:
    assert said in Meaning(slots).problem()


def test_what_was_said_comes_back() -> None:
    said = Meaning(("", "t", *SIX, "temp_c"))
    said.units.update(a="mg", g="radps", t="us")
    said.counts.update(g=16.4)
    assert meaning_of(said.names(), len(said.slots)) == said


@pytest.mark.parametrize("width", range(1, 15))
def test_a_guess_has_the_width_asked_for(width: int) -> None:
    assert len(guess(width).slots) == width
    assert len(meaning_of(("ax_g",), width).slots) == width


@pytest.mark.parametrize(("width", "complete"), [(6, True), (7, True), (9, True), (10, True), (5, False)])
def test_a_guess_of_a_usual_width_can_be_used(width: int, complete: bool) -> None:
    assert (guess(width).problem() == "") is complete


def test_lines_are_found_behind_the_reason_in_the_log() -> None:
    texts = ["numbers without a header line: name the columns: 1.5,-2,3e-1", "GO", "malformed: 7;8", "  1\t2\t3"]
    assert bare_lines(texts) == ["1.5,-2,3e-1", "1\t2\t3"]


@pytest.mark.parametrize(
    ("line", "parts"),
    [("1, 2,3\r\n", ["1", "2", "3"]), ("1;2,5;3", ["1", "2,5", "3"]), ("1\t2", ["1", "2"]), (" 1  2 ", ["1", "2"])],
)
def test_cells(line: str, parts: list[str]) -> None:
    assert cells(line) == parts


def test_width_of_the_majority() -> None:
    assert width_of(["1,2,3", "1,2", "4,5,6"]) == 3
    assert width_of([]) == 0
