"""Which directions of the field have been seen, which have not, and which samples are worth keeping."""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from imugui.calibration.ellipsoid import Floats

CELLS = 100
GRID = 600
"""Directions among which the largest gap is searched: about 8 degrees apart."""

PER_CELL = 5
NEAREST = 0.08
"""Least distance between kept samples as a share of the radius: 4.6 degrees."""


@cache
def fibonacci(count: int) -> Floats:
    """Unit vectors (count, 3), each the middle of an equal area of the sphere (the golden spiral)."""
    index = np.arange(count) + 0.5
    up = 1.0 - 2.0 * index / count
    level = np.sqrt(1.0 - up * up)
    turn = np.pi * (1.0 + np.sqrt(5.0)) * index
    directions: Floats = np.column_stack((level * np.cos(turn), level * np.sin(turn), up))
    directions.setflags(write=False)
    return directions


def directions_from(centre: ArrayLike, points: ArrayLike) -> Floats:
    """Unit vectors (n, 3) from the centre to raw points; unscaled, or a flat fit would inflate its own coverage."""
    away = np.asarray(points, float) - np.asarray(centre, float)
    return np.asarray(away / np.maximum(np.linalg.norm(away, axis=1, keepdims=True), 1e-12))


def cells_of(directions: Floats) -> NDArray[np.int64]:
    """The number of the cell, 0 to CELLS - 1, of each unit vector (n, 3)."""
    return np.asarray((directions @ fibonacci(CELLS).T).argmax(axis=1), np.int64)


def coverage(directions: Floats) -> float:
    """Share of the cells in which there is a direction, 0 to 1."""
    return len(np.unique(cells_of(directions))) / CELLS if len(directions) else 0.0


def largest_gap(directions: Floats) -> tuple[Floats, float]:
    """The direction (3,) farthest from all given ones (n, 3), and how far that is in degrees."""
    grid = fibonacci(GRID)
    if not len(directions):
        return grid[0], 180.0
    nearest = (grid @ directions.T).max(axis=1)
    worst = int(nearest.argmin())
    return grid[worst], float(np.degrees(np.arccos(np.clip(nearest[worst], -1.0, 1.0))))


def planarity(directions: Floats) -> float:
    """Smallest over largest eigenvalue of the directions' scatter: 1 for a sphere, 0 for a ring (n, 3)."""
    if len(directions) < 3:
        return 0.0
    values = np.linalg.eigvalsh(np.cov(directions.T))
    return float(max(values[0], 0.0) / max(values[-1], 1e-12))


class CellBuffer:
    """The samples worth keeping: never two close together, at most five per direction cell; the newest win.

    Closeness is measured in the sensor's unit, ``NEAREST`` of the radius, so that it needs no centre: a board that is
    held still only renews what it has. ``centre`` and ``radius`` are the caller's best guess; see ``recentre``.
    """

    def __init__(self, radius: float, per_cell: int = PER_CELL) -> None:
        self.radius, self.per_cell = radius, per_cell
        self.centre: Floats | None = None
        self.points: Floats = np.zeros((0, 3))  # oldest first
        self.times: Floats = np.zeros(0)  # s

    def __len__(self) -> int:
        return len(self.points)

    def add(self, point: ArrayLike, t: float = 0.0) -> bool:
        """Take one raw sample (3,); True when it is somewhere new, False when it only renews a neighbour."""
        point = np.asarray(point, float)
        away = ((self.points - point) ** 2).sum(axis=1)
        near = away < (NEAREST * self.radius) ** 2
        self._keep(~near)
        self.points = np.concatenate((self.points, point[None]))
        self.times = np.append(self.times, t)
        return not bool(near.any())

    def recentre(self, centre: ArrayLike, radius: float) -> None:
        """Sort by the cells seen from this centre, and drop what is too much or, by the radius, too close."""
        self.centre, self.radius = np.asarray(centre, float), float(radius)
        cells = cells_of(directions_from(self.centre, self.points))
        self._keep(newest_of_each(cells, self.per_cell))

    def _keep(self, chosen: NDArray[np.bool_]) -> None:
        if not chosen.all():
            self.points, self.times = self.points[chosen], self.times[chosen]


def newest_of_each(cells: NDArray[np.int64], most: int) -> NDArray[np.bool_]:
    """Which of the samples, oldest first, are among the newest ``most`` of their cell (n,)."""
    order = np.argsort(cells[::-1], kind="stable")
    grouped = cells[::-1][order]
    starts = np.searchsorted(grouped, grouped)
    chosen = np.zeros(len(cells), bool)
    chosen[len(cells) - 1 - order[np.arange(len(cells)) - starts < most]] = True
    return chosen
