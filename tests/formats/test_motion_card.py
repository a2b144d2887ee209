"""The motion card's own message, against the one that was captured and published."""

from __future__ import annotations

import math

import numpy as np
import pytest

from imugui.formats import FAMILIES, FORMATS, Options
from imugui.samples import GRAVITY, SAMPLE, Rows, empty_rows

CAPTURED = bytes.fromhex("03 5A FA AE 3F 0E 00 00 00 01 00 00 EB 47 00")
DEG = math.pi / 180


def captured_row(options: Options | None = None) -> Rows:
    return FORMATS["motion-card"].decoder(options or Options()).feed(CAPTURED, 3.0)[0]


def test_the_captured_message_decodes_to_what_was_measured() -> None:
    row = captured_row()
    assert (row["acc"] / GRAVITY).round(3).tolist() == [0.052, -0.083, 0.985]
    assert (row["gyr"] / DEG).round(3).tolist() == [0.0, 0.061, 0.0]
    assert round(float(row["temp_c"]), 2) == 20.93
    assert row["status"] == 0
    assert np.isnan(row["mag"]).all()
    assert np.isnan(row["lat"])


def test_the_captured_message_encodes_to_itself() -> None:
    rows = np.array([captured_row()], SAMPLE)
    assert FORMATS["motion-card"].encoder().encode(rows) == CAPTURED


def test_the_status_byte_is_the_button() -> None:
    decoder = FORMATS["motion-card"].decoder(Options())
    heard = [int(decoder.feed(CAPTURED[:-1] + bytes([status]), 0.0)["status"][0]) for status in (0, 1, 2, 255)]
    assert heard == [0, 1, 2, 255]


@pytest.mark.parametrize(("asked", "sent"), [(-1, 0), (0, 0), (2, 2), (255, 255), (300, 255)])
def test_a_status_fits_its_byte(asked: int, sent: int) -> None:
    rows = empty_rows(SAMPLE, 1)
    rows["status"], rows["acc"] = asked, (0.0, 0.0, GRAVITY)
    rows["gyr"], rows["temp_c"] = 0.0, 25.0
    assert FORMATS["motion-card"].encoder().encode(rows)[-1] == sent


def test_the_scales_are_those_of_the_family() -> None:
    usual, other = captured_row(), captured_row(Options(family="mpu9250"))
    assert other["temp_c"] == pytest.approx(-5305 / FAMILIES["mpu9250"].temp_per_c + 21.0)
    assert other["acc"].tolist() == usual["acc"].tolist()
    decoder = FORMATS["motion-card"].decoder(Options())
    assert decoder.seen == "raw counts, 16384 per g, 16.4 per deg/s"


def test_a_message_of_another_length_is_bad_and_quoted() -> None:
    decoder = FORMATS["motion-card"].decoder(Options())
    assert len(decoder.feed(CAPTURED[:14], 1.0)) == 0
    assert decoder.counts.bad_messages == 1
    assert decoder.log.entries() == [(1.0, "bad", "14 bytes instead of 15: 03 5a fa ae 3f 0e 00 00 00 01 00 00 eb 47")]
