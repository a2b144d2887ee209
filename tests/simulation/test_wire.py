"""The wire: what the board says is what a decoder hears, and faults damage only what they should."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from imugui.formats import FORMATS
from imugui.formats.base import Options
from imugui.samples import Rows
from imugui.simulation.board import VirtualBoard
from imugui.simulation.errors import PRESETS
from imugui.simulation.wire import Faults, Wire, real_board


def heard(form: str, messages: list[bytes]) -> tuple[Rows, int]:
    """The rows that the format's decoder makes of them, and how many messages it called bad."""
    decoder = FORMATS[form].decoder(Options())
    rows = np.concatenate([*(decoder.feed(message, 1.0) for message in messages), decoder.flush(2.0)])
    return rows, decoder.counts.bad_messages


@pytest.mark.parametrize("form", FORMATS)
def test_every_format_carries_every_sample_of_a_real_board(form: str) -> None:
    wire = real_board(form, "driving", PRESETS["ideal"], seed=3)
    true = VirtualBoard("driving", FORMATS[form].rate_hz, seed=3).rows(600)
    rows, bad = heard(form, wire.messages(600))
    assert len(rows) == 600
    assert bad == 0
    assert np.abs(rows["acc"] - true["acc"]).max() < 0.05  # 0.01 g of quantisation
    assert np.abs(rows["gyr"] - true["gyr"]).max() < 2e-3


def test_the_screw_assistants_board_holds_its_magnetometer_for_17_or_18_messages() -> None:
    rows, _ = heard("accel-lines", real_board("accel-lines", "free").messages(2000))
    new = np.flatnonzero((rows["mag"][1:] != rows["mag"][:-1]).any(axis=1))
    assert set(np.diff(new).tolist()) == {17, 18}


def test_the_car_sends_its_place_ten_times_a_second() -> None:
    rows, _ = heard("triplets", real_board("triplets", "driving").messages(round(FORMATS["triplets"].rate_hz * 5)))
    assert np.count_nonzero(~np.isnan(rows["lat"])) == pytest.approx(50, abs=1)


@pytest.mark.parametrize("form", FORMATS)
def test_the_preamble_comes_first_once_and_again_after_a_reset(form: str) -> None:
    preamble = FORMATS[form].encoder().preamble()
    wire = real_board(form, "rest")
    first, second = wire.take(3), wire.take(3)
    assert first.startswith(preamble)
    assert len(first) > len(preamble)
    if preamble:
        assert not second.startswith(preamble)
    wire.restart()
    assert wire.take(3).startswith(preamble)


@settings(max_examples=20, deadline=None)
@given(st.sampled_from(list(FORMATS)), st.lists(st.integers(0, 40), max_size=6), st.booleans())
def test_the_bytes_do_not_depend_on_how_many_samples_are_taken(form: str, cuts: list[int], faulty: bool) -> None:
    faults = Faults(cut_percent=10.0, flip_percent=10.0) if faulty else Faults()
    whole, pieces = (real_board(form, "turns", seed=5, faults=faults) for _ in range(2))
    assert whole.take(sum(cuts) + 1) == b"".join(pieces.take(n) for n in [*cuts, 1])


@pytest.mark.parametrize("form", FORMATS)
def test_cut_and_altered_lines_are_counted_and_the_others_arrive(form: str) -> None:
    wire = real_board(form, "turns", seed=1, faults=Faults(cut_percent=3.0, flip_percent=3.0))
    rows, bad = heard(form, wire.messages(1000))
    assert wire.spoiled > 20
    assert 0 < bad <= 2 * wire.spoiled
    # a cut line spoils the next one too; four lines make a message of accel-lines
    assert 1000 - 2 * wire.spoiled <= len(rows) < 1000


def test_faults_come_as_often_as_asked_and_the_same_for_the_same_seed() -> None:
    one, again, other = (
        real_board("triplets", "rest", seed=seed, faults=Faults(flip_percent=20.0)) for seed in (1, 1, 2)
    )
    chunk = one.take(3000)
    assert chunk == again.take(3000)
    assert chunk != other.take(3000)
    assert one.spoiled == pytest.approx(600, rel=0.15)


def test_a_pause_is_silent_for_its_time_and_what_was_said_is_lost() -> None:
    board = VirtualBoard("rest", 100.0)
    wire = Wire(board, FORMATS["triplets"], Faults(pause_every_s=2.0, pause_s=0.5))
    sizes = np.array([len(wire.take(10)) for _ in range(60)])
    assert (np.flatnonzero(sizes == 0) == [15, 16, 17, 18, 19, 35, 36, 37, 38, 39, 55, 56, 57, 58, 59]).all()
    assert board.count == 600


def test_an_unknown_format_is_refused_in_words() -> None:
    with pytest.raises(ValueError, match=r"unknown format 'morse'; there are accel-lines, triplets"):
        real_board("morse", "rest")
