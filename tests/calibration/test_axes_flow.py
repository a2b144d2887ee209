"""The guided search for the axes, and the calibration in the axes that were found."""

from __future__ import annotations

import numpy as np
import pytest

from imugui.calibration.axes import MAPS
from imugui.calibration.axes_flow import AxesFlow, MappedMagnetometerFlow
from imugui.samples import Rows
from imugui.simulation.board import VirtualBoard
from imugui.simulation.errors import PRESETS

BLOCK = 50


def turned_rows(name: str, seconds: float = 40.0) -> Rows:
    """A board turned to all sides whose magnetometer sits in other axes: Q @ (what it sends) is right."""
    rows = VirtualBoard("free", 100.0, PRESETS["mpu9250"], seed=4).rows(round(100 * seconds))
    rows["mag"] = rows["mag"] @ MAPS[name]  # the inverse of Q, row by row
    return rows


def feed(flow: AxesFlow | MappedMagnetometerFlow, rows: Rows) -> None:
    for start in range(0, len(rows), BLOCK):
        flow.feed(rows[start : start + BLOCK])


@pytest.mark.parametrize("name", ["+x +y +z", "+y +x -z"])
def test_the_axes_are_found(name: str) -> None:
    flow = AxesFlow()
    assert flow.progress == 0.0
    feed(flow, turned_rows(name))
    found = flow.result()
    assert flow.done
    assert found.accepted
    assert found.axes.name == name
    assert found.axes.margin > 2.5
    assert flow.missing == ()


def test_a_board_at_rest_has_no_axes() -> None:
    flow = AxesFlow()
    feed(flow, VirtualBoard("rest", 100.0, PRESETS["mpu9250"], seed=4).rows(1500))
    assert not flow.done
    assert not flow.result().accepted
    assert flow.missing != ()
    assert flow.progress < 0.9


def test_the_field_is_calibrated_in_the_axes_found() -> None:
    rows = turned_rows("+y +x -z", 60.0)
    mapped, plain = MappedMagnetometerFlow("+y +x -z"), MappedMagnetometerFlow()
    feed(mapped, rows)
    feed(plain, rows)
    _, spread = mapped.measured_dip()
    _, wrong = plain.measured_dip()
    assert mapped.verdict.accepted
    assert spread < 3.0 < wrong
    assert np.isfinite(mapped.verdict.heading_deg)
