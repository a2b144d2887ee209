"""The running alarm on norm and dip."""

from __future__ import annotations

import numpy as np
import pytest

from imugui.calibration.alarm import WORDS, FieldAlarm
from imugui.fusion.pipeline import Pipeline
from imugui.simulation.board import VirtualBoard
from imugui.simulation.errors import Errors

FIELD = 48.0


def steady(
    seconds: float, factor: float = 1.0, start: float = 0.0, rate_hz: float = 50.0
) -> tuple[np.ndarray, np.ndarray]:
    t = start + np.arange(int(seconds * rate_hz)) / rate_hz
    noise = 1e-3 * np.random.default_rng(0).normal(size=(len(t), 3))
    return t, np.array([0.0, 20.3, -43.5]) * factor + noise


def test_it_begins_without_a_field() -> None:
    alarm = FieldAlarm(FIELD)
    assert alarm.light == "off"
    assert alarm.update(np.array([0.0]), np.full((1, 3), np.nan)) == "off"
    assert alarm.sentence == WORDS["off"]


@pytest.mark.parametrize(
    ("factor", "light"), [(1.0, "green"), (1.03, "green"), (0.95, "yellow"), (1.05, "yellow"), (1.07, "red")]
)
def test_the_limits_are_4_and_6_per_cent(factor: float, light: str) -> None:
    alarm = FieldAlarm(FIELD)
    assert alarm.update(*steady(2.0, factor)) == light
    assert alarm.sentence.startswith(WORDS[light])


def test_a_knock_does_not_turn_it_red() -> None:
    alarm = FieldAlarm(FIELD)
    t, mag = steady(3.0)
    mag[70:73] *= 1.5
    lights = {alarm.update(t[i : i + 1], mag[i : i + 1]) for i in range(len(t))}
    assert "red" not in lights


def test_red_comes_within_a_second_and_goes_when_the_field_is_back() -> None:
    alarm = FieldAlarm(FIELD)
    alarm.update(*steady(3.0))
    assert alarm.update(*steady(0.5, 1.08, 3.0)) != "red"
    assert alarm.update(*steady(0.5, 1.08, 3.5)) == "red"
    assert alarm.update(*steady(0.2, 1.0, 4.0)) == "red"
    assert alarm.update(*steady(2.0, 1.0, 4.2)) == "green"


def test_repeats_and_gaps_of_the_magnetometer_are_no_measurements() -> None:
    alarm = FieldAlarm(FIELD)
    alarm.update(*steady(2.0))
    t, mag = steady(2.0, 2.0, 2.0)
    mag[1:] = np.nan
    assert alarm.update(t, mag) == "green"


def test_a_stream_that_begins_again_is_judged_afresh() -> None:
    alarm = FieldAlarm(FIELD)
    alarm.update(*steady(2.0, 1.5, 100.0))
    assert alarm.light == "red"
    assert alarm.update(*steady(0.5, 1.0, 0.0)) == "green"


def test_the_dip_is_watched_too() -> None:
    """A magnet that leaves the strength as it is and bends the field."""
    t, mag = steady(2.0)
    quat = np.tile([1.0, 0.0, 0.0, 0.0], (len(t), 1))
    assert FieldAlarm(FIELD, 65.0).update(t, mag, quat) == "green"
    assert FieldAlarm(FIELD, 58.0).update(t, mag, quat) == "yellow"
    alarm = FieldAlarm(FIELD, 50.0)
    assert alarm.update(t, mag, quat) == "red"
    assert "dip 15° off" in alarm.sentence


def test_a_passing_magnet_on_the_virtual_board() -> None:
    errors = Errors(mag_noise_ut=0.3, magnet_ut=40.0, magnet_at_s=10.0, magnet_lasts_s=6.0)
    board, pipeline, alarm = VirtualBoard("free", 50.0, errors), Pipeline(), FieldAlarm(FIELD, 65.0)
    lights = [alarm.feed(pipeline.step(board.rows(25))) for _ in range(60)]  # half a second each
    assert "red" not in lights[4:20]
    assert "red" in lights[21:26]
    assert lights[-1] == "green"


def test_a_field_of_nothing_is_refused() -> None:
    with pytest.raises(ValueError, match="above 0"):
        FieldAlarm(0.0)
    with pytest.raises(ValueError, match="above 0"):
        FieldAlarm(float("nan"))
