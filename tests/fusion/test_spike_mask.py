"""A press of the button: what is masked, what is fed, and that nothing depends on blocks or gets lost on the way."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from imugui.fusion import FILTERS
from imugui.fusion.attitude import from_euler
from imugui.fusion.pipeline import Pipeline
from imugui.fusion.quaternion import angle_between
from imugui.fusion.spike_mask import SpikeMask
from imugui.samples import NO_STATUS, Rows

PRESS = slice(300, 303)  # at 100 Hz the sample of the change and two more
SPIKE = (30.0, -20.0, 5.0)  # m/s2


def swinging(t: Any) -> Any:
    return from_euler(0.4 + 0.8 * np.sin(t), 0.3 * np.sin(0.7 * t), 0.5 * np.sin(1.3 * t))


@pytest.fixture
def pressed(ideal_rows: Any) -> tuple[Rows, Rows, Any]:
    """Rows of a board whose button is pressed at 3 s: (undisturbed, with the spike, true attitudes)."""
    calm, truth = ideal_rows(np.arange(600) / 100.0, motion=swinging)
    calm["status"] = np.arange(600) >= PRESS.start
    shaken = calm.copy()
    shaken["acc"][PRESS] += SPIKE
    return calm, shaken, truth


def masked(status: list[int], period_s: float = 0.01) -> list[bool]:
    t = 5.0 + period_s * np.arange(len(status))
    return SpikeMask().step(t, np.array(status, np.int16), np.zeros((len(status), 3)))[0].tolist()


def test_the_change_and_20_ms_after_it_are_masked() -> None:
    assert masked([0, 0, 1, 1, 1, 1, 1]) == [False, False, True, True, True, False, False]
    assert masked([0, 1, 0, 1, 1, 1, 1]) == [False, True, True, True, True, True, False]
    assert sum(masked([0] * 50 + [2] * 50, 0.001)) == 21


def test_a_status_that_is_new_or_not_sent_is_no_press() -> None:
    assert not any(masked([NO_STATUS, NO_STATUS, 1, 1]))
    assert not any(masked([1, NO_STATUS, NO_STATUS, 1]))
    assert masked([1, NO_STATUS, 2, 2]) == [False, False, True, True]


def test_nothing_is_masked_across_a_gap() -> None:
    t, status = np.array([0.0, 0.01, 9.0, 9.01]), np.array([0, 0, 1, 1], np.int16)
    assert not SpikeMask().step(t, status, np.zeros((4, 3)))[0].any()


@given(st.lists(st.sampled_from([NO_STATUS, 0, 1, 2]), min_size=1, max_size=40), st.data())
def test_blocks_and_saved_states_change_nothing(status: list[int], data: st.DataObject) -> None:
    t, acc = np.arange(len(status)) * 0.008, np.arange(3.0 * len(status)).reshape(-1, 3)
    values = np.array(status, np.int16)
    cut = data.draw(st.integers(0, len(status)))
    whole = SpikeMask().step(t, values, acc)
    first, second = SpikeMask(), SpikeMask()
    before = first.step(t[:cut], values[:cut], acc[:cut])
    second.restore(json.loads(json.dumps(first.state())))
    after = second.step(t[cut:], values[cut:], acc[cut:])
    for expected, *parts in zip(whole, before, after, strict=True):
        np.testing.assert_array_equal(expected, np.concatenate(parts))


@pytest.mark.parametrize("name", FILTERS)
def test_a_spike_leaves_the_attitude_alone(pressed: tuple[Rows, Rows, Any], name: str) -> None:
    calm, shaken, truth = pressed
    off, on = Pipeline(name).step(shaken), Pipeline(name, spike_mask=True).step(shaken)
    undisturbed = Pipeline(name).step(calm)
    after = slice(PRESS.start, PRESS.stop + 100)
    worst_off, worst_on, usual = (
        np.degrees(angle_between(out["quat"], truth)[after]).max() for out in (off, on, undisturbed)
    )
    assert worst_on < usual + 0.05
    assert worst_off > worst_on
    np.testing.assert_array_equal(on["rest"], undisturbed["rest"])


@pytest.mark.parametrize("name", FILTERS)
def test_the_gyroscope_alone_turns_the_attitude_meanwhile(pressed: tuple[Rows, Rows, Any], name: str) -> None:
    """What the accelerometer and magnetometer say of masked samples changes nothing at all."""
    calm, shaken, _ = pressed
    shaken["mag"][PRESS] += 15.0
    outs = [Pipeline(name, spike_mask=True).step(rows) for rows in (calm, shaken)]
    np.testing.assert_array_equal(outs[0]["quat"][: PRESS.stop], outs[1]["quat"][: PRESS.stop])
    quats = outs[0]["quat"]
    turned = angle_between(quats[PRESS.start - 1], quats[PRESS.stop - 1])
    assert turned == pytest.approx(np.linalg.norm(calm["gyr"][PRESS].sum(axis=0)) / 100.0, rel=0.05)


def test_it_shows_what_it_did(pressed: tuple[Rows, Rows, Any]) -> None:
    _, shaken, _ = pressed
    out = Pipeline(spike_mask=True).step(shaken)
    assert np.flatnonzero(out["masked"]).tolist() == list(range(PRESS.start, PRESS.stop))
    np.testing.assert_array_equal(out["acc"][PRESS], np.repeat(out["acc"][PRESS.start - 1][None], 3, axis=0))
    assert not out["mag_used"][PRESS].any()
    plain = Pipeline().step(shaken)
    assert not plain["masked"].any()
    np.testing.assert_array_equal(plain["acc"], shaken["acc"])


@pytest.mark.parametrize("name", FILTERS)
def test_a_state_saved_within_a_press_continues_bit_for_bit(pressed: tuple[Rows, Rows, Any], name: str) -> None:
    _, shaken, _ = pressed
    whole = Pipeline(name, spike_mask=True)
    whole.step(shaken[: PRESS.start + 1])
    resumed = Pipeline.from_state(json.loads(json.dumps(whole.state())))
    expected, got = whole.step(shaken[PRESS.start + 1 :]), resumed.step(shaken[PRESS.start + 1 :])
    for field in ("quat", "acc", "masked", "mag_used", "bias", "rest"):
        np.testing.assert_array_equal(expected[field], got[field], field)
    assert resumed.settings()["spike_mask"] is True


def test_a_state_without_a_mask_has_none() -> None:
    state = Pipeline().state()
    del state["mask"], state["settings"]["spike_mask"]
    assert not Pipeline.from_state(state).spike_mask


def test_a_sample_that_is_not_fed_does_not_hide_a_press(pressed: tuple[Rows, Rows, Any]) -> None:
    _, shaken, _ = pressed
    shaken["gyr"][PRESS.start] = np.nan
    out = Pipeline(spike_mask=True).step(shaken)
    assert np.flatnonzero(out["masked"]).tolist() == [301, 302, 303]
