"""The tool's axis from a spin by hand, on the virtual board: tremor, datasheet errors, and what must be refused."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from imugui.fusion.pipeline import Pipeline
from imugui.fusion.quaternion import Floats, from_rotation_vector, multiply, normalise, rotate, to_matrix
from imugui.guidance.aiming import axis_error
from imugui.guidance.tool_axis import BOX_AXES, SpinFlow, ToolAxis, spin_axis
from imugui.samples import ATTITUDE, Rows, empty_rows
from imugui.simulation.board import VirtualBoard
from imugui.simulation.curves import Wander, smooth_step
from imugui.simulation.errors import PRESETS, Errors
from imugui.simulation.path import Path

DEGREE = math.pi / 180
AXIS: Floats = np.array((12.0, 4.0, -3.0)) / 13.0  # a tool roughly along x in a clamp that is not straight


def laid(axis: Floats, towards: Floats) -> Floats:
    """The shortest rotation (4,) that lays the box's axis along a direction of the earth."""
    half = axis + towards
    return normalise(np.concatenate(([axis @ half], np.cross(axis, half))))


class Spin(Path):
    """Rests ``still_s``, then a trembling hand spins the tool, tip down at 20 degrees from plumb."""

    speed = 90.0 * DEGREE  # rad/s on average

    def __init__(self, axis: Floats, seed: int, turn_deg: float = 230.0, still_s: float = 4.0) -> None:
        rng = np.random.default_rng(seed)
        tip = np.array((math.sin(20 * DEGREE), 0.0, -math.cos(20 * DEGREE)))
        self.axis, self.turn, self.still_s = axis, turn_deg * DEGREE, still_s
        self._start = laid(axis, tip)
        self._tremor, self._sway = Wander(rng, 8.0, 12.0, 0.12 * DEGREE), Wander(rng, 0.05, 0.5, 0.4 * DEGREE)

    @property
    def seconds(self) -> float:
        """How long it takes, s."""
        return self.still_s + abs(self.turn) / self.speed + 1.0

    def quats(self, t: Floats) -> Floats:
        """Attitude (n, 4) at times t (n,) in s."""
        share = smooth_step((t - self.still_s) * self.speed / abs(self.turn))
        spun = multiply(self._start, from_rotation_vector((self.turn * share)[:, None] * self.axis))
        alive = smooth_step(t - self.still_s + 1.0)[:, None]
        return multiply(from_rotation_vector(alive * (self._tremor(t) + self._sway(t))), spun)


def attitudes(path: Spin, errors: Errors, seed: int) -> Rows:
    """What the filter makes of it, without magnetometer."""
    return Pipeline("vqf", use_mag=False).step(VirtualBoard(path, 100.0, errors, seed).rows(round(100 * path.seconds)))


def rows_of(quats: Floats) -> Rows:
    rows = empty_rows(ATTITUDE, len(quats))
    rows["quat"] = quats
    return rows


def fed(rows: Rows, block: int = 7) -> SpinFlow:
    flow = SpinFlow()
    for start in range(0, len(rows), block):
        flow.feed(rows[start : start + block])
    return flow


def off_deg(found: ToolAxis, axis: Floats = AXIS) -> float:
    return math.degrees(float(axis_error(found.axis, axis)))


@pytest.mark.parametrize("seed", [1, 2, 3, 4])
@pytest.mark.parametrize("turn_deg", [230.0, -230.0])
def test_a_hand_finds_the_axis_on_a_calibrated_board(seed: int, turn_deg: float) -> None:
    axis = np.random.default_rng(seed).normal(size=3)
    axis /= np.linalg.norm(axis)
    flow = fed(attitudes(Spin(axis, seed, turn_deg), PRESETS["mpu9250-calibrated"], seed))
    found = flow.result()
    assert (flow.done, found.accepted, flow.progress, flow.missing) == (True, True, 1.0, ())
    assert off_deg(found, axis) < 0.8
    assert off_deg(found, axis) < 4 * found.quality_deg < 4.0
    assert found.spin_deg >= 180.0
    assert flow.sentence.startswith("Done. Turned by 18")


def test_a_gyroscopes_bias_does_no_harm() -> None:
    """The filter learns 2 degrees a second in the rest before; what it does not learn costs bias over spin rate."""
    biased = Errors(gyr_bias_dps=2.0)
    assert off_deg(fed(attitudes(Spin(AXIS, 5, still_s=8.0), biased, 5)).result()) < 0.8


@given(st.tuples(*[st.floats(-1, 1)] * 3).filter(lambda v: math.hypot(*v) > 0.1), st.floats(190, 350))
@settings(max_examples=30)
def test_a_perfect_spin_is_exact(axis: tuple[float, float, float], turn_deg: float) -> None:
    true = np.array(axis) / math.hypot(*axis)
    angles = np.radians(np.arange(0.0, turn_deg, 2.0))
    start = laid(true, np.array((0.0, 0.6, -0.8)))
    flow = fed(rows_of(multiply(start, from_rotation_vector(angles[:, None] * true))))
    assert off_deg(flow.result(), true) < 1e-5
    assert flow.result().quality_deg < 1e-5


def test_the_mean_matrix_is_the_sum_over_all_pairs() -> None:
    """The rule of C.3, written out: smallest eigenvector of sum (dR - I)^T (dR - I), e = sqrt(lambda_min / N)."""
    noise = np.random.default_rng(1).normal(0.0, 0.02, (30, 3))
    quats = multiply(from_rotation_vector(noise), from_rotation_vector(np.linspace(0, 4, 30)[:, None] * AXIS))
    matrices = to_matrix(quats)
    total = np.zeros((3, 3))
    for one in matrices:
        for other in matrices:
            step = one.T @ other - np.eye(3)
            total += step.T @ step
    values, vectors = np.linalg.eigh(total)
    error = math.sqrt(values[0] / len(quats) ** 2)
    axis, wobble_deg = spin_axis(quats)
    assert abs(axis @ vectors[:, 0]) == pytest.approx(1.0, abs=1e-12)
    assert wobble_deg == pytest.approx(math.degrees(math.acos(1 - error**2 / 2)), abs=1e-9)
    assert wobble_deg == pytest.approx(math.degrees(0.02 * 2), rel=0.3)  # two components, two poses


def test_less_than_half_a_turn_is_not_enough() -> None:
    """Rocking to and fro by 60 degrees does not add up."""
    angles = 30.0 * DEGREE * np.sin(np.linspace(0.0, 40.0, 4000))
    flow = fed(rows_of(multiply(laid(AXIS, -np.eye(3)[2]), from_rotation_vector(angles[:, None] * AXIS))), 100)
    assert not flow.done
    assert flow.result().spin_deg == pytest.approx(60.0, abs=10.0)
    assert flow.progress == pytest.approx(1 / 3, abs=0.06)
    assert flow.missing[0].endswith("of 180°.")
    assert flow.sentence.startswith("Hold the tip down and turn")


def test_turning_about_changing_axes_is_refused_with_the_wobble() -> None:
    board = VirtualBoard("free", 100.0)
    board.rows(2000)
    flow = fed(rows_of(board.truth), 50)
    found = flow.result()
    assert not found.accepted
    assert found.quality_deg > 30.0
    assert f"still moved by {found.quality_deg:.1f}°, 3° is the most" in found.reason
    assert flow.sentence.endswith("Begin again.")


def test_a_wavering_spin_is_refused() -> None:
    angles = np.linspace(0.0, 4.0, 400)
    waver = 6.0 * DEGREE * np.sin(3.1 * angles)
    quats = multiply(
        from_rotation_vector(waver[:, None] * np.eye(3)[0]),
        multiply(laid(AXIS, -np.eye(3)[2]), from_rotation_vector(angles[:, None] * AXIS)),
    )
    found = fed(rows_of(quats)).result()
    assert not found.accepted
    assert "not turned about one axis" in found.reason


@pytest.mark.parametrize(("tip", "accepted"), [(-1.0, True), (-0.3, True), (-0.2, False), (0.2, False)])
def test_gravity_says_which_end_is_the_tip(tip: float, accepted: bool) -> None:
    start = laid(AXIS, np.array((math.sqrt(1 - tip * tip), 0.0, tip)))
    angles = np.linspace(0.0, 4.0, 400)
    found = fed(rows_of(multiply(start, from_rotation_vector(angles[:, None] * AXIS)))).result()
    assert found.accepted == accepted
    assert ("hold the tip down" in found.reason) != accepted
    if accepted:
        assert rotate(start, found.axis)[2] < 0.0


def test_blocks_gaps_and_what_comes_after_change_nothing() -> None:
    rows = attitudes(Spin(AXIS, 7), PRESETS["ideal"], 7)
    holes = rows_of(np.full((3, 4), np.nan))
    before = fed(rows, len(rows)).result()
    assert fed(rows, 1).result() == before
    flow = fed(np.concatenate((holes, rows, holes)))
    assert flow.result() == before
    flow.feed(rows_of(normalise(np.random.default_rng(2).normal(size=(100, 4)))))
    assert flow.result() == before
    empty = SpinFlow()
    empty.feed(rows[:0])
    assert (empty.progress, empty.done, empty.missing) == (0.0, False, ("The tool has not been turned yet.",))


def test_box_axes() -> None:
    assert {name: tuple(axis) for name, axis in BOX_AXES.items()} == {
        sign + letter: tuple((1.0 if sign == "+" else -1.0) * float(k == i) for k in range(3))
        for i, letter in enumerate("xyz")
        for sign in "+-"
    }
