"""What makes a row useless."""

from __future__ import annotations

from math import inf, nan

import pytest

from imugui.targeting.settings import Control
from imugui.targeting.validity import Validity

LEVEL, STILL = (1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0)


def running(period: float = 0.01, rows: int = 20) -> Validity:
    """After so many good rows; the last at ``rows * period``."""
    validity = Validity(Control())
    for k in range(rows + 1):
        validity.look(k * period, LEVEL, STILL)
    return validity


def test_dt_is_measured() -> None:
    validity = Validity(Control())
    seen = []
    for t in (5.0, 5.01, 5.04, 5.04, 5.125):
        assert validity.look(t, LEVEL, STILL) == ""
        seen.append(validity.dt)
    assert seen == pytest.approx([0.0, 0.01, 0.03, 0.0, 0.085])


@pytest.mark.parametrize(
    ("row", "words"),
    [
        ((nan, LEVEL, STILL), "a time that is not a number"),
        ((inf, LEVEL, STILL), "a time that is not a number"),
        ((0.1, LEVEL, STILL), "time went back"),
        ((0.31, LEVEL, STILL), "no sample for 100 ms"),
        ((0.21, (nan, 0.0, 0.0, 0.0), STILL), "an attitude that is not a number"),
        ((0.21, (1.0, inf, 0.0, 0.0), STILL), "an attitude that is not a number"),
        ((0.21, (1.011, 0.0, 0.0, 0.0), STILL), "a quaternion that is not of unit length"),
        ((0.21, (0.0, 0.0, 0.0, 0.0), STILL), "a quaternion that is not of unit length"),
        ((0.21, LEVEL, (0.0, -34.9, 0.0)), "the gyroscope is saturated"),
        ((0.21, LEVEL, (0.0, 0.0, inf)), "the gyroscope is saturated"),
    ],
)
def test_useless_rows(row: tuple[float, tuple[float, ...], tuple[float, ...]], words: str) -> None:
    assert running().look(*row) == words


@pytest.mark.parametrize(
    "row",
    [
        (0.2, LEVEL, STILL),
        (0.299, LEVEL, STILL),
        (0.21, (-0.991, 0.0, 0.0, 0.0), STILL),
        (0.21, LEVEL, (nan, nan, nan)),
        (0.21, LEVEL, (0.0, 34.0, 0.0)),
    ],
    ids=["same time", "late", "nearly unit", "no gyroscope", "fast"],
)
def test_good_rows(row: tuple[float, tuple[float, ...], tuple[float, ...]]) -> None:
    assert running().look(*row) == ""


def test_a_slow_board_may_be_slow() -> None:
    """T2: max(100 ms, 5 periods). A 9.6 Hz board is late only once, while its period is not known."""
    validity = Validity(Control())
    reasons = [validity.look(0.104 * k, LEVEL, STILL) for k in range(12)]
    assert [k for k, reason in enumerate(reasons) if reason] == [1]
    assert validity.limit_s == pytest.approx(0.52)
    assert validity.look(11 * 0.104 + 0.53, LEVEL, STILL) == "no sample for 520 ms"


def test_a_gap_does_not_make_the_next_one_longer() -> None:
    validity = running()
    for t in (0.9, 0.91, 0.92, 1.7):
        validity.look(t, LEVEL, STILL)
    assert validity.limit_s == 0.1


def test_a_clock_that_began_again_is_followed() -> None:
    validity = running()
    assert validity.look(0.05, LEVEL, STILL) == "time went back"
    assert validity.look(0.06, LEVEL, STILL) == ""
    assert validity.dt == pytest.approx(0.01)


def test_after_a_broken_time_the_last_good_one_counts() -> None:
    validity = running()
    validity.look(nan, LEVEL, STILL)
    assert validity.look(0.21, LEVEL, STILL) == ""
    assert validity.dt == pytest.approx(0.01)
