"""Pure projection maths of the 3D scene: a perspective camera that orbits the board, and a convex hull.

Scene units: the drawn axes are one unit long. Earth frame: x east, y north, z up.
"""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.float64]

AIM = np.array((0.0, 0.0, -0.2))
"""Where cameras look: a little below the board's centre, so that the ground has room."""
_Y_DOWN = np.array((1.0, -1.0))
NEAREST = 2.4
FARTHEST = 14.0
LOWEST = math.radians(-89.0)
HIGHEST = math.radians(90.0)


@dataclass(frozen=True)
class Camera:
    """Looks at AIM from ``azimuth`` (rad, counter-clockwise from east), ``elevation`` (rad) and ``distance``."""

    azimuth: float = math.radians(-47.0)
    elevation: float = math.radians(22.0)
    distance: float = 6.0
    field_of_view: float = math.radians(28.0)

    @functools.cached_property
    def position(self) -> Points:
        """Where the camera is, shape (3,), earth frame."""
        flat = math.cos(self.elevation)
        direction = (math.cos(self.azimuth) * flat, math.sin(self.azimuth) * flat, math.sin(self.elevation))
        return AIM + self.distance * np.array(direction)

    @functools.cached_property
    def basis(self) -> Points:
        """Rows right, up and towards the camera, shape (3, 3): the rotation earth -> camera."""
        ca, sa = math.cos(self.azimuth), math.sin(self.azimuth)
        ce, se = math.cos(self.elevation), math.sin(self.elevation)
        return np.array([(-sa, ca, 0.0), (-ca * se, -sa * se, ce), (ca * ce, sa * ce, se)])

    def focal(self, width: float, height: float) -> float:
        """Pixels per unit at distance one; the smaller side of the picture spans the field of view."""
        return min(width, height) / (2.0 * math.tan(self.field_of_view / 2.0))

    def project(self, points: Points, width: float, height: float) -> tuple[Points, Points]:
        """Earth points (n, 3) to pixels (n, 2), y down, and their distance (n,) along the line of sight.

        Points behind the camera are held just in front of it, so that nothing divides by zero.
        """
        seen = (points - AIM) @ self.basis.T
        depth = np.maximum(self.distance - seen[:, 2], 1e-3)
        scale = self.focal(width, height) / depth
        return (width / 2.0, height / 2.0) + seen[:, :2] * (scale[:, None] * _Y_DOWN), depth

    def orbited(self, right: float, up: float) -> Camera:
        """The camera moved around its aim by angles in rad; it stops above the pole and below the ground."""
        azimuth = math.remainder(self.azimuth + right, 2.0 * math.pi)
        return replace(self, azimuth=azimuth, elevation=min(HIGHEST, max(LOWEST, self.elevation + up)))

    def zoomed(self, factor: float) -> Camera:
        """The camera at ``factor`` times the distance, within bounds."""
        return replace(self, distance=min(FARTHEST, max(NEAREST, self.distance * factor)))


_ANGLES_DEG = {"x": (0.0, 0.0), "y": (90.0, 0.0), "z": (-90.0, 90.0)}
VIEWS = ("default", *_ANGLES_DEG)


def camera_from(view: str) -> Camera:
    """The camera on the earth's x, y or z axis, or the "default" one. Raises KeyError on other names."""
    if view == "default":
        return Camera()
    azimuth_deg, elevation_deg = _ANGLES_DEG[view]
    return Camera(math.radians(azimuth_deg), math.radians(elevation_deg), distance=6.7)


def unit_quat(values: object) -> tuple[float, float, float, float] | None:
    """Four numbers scaled to length one, or None when they are no rotation (NaN, zero, wrong count)."""
    quat = np.asarray(values, dtype=float).ravel()
    norm = float(np.linalg.norm(quat)) if quat.shape == (4,) else math.nan
    if not math.isfinite(norm) or norm < 1e-6:
        return None
    w, x, y, z = (float(value) / norm for value in quat)
    return w, x, y, z


def hull(points: Points) -> Points:
    """Corners (m, 2) of the convex hull of points (n, 2), by Andrew's monotone chain (1979)."""
    ordered = sorted({(x, y) for x, y in points.tolist()})
    if len(ordered) < 3:
        return np.array(ordered)
    return np.array(_half_hull(ordered)[:-1] + _half_hull(ordered[::-1])[:-1])


def _half_hull(ordered: list[tuple[float, float]]) -> list[tuple[float, float]]:
    chain: list[tuple[float, float]] = []
    for x, y in ordered:
        while len(chain) >= 2:
            (ax, ay), (bx, by) = chain[-2], chain[-1]
            if (bx - ax) * (y - ay) - (by - ay) * (x - ax) > 0:
                break
            chain.pop()
        chain.append((x, y))
    return chain
