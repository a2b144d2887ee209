"""Names of columns: what they mean, in which unit."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from imugui.formats.columns import MAP_NAMES, SLOTS, read_name, table_from
from imugui.formats.families import ALIGNED
from imugui.samples import GRAVITY


@pytest.mark.parametrize(
    ("name", "slot", "factor"),
    [
        ("ax", "ax", 1.0),
        ("ax_mps2", "ax", 1.0),
        ("AccY", "ay", 1.0),
        ("Acceleration z (m/s^2)", "az", 1.0),
        ("accel_x (m/s²)", "ax", 1.0),
        ("ax_mg", "ax", GRAVITY / 1000),
        ("ax_g/16384", "ax", GRAVITY / 16384),
        ("ax_g * 0.5", "ax", GRAVITY / 2),
        ("ax_g*-1", "ax", -GRAVITY),
        ("ax_g/-16384", "ax", -GRAVITY / 16384),
        ("gx_rads", "gx", 1.0),
        ("Gyroscope x (rad/s)", "gx", 1.0),
        ("gyro_z [mdps]", "gz", math.pi / 180_000),
        ("omega_y (deg/s)", "gy", math.pi / 180),
        ("mx_uT", "mx", 1.0),
        ("Magnetic field y (µT)", "my", 1.0),
        ("mag_z_mG", "mz", 0.1),
        ("mx (T)", "mx", 1e6),
        ("timestamp_us", "t", 1e-6),
        ("micros", "t", 1e-6),
        ("millis", "t", 1e-3),
        ("Time", "t", 1.0),
        ("temp_c", "temp_c", 1.0),
        ("Temperature (°C)", "temp_c", 1.0),
        ("speed (km/h)", "speed", 1 / 3.6),
        ("course_deg", "course_deg", 1.0),
        ("Longitude", "lon", 1.0),
    ],
)
def test_known_names(name: str, slot: str, factor: float) -> None:
    column = read_name(name)
    assert column is not None
    assert column.slot == slot
    assert column.factor == pytest.approx(factor)


@pytest.mark.parametrize(
    "name", ["", "-", "qw", "px", "Linear Acceleration x (m/s^2)", "heading", "roll", "n_samples", "x", "ts", "axg"]
)
def test_other_names_mean_nothing(name: str) -> None:
    assert read_name(name) is None


@pytest.mark.parametrize("name", ["ax (counts)", "gx (rpm)", "status (x)", "temp (F)"])
def test_unknown_units_are_told(name: str) -> None:
    column = read_name(name)
    assert column is not None
    assert column.factor is None


@given(st.text(max_size=40))
def test_no_name_raises(name: str) -> None:
    column = read_name(name)
    assert column is None or column.slot in SLOTS


def test_the_parts_of_an_acceleration_are_known_to_column_maps_only() -> None:
    assert read_name("gravx_g") is None
    column = read_name("gravx_g", MAP_NAMES)
    assert column is not None
    assert (column.slot, column.factor) == ("gravx", GRAVITY)


@pytest.mark.parametrize(
    ("names", "force", "sums"),
    [
        (("ax", "ay", "az"), "total", ()),
        (("linx", "liny", "linz"), "linear", ()),
        (("gravx", "gravy", "gravz"), "gravity", ()),
        (("linx", "liny", "linz", "gravx", "gravy", "gravz"), "total", ((0, 3), (1, 4), (2, 5))),
        (("linx", "liny", "linz", "ax", "ay", "az"), "total", ()),
        (("mx", "my", "mz"), "", ()),
    ],
)
def test_what_the_acceleration_of_a_partial_table_is(
    names: tuple[str, ...], force: str, sums: tuple[tuple[int, int], ...]
) -> None:
    table = table_from(names, b",", ALIGNED, partial=True)
    assert (table.problem, table.force, table.sums) == ("", force, sums)


def test_a_table_says_what_is_missing() -> None:
    assert table_from(("ax", "ay", "az"), b",", ALIGNED).problem == "no column for gx, gy, gz"
    assert table_from(("ax", "ay", "az", "gx", "gy", "gz"), b",", ALIGNED).problem == ""
