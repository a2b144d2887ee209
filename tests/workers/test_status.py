"""What the status says of the magnetometer."""

from __future__ import annotations

import math

import pytest

from imugui.samples import ATTITUDE, Rows, empty_rows
from imugui.workers.status import mag_trust


def fused(norm: float, disturbed: bool) -> Rows:
    rows = empty_rows(ATTITUDE, 50)
    rows["mag"] = [norm, 0.0, 0.0]
    rows["disturbed"] = disturbed
    return rows


@pytest.mark.parametrize(
    ("rows", "use_mag", "word"),
    [
        (empty_rows(ATTITUDE, 0), True, "none"),
        (fused(math.nan, False), True, "none"),
        (fused(48.0, False), False, "off"),
        (fused(48.0, False), True, "uncalibrated"),
        (fused(750.0, True), True, "disturbed"),
    ],
)
def test_without_a_profile_a_quiet_field_is_not_yet_a_good_one(rows: Rows, use_mag: bool, word: str) -> None:
    assert mag_trust(rows, use_mag, calibrated=False)[0] == word


def test_with_a_profile_it_is() -> None:
    assert mag_trust(fused(48.0, False), True, calibrated=True) == ("good", 48.0)
