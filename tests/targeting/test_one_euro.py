"""The 1-euro filter against its authors' vector, and what it is for."""

from __future__ import annotations

from math import hypot, pi, sin

import pytest

from imugui.targeting.one_euro import OneEuro
from imugui.targeting.settings import Control

# reference notes, E.3: matches groundTruth.csv of casiez/OneEuroFilter to 1e-7
RATE_HZ = 120.0
RAW = (-0.0385099, -0.0280664, 0.048622, 0.111498, 0.053026)
FILTERED = (-0.0385099, -0.0379872, -0.0334426, -0.0252696, -0.0207099)


def test_the_authors_vector() -> None:
    one_euro = OneEuro(min_cutoff_hz=1.0, beta=0.1, derivative_cutoff_hz=1.0)
    seen = [one_euro.update((x, 0.0), 1.0 / RATE_HZ) for x in RAW]
    assert [a for a, _ in seen] == pytest.approx(FILTERED, abs=1e-7)
    assert {b for _, b in seen} == {0.0}


def test_the_second_number_is_filtered_alike() -> None:
    one_euro = OneEuro(min_cutoff_hz=1.0, beta=0.1)
    seen = [one_euro.update((0.0, x), 1.0 / RATE_HZ)[1] for x in RAW]
    assert seen == pytest.approx(FILTERED, abs=1e-7)


def test_a_straight_movement_stays_straight() -> None:
    one_euro, alone = OneEuro(beta=0.5), OneEuro(beta=0.5)
    for x in RAW:
        length, _ = alone.update((x, 0.0), 0.01)
        assert one_euro.update((0.6 * x, -0.8 * x), 0.01) == pytest.approx((0.6 * length, -0.8 * length), abs=1e-15)


def test_a_hand_at_rest_stays_exactly() -> None:
    one_euro = OneEuro(beta=0.02)
    one_euro.reset((0.1, -7.3))
    assert {one_euro.update((0.1, -7.3), dt) for dt in (0.01, 0.003, 0.2, 0.0)} == {(0.1, -7.3)}


def test_reset_forgets_value_and_speed() -> None:
    used, fresh = OneEuro(beta=1.0), OneEuro(beta=1.0)
    for x in RAW:
        used.update((1000.0 * x, 5.0), 0.01)
    for one_euro in (used, fresh):
        one_euro.reset((0.0, 0.0))
    assert [used.update((x, x), 0.01) for x in RAW] == [fresh.update((x, x), 0.01) for x in RAW]


def test_without_time_nothing_changes() -> None:
    one_euro = OneEuro()
    one_euro.reset((1.0, 2.0))
    assert one_euro.update((50.0, 50.0), 0.0) == (1.0, 2.0)
    assert one_euro.update((1.0, 2.0), 0.01) == (1.0, 2.0)  # the speed was not touched either


def test_tremor_is_damped_at_rest_and_a_fast_hand_is_followed() -> None:
    control = Control()
    one_euro = OneEuro(control.min_cutoff_hz, control.beta, control.derivative_cutoff_hz)
    tremor = [one_euro.update((0.1 * sin(2 * pi * 10 * k / 100), 0.0), 0.01)[0] for k in range(400)]
    assert max(tremor[200:]) < 0.1 * 10 ** (-12 / 20)  # 12 dB at 10 Hz

    def behind(speed: float) -> float:
        """Seconds by which a steady movement (deg/s) is late."""
        fresh = OneEuro(control.min_cutoff_hz, control.beta, control.derivative_cutoff_hz)
        late = [speed * k / 100 - hypot(*fresh.update((speed * k / 100, 0.0), 0.01)) for k in range(300)]
        return late[-1] / speed

    assert behind(200.0) < behind(2.0) / 3
