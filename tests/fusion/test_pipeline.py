"""Pipeline: every sample once with its own dt, held fields, gaps, bad rows, origin, and blocks that do not matter."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from imugui.fusion import DEFAULT_FILTER, FILTERS
from imugui.fusion import attitude as at
from imugui.fusion import quaternion as qt
from imugui.fusion.correction import Correction
from imugui.fusion.pipeline import Pipeline
from imugui.samples import ATTITUDE, GRAVITY, SAMPLE, Rows, empty_rows

IdealRows = Callable[..., tuple[Rows, qt.Floats]]
NAMES = list(FILTERS)
UP = (0.0, 0.0, GRAVITY)
FIELD = (0.0, 20.0, -43.0)


def still_rows(n: int, rate_hz: float = 138.6) -> Rows:
    """A level board that lies still and sees the earth's field."""
    rows = empty_rows(SAMPLE, n)
    rows["t"] = np.arange(n) / rate_hz
    rows["gyr"], rows["acc"], rows["mag"] = 0.0, UP, FIELD
    return rows


def error_deg(quats: object, truth: object) -> qt.Floats:
    return np.degrees(qt.angle_between(quats, truth))  # type: ignore[arg-type]


def counts(pipeline: Pipeline) -> tuple[int, ...]:
    return pipeline.mag_updates, pipeline.mag_refused, pipeline.skipped, pipeline.restarts


@pytest.mark.parametrize("name", NAMES)
def test_rows_come_out_complete(ideal_rows: IdealRows, name: str) -> None:
    rows, truth = ideal_rows(np.arange(2000) / 100.0)
    rows["t_arrival"], rows["status"] = rows["t"] + 7.0, np.arange(2000) % 3
    pipeline = Pipeline(name)
    out = pipeline.step(rows)
    assert out.dtype == ATTITUDE
    for column in ("t", "t_arrival", "acc", "mag", "status"):
        assert out[column].tobytes() == rows[column].tobytes()
    assert error_deg(out["quat"], truth).max() < 0.2
    assert out["local"].tobytes() == out["quat"].tobytes()
    assert np.allclose(out["gyr"], rows["gyr"] - out["bias"])
    assert np.isnan(out["t_publish"]).all()
    for column in ("sigma_tilt", "sigma_heading"):
        known = (out[column] > 0.0) & (out[column] < 0.2)
        assert known.all() if name == "imugui" else np.isnan(out[column]).all()
    assert out["mag_used"].all()
    assert not out["disturbed"].any()
    assert counts(pipeline) == (2000, 0, 0, 0)
    assert pipeline.filter_name == name
    assert pipeline.params == FILTERS[name].Params()


def test_the_default_filter_and_given_parameters() -> None:
    assert Pipeline().filter_name == DEFAULT_FILTER
    params = FILTERS["mahony"].PRESETS["Screw assistant 2018"]
    assert Pipeline("mahony", params).params is params


def test_no_rows_give_no_rows() -> None:
    pipeline = Pipeline()
    out = pipeline.step(empty_rows(SAMPLE, 0))
    assert out.dtype == ATTITUDE
    assert len(out) == 0
    assert counts(pipeline) == (0, 0, 0, 0)


def messy_rows(seed: int) -> Rows:
    """A tumbling board with jitter, held and missing fields, bad rows, repeated and backward times, and a gap."""
    rng = np.random.default_rng(seed)
    n = 260
    rows = empty_rows(SAMPLE, n)
    rows["t"] = np.cumsum(rng.choice([0.0, 0.004, 0.01, 0.02, -0.005], n, p=[0.1, 0.3, 0.3, 0.25, 0.05]))
    rows["t"][170:] += 3.0
    rows["gyr"], rows["acc"] = rng.normal(size=(n, 3)), rng.normal(UP, size=(n, 3))
    rows["mag"] = rng.normal(FIELD, size=(n, 3))[np.arange(n) // 4 * 4]
    rows["mag"][rng.random(n) < 0.1] = np.nan
    rows["mag"][200:208] *= 10.0
    rows["acc"][rng.random(n) < 0.04] = np.nan
    rows["gyr"][rng.random(n) < 0.03] = 1e6
    rows["t"][rng.random(n) < 0.01] = np.nan
    return rows


wild = st.floats(allow_nan=True, allow_infinity=True)


@settings(max_examples=40)
@given(values=st.lists(st.tuples(*[wild] * 10), min_size=1, max_size=8))
@pytest.mark.parametrize("name", NAMES)
def test_no_row_is_too_wild(name: str, values: list[tuple[float, ...]]) -> None:
    """Any number in any column, infinite ones too, between good rows: a finite unit attitude for every row."""
    table = np.array(values)
    rows = still_rows(len(table) + 4)
    rows["t"][2:-2], rows["gyr"][2:-2], rows["acc"][2:-2] = table[:, 0], table[:, 1:4], table[:, 4:7]
    rows["mag"][2:-2] = table[:, 7:]
    out = Pipeline(name, origin=(0.6, 0.0, 0.8, 0.0)).step(rows)
    for column in ("quat", "local"):
        assert np.allclose(qt.length(out[column]), 1.0, atol=1e-9)
    assert np.isfinite(out["bias"]).all()


@settings(max_examples=25)
@given(cuts=st.lists(st.integers(0, 260), max_size=30), seed=st.integers(0, 3))
@pytest.mark.parametrize("name", NAMES)
def test_blocks_do_not_matter(name: str, cuts: list[int], seed: int) -> None:
    rows = messy_rows(seed)
    correction = Correction(gyr_bias=(0.01, 0.02, -0.01), mag_matrix=np.eye(3) * 1.02, mounting=(0.5, 0.5, -0.5, 0.5))
    origin = (0.8, 0.0, 0.6, 0.0)
    whole, cut = (Pipeline(name, correction=correction, origin=origin) for _ in range(2))
    expected = whole.step(rows)
    blocks = np.split(rows, sorted(cuts))
    assert np.concatenate([cut.step(block) for block in blocks]).tobytes() == expected.tobytes()
    assert counts(cut) == counts(whole)
    assert whole.restarts >= 1
    assert whole.skipped > 0


def test_the_screw_assistants_recording_holds_1111_measurements(data_dir: Path) -> None:
    lines = (data_dir / "boards" / "lines-magnetometer-raw-and-calibrated.txt").read_text(encoding="ascii").splitlines()
    mags = np.array([[float(word) for word in line.split()[1:]] for line in lines if line.startswith("1 ")])
    assert len(mags) == 19246
    rows = still_rows(len(mags))
    rows["mag"] = mags
    pipeline = Pipeline()
    out = np.concatenate([pipeline.step(block) for block in np.array_split(rows, 777)])
    assert pipeline.mag_updates + pipeline.mag_refused == 1111
    assert pipeline.mag_refused == 0
    assert int(out["mag_used"].sum()) == 1111
    gaps = np.diff(np.flatnonzero(out["mag_used"]))
    assert np.median(gaps) == 17.0


def test_the_beside_the_motor_field_is_disturbed_and_never_fed(data_dir: Path) -> None:
    text = (data_dir / "boards" / "triplets-car-run3.txt").read_text(encoding="ascii")
    values = np.array([[float(x) for x in line.replace(";", ",").split(",")[:9]] for line in text.splitlines()])
    rows = still_rows(len(values), rate_hz=9.6)
    rows["acc"], rows["gyr"] = values[:, 0:3] * GRAVITY, np.radians(values[:, 3:6])
    # mG in the magnetometer's own axes -> uT in the accelerometer's
    rows["mag"] = np.stack((values[:, 7], values[:, 6], -values[:, 8]), axis=-1) / 10.0
    for name in NAMES:
        pipeline = Pipeline(name)
        out = pipeline.step(rows)
        assert out["disturbed"].mean() > 0.99
        assert not out["mag_used"].any()
        assert pipeline.mag_updates == 0
        assert pipeline.mag_refused > 400


def test_a_held_field_is_fed_once_and_a_missing_one_not_at_all() -> None:
    rows = still_rows(8)
    rows["mag"][3:6] += 0.1
    rows["mag"][6:] = np.nan
    pipeline = Pipeline()
    assert pipeline.step(rows)["mag_used"].tolist() == [True, False, False, True, False, False, False, False]
    assert pipeline.mag_updates == 2


def test_a_board_that_sends_its_field_only_when_new_may_repeat_it() -> None:
    rows = still_rows(9)
    rows["mag"][np.arange(9) % 3 != 0] = np.nan
    assert Pipeline().step(rows)["mag_used"].tolist() == [True, False, False] * 3


def test_a_field_that_came_new_in_a_bad_row_is_fed_with_the_next() -> None:
    rows = still_rows(6)
    rows["mag"][3:] += 0.1
    rows["acc"][3] = np.nan
    assert Pipeline().step(rows)["mag_used"].tolist() == [True, False, False, False, True, False]


@pytest.mark.parametrize("name", NAMES)
def test_without_magnetometer_nothing_of_it_is_fed(ideal_rows: IdealRows, name: str) -> None:
    rows, _ = ideal_rows(np.arange(500) / 100.0)
    blind = rows.copy()
    blind["mag"] = np.nan
    off, none = Pipeline(name, use_mag=False), Pipeline(name)
    out = off.step(rows)
    assert out["quat"].tobytes() == none.step(blind)["quat"].tobytes()
    assert counts(off) == counts(none) == (0, 0, 0, 0)
    assert not out["mag_used"].any()
    assert abs(at.euler(out["quat"][0])[0]) < 1e-9
    assert out["mag"].tobytes() == rows["mag"].tobytes()


@pytest.mark.parametrize(
    ("norm", "fed", "disturbed"),
    [
        (3.0, False, True),
        (10.0, True, True),
        (21.0, True, False),
        (69.0, True, False),
        (80.0, True, True),
        (250.0, False, True),
    ],
)
def test_what_the_strength_of_the_field_decides(norm: float, fed: bool, disturbed: bool) -> None:
    rows = still_rows(5)
    rows["mag"][0] = (0.0, 0.6 * norm, -0.8 * norm)
    rows["mag"][1:4] = np.nan  # the flag is held while no field comes
    rows["mag"][4] = FIELD
    pipeline = Pipeline("madgwick")
    out = pipeline.step(rows)
    assert out["mag_used"].tolist() == [fed, False, False, False, True]
    assert out["disturbed"].tolist() == [disturbed] * 4 + [False]
    assert pipeline.mag_refused == (0 if fed else 1)


def test_the_field_is_judged_after_correction() -> None:
    rows = still_rows(4)
    rows["mag"] += (300.0, 0.0, 0.0)  # hard iron
    out = Pipeline(correction=Correction(mag_bias=(300.0, 0.0, 0.0))).step(rows)
    assert not out["disturbed"].any()
    assert out["mag_used"][0]
    assert abs(at.euler(out["quat"][-1])[0]) < 1e-9
    assert Pipeline().step(rows)["disturbed"].all()


@pytest.mark.parametrize("name", NAMES)
def test_bad_rows_hold_the_attitude_and_the_next_dt_bridges_them(name: str) -> None:
    rows = still_rows(400, rate_hz=100.0)
    rows["gyr"] = (0.0, 0.0, np.radians(45.0))
    rows["mag"] = np.nan
    bad = {"gyr": np.nan, "acc": np.inf, "t": np.nan}
    for place, (column, value) in zip((100, 200, 300), bad.items(), strict=True):
        rows[column][place : place + 20] = value
    rows["gyr"][350:353] = 2e3  # no gyroscope turns that fast
    pipeline = Pipeline(name)
    out = pipeline.step(rows)
    assert pipeline.skipped == 63
    assert pipeline.restarts == 0
    for place in (100, 200, 300, 350):
        assert (out["quat"][place : place + 3] == out["quat"][place - 1]).all()
    assert np.isfinite(out["quat"]).all()
    assert error_deg(out["quat"][-1], at.from_euler(np.radians(45.0 * 3.99), 0.0, 0.0)) < 1e-6


def test_before_the_first_usable_row_the_attitude_is_the_identity() -> None:
    rows = still_rows(5)
    rows["acc"][:3] = np.nan
    out = Pipeline().step(rows)
    assert (out["quat"][:3] == (1.0, 0.0, 0.0, 0.0)).all()


@pytest.mark.parametrize("name", NAMES)
def test_a_gap_restarts_from_gravity_and_keeps_heading_and_bias(name: str) -> None:
    rows = still_rows(3000, rate_hz=100.0)
    rows["gyr"] = (0.0, 0.0, 0.004)
    rows["mag"] = np.nan
    rows["gyr"][200:300] += (0.0, 0.0, np.radians(70.0))
    after = at.from_euler(np.radians(70.0), 0.5, -1.0)
    rows["t"][2000:] += 5.0
    rows["acc"][2000:] = at.gravity(after)
    pipeline = Pipeline(name)
    out = pipeline.step(rows)
    assert pipeline.restarts == 1
    heading = at.heading_deg(out["quat"])
    assert abs(heading[2000] - heading[1999]) < 1e-6
    assert np.allclose(at.gravity(out["quat"][2000]), rows["acc"][2000], atol=1e-9)
    assert np.allclose(out["bias"][2000], out["bias"][1999], atol=1e-6)


@pytest.mark.parametrize("name", NAMES)
def test_after_a_gap_the_next_field_sets_the_heading(ideal_rows: IdealRows, name: str) -> None:
    rows, truth = ideal_rows(np.arange(3000) / 100.0, mag_every=10)
    keep = np.r_[0:1200, 2205:3000]
    rows, truth = rows[keep], truth[keep]
    pipeline = Pipeline(name)
    out = pipeline.step(rows)
    assert pipeline.restarts == 1
    # the first field after the gap was held since before its row: the second sets the heading
    second = np.flatnonzero(out["mag_used"])[120:][1]
    assert error_deg(out["quat"][:1200], truth[:1200]).max() < 0.2
    assert error_deg(out["quat"][second:], truth[second:]).max() < 0.2


def test_half_a_second_is_bridged_without_restart(ideal_rows: IdealRows) -> None:
    for name in NAMES:
        rows = still_rows(300, rate_hz=100.0)
        rows["gyr"] = (0.0, 0.0, np.radians(45.0))
        rows["mag"] = np.nan
        kept = np.delete(rows, np.r_[150:200])
        pipeline = Pipeline(name)
        out = pipeline.step(kept)
        assert pipeline.restarts == 0
        assert error_deg(out["quat"][-1], at.from_euler(np.radians(45.0 * 2.99), 0.0, 0.0)) < 1e-6


@pytest.mark.parametrize("name", NAMES)
def test_time_that_stands_still_or_goes_back_integrates_nothing(name: str) -> None:
    rows = still_rows(200, rate_hz=100.0)
    rows["gyr"] = (0.0, 0.0, np.radians(45.0))
    rows["mag"] = np.nan
    rows["t"][100:] -= 0.01  # one repeated time
    rows["t"][150:] -= 0.05  # one step back
    pipeline = Pipeline(name)
    out = pipeline.step(rows)
    assert (out["quat"][100] == out["quat"][99]).all()
    assert np.allclose(out["quat"][150], out["quat"][149], atol=1e-12)
    assert pipeline.restarts == 0
    assert error_deg(out["quat"][-1], at.from_euler(np.radians(45.0 * 1.97), 0.0, 0.0)) < 1e-6


def test_a_clock_that_starts_again_is_a_gap() -> None:
    rows = np.concatenate((still_rows(100), still_rows(100)))
    rows["t"][:100] += 50.0
    pipeline = Pipeline()
    pipeline.step(rows)
    assert pipeline.restarts == 1


def test_local_is_the_attitude_seen_from_the_origin(ideal_rows: IdealRows) -> None:
    rows, _ = ideal_rows(np.arange(300) / 100.0)
    pipeline = Pipeline()
    first = pipeline.step(rows[:200])
    pipeline.set_origin(first["quat"][-1])
    second = pipeline.step(rows[200:250])
    assert error_deg(qt.multiply(first["quat"][-1], second["local"]), second["quat"]).max() < 1e-9
    pipeline.set_origin(None)
    assert pipeline.origin is None
    third = pipeline.step(rows[250:])
    assert third["local"].tobytes() == third["quat"].tobytes()


def test_the_origin_at_yaw_50_pitch_30_then_a_body_pitch_of_10_reads_10() -> None:
    # the check value of the screw assistant: the source's rule, not its report's
    begin = at.from_euler(np.radians(50.0), np.radians(30.0), 0.0)
    pipeline = Pipeline(origin=begin)
    pipeline.filter.start(qt.multiply(begin, at.from_euler(0.0, np.radians(10.0), 0.0)))
    rows = still_rows(1)
    rows["acc"], rows["mag"] = at.gravity(pipeline.filter.quat), np.nan
    assert np.allclose(np.degrees(at.euler(pipeline.step(rows)["local"][0])), (0.0, 10.0, 0.0), atol=1e-6)


@pytest.mark.parametrize("old", NAMES)
@pytest.mark.parametrize("new", NAMES)
def test_another_filter_goes_on_where_this_one_is(ideal_rows: IdealRows, old: str, new: str) -> None:
    rows, truth = ideal_rows(np.arange(2000) / 138.6, mag_every=17)
    before = Pipeline(old, origin=(0.5, 0.5, 0.5, 0.5))
    last = before.step(rows[:1000])[-1]
    after = Pipeline(new)
    after.continue_from(before)
    out = after.step(rows[1000:])
    assert after.origin == before.origin == (0.5, 0.5, 0.5, 0.5)
    assert error_deg(out["quat"][0], last["quat"]) < 2.0
    assert error_deg(out["quat"], truth[1000:]).max() < 0.2
    assert after.mag_updates == before.mag_updates + int(out["mag_used"].sum())
    assert after.mag_updates == int(np.ceil(2000 / 17))


def test_other_parameters_keep_what_the_filter_has_learnt() -> None:
    rng = np.random.default_rng(4)
    rows = still_rows(4000, rate_hz=100.0)
    rows["gyr"] = rng.normal((0.01, -0.008, 0.006), 1e-3, size=(4000, 3))
    rows["mag"] += rng.normal(scale=0.2, size=(4000, 3))
    before = Pipeline("mahony", FILTERS["mahony"].Params(kp=2.0, ki=0.2))
    learnt = before.step(rows[:3000])["bias"][-1]
    assert np.allclose(learnt, (0.01, -0.008, 0.006), atol=2e-3)
    after = Pipeline("mahony", FILTERS["mahony"].Params(kp=1.0, ki=0.0))
    after.continue_from(before)
    assert np.allclose(after.step(rows[3000:])["bias"], learnt)
    recalibrated = Pipeline("mahony", correction=Correction(gyr_bias=(0.01, -0.008, 0.006)))
    recalibrated.continue_from(before)
    assert np.allclose(recalibrated.filter.bias, 0.0)


def test_going_on_from_a_pipeline_without_rows_is_a_fresh_start() -> None:
    rows = still_rows(5)
    rows["acc"] = (GRAVITY, 0.0, 0.0)
    for name in NAMES:
        fresh = Pipeline(name)
        fresh.continue_from(Pipeline("madgwick"))
        assert np.allclose(at.gravity(fresh.step(rows)["quat"][0]), (GRAVITY, 0.0, 0.0))


def test_switching_the_magnetometer_on_sets_the_heading_at_once(ideal_rows: IdealRows) -> None:
    rows, truth = ideal_rows(np.arange(1000) / 100.0)
    blind: dict[str, Any] = {"use_mag": False}
    for name in NAMES:
        before, after = Pipeline("complementary", **blind), Pipeline(name)
        assert error_deg(before.step(rows[:500])["quat"][-1], truth[499]) > 10.0
        after.continue_from(before)
        assert error_deg(after.step(rows[500:])["quat"][20:], truth[520:]).max() < 0.5


@pytest.mark.parametrize("name", FILTERS)
def test_a_saved_state_continues_bit_for_bit_through_json(ideal_rows: IdealRows, name: str) -> None:
    rows, _ = ideal_rows(np.arange(400) / 100.0, mag_every=7)
    whole = Pipeline(name, origin=(0.6, 0.0, 0.8, 0.0))
    whole.step(rows[:150])
    text = json.dumps(whole.state())
    resumed = Pipeline.from_state(json.loads(text))
    expected, got = whole.step(rows[150:]), resumed.step(rows[150:])
    for field in ("quat", "local", "bias", "rest", "disturbed", "mag_used"):
        assert np.array_equal(expected[field], got[field]), field
    assert resumed.settings() == whole.settings()


def test_a_restart_forgets_what_was(ideal_rows: IdealRows) -> None:
    rows, _ = ideal_rows(np.arange(300) / 100.0)
    pipeline = Pipeline(origin=(0.6, 0.0, 0.8, 0.0))
    pipeline.step(rows[:200])
    pipeline.restart()
    assert np.array_equal(pipeline.step(rows[200:])["quat"], Pipeline().step(rows[200:])["quat"])
    assert pipeline.origin is not None
    assert pipeline.restarts == 1
