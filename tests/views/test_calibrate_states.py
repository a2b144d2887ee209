"""A gyroscope whose scale was learnt, in the overview's words."""

from __future__ import annotations

from dataclasses import replace
from datetime import UTC, datetime, timedelta

from imugui.calibration.learnt import METHOD
from imugui.calibration.parts import GyroscopePart
from imugui.calibration.profile import Profile
from imugui.views.calibrate_states import part_states

NOW = datetime(2026, 5, 1, 12, 0, tzinfo=UTC)
PART = GyroscopePart(
    "at rest",
    (NOW - timedelta(days=2)).isoformat(),
    quality="good",
    sigma=(1e-4, 1e-4, 1e-4),
    matrix_method=METHOD,
    matrix_sigma=0.0034,
    matrix_date=(NOW - timedelta(days=1)).isoformat(),
)


def test_it_says_how_well_the_scale_is_known() -> None:
    state = part_states(Profile(gyroscope=PART), NOW)["gyr"]
    assert state.good == "Drifts by at most 0.7° a minute; scale learnt in motion, to 0.3 %"
    assert state.word == "Good"


def test_a_scale_that_is_old_makes_the_part_old_whatever_the_bias() -> None:
    old = replace(PART, matrix_date=(NOW - timedelta(days=370)).isoformat())
    assert part_states(Profile(gyroscope=old), NOW)["gyr"].word == "Old"
