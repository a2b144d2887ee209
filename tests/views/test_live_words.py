"""What the Live page decides before it shows anything."""

from __future__ import annotations

import math

import numpy as np
import pytest

from imugui.fusion.attitude import CONVENTIONS, euler, from_euler
from imugui.views.live_words import heading_reason, origin_words, quat_words, shown_quat, sigma_words, stale_word
from imugui.workers.session import State, Status


@pytest.mark.parametrize(
    ("state", "age_s", "word"),
    [
        (State.STREAMING, 0.01, ""),
        (State.STREAMING, 0.5, ""),
        (State.STREAMING, 0.6, "No data for 600 ms"),
        (State.STREAMING, math.nan, "Streaming"),
        (State.IDLE, 0.01, ""),
        (State.IDLE, 3.0, "Not connected"),
        (State.OPENING, math.nan, "Opening"),
        (State.STALLED, 0.01, "Stalled"),
        (State.LOST, 0.01, "Connection lost"),
        (State.IMPOSSIBLE, 0.01, "Impossible values"),
        (State.ENDED, 0.01, "Recording ended"),
    ],
)
def test_stale_word(state: State, age_s: float, word: str) -> None:
    assert stale_word(state, age_s) == word


@pytest.mark.parametrize("convention", CONVENTIONS)
def test_at_the_origin_all_angles_are_zero(convention: str) -> None:
    shown = shown_quat(np.array([1.0, 0.0, 0.0, 0.0]), convention, has_origin=True)
    np.testing.assert_allclose(euler(shown), 0.0, atol=1e-12)


@pytest.mark.parametrize(("convention", "signs"), [("ENU", (1, 1, 1)), ("NWU", (1, 1, 1)), ("NED", (-1, -1, 1))])
def test_angles_from_the_origin_keep_the_sense_of_the_convention(convention: str, signs: tuple[int, ...]) -> None:
    angles = np.radians((30.0, 20.0, 10.0))
    shown = shown_quat(from_euler(*angles), convention, has_origin=True)
    np.testing.assert_allclose(euler(shown), angles * signs, atol=1e-12)


def test_without_origin_yaw_counts_from_the_conventions_own_axis() -> None:
    east = np.array([1.0, 0.0, 0.0, 0.0])
    yaws = {name: float(np.degrees(euler(shown_quat(east, name, has_origin=False))[0])) for name in CONVENTIONS}
    assert {name: round(yaw) for name, yaw in yaws.items()} == {"ENU": 0, "NWU": -90, "NED": 90}


@pytest.mark.parametrize(
    ("trust", "reason"),
    [("good", ""), ("none", "no field"), ("off", "not used"), ("disturbed", "disturbed")],
)
def test_heading_reason(trust: str, reason: str) -> None:
    assert heading_reason(Status(mag_trust=trust)) == reason


@pytest.mark.parametrize(
    ("age_s", "words"),
    [
        (math.nan, "relative to the origin"),
        (0.4, "relative to the origin set 0 s ago"),
        (12.3, "relative to the origin set 12 s ago"),
        (130.0, "relative to the origin set 2 min ago"),
    ],
)
def test_origin_words(age_s: float, words: str) -> None:
    assert origin_words(age_s) == words


def test_quat_words() -> None:
    assert quat_words(np.array([0.5, -0.5, 0.0, 0.70712])) == "w +0.500  x −0.500  y +0.000  z +0.707"


@pytest.mark.parametrize(
    ("tilt_deg", "heading_deg", "words"),
    [
        (0.42, 1.26, "tilt ±0.4°  heading ±1.3°"),
        (0.42, 37.4, "tilt ±0.4°  heading ±37°"),
        (0.42, math.nan, "tilt ±0.4°"),
        (math.nan, math.nan, ""),
    ],
)
def test_the_filters_own_error_shows_no_digit_too_many(tilt_deg: float, heading_deg: float, words: str) -> None:
    assert sigma_words(math.radians(tilt_deg), math.radians(heading_deg)) == words
