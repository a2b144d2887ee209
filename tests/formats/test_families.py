"""The delays of the boards that are known."""

from __future__ import annotations

import importlib

import pytest

from imugui.formats.families import FAMILIES, FIRMWARES, Delays, known_delays


@pytest.mark.parametrize("name", FIRMWARES)
def test_the_firmwares_have_the_families_of_their_formats(name: str) -> None:
    module = importlib.import_module(f"imugui.formats.{name.replace('-', '_')}")
    assert FIRMWARES[name][0] == module.FAMILY


def test_delays_by_the_low_pass_that_the_boards_own_firmware_sets() -> None:
    assert known_delays("accel-lines") == Delays(5.9, 1.0, "MPU-9250, low-pass of 41 Hz")
    assert known_delays("triplets") == Delays(33.5, 0.0, "MPU-9250, low-pass of 5 Hz")


def test_a_family_that_the_user_names_has_its_usual_low_pass() -> None:
    assert known_delays("csv-line", "mpu9250") == Delays(5.9, 1.0, "MPU-9250, low-pass of 41 Hz")
    assert known_delays("motion-card", "mpu9250") == known_delays("csv-line", "mpu9250")


@pytest.mark.parametrize(
    ("board_format", "family"),
    [("csv-line", ""), ("csv-line", "aligned"), ("motion-card", ""), ("accel-lines", "aligned"), ("", "nonsense")],
)
def test_where_nothing_is_known_nothing_is_claimed(board_format: str, family: str) -> None:
    assert known_delays(board_format, family) is None


def test_a_narrower_low_pass_is_later() -> None:
    for family in FAMILIES.values():
        by_width = [family.gyr_delay_ms[hz] for hz in sorted(family.gyr_delay_ms, reverse=True)]
        assert by_width == sorted(by_width)
