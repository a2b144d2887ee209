"""Axis maps and the fine rotation on virtual boards with known axes."""

from __future__ import annotations

import numpy as np
import pytest

from imugui.calibration.alignment import fine_rotation
from imugui.calibration.axes import MAPS, PROPER, gyr_map, mag_map
from imugui.fusion.quaternion import from_rotation_vector, to_matrix
from imugui.samples import Rows
from imugui.simulation.board import VirtualBoard
from imugui.simulation.errors import PRESETS

ROTATION = to_matrix(from_rotation_vector(np.radians([3.0, -4.0, 2.0])))


@pytest.fixture(scope="module")
def rows() -> Rows:
    return VirtualBoard("free", 100.0, PRESETS["mpu9250-calibrated"], 4).rows(4000)


def test_there_are_24_proper_maps_of_48() -> None:
    assert len(MAPS) == 48
    assert len(PROPER) == 24
    np.testing.assert_allclose(MAPS["+y +x -z"] @ (1.0, 2.0, 3.0), (2.0, 1.0, -3.0))


@pytest.mark.parametrize("name", ["+x +y +z", "+y +x -z", "+x +z -y", "-z -x +y"])
def test_the_magnetometers_map_is_found(rows: Rows, name: str) -> None:
    """What arrives is the true field with the inverse map; the map found must undo it."""
    found = mag_map(rows["acc"], rows["mag"] @ PROPER[name])
    assert found.accepted, found.reason
    assert found.name == name
    assert found.margin >= 2.5
    assert len(found.scores) == 24
    if name == "+x +y +z":
        assert found.identity_deg == found.best_deg


@pytest.mark.parametrize("name", ["+x +y +z", "-x -y +z", "-x +y +z", "+y -z -x"])
@pytest.mark.parametrize("seen", ["mag", "acc"])
def test_the_gyroscopes_map_is_found_mirrored_or_not(rows: Rows, name: str, seen: str) -> None:
    found = gyr_map(rows["t"], rows["gyr"] @ MAPS[name], rows["t"], rows[seen])
    assert found.accepted, found.reason
    assert found.name == name
    assert found.margin >= 2.0
    assert len(found.scores) == 48


def test_too_little_data_is_said() -> None:
    still = VirtualBoard("rest", 100.0, PRESETS["mpu9250"], 1).rows(2000)
    map_of_mag = mag_map(still["acc"], still["mag"])
    map_of_gyr = gyr_map(still["t"], still["gyr"] * 0.01, still["t"], still["mag"])
    for found in (map_of_mag, map_of_gyr, mag_map(still["acc"][:20], still["mag"][:20])):
        assert not found.accepted
        assert found.reason.startswith("Not enough data")
        np.testing.assert_allclose(found.matrix, np.eye(3))


def test_an_unclear_map_is_refused(rows: Rows) -> None:
    noise = 40.0 * np.random.default_rng(0).normal(size=rows["mag"].shape)
    found = mag_map(rows["acc"], noise)
    assert not found.accepted
    assert "not clear" in found.reason


def test_the_fine_rotation_is_found(rows: Rows) -> None:
    turned = rows["mag"] @ ROTATION  # what comes is rotated back; Q must be ROTATION
    found = fine_rotation(rows["t"], rows["gyr"], rows["t"], turned, acc=rows["acc"])
    assert found.accepted, found.reason
    error = np.degrees(np.arccos((np.trace(found.matrix @ ROTATION.T) - 1) / 2))
    assert error < 0.7
    assert found.angle_deg == pytest.approx(5.4, abs=0.7)
    assert found.dip_spread_deg[1] < found.dip_spread_deg[0]


def test_it_starts_from_a_map(rows: Rows) -> None:
    start = PROPER["+y +x -z"]
    found = fine_rotation(rows["t"], rows["gyr"], rows["t"], rows["mag"] @ start, start)
    assert found.accepted
    assert found.angle_deg < 0.7
    wrong = fine_rotation(rows["t"], rows["gyr"], rows["t"], rows["mag"] @ start)
    assert not wrong.accepted
    np.testing.assert_allclose(wrong.matrix, np.eye(3))


def test_turning_about_one_axis_is_refused() -> None:
    t = np.arange(3000) / 100.0
    gyr = np.tile([0.0, 0.0, 1.0], (len(t), 1))
    mag = np.column_stack((20 * np.cos(-t), 20 * np.sin(-t), np.full(len(t), -43.0)))
    found = fine_rotation(t, gyr, t, mag)
    assert not found.accepted
    assert "all three axes" in found.reason


def test_a_rotation_that_spreads_the_dip_is_not_taken(rows: Rows) -> None:
    """The gyroscope's axes turned instead of the magnetometer's: the dip was right as it was."""
    found = fine_rotation(rows["t"], rows["gyr"] @ ROTATION.T, rows["t"], rows["mag"], acc=rows["acc"])
    assert not found.accepted
    assert "spread more" in found.reason
    np.testing.assert_allclose(found.matrix, np.eye(3))


def test_missing_values_are_passed_over(rows: Rows) -> None:
    holes = rows.copy()
    holes["gyr"][::50] = np.nan
    holes["mag"][::7] = np.nan
    holes["acc"][::9] = np.nan
    assert mag_map(holes["acc"], holes["mag"]).accepted
    assert gyr_map(holes["t"], holes["gyr"], holes["t"], holes["mag"]).accepted
    assert not fine_rotation(rows["t"][:1], rows["gyr"][:1], rows["t"], rows["mag"]).accepted
