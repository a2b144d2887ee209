"""The contract every entry of FILTERS keeps, with its default and with every preset."""

from __future__ import annotations

import copy
import json
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from imugui import fields
from imugui.fusion import DEFAULT_FILTER, FILTER_TITLES, FILTERS, VQF_MISSING
from imugui.fusion import attitude as at
from imugui.fusion import quaternion as qt
from imugui.fusion.filter import Filter
from imugui.samples import GRAVITY, Rows

IdealRows = Callable[..., tuple[Rows, qt.Floats]]
Sample = tuple[list[float], list[float], list[float] | None, float]

NAMES = list(FILTERS)
PRESETS = [(name, preset) for name in FILTERS for preset in FILTERS[name].PRESETS]
FIELD = (0.0, 20.0, -43.0)
UP = (0.0, 0.0, GRAVITY)
STILL = (0.0, 0.0, 0.0)


@pytest.fixture(params=NAMES)
def name(request: pytest.FixtureRequest) -> str:
    return str(request.param)


@pytest.fixture
def board(name: str) -> Filter:
    return FILTERS[name]()


def samples_of(rows: Rows, use_mag: bool = True) -> list[Sample]:
    """Rows as filters take them; dt of the first is 0."""
    dts = np.diff(rows["t"], prepend=rows["t"][0]).tolist()
    columns = zip(rows["gyr"].tolist(), rows["acc"].tolist(), rows["mag"].tolist(), dts, strict=True)
    return [(gyr, acc, mag if use_mag else None, dt) for gyr, acc, mag, dt in columns]


def run(board: Filter, samples: list[Sample]) -> qt.Floats:
    quats = []
    for sample in samples:
        board.update(*sample)
        quats.append(board.quat)
    return np.array(quats)


def error_deg(quat: object, truth: object) -> qt.Floats:
    return np.degrees(qt.angle_between(quat, truth))  # type: ignore[arg-type]


def seen(quat: object, vector: tuple[float, ...]) -> list[float]:
    """An earth vector as the sensor in attitude ``quat`` sees it."""
    return qt.rotate(qt.conjugate(quat), vector).tolist()  # type: ignore[arg-type, no-any-return]


def test_the_default_filter_is_in_the_table() -> None:
    assert DEFAULT_FILTER in FILTERS
    assert ("vqf" in FILTERS) == (VQF_MISSING == "")
    assert {"madgwick", "mahony", "complementary"} <= set(FILTERS)


def test_the_titles_are_those_of_the_filters() -> None:
    assert list(FILTER_TITLES.items()) == [(name, kind.title) for name, kind in FILTERS.items()]


def test_presets_are_valid_and_begin_with_the_defaults(name: str) -> None:
    kind = FILTERS[name]
    presets = list(kind.PRESETS.values())
    assert presets[0] == kind.Params() == kind().params
    for params in presets:
        values = {item.name: getattr(params, item.name) for item in fields.dataclasses.fields(params)}
        assert fields.from_mapping(kind.Params, values) == (params, [])
    for item in fields.dataclasses.fields(kind.Params):
        assert item.metadata["label"]
        assert item.metadata["tip"]


@pytest.mark.parametrize("mag_every", [1, 17])
@pytest.mark.parametrize(("name", "preset"), PRESETS)
def test_it_follows_a_known_rotation(ideal_rows: IdealRows, name: str, preset: str, mag_every: int) -> None:
    rows, truth = ideal_rows(np.arange(3000) / 138.6, mag_every=mag_every)
    samples = [
        (gyr, acc, mag if i % mag_every == 0 else None, dt) for i, (gyr, acc, mag, dt) in enumerate(samples_of(rows))
    ]
    quats = run(FILTERS[name](FILTERS[name].PRESETS[preset]), samples)
    assert error_deg(quats, truth).max() < 0.2


@pytest.mark.parametrize(("name", "preset"), PRESETS)
def test_it_follows_a_known_rotation_without_magnetometer(ideal_rows: IdealRows, name: str, preset: str) -> None:
    rows, truth = ideal_rows(np.arange(3000) / 100.0)
    quats = run(FILTERS[name](FILTERS[name].PRESETS[preset]), samples_of(rows, use_mag=False))
    relative = qt.multiply(qt.multiply(truth[0], qt.conjugate(quats[0])), quats)  # the yaw began at 0
    assert error_deg(relative, truth).max() < 0.2


@pytest.mark.parametrize("rate_hz", [10.0, 1000.0])
def test_it_follows_at_any_rate(ideal_rows: IdealRows, board: Filter, rate_hz: float) -> None:
    rows, truth = ideal_rows(np.arange(int(10 * rate_hz)) / rate_hz)
    assert error_deg(run(board, samples_of(rows)), truth).max() < 0.2


def test_irregular_times_are_no_worse(ideal_rows: IdealRows, name: str) -> None:
    rng = np.random.default_rng(5)
    even = np.arange(4000) / 100.0
    for t in (even, np.cumsum(rng.uniform(0.001, 0.019, 4000)), np.delete(even, rng.choice(4000, 800, replace=False))):
        rows, truth = ideal_rows(t)
        assert error_deg(run(FILTERS[name](), samples_of(rows)), truth).max() < 0.2


@settings(max_examples=8)
@given(axis=st.tuples(*[st.floats(-1.0, 1.0)] * 3), angle=st.floats(0.0, np.pi), yaw=st.floats(-3.0, 3.0))
@pytest.mark.parametrize("name", NAMES)
def test_it_settles_to_gravity_from_any_start(name: str, axis: tuple[float, ...], angle: float, yaw: float) -> None:
    truth = at.from_euler(yaw, 0.4, -2.0)
    board = FILTERS[name]()
    board.start(qt.multiply(qt.from_rotation_vector(angle * np.array(axis)), truth))
    run(board, [(list(STILL), seen(truth, UP), None, 0.05)] * 1000)
    assert np.allclose(at.gravity(board.quat), seen(truth, UP), atol=GRAVITY * np.radians(0.2))


def test_it_settles_even_from_exactly_upside_down(board: Filter) -> None:
    board.start((0.0, 1.0, 0.0, 0.0))
    run(board, [(list(STILL), list(UP), None, 0.05)] * 1000)
    assert np.allclose(at.gravity(board.quat), UP, atol=GRAVITY * np.radians(0.2))


@pytest.mark.parametrize("yaw_deg", [0.0, 90.0, 180.0, -90.0, 37.0])
def test_it_starts_from_accelerometer_and_field(name: str, yaw_deg: float) -> None:
    for pitch, roll in ((0.0, 0.0), (0.5, -1.0), (-1.2, 3.0)):
        truth = at.from_euler(np.radians(yaw_deg), pitch, roll)
        board = FILTERS[name]()
        board.update(STILL, seen(truth, UP), seen(truth, FIELD), 0.0)
        assert error_deg(board.quat, truth) < 1e-9


def test_a_level_board_with_x_east_reads_yaw_0_and_counts_counter_clockwise(board: Filter) -> None:
    for yaw_deg in (0.0, 90.0, 180.0, -90.0):
        truth = at.from_euler(np.radians(yaw_deg), 0.0, 0.0)
        fresh = type(board)()
        run(fresh, [(list(STILL), seen(truth, UP), seen(truth, FIELD), 0.01)] * 5)
        yaw, pitch, roll = np.degrees(at.euler(fresh.quat))
        assert abs((yaw - yaw_deg + 180.0) % 360.0 - 180.0) < 1e-6
        assert abs(pitch) < 1e-6
        assert abs(roll) < 1e-6


def test_without_a_field_the_yaw_starts_at_0_and_the_first_field_snaps_it(board: Filter) -> None:
    truth = at.from_euler(2.0, 0.3, -0.6)
    spin = seen(truth, (0.0, 0.0, 0.0))
    run(board, [(spin, seen(truth, UP), None, 0.01)] * 50)
    assert np.allclose(at.euler(board.quat), (0.0, 0.3, -0.6), atol=1e-9)
    board.update(spin, seen(truth, UP), seen(truth, FIELD), 0.01)
    assert error_deg(board.quat, truth) < 1e-6


def test_a_start_from_outside_is_kept(board: Filter) -> None:
    begin = at.from_euler(1.0, 0.2, -0.3)
    board.start(2.0 * begin)
    assert error_deg(board.quat, begin) < 1e-9
    run(board, [(list(STILL), seen(begin, UP), None, 0.01)] * 100)
    assert error_deg(board.quat, begin) < 1e-6


def test_a_start_with_unknown_heading_waits_for_the_field(board: Filter) -> None:
    truth, begin = at.from_euler(-1.0, 0.2, -0.3), at.from_euler(1.0, 0.2, -0.3)
    for heading_known, expected in ((False, truth), (True, begin)):
        board.start(begin, heading_known=heading_known)
        run(board, [(list(STILL), seen(begin, UP), None, 0.01)] * 20)
        board.update(STILL, seen(begin, UP), seen(truth, FIELD), 0.01)
        assert error_deg(board.quat, expected) < 10.0  # of the 115 degrees between the two


def test_turning_integrates_the_rate(board: Filter) -> None:
    board.update(STILL, UP, None, 0.0)
    run(board, [([0.0, 0.0, np.radians(45.0)], list(UP), None, 0.01)] * 200)
    assert np.allclose(np.degrees(at.euler(board.quat)), (90.0, 0.0, 0.0), atol=1e-6)


def test_in_free_fall_it_integrates_on(board: Filter) -> None:
    board.update(STILL, UP, None, 0.0)
    board.update(STILL, UP, None, 0.01)
    run(board, [([np.radians(90.0), 0.0, 0.0], [0.0, 0.0, 0.0], None, 0.01)] * 100)
    assert np.allclose(np.degrees(at.euler(board.quat)), (0.0, 0.0, 90.0), atol=1e-6)


def test_it_waits_for_gravity_before_it_starts(board: Filter) -> None:
    run(board, [([1.0, 2.0, 3.0], [0.0, 0.0, 0.0], [0.0, 20.0, -43.0], 0.01)] * 10)
    assert board.quat == (1.0, 0.0, 0.0, 0.0)
    truth = at.from_euler(0.0, 0.4, 1.0)
    board.update(STILL, seen(truth, UP), None, 0.01)
    assert error_deg(board.quat, truth) < 1e-9


def test_a_zero_field_is_no_field(name: str, ideal_rows: IdealRows) -> None:
    samples = samples_of(ideal_rows(np.arange(500) / 100.0)[0], use_mag=False)
    without = run(FILTERS[name](), samples)
    zero = run(FILTERS[name](), [(gyr, acc, [0.0, 0.0, 0.0], dt) for gyr, acc, _, dt in samples])
    assert without.tobytes() == zero.tobytes()


def test_dt_zero_or_negative_integrates_nothing(board: Filter, ideal_rows: IdealRows) -> None:
    run(board, samples_of(ideal_rows(np.arange(300) / 100.0)[0]))
    before = board.quat
    level = at.gravity(before).tolist()
    for dt in (0.0, -0.01, -5.0):
        board.update([3.0, -2.0, 1.0], level, None, dt)
        assert error_deg(board.quat, before) < 0.01


def test_not_a_number_does_not_poison_it(board: Filter, ideal_rows: IdealRows) -> None:
    rows, truth = ideal_rows(np.arange(1500) / 100.0)
    samples = samples_of(rows)
    samples[700:700] = [([np.nan] * 3, [np.nan] * 3, [np.nan] * 3, 0.0), ([np.inf] * 3, [-np.inf] * 3, None, 0.0)]
    quats = run(board, samples)
    assert np.isfinite(quats).all()
    assert error_deg(quats[-1], truth[-1]) < 0.2


anything = st.floats(allow_nan=False, allow_infinity=False)
triples = st.tuples(anything, anything, anything).map(list)
nasty = st.tuples(triples, triples, st.none() | triples, anything | st.floats(0.0, 0.1))


@settings(max_examples=60)
@given(st.lists(nasty, min_size=1, max_size=12))
@pytest.mark.parametrize("name", NAMES)
def test_any_finite_input_keeps_it_finite_and_unit(name: str, samples: list[Sample]) -> None:
    board = FILTERS[name]()
    board.update(STILL, UP, FIELD, 0.0)
    quats = run(board, samples)
    assert np.isfinite(quats).all()
    assert np.allclose(qt.length(quats), 1.0, atol=1e-9)
    assert np.isfinite(board.bias).all()
    assert isinstance(board.rest, bool)
    assert isinstance(board.disturbed, bool)


@pytest.mark.parametrize("at_row", [0, 1, 2, 40, 900])
def test_a_restored_state_continues_with_the_same_bits(name: str, at_row: int, ideal_rows: IdealRows) -> None:
    samples = samples_of(ideal_rows(np.arange(1200) / 100.0)[0])
    board = FILTERS[name]()
    run(board, samples[:at_row])
    saved = json.loads(json.dumps(board.state()))  # plain numbers, lists and dicts
    kept = copy.deepcopy(saved)
    expected = run(board, samples[at_row:])
    assert json.dumps(saved) == json.dumps(kept)
    again = FILTERS[name]()
    again.restore(saved)
    assert run(again, samples[at_row:]).tobytes() == expected.tobytes()
    assert (again.bias, again.rest, again.disturbed) == (board.bias, board.rest, board.disturbed)


def test_values_are_plain_floats(board: Filter, ideal_rows: IdealRows) -> None:
    run(board, samples_of(ideal_rows(np.arange(50) / 100.0)[0]))
    assert [type(part) for part in (*board.quat, *board.bias)] == [float] * 7


def test_rest_is_seen_and_motion_ends_it(board: Filter) -> None:
    rng = np.random.default_rng(2)
    noise = rng.normal(scale=0.002, size=(400, 3))
    still = [((0.01 + row).tolist(), (np.array(UP) + 10 * row).tolist(), None, 0.01) for row in noise]
    run(board, still[:100])
    assert not board.rest
    run(board, still[100:])
    assert board.rest
    run(board, [([0.5, 0.0, 0.0], list(UP), None, 0.01)] * 3)
    assert not board.rest


def test_a_steady_turn_is_not_rest(board: Filter) -> None:
    run(board, [([0.0, 0.0, 0.2], list(UP), None, 0.01)] * 1000)
    assert not board.rest


def test_a_magnet_disturbs_and_its_leaving_ends_it(board: Filter, ideal_rows: IdealRows) -> None:
    rows, _ = ideal_rows(np.arange(3000) / 100.0)
    magnet = rows.copy()
    magnet["mag"][1500:1800] += (0.0, 0.0, 30.0)  # fixed to the board
    flags = []
    for sample in samples_of(magnet):
        board.update(*sample)
        flags.append(board.disturbed)
    assert not any(flags[1000:1500])
    assert np.mean(flags[1530:1800]) > 0.9
    assert not any(flags[1900:])


def test_a_wrong_heading_is_pulled_to_north_and_a_missing_field_leaves_it(name: str) -> None:
    wrong = at.from_euler(0.3, 0.0, 0.0)
    headings = {}
    for mag in (None, list(FIELD)):
        board = FILTERS[name]()
        board.start(wrong)
        run(board, [(list(STILL), list(UP), mag, 0.01)] * 9000)
        headings[mag is None] = abs(float(np.degrees(at.euler(board.quat)[0])))
    assert headings[True] > 17.0
    assert headings[False] < 2.0


def test_one_wrong_field_of_a_slow_magnetometer_moves_the_heading_little(board: Filter) -> None:
    fields = [list(FIELD) if i % 17 == 0 else None for i in range(1360)]
    run(board, [(list(STILL), list(UP), mag, 1 / 138.6) for mag in fields])
    board.update(STILL, UP, seen(at.from_euler(0.8, 0.0, 0.0), FIELD), 1 / 138.6)
    assert error_deg(board.quat, (1.0, 0.0, 0.0, 0.0)) < 8.0  # of 46


def test_the_first_heading_is_a_mean_of_noisy_fields(board: Filter) -> None:
    headings = []
    for seed in range(20):
        rng = np.random.default_rng(seed)
        fresh = type(board)()
        run(fresh, [(list(STILL), list(UP), rng.normal(FIELD, 1.0).tolist(), 0.01) for _ in range(12)])
        headings.append(float(np.degrees(at.euler(fresh.quat)[0])))
    assert np.std(headings) < 1.5  # a single field of 20 uT level strength scatters by 2.9 degrees


def test_a_field_held_since_before_the_start_does_not_stay(board: Filter) -> None:
    old, now = at.from_euler(0.5, 0.0, 0.0), at.from_euler(0.0, 0.0, 0.0)
    board.update(STILL, UP, seen(old, FIELD), 0.0)
    run(board, [(list(STILL), list(UP), None, 0.01)] * 11)
    board.update(STILL, UP, seen(now, FIELD), 0.01)
    assert error_deg(board.quat, now) < 0.2
