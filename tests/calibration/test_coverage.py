"""Cells, gaps and the buffer of samples worth keeping."""

from __future__ import annotations

import numpy as np
import pytest

from imugui.calibration.coverage import (
    CELLS,
    NEAREST,
    PER_CELL,
    CellBuffer,
    cells_of,
    coverage,
    fibonacci,
    largest_gap,
    newest_of_each,
    planarity,
)


def random_directions(count: int, seed: int = 0) -> np.ndarray:
    v = np.random.default_rng(seed).normal(size=(count, 3))
    return v / np.linalg.norm(v, axis=1, keepdims=True)


def test_cells_have_equal_areas() -> None:
    counts = np.bincount(cells_of(random_directions(100_000)), minlength=CELLS)
    assert counts.min() > 850
    assert counts.max() < 1150


def test_coverage_counts_cells() -> None:
    assert coverage(fibonacci(CELLS)) == 1.0
    assert coverage(fibonacci(CELLS)[:37]) == pytest.approx(0.37)
    assert coverage(np.zeros((0, 3))) == 0.0


def test_the_largest_gap_is_opposite_to_a_cap() -> None:
    up = random_directions(5000)
    up = up[up[:, 2] > 0.0]
    direction, angle = largest_gap(up)
    assert direction[2] < -0.97
    assert 80 < angle <= 92
    assert largest_gap(np.zeros((0, 3)))[1] == 180.0


def test_a_ring_is_planar_and_a_sphere_is_not() -> None:
    t = np.linspace(0, 6.28, 100)
    assert planarity(np.column_stack((np.cos(t), np.sin(t), 0 * t))) < 1e-6
    assert planarity(fibonacci(500)) > 0.95
    assert planarity(np.zeros((2, 3))) == 0.0


def test_kept_samples_are_apart_and_the_newest_wins() -> None:
    buffer = CellBuffer(50.0)
    assert buffer.add((50.0, 0.0, 0.0), 1.0)
    assert not buffer.add((50.0, 1.0, 0.0), 2.0)
    assert len(buffer) == 1
    assert buffer.times[0] == 2.0
    assert buffer.add((0.0, 50.0, 0.0), 3.0)
    for point in 50.0 * random_directions(4000):
        buffer.add(point)
    apart = np.linalg.norm(buffer.points[:, None] - buffer.points[None], axis=2) + 1e9 * np.eye(len(buffer))
    assert apart.min() >= NEAREST * 50.0


def test_each_cell_keeps_its_newest() -> None:
    buffer = CellBuffer(50.0)
    for t, point in enumerate(50.0 * random_directions(4000) + 20.0):
        buffer.add(point, float(t))
    buffer.recentre((20.0, 20.0, 20.0), 50.0)
    counts = np.bincount(cells_of((buffer.points - 20.0) / 50.0), minlength=CELLS)
    assert counts.max() == PER_CELL
    assert counts.min() >= 3
    assert (np.diff(buffer.times) > 0).all()


def test_the_newest_of_each_cell_are_chosen() -> None:
    cells = np.array([4, 7, 4, 4, 7, 9])
    assert newest_of_each(cells, 2).tolist() == [False, True, True, True, True, True]
    assert newest_of_each(np.zeros(0, int), 2).tolist() == []
