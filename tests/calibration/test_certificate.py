"""The certificate says what is known and what is not, and trusts no text from outside."""

from __future__ import annotations

import re
from dataclasses import replace
from datetime import UTC, datetime
from xml.etree import ElementTree

import pytest

from imugui.calibration.certificate import NOTE, certificate_html, certificate_rows
from imugui.calibration.coverage_picture import coverage_svg, place
from imugui.calibration.learnt import METHOD
from imugui.calibration.parts import AccelerometerPart, GyroscopePart, MagnetometerPart, NoisePart
from imugui.calibration.profile import Board, Profile

DATE = "2026-11-01T12:00:00+00:00"
NOW = datetime(2026, 11, 20, tzinfo=UTC)
EVIL = "<script>alert('x')</script>&\"'"
FULL = Profile(
    Board("serial", "ABC", "probe 1"),
    GyroscopePart("at rest", DATE, 25.0, 500, "good", bias=(0.01, -0.02, 0.03), sigma=(1e-4, 1e-4, 1e-4)),
    AccelerometerPart("many", DATE, 25.0, 3000, positions=((0.0, 0.0, 1.0), (1.0, 0.0, 0.0)), tilt_deg=0.03),
    MagnetometerPart(
        "tukey", DATE, field_ut=48.0, dip_deg=60.0, predicted_deg=0.5, coverage=0.03, gap_deg=20.0, cells=(0, 50, 99)
    ),
    noise=NoisePart("Allan deviation", DATE, rate_hz=99.3, gyr_white=(0.0127, 0.0091, 0.0095)),
    rate_hz=99.3,
)


def parsed(page: str) -> ElementTree.Element:
    """The elements of a page; fails when a tag is left open."""
    text = page.replace("<!DOCTYPE html>", "").replace('<meta charset="utf-8">', "")
    return ElementTree.fromstring(text)  # noqa: S314  (made by ourselves a line before)


def values(profile: Profile, now: datetime = NOW) -> dict[str, str]:
    return {f"{row.section}/{row.label}": row.value for row in certificate_rows(profile, now)}


def test_it_tells_errors_in_degrees_and_until_when() -> None:
    found = values(FULL)
    assert found["Trust/Expected tilt error"] == "0.03 deg"
    assert found["Trust/Expected heading error"] == "0.7 deg"
    assert found["Trust/Good until"] == "2026-12-01"
    assert found["Gyroscope/Bias"] == "+0.573, -1.146, +1.719 deg/s"
    assert found["Gyroscope/Known to"] == "0.011 deg/s (2 sigma)"
    assert found["Magnetometer/Coverage"] == "3 % of all directions, largest gap 20 deg"
    assert found["Noise/Gyroscope N"] == "0.0127, 0.0091, 0.0095 deg/s/√Hz"
    assert found["Mounting/"] == "not calibrated"


def test_an_old_one_says_so() -> None:
    late = datetime(2027, 1, 1, tzinfo=UTC)
    assert values(FULL, late)["Trust/Good until"].endswith("(over)")
    assert "60 days old" in certificate_html(FULL, late)


def test_an_empty_profile_claims_nothing() -> None:
    found = values(Profile())
    assert found["Trust/Expected tilt error"] == "not known"
    assert found["Trust/Good until"] == "not known"
    assert "<svg" not in certificate_html(Profile(), NOW)


def test_the_page_is_whole_self_contained_and_carries_the_note() -> None:
    page = certificate_html(FULL, NOW)
    assert NOTE in page
    assert "medical device" in NOTE
    assert not re.search(r"https?://(?!www\.w3\.org/2000/svg)|<script|<link|<img|@import|url\(", page)
    parsed(page)


def test_every_row_is_on_the_page() -> None:
    page = certificate_html(FULL, NOW)
    for row in certificate_rows(FULL, NOW):
        assert row.value in page


@pytest.mark.parametrize(
    "profile",
    [
        Profile(Board("serial", "x", EVIL)),
        Profile(Board(EVIL, EVIL)),
        Profile(magnetometer=MagnetometerPart(EVIL, DATE, axes=EVIL, verdict=EVIL)),
        Profile(gyroscope=GyroscopePart(EVIL, DATE, matrix_method=EVIL)),
    ],
)
def test_outside_text_is_escaped(profile: Profile) -> None:
    page = certificate_html(profile, NOW)
    assert "<script" not in page
    assert "&lt;script&gt;" in page
    parsed(page)


def test_the_picture_has_a_dot_for_each_cell_and_a_square_for_each_position() -> None:
    picture = coverage_svg((0, 50, 99), ((0.0, 0.0, 1.0), (0.0, 0.0, -1.0)))
    root = parsed(picture)
    names = [one.tag.rpartition("}")[2] for one in root.iter()]
    assert names.count("circle") == 100 + 2
    assert names.count("rect") == 2
    assert picture.count('fill="#0072b2"') == 3
    assert "3 of 100 directions seen, 2 positions held" in picture


def test_the_halves_lie_side_by_side_and_nothing_falls_out() -> None:
    import numpy as np

    from imugui.calibration.coverage import fibonacci

    for way in fibonacci(300):
        x, y = place(way)
        assert 10 <= y <= 170
        assert (x < 170) == bool(way[2] >= 0)
    assert place(np.array([0.0, 0.0, 1.0]))[0] < place(np.array([0.0, 0.0, -1.0]))[0]


def test_a_scale_that_was_learnt_tells_how_when_and_how_well() -> None:
    part = GyroscopePart("at rest", DATE, 25.0, 500, "good", bias=(0.01, -0.02, 0.03))
    learnt = replace(
        part, matrix_method=METHOD, matrix_sigma=0.0034, matrix_date="2026-11-10T08:30:00+00:00", matrix_temp_c=27.0
    )
    found = values(replace(FULL, gyroscope=learnt, delays_ms=(5.9, 1.3)))
    assert found["Gyroscope/Method"] == "at rest, 500 samples"
    assert found["Gyroscope/Scale and cross-axis"].startswith("learnt in motion by the imugui filter, scale +0.00")
    assert found["Gyroscope/Scale known to"] == "0.34 % (1 sigma of the worst known element)"
    assert found["Gyroscope/Scale calibrated"] == "2026-11-10 08:30 UTC, at 27.0 °C"
    assert found["Board/Delays"] == "gyroscope 5.9 ms, magnetometer 1.3 ms later (set by hand)"
    assert "Gyroscope/Error of a turn" not in found
    guided = values(replace(FULL, gyroscope=replace(part, matrix_method="turns", turn_error_deg=0.4)))
    assert guided["Gyroscope/Error of a turn"] == "0.40 deg"
    assert "Gyroscope/Scale known to" not in guided
    assert "Board/Delays" not in guided
