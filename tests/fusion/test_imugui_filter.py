"""imugui's own filter beyond the contract of all filters: what it learns, what it says of itself, when it gives up."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from imugui.fusion import attitude as at
from imugui.fusion import quaternion as qt
from imugui.fusion.imugui_filter import Imugui
from imugui.fusion.pipeline import Pipeline
from imugui.fusion.self_calibrating_block import FROM_QUATS, Block
from imugui.fusion.self_calibrating_field import FieldWatch
from imugui.fusion.self_calibrating_params import ImuguiParams
from imugui.fusion.self_calibrating_rest import RestRates
from imugui.fusion.self_calibrating_steps import HEADING_STATES, SIZE, Update
from imugui.samples import GRAVITY, SAMPLE, Rows, empty_rows
from imugui.simulation.board import VirtualBoard
from imugui.simulation.errors import PRESETS

IdealRows = Callable[..., tuple[Rows, qt.Floats]]
BROAD = ImuguiParams(gyr_latency_ms=2.4, mag_latency_ms=14.0)  # the delays of that hardware
OFF = dataclasses.replace(PRESETS["mpu9250-calibrated"], gyr_scale_percent=3.0, gyr_cross_percent=1.75)


def turned(seconds: float, rate_hz: float = 100.0, seed: int = 2) -> tuple[VirtualBoard, Rows, qt.Floats]:
    board = VirtualBoard("free", rate_hz, OFF, seed)
    rows = board.rows(round(seconds * rate_hz))
    return board, rows, board.truth


def quick(t: qt.Floats) -> qt.Floats:
    """To all sides with up to 300 deg/s."""
    return at.from_euler(1.1 * t, 0.9 * np.sin(2.1 * t), 3.0 * np.sin(1.3 * t))


def rms_deg(quats: qt.Floats, truth: qt.Floats) -> float:
    return float(np.degrees(np.sqrt((qt.angle_between(quats, truth) ** 2).mean())))


def inclination(quats: qt.Floats, truth: qt.Floats) -> qt.Floats:
    w, x, y, z = qt.multiply(quats, qt.conjugate(truth)).T
    return np.asarray(2.0 * np.arctan2(np.hypot(x, y), np.hypot(w, z)))


@pytest.mark.parametrize("rate_hz", [25.0, 100.0])
def test_it_learns_scale_and_misalignment_of_the_gyroscope(rate_hz: float) -> None:
    board, rows, truth = turned(60.0, rate_hz)
    own, vqf = Pipeline("imugui"), Pipeline("vqf")
    before = board.sensors.gyr.matrix - np.eye(3)
    quats = own.step(rows)["quat"]
    left = own.filter.matrix @ board.sensors.gyr.matrix - np.eye(3)  # type: ignore[attr-defined]
    assert np.abs(before).max() > 0.01
    assert np.abs(left).max() < 0.003
    assert rms_deg(quats, truth) < 0.7 * rms_deg(vqf.step(rows)["quat"], truth)


def test_without_turning_nothing_is_learnt_about_the_matrix() -> None:
    rows = VirtualBoard("rest", 100.0, OFF, 3).rows(3000)
    own = Pipeline("imugui")
    out = own.step(rows)
    assert out["rest"][-1]
    assert np.abs(own.filter.matrix - np.eye(3)).max() < 1e-4  # type: ignore[attr-defined]
    assert own.filter.matrix_sigma > 0.0039  # type: ignore[attr-defined]


def test_the_delay_of_the_magnetometer_is_learnt(ideal_rows: IdealRows) -> None:
    rows, truth = ideal_rows(np.arange(9000) / 200.0, motion=quick)
    late = rows.copy()
    late["mag"][3:] = rows["mag"][:-3]  # 15 ms
    own = Pipeline("imugui")
    own.step(late)
    assert own.filter.delay == pytest.approx(0.015, abs=0.003)  # type: ignore[attr-defined]
    told = Pipeline("imugui", ImuguiParams(mag_latency_ms=15.0, mag_latency_sigma_ms=0.0))
    assert rms_deg(told.step(late)["quat"][4000:], truth[4000:]) < 0.2
    assert told.filter.delay == 0.015  # type: ignore[attr-defined]


def test_the_gyroscopes_delay_predicts_the_attitude_ahead(ideal_rows: IdealRows) -> None:
    rows, truth = ideal_rows(np.arange(2000) / 200.0)
    ahead = Pipeline("imugui", ImuguiParams(gyr_latency_ms=5.0)).step(rows)["quat"]
    assert rms_deg(ahead[20:-1], truth[21:]) < 0.02  # a sample of 5 ms later, at a nearly constant rate
    assert rms_deg(ahead[20:-1], truth[20:-1]) > 0.15


def test_the_sigma_of_the_heading_grows_without_a_magnetometer_and_not_with_one() -> None:
    _, rows, truth = turned(30.0)
    blind, seeing = (Pipeline("imugui", use_mag=use_mag).step(rows) for use_mag in (False, True))
    assert blind["sigma_heading"][500] > 10.0 * blind["sigma_heading"][100] > 0.0
    assert seeing["sigma_heading"][-1] < seeing["sigma_heading"][100]
    within = inclination(blind["quat"], truth) < 2.0 * blind["sigma_tilt"]
    assert 0.5 < within.mean() <= 1.0
    w, _, _, z = qt.multiply(blind["quat"], qt.conjugate(truth)).T
    off = 2.0 * np.arctan(z / w)
    assert (np.abs(off - off[0]) < 2.0 * blind["sigma_heading"])[1:].mean() > 0.93


def about_the_vertical(rows: Rows, angle: qt.Floats) -> Rows:
    """A level board that turns to these angles (n,), rad, with a gyroscope that makes no error."""
    rows["gyr"], rows["acc"], rows["mag"] = 0.0, (0.0, 0.0, GRAVITY), np.nan
    rows["gyr"][1:, 2] = np.diff(angle) / np.diff(rows["t"])
    return rows


def test_turning_on_costs_heading_and_turning_back_returns_most_of_it(ideal_rows: IdealRows) -> None:
    t = np.arange(3000) / 100.0
    angle = 2.0 * np.pi * np.clip(t - 5.0, 0.0, 10.0) / 10.0
    there = Pipeline("imugui").step(about_the_vertical(ideal_rows(t)[0], angle))
    back = Pipeline("imugui").step(about_the_vertical(ideal_rows(t)[0], np.minimum(angle, angle[::-1])))
    assert there["sigma_heading"][-1] == pytest.approx(2.0 * np.pi * ImuguiParams().matrix_worst, rel=0.2)
    assert back["sigma_heading"][1500] > 3.0 * back["sigma_heading"][-1] > 0.0


def test_a_heading_that_is_referred_to_is_exact_and_nothing_else_is_moved() -> None:
    _, rows, _ = turned(12.0)
    own, other = Pipeline("imugui", use_mag=False), Pipeline("imugui", use_mag=False)
    for one in (own, other):
        one.step(rows[:800])
    own.refer_heading()
    now, then = own.filter, other.filter
    assert now.sigma_heading == 0.0 < then.sigma_heading  # type: ignore[attr-defined]
    assert now.sigma_tilt == then.sigma_tilt  # type: ignore[attr-defined]
    assert (now.quat, now.bias) == (then.quat, then.bias)
    again = Pipeline.from_state(json.loads(json.dumps(own.state())))
    ahead = own.step(rows[800:])
    assert (ahead["sigma_heading"] == again.step(rows[800:])["sigma_heading"]).all()
    assert 0.0 < ahead["sigma_heading"][50] < other.step(rows[800:])["sigma_heading"][50]


def test_with_a_magnetometer_and_in_other_filters_no_heading_is_referred_to() -> None:
    _, rows, _ = turned(4.0)
    own, madgwick = Pipeline("imugui"), Pipeline("madgwick")
    for one in (own, madgwick):
        one.step(rows)
        before = one.filter.state()
        one.refer_heading()
        assert one.filter.state() == before


@pytest.mark.parametrize("told", [True, False])
def test_a_clipped_gyroscope_is_noticed(ideal_rows: IdealRows, told: bool) -> None:
    rows, truth = ideal_rows(np.arange(3000) / 100.0, motion=quick)
    limit_dps, clipped = 230.0, rows.copy()
    clipped["gyr"] = np.clip(rows["gyr"], -np.radians(limit_dps), np.radians(limit_dps))
    assert (clipped["gyr"] != rows["gyr"]).any(axis=1).sum() > 100
    whole = Pipeline("imugui").step(rows)
    out = Pipeline("imugui", ImuguiParams(gyr_full_scale_dps=limit_dps if told else 0.0)).step(clipped)
    assert out["sigma_tilt"][200:].mean() > 1.5 * whole["sigma_tilt"][200:].mean()
    assert rms_deg(out["quat"], truth) < rms_deg(Pipeline("vqf").step(clipped)["quat"], truth)


def test_a_repeated_extreme_is_clipping_and_a_single_one_is_not() -> None:
    for values, expected in (((3.0, 5.0, 4.0), False), ((3.0, 5.0, 5.0), True), ((3.0, 3.0, 2.0), False)):
        block = Block()
        for value in values:
            block.add((value, 0.1, -0.1), (0.0, 0.0, GRAVITY), (1.0, 0.0, 0.0, 0.0), 0.01)
        assert block.sums().clipped is expected


def moved_away(seconds: float, acceleration: float) -> Rows:
    """A level board at rest for 4 s, then pushed along x for one second in every four: it never comes back."""
    rows = empty_rows(SAMPLE, round(100.0 * seconds))
    rows["t"] = np.arange(len(rows)) / 100.0
    rows["gyr"], rows["acc"] = 0.0, (0.0, 0.0, GRAVITY)
    rows["acc"][:, 0] = np.where((rows["t"] > 4.0) & (rows["t"] % 4.0 < 1.0), acceleration, 0.0)
    rows["acc"] += np.random.default_rng(1).normal(0.0, 0.02, (len(rows), 3))
    rows["gyr"] += np.random.default_rng(2).normal(0.0, 0.05, (len(rows), 3))
    return rows


def test_a_board_that_travels_is_left_to_vqf_and_taken_back() -> None:
    rows = moved_away(12.0, 30.0)
    own = Imugui()
    notes = []
    for gyr, acc in zip(rows["gyr"].tolist(), rows["acc"].tolist(), strict=True):
        own.update(gyr, acc, None, 0.01)
        notes.append(own.note)
    away = np.flatnonzero([note != "" for note in notes])
    assert away[0] > 400
    assert "farther than an arm reaches" in notes[away[0]]
    assert np.isnan(own.sigma_tilt)
    saved = json.loads(json.dumps(own.state()))
    again = Imugui()
    again.restore(saved)
    for gyr in np.random.default_rng(3).normal(0.0, 0.002, (2500, 3)).tolist():
        for board in (own, again):
            board.update(gyr, (0.0, 0.0, GRAVITY), None, 0.01)
        assert own.quat == again.quat
    assert own.note == ""
    assert own.sigma_tilt < 0.05
    assert np.degrees(inclination(np.array([own.quat]), np.array([[1.0, 0.0, 0.0, 0.0]])))[0] < 0.5


def test_a_vehicle_may_travel() -> None:
    """A circle of 40 m at 8 m/s: the position is not held, the tilt stays."""
    t = np.arange(12000) / 100.0
    speed, rate = 8.0 * np.clip((t - 5.0) / 8.0, 0.0, 1.0), 8.0 / 40.0
    pace = rate * np.clip((t - 5.0) / 8.0, 0.0, 1.0)
    yaw = np.cumsum(pace) / 100.0
    rows = empty_rows(SAMPLE, len(t))
    rows["t"], rows["gyr"], rows["acc"] = t, 0.0, (0.0, 0.0, GRAVITY)
    rows["gyr"][:, 2] = np.diff(yaw, prepend=0.0) * 100.0
    rows["acc"][:, 0], rows["acc"][:, 1] = np.gradient(speed, t), speed * pace
    truth = at.from_euler(yaw, 0.0, 0.0)
    vehicle = Pipeline("imugui", Imugui.PRESETS["Vehicle"], use_mag=False)
    off = np.degrees(inclination(vehicle.step(rows)["quat"], truth))
    assert vehicle.filter.note == ""  # type: ignore[attr-defined]
    assert off.max() < 3.0
    assert off.max() < np.degrees(inclination(Pipeline("vqf", use_mag=False).step(rows)["quat"], truth)).max()


def test_a_gap_and_a_shaken_start_do_not_lose_it() -> None:
    _, rows, truth = turned(40.0)
    cut = np.concatenate((rows[:1500], rows[1900:]))
    own = Pipeline("imugui")
    off = qt.angle_between(own.step(cut)["quat"], np.concatenate((truth[:1500], truth[1900:])))
    assert own.restarts == 1
    assert np.degrees(off[2500:]).max() < 6.0


def test_the_quadratic_form_is_the_rotation_matrix() -> None:
    quats = qt.normalise(np.random.default_rng(4).normal(size=(20, 4)))
    products = (quats[:, :, None] * quats[:, None, :]).reshape(-1, 16)
    assert np.allclose((FROM_QUATS @ products.T).T.reshape(-1, 3, 3), qt.to_matrix(quats), atol=1e-12)


def covariance(seed: int = 5) -> qt.Floats:
    root = np.random.default_rng(seed).normal(size=(SIZE, SIZE))
    return np.asarray(root @ root.T + np.eye(SIZE))


def test_an_update_is_josephs_form_and_can_be_taken_back() -> None:
    p = covariance()
    update = Update(p.copy())
    update.observe(7, 0.3, 2.0)
    gain = p[:, 7] / (p[7, 7] + 2.0)
    keep = np.eye(SIZE) - np.outer(gain, np.eye(SIZE)[7])
    assert np.allclose(update.p, keep @ p @ keep.T + 2.0 * np.outer(gain, gain))
    assert np.allclose(update.x, 0.3 * gain)
    update.withdraw(7, 0.3, 2.0)
    assert np.allclose(update.p, p)
    assert np.allclose(update.x, 0.0)


def test_three_updates_at_once_are_three_updates() -> None:
    one, three = Update(covariance()), Update(covariance())
    singly = [one.observe(index, z, 0.7) for index, z in ((3, 0.1), (4, -0.2), (5, 0.3))]
    assert np.allclose(three.observe_three(3, (0.1, -0.2, 0.3), 0.7), singly)
    assert np.allclose(three.p, one.p)
    assert np.allclose(three.x, one.x)
    assert (three.p == three.p.T).all()


def test_a_heading_moves_no_tilt_and_its_covariance_is_that_of_the_gain_it_used() -> None:
    p = covariance()
    block = Block()
    block.add((0.2, 0.1, 0.3), (0.0, 0.0, GRAVITY), (1.0, 0.0, 0.0, 0.0), 0.01)
    block.add_field((2.0, 20.0, -40.0))
    field = block.sums().field
    assert field is not None
    update = Update(p.copy())
    update.observe_heading(field, 0.5)
    h = np.zeros(SIZE)
    h[2], h[1] = 1.0, 40.0 / np.hypot(2.0, 20.0)
    gain = np.where(HEADING_STATES, p @ h / (h @ p @ h + 0.5), 0.0)
    keep = np.eye(SIZE) - np.outer(gain, h)
    assert np.allclose(update.p, keep @ p @ keep.T + 0.5 * np.outer(gain, gain))
    assert np.allclose(update.x, gain * np.arctan2(2.0, 20.0))
    assert not update.x[~HEADING_STATES].any()


def test_rates_at_rest_wait_half_a_second_and_a_beginning_turn_counts_little() -> None:
    rates = RestRates()
    still = [rates.push(np.zeros(3), np.zeros(3), rest=True) for _ in range(13)]
    assert still[:12] == [None] * 12
    assert still[12] is not None
    quiet = still[12][1][0]
    turning = rates.push(np.array((0.03, 0.0, 0.0)), np.zeros(3), rest=True)
    assert turning is not None
    assert turning[0] == [0.0, 0.0, 0.0]
    assert turning[1][0] > 50.0 * quiet
    assert rates.push(np.array((0.5, 0.0, 0.0)), np.zeros(3), rest=False) is None


def test_another_field_becomes_the_reference_only_while_turning() -> None:
    limits = (0.1, np.radians(6.0), 150.0)
    for rate, disturbed in ((0.0, True), (1.0, False)):
        watch = FieldWatch()
        for _ in range(100):
            watch.update(48.0, 1.1, 0.04, 1.0, limits)
        assert watch.noise_factor() == 1.0
        for _ in range(700):
            watch.update(60.0, 1.1, 0.04, rate, limits)
        assert watch.disturbed is disturbed
        assert (watch.noise_factor() == 0.0) is disturbed


def test_a_trial_of_broad(data_dir: Path) -> None:
    """The one where a magnet is fixed to the board: VQF has 3.58 degrees total and 0.60 of inclination."""
    with np.load(data_dir / "broad" / "33_disturbed_attached_magnet_2cm.npz") as file:
        trial = {key: file[key] for key in ("gyr", "acc", "mag", "opt_quat", "movement", "rate")}
    rows = empty_rows(SAMPLE, len(trial["gyr"]))
    rows["t"] = np.arange(len(rows)) / float(trial["rate"])
    for key in ("gyr", "acc", "mag"):
        rows[key] = trial[key]
    counted = trial["movement"] & np.isfinite(trial["opt_quat"]).all(axis=1)
    truth = trial["opt_quat"][counted].astype(float)
    own = Pipeline("imugui", BROAD)
    out = own.step(rows)
    assert rms_deg(out["quat"][counted], truth) < 1.8
    tilt = inclination(out["quat"][counted], truth)
    assert np.degrees(np.sqrt((tilt**2).mean())) < 0.45
    assert 0.5 < (tilt < out["sigma_tilt"][counted]).mean() < 0.95
    assert own.filter.delay == pytest.approx(0.014, abs=0.004)  # type: ignore[attr-defined]
    assert own.filter.note == ""  # type: ignore[attr-defined]
