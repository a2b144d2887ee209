"""The chain from attitude to place: fresh at each engaging, its stages in order."""

from __future__ import annotations

from dataclasses import replace
from math import radians

import pytest

from imugui.fusion.scalar import Quat, turned_in_sensor
from imugui.targeting.engagement import NO_STAGES, Engagement
from imugui.targeting.one_euro import OneEuro
from imugui.targeting.settings import PRESETS, Control
from imugui.targeting.view_pose import Pair

LEVEL: Quat = (1.0, 0.0, 0.0, 0.0)
PLAIN = replace(PRESETS["position"], smoothing=False, gain_ramp_s=0.0)


def right(angle_deg: float) -> Quat:
    return turned_in_sensor(LEVEL, 0.0, 0.0, -radians(angle_deg))


def run(control: Control, angles_deg: list[float], t: float = 7.0, dt: float = 0.01) -> list[Pair]:
    """The places for these angles to the right, one per row."""
    engagement = Engagement(control, "pan", t, LEVEL, (10.0, -20.0))
    places = []
    for angle in angles_deg:
        t += dt
        engagement.look(right(angle))
        places.append(engagement.step(t, dt))
    return places


def test_it_begins_with_nothing() -> None:
    engagement = Engagement(PLAIN, "pan", 7.0, LEVEL, (10.0, -20.0))
    assert engagement.turn == (0.0, 0.0, 0.0)
    assert engagement.stages == NO_STAGES


def test_a_twitch_in_the_first_row_is_smoothed_from_rest() -> None:
    control = replace(PLAIN, smoothing=True)
    one_euro = OneEuro(control.min_cutoff_hz, control.beta, control.derivative_cutoff_hz)
    one_euro.reset((0.0, 0.0))
    expected, _ = one_euro.update((4.0, 0.0), 0.01)
    assert 0.0 < expected < 0.5
    assert run(control, [4.0])[0] == pytest.approx((10.0 + 8.0 * expected, -20.0))


@pytest.mark.parametrize("ramp_s", [0.0, 0.15])
def test_dead_time_shows_the_same_later(ramp_s: float) -> None:
    """A hand that moves from the first row on; the ramp waits for it too."""
    control = replace(PLAIN, gain_ramp_s=ramp_s)
    angles = [0.5 * k for k in range(1, 41)]
    late = run(replace(control, dead_time_s=0.1), angles)
    assert late[:9] == [(10.0, -20.0)] * 9
    for place, earlier in zip(late[10:], run(control, angles)[:-10], strict=True):
        assert place == pytest.approx(earlier)


def test_the_stages_can_be_looked_at() -> None:
    engagement = Engagement(replace(PRESETS["position"], dead_time_s=0.02), "pan", 0.0, LEVEL, (0.0, 0.0))
    for k in range(1, 30):
        engagement.look(right(float(k)))
        engagement.step(0.01 * k, 0.01)
    steer, smooth, delayed = (stage[0] for stage in engagement.stages)
    assert steer == pytest.approx(29.0)
    assert steer > smooth > delayed > 0.0
