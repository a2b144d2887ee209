"""The field's strength at the place, as the user knows it, speaks against a calibration that finds another."""

from __future__ import annotations

import pytest

from imugui.calibration.magnetometer import MagnetometerFlow
from imugui.simulation.board import EarthField, VirtualBoard
from imugui.simulation.errors import PRESETS


@pytest.mark.parametrize(("expected_ut", "accepted"), [(25.0, True), (60.0, False)])
def test_another_strength_than_expected_is_refused(expected_ut: float, accepted: bool) -> None:
    board = VirtualBoard("free", 50.0, PRESETS["mpu9250-calibrated"], 1, EarthField(25.0))
    flow = MagnetometerFlow()
    flow.expect(expected_ut)
    for _ in range(60):
        flow.feed(board.rows(50))
    assert flow.result().accepted is accepted
    assert flow.result().reason
