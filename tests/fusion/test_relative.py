"""The attitude of a tool in a reference's frame: exact on a known motion, whatever the clocks and the blocks."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from imugui.fusion.quaternion import angle_between, conjugate, from_rotation_vector, multiply, slerp
from imugui.fusion.relative import BRIDGE_S, KEEP_S, HostTime, Relative, align, bracket, relative_quat
from imugui.samples import ATTITUDE, Rows, empty_rows

AXIS = np.array([0.48, -0.6, 0.64])
RATE = 1.5  # rad/s
MOUNTED = from_rotation_vector([0.3, -0.2, 0.5])
ANGLES = st.floats(-3.0, 3.0)
VECTORS = st.tuples(ANGLES, ANGLES, ANGLES)


def body(t: np.ndarray) -> np.ndarray:
    """A rigid body that turns steadily about one axis: slerp between samples is exact."""
    return from_rotation_vector(RATE * np.asarray(t)[:, None] * AXIS)


def rows_of(host: np.ndarray, clock: float = 1.0, offset: float = 0.0, mounted=(1.0, 0.0, 0.0, 0.0)) -> Rows:
    """Attitudes sampled at host times, by a clock that runs so fast and began elsewhere; each arrives at once."""
    rows = empty_rows(ATTITUDE, len(host))
    rows["t"], rows["t_arrival"] = offset + clock * host, host
    rows["quat"] = rows["local"] = multiply(body(host), mounted)
    rows["gyr"] = RATE * AXIS
    return rows


def times(rate_hz: float, seconds: float = 4.0, start: float = 100.0) -> np.ndarray:
    return start + np.arange(int(seconds * rate_hz)) / rate_hz


@given(p=VECTORS, q=VECTORS, share=st.floats(0.0, 1.0))
def test_slerp_goes_the_shortest_way_at_a_steady_pace(p, q, share: float) -> None:
    p, q = from_rotation_vector(p), from_rotation_vector(q)
    part = slerp(p, q, share)
    assert np.linalg.norm(part) == pytest.approx(1.0, abs=1e-12)
    assert float(angle_between(p, part)) == pytest.approx(share * float(angle_between(p, q)), abs=1e-9)
    assert float(angle_between(slerp(p, -q, share), part)) < 1e-7 or float(angle_between(p, q)) > np.pi - 1e-6


@given(p=VECTORS, q=VECTORS, turn=VECTORS, v=VECTORS)
def test_the_relative_attitude_does_not_see_how_the_earth_is_turned(p, q, turn, v) -> None:
    p, q, turn = (from_rotation_vector(x) for x in (p, q, turn))
    seen = relative_quat(p, q)
    assert float(angle_between(relative_quat(multiply(turn, p), multiply(turn, q)), seen)) < 1e-7
    assert float(angle_between(multiply(q, seen), p)) < 1e-7


@given(at=VECTORS, tool=st.floats(-3.1, 3.1), reference=st.floats(-3.1, 3.1), later=VECTORS)
def test_two_headings_are_aligned_for_every_later_attitude(at, tool: float, reference: float, later) -> None:
    own, others = (from_rotation_vector([0.0, 0.0, angle]) for angle in (tool, reference))
    pose, then = from_rotation_vector(at), from_rotation_vector(later)
    found = align(multiply(own, pose), multiply(others, pose), same_north=False)
    assert found.residual < 1e-6
    after = relative_quat(multiply(own, then), multiply(others, then), found.heading)
    assert float(angle_between(after, (1.0, 0.0, 0.0, 0.0))) < 1e-6


def test_with_a_common_north_the_heading_is_left_alone() -> None:
    turned = from_rotation_vector([0.0, 0.0, 0.4])
    found = align(turned, (1.0, 0.0, 0.0, 0.0), same_north=True)
    assert found.heading == (1.0, 0.0, 0.0, 0.0)
    assert found.residual == pytest.approx(0.4)
    assert align(turned, (1.0, 0.0, 0.0, 0.0), same_north=False).residual == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize(("clock", "offset"), [(1.0, 0.0), (1.03, -50.0), (0.97, 1e4)])
def test_a_rigid_body_stays_where_it_is_whatever_the_clocks(clock: float, offset: float) -> None:
    relative = Relative()
    tool = rows_of(times(100.0), mounted=MOUNTED)
    out = relative.step(tool, rows_of(times(77.0, 4.1), clock, offset))
    assert len(out) == len(tool)
    assert relative.dropped == 0
    assert np.degrees(angle_between(out["quat"], MOUNTED)).max() < 1e-4
    assert out["t"].tolist() == tool["t"].tolist()
    assert np.abs(out["gyr"] - (RATE * AXIS - multiply_vector(MOUNTED))).max() < 1e-6


def multiply_vector(mounted: np.ndarray) -> np.ndarray:
    """The body's rate in the axes of a board mounted so."""
    vector = np.concatenate(([0.0], RATE * AXIS))
    return multiply(multiply(conjugate(mounted), vector), mounted)[1:]


@settings(max_examples=40, deadline=None)
@given(st.lists(st.tuples(st.booleans(), st.integers(1, 60)), min_size=1, max_size=30))
def test_the_result_does_not_depend_on_the_blocks(cuts: list[tuple[bool, int]]) -> None:
    tool, reference = rows_of(times(100.0, 1.5), mounted=MOUNTED), rows_of(times(60.0, 1.6), 1.03)
    whole = Relative().step(tool, reference)
    relative, parts, at = Relative(), [], [0, 0]
    for of_tool, n in [*cuts, (True, len(tool)), (False, len(reference))]:
        first = list(at)
        at[0 if of_tool else 1] += n
        parts.append(relative.step(tool[first[0] : at[0]], reference[first[1] : at[1]]))
    assert np.concatenate(parts).tobytes() == whole.tobytes()


def test_nothing_is_extrapolated_a_silent_reference_gives_nothing() -> None:
    relative, host = Relative(), times(100.0)
    reference = rows_of(host[:100])
    assert len(relative.step(rows_of(host[:150]), reference)) == 99
    quiet = relative.step(rows_of(host[150:]), reference[:0])
    assert quiet["t"].tolist() == host[99:100].tolist()
    assert relative.dropped > 0  # those that have waited for KEEP_S
    late = relative.step(rows_of(host[:0]), rows_of(host[150:]))
    assert late["t"][0] >= host[-1] - KEEP_S - 0.011
    assert relative.dropped + 100 + len(late) == len(host) - 1


def test_a_gap_of_the_reference_is_not_bridged() -> None:
    host = times(100.0)
    gap = (host > 101.0) & (host < 101.0 + 2.0 * BRIDGE_S)
    relative = Relative()
    tool = rows_of(host + 0.003)
    out = relative.step(tool, rows_of(host[~gap]))
    assert relative.dropped == gap.sum() + 1
    assert not ((out["t"] > 101.0) & (out["t"] < host[gap][-1] + 0.01)).any()
    assert len(out) == len(tool) - relative.dropped - 1


def test_between_two_times() -> None:
    after, share, known = bracket(np.array([0.0, 0.1, 0.1, 0.5]), np.array([-0.1, 0.0, 0.025, 0.1, 0.3, 0.5, 0.6]))
    assert known.tolist() == [False, True, True, True, False, False, False]
    assert after[:4].tolist() == [1, 1, 1, 1]
    assert share[1:4] == pytest.approx([0.0, 0.25, 1.0])


def test_flags_sigmas_and_arrival_are_those_of_both() -> None:
    host = times(100.0, 1.0)
    tool, reference = rows_of(host), rows_of(host)
    tool["rest"], reference["rest"] = True, host > 100.5
    reference["disturbed"], tool["sigma_tilt"], reference["sigma_tilt"] = host < 100.2, 0.03, 0.04
    tool["sigma_heading"] = 0.1
    tool["t_arrival"] += 0.004
    out = Relative().step(tool, reference)
    assert not out["rest"][:50].any()
    assert out["rest"][60:].all()
    assert out["disturbed"][:19].all()
    assert not out["disturbed"][25:].any()
    assert out["sigma_tilt"] == pytest.approx(0.05)
    assert np.isnan(out["sigma_heading"]).all()
    assert (out["t_arrival"] <= tool["t_arrival"][: len(out)]).all()


def test_rows_without_an_attitude_are_left_out() -> None:
    host = times(100.0, 1.0)
    reference = rows_of(host)
    reference["quat"][30:33] = np.nan
    out = Relative().step(rows_of(host), reference)
    assert len(out) == len(host) - 1
    assert np.isfinite(out["quat"]).all()
    assert np.degrees(angle_between(out["quat"], (1.0, 0.0, 0.0, 0.0))).max() < 1e-4


def test_jittered_arrivals_are_smoothed_and_a_clock_that_begins_anew_is_followed() -> None:
    host = times(100.0, 20.0)
    jitter = np.random.default_rng(1).uniform(0.0, 0.02, len(host))
    rows = rows_of(host, 1.03)
    rows["t_arrival"] = host + jitter
    settled = HostTime().convert(rows)[300:] - host[300:] - jitter.mean()
    assert np.abs(settled).max() < 0.003
    again = rows_of(host[:50] + 20.0)
    again["t"] -= 119.0  # the board was reset
    line = HostTime()
    line.convert(rows_of(host))
    assert np.abs(line.convert(again) - again["t_arrival"]).max() < 1e-6
