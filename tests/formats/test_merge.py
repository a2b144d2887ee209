"""Tables with clocks of their own on the gyroscope's times."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from imugui.formats.merge import Part, hold, merge, nearest
from imugui.samples import NO_STATUS, SAMPLE, Rows, empty_rows


def part(name: str, t: NDArray[np.float64], value: NDArray[np.float64], force: str = "") -> Part:
    rows = empty_rows(SAMPLE, len(t))
    rows["t"], rows[name] = t, value
    return Part(rows, force)


def vectors(t: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.column_stack([t, -t, t * 10])


GYR = np.arange(0.0, 1.0, 0.01)
ACC = np.arange(0.003, 0.9, 0.01)
MAG = np.arange(0.1, 0.8, 0.07)


def test_everything_is_brought_to_the_gyroscopes_times() -> None:
    parts = [
        part("mag", MAG, vectors(MAG)),
        part("acc", ACC, vectors(ACC), "total"),
        part("gyr", GYR, vectors(GYR)),
        part("temp_c", np.array([0.0, 0.5]), np.array([20.0, 21.0])),
    ]
    rows = merge(parts)
    assert rows["t"].tolist() == GYR[: len(rows)].tolist()
    assert rows["gyr"] == pytest.approx(vectors(rows["t"]))
    assert np.abs(rows["acc"][:, 0] - rows["t"]).max() <= 0.0071  # the nearest, not a mixture
    assert set(rows["acc"][:, 0]) <= set(ACC)
    assert len(rows) == 91  # the accelerometer ended at 0.893 s
    assert rows["temp_c"].tolist()[48:52] == [20.0, 20.0, 21.0, 21.0]
    assert (rows["status"] == NO_STATUS).all()


def test_the_magnetometer_is_held_bit_for_bit_until_the_next_value() -> None:
    values = np.random.default_rng(3).normal(size=(len(MAG), 3))
    rows = merge([part("gyr", GYR, vectors(GYR)), part("mag", MAG, values)])
    known = rows[rows["t"] >= MAG[0]]
    assert np.isnan(rows["mag"][rows["t"] < MAG[0]]).all()
    assert {tuple(value) for value in known["mag"].tolist()} == {tuple(value) for value in values.tolist()}
    assert (np.diff(known["mag"], axis=0) != 0).any(axis=1).sum() == len(MAG) - 1


def test_the_parts_of_the_acceleration_are_added_where_there_is_no_whole() -> None:
    linear, gravity = part("acc", ACC, vectors(ACC), "linear"), part("acc", ACC, np.full((len(ACC), 3), 5.0), "gravity")
    rows = merge([part("gyr", GYR, vectors(GYR)), linear, gravity])
    assert rows["acc"][10] == pytest.approx(vectors(ACC)[10] + 5.0)
    whole = part("acc", ACC, np.full((len(ACC), 3), 7.0), "total")
    assert (merge([part("gyr", GYR, vectors(GYR)), linear, gravity, whole])["acc"] == 7.0).all()
    assert len(merge([part("gyr", GYR, vectors(GYR)), linear])) == 0


def test_without_a_gyroscope_the_next_sensor_sets_the_times() -> None:
    assert (
        merge([part("mag", MAG, vectors(MAG)), part("acc", ACC, vectors(ACC), "total")])["t"].tolist() == ACC.tolist()
    )
    assert merge([part("mag", MAG, vectors(MAG)), part("temp_c", ACC, ACC)])["t"].tolist() == MAG.tolist()
    assert len(merge([part("temp_c", ACC, ACC), part("temp_c", MAG, MAG)])) == 0


def test_times_in_disorder_are_sorted_when_tables_are_joined() -> None:
    shuffled = np.random.default_rng(5).permutation(GYR)
    rows = merge([part("gyr", shuffled, vectors(shuffled)), part("mag", MAG, vectors(MAG))])
    assert rows["t"].tolist() == GYR.tolist()
    assert rows["gyr"] == pytest.approx(vectors(GYR))


def test_one_whole_table_is_left_as_it_is() -> None:
    rows: Rows = empty_rows(SAMPLE, 4)
    rows["t"], rows["gyr"], rows["acc"] = (0.3, 0.1, 0.2, 0.0), 1.0, 2.0
    assert merge([Part(rows, "total")]) is rows


def test_hold_and_nearest_at_the_ends() -> None:
    times, values = np.array([1.0, 2.0]), np.array([[1.0] * 3, [2.0] * 3])
    assert np.isnan(hold(np.array([0.5]), times, values)).all()
    assert hold(np.array([1.0, 1.9, 9.0]), times, values)[:, 0].tolist() == [1.0, 1.0, 2.0]
    assert nearest(np.array([0.0, 1.4, 1.6, 3.4]), times, values)[:, 0].tolist() == [1.0, 1.0, 2.0, 2.0]
    assert np.isnan(nearest(np.array([-0.6, 3.6]), times, values)).all()
    assert nearest(np.array([5.0]), times[:1], values[:1])[:, 0].tolist() == [1.0]
