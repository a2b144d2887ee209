"""The pacer: as many samples as the clock says, over any length, and no flood after a stall."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from imugui.simulation.pacing import Pacer

STEPS = st.lists(st.floats(0.0, 0.4), min_size=1, max_size=60)


@given(st.floats(25.0, 1000.0), STEPS)
def test_without_stalls_all_samples_are_sent_and_none_early(rate_hz: float, steps: list[float]) -> None:
    pacer, t, sent = Pacer(rate_hz, start_t=100.0), 100.0, 0
    for step in steps:
        t += step
        sent += pacer.due(t)
        assert abs(sent - 1 - (t - 100.0) * rate_hz) <= 1.001
        assert 0.0 <= pacer.wait_s(t) <= 1 / rate_hz + 1e-6
    assert pacer.skipped == 0


@given(st.floats(25.0, 1000.0), st.floats(0.6, 1000.0))
def test_a_stall_is_made_up_for_half_a_second_at_most(rate_hz: float, stall_s: float) -> None:
    pacer = Pacer(rate_hz, start_t=0.0)
    assert pacer.due(0.0) == 1
    sent = pacer.due(stall_s)
    assert sent == int(0.5 * rate_hz)
    assert sent + pacer.skipped == pytest.approx(stall_s * rate_hz, abs=1)
    assert pacer.due(stall_s) == 0
    assert pacer.due(stall_s + 1.001 / rate_hz) in (1, 2)


def test_it_does_not_drift_in_a_day() -> None:
    pacer = Pacer(138.6, start_t=0.0)
    sent = sum(pacer.due(k * 0.25) for k in range(86_400 * 4 // 24))
    assert sent == int(138.6 * (3600 - 0.25)) + 1


def test_a_clock_that_goes_back_sends_nothing() -> None:
    pacer = Pacer(100.0, start_t=10.0)
    assert pacer.due(10.1) == 11
    assert pacer.due(10.0) == 0
    assert pacer.due(9.0) == 0
    assert pacer.due(10.11) == 1


def test_an_impossible_rate_is_refused() -> None:
    with pytest.raises(ValueError, match="above 0 Hz"):
        Pacer(0.0, 0.0)
