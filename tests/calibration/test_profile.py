"""Profiles: what they make of raw samples, and how far they say they may be trusted."""

from __future__ import annotations

import dataclasses
import math
from datetime import UTC, datetime

import numpy as np
import pytest

from imugui.calibration.accelerometer import AccelerometerResult
from imugui.calibration.build import accelerometer_part, gyroscope_part
from imugui.calibration.compare import compare
from imugui.calibration.parts import (
    PARTS,
    AccelerometerPart,
    GyroscopePart,
    MagnetometerPart,
    MountingPart,
    Part,
    TemperaturePart,
)
from imugui.calibration.profile import Board, Profile
from imugui.calibration.rest import RestResult
from imugui.fusion.correction import Correction

DATE = "2026-11-01T12:00:00+00:00"
NOW = datetime(2026, 11, 20, tzinfo=UTC)
GYR = GyroscopePart("at rest", DATE, 25.0, 500, bias=(0.01, -0.02, 0.03), sigma=(1e-4, 1e-4, 1e-4))
ACC = AccelerometerPart("many", DATE, 25.0, 3000, tilt_deg=0.03, bias=(0.1, 0.2, 0.3), residual_mg=0.1)
MAG = MagnetometerPart("tukey", DATE, hard_iron=(10.0, -5.0, 30.0), field_ut=48.0, dip_deg=60.0, predicted_deg=0.5)
TEMPERATURE = TemperaturePart(
    "linear", DATE, 25.0, coefficients=((0.01, 0, 0), (0.001, 0, 0)), reference_c=25.0, low_c=15.0, high_c=35.0
)
FULL = Profile(Board("serial", "ABC123", "probe 1"), GYR, ACC, MAG)


def test_an_empty_profile_changes_nothing() -> None:
    assert Profile().correction() == Correction()
    assert math.isnan(Profile().heading_error_deg)
    assert math.isnan(Profile().tilt_error_deg)
    assert Profile().good_until is None
    assert Profile().warnings(NOW) == []


def test_the_correction_holds_every_part() -> None:
    half = math.sqrt(0.5)
    profile = FULL.with_part(MountingPart("level, nose up", DATE, quat=(half, 0.0, 0.0, half)))
    found = profile.correction()
    assert found.gyr_bias == GYR.bias
    assert found.acc_bias == ACC.bias
    assert found.mag_bias == MAG.hard_iron
    assert found.mounting == (half, 0.0, 0.0, half)


def test_the_bias_follows_the_temperature_from_where_it_was_measured() -> None:
    profile = FULL.with_part(TEMPERATURE)
    assert profile.correction().gyr_bias == GYR.bias
    assert profile.correction(25.0).gyr_bias == pytest.approx(GYR.bias)
    assert profile.correction(30.0).gyr_bias == pytest.approx([0.015, -0.02, 0.03])
    assert profile.correction(99.0).gyr_bias == pytest.approx([0.02, -0.02, 0.03])  # clamped at 35
    assert Profile(temperature=TEMPERATURE).correction(30.0).gyr_bias == pytest.approx([0.015, 0, 0])


def test_errors_are_told_in_degrees() -> None:
    assert FULL.tilt_error_deg == pytest.approx(0.03)
    assert FULL.heading_error_deg == pytest.approx(math.hypot(math.sqrt(0.5), 0.03 * math.sqrt(3)), rel=1e-6)
    uneven = dataclasses.replace(MAG, residual_percent=1.0)
    assert FULL.with_part(uneven).heading_error_deg > 1.3
    blind = dataclasses.replace(FULL, accelerometer=None)
    assert blind.heading_error_deg > 3.0  # an unknown tilt is not taken for none


def test_it_ages() -> None:
    assert FULL.good_until == datetime(2026, 12, 1, 12, tzinfo=UTC)
    assert FULL.warnings(NOW, 25.0) == []
    old = FULL.warnings(datetime(2027, 1, 1, tzinfo=UTC), 25.0)
    assert len(old) == 2
    assert "magnetometer" in old[1]
    assert "60 days" in old[1]
    assert "in the future" in FULL.warnings(datetime(2025, 1, 1, tzinfo=UTC))[0]


def test_a_far_temperature_is_said_unless_there_is_a_model() -> None:
    assert [text.split()[1] for text in FULL.warnings(NOW, 37.0)] == ["gyroscope"]
    assert FULL.with_part(TEMPERATURE).warnings(NOW, 37.0) == []
    assert len(FULL.warnings(NOW, 60.0)) == 2


@pytest.mark.parametrize(
    "address", ["/dev/ttyUSB0", "../../etc/passwd", "C:\\x:y*?", "ff:00:aa", "é" * 500, "", "nul\0byte", "-", "."]
)
def test_every_address_gives_a_safe_file_name(address: str) -> None:
    name = Board("serial", address).file_name
    assert len(name) <= 60
    assert set(name) <= set("abcdefghijklmnopqrstuvwxyz0123456789-.")
    assert name[0].isalnum()
    assert name.endswith(".json")
    assert name.count(".") == 1


def test_file_names_differ_for_boards_and_not_for_names() -> None:
    assert Board("serial", "a/b").file_name != Board("serial", "a-b").file_name
    assert Board("serial", "a", "x").file_name == Board("serial", "a", "y").file_name


@pytest.mark.parametrize(
    ("kind", "values"),
    [
        (GyroscopePart, {"bias": (0.0, 0.0, math.inf)}),
        (GyroscopePart, {"bias": (9.0, 0.0, 0.0)}),
        (GyroscopePart, {"bias": (0.0, 0.0)}),
        (GyroscopePart, {"samples": -1}),
        (GyroscopePart, {"samples": 1.5}),
        (GyroscopePart, {"quality": "superb"}),
        (GyroscopePart, {"date": "yesterday"}),
        (GyroscopePart, {"verdict": "x" * 5000}),
        (AccelerometerPart, {"matrix": ((0.0,) * 3,) * 3}),
        (AccelerometerPart, {"matrix": ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, math.nan))}),
        (AccelerometerPart, {"positions": ((1.0, 0.0, 0.0),) * 501}),
        (MagnetometerPart, {"soft_iron": ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 0.01))}),
        (MagnetometerPart, {"soft_iron": ((-1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))}),
        (MagnetometerPart, {"cells": (100,)}),
        (MagnetometerPart, {"coverage": True}),
        (MountingPart, {"quat": (0.5, 0.0, 0.0, 0.0)}),
        (TemperaturePart, {"coefficients": ()}),
        (TemperaturePart, {"coefficients": ((0.0,) * 3,) * 4}),
    ],
)
def test_implausible_parts_cannot_be_made(kind: type[Part], values: dict[str, object]) -> None:
    good: dict[str, object] = {"date": DATE, "coefficients": ((0.0, 0.0, 0.0),)}
    names = {item.name for item in dataclasses.fields(kind)}
    given = {key: value for key, value in good.items() if key in names}
    kind(**given)
    with pytest.raises(ValueError, match=rf"^{next(iter(values))}: "):
        kind(**{**given, **values})


def test_refused_results_become_no_part() -> None:
    with pytest.raises(ValueError, match="refused: moved"):
        gyroscope_part(RestResult(False, "moved"))
    with pytest.raises(ValueError, match="refused: few"):
        accelerometer_part(AccelerometerResult(False, "few"))


def test_a_comparison_says_what_changed_in_numbers_and_words() -> None:
    assert compare(FULL, FULL) == []
    later = dataclasses.replace(MAG, hard_iron=(14.0, -5.0, 27.0), date="2026-11-11T12:00:00+00:00", predicted_deg=1.5)
    moved = dataclasses.replace(GYR, bias=tuple(np.add(GYR.bias, (0.0, 0.0, math.radians(0.1)))))
    lines = {line.label: line for line in compare(FULL, dataclasses.replace(FULL, magnetometer=later, gyroscope=moved))}
    assert lines["Magnetometer"].change == "10 days later"
    assert lines["Hard iron"].change.startswith("moved by 5.0 µT: directions change by up to 6.0 deg")
    assert lines["Gyroscope bias"].change == "moved by 0.100 deg/s"
    assert lines["Expected heading error"].change == "worse"
    alone = {line.label: line.change for line in compare(FULL, Profile(gyroscope=GYR))}
    assert alone == {"Accelerometer": "only in the first", "Magnetometer": "only in the first"}


def test_every_part_has_its_place() -> None:
    assert set(PARTS) <= {item.name for item in dataclasses.fields(Profile)}
