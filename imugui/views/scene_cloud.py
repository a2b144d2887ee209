"""A point cloud in the scene: small round dots written into one picture by numpy, nearer ones over farther ones."""

from __future__ import annotations

import functools
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PySide6.QtGui import QImage, QPainter

from imugui.views import theme
from imugui.views.geometry import Points
from imugui.views.scene_body import Pose

Colours = NDArray[np.uint8]

_DOT_RADIUS = 2.1  # logical pixels


@dataclass(frozen=True)
class Cloud:
    """Finite points (n, 3) in scene units; colours (n, 3) or None for the accent; turning with the board or not."""

    points: Points = field(default_factory=lambda: np.empty((0, 3)))
    colours: Colours | None = None
    turning: bool = True


def make_cloud(points: Any, colours: Any, turning: bool) -> Cloud:
    """A cloud without the rows that are not finite. Raises ValueError when the shapes do not fit."""
    points = np.asarray(points, dtype=float).reshape(-1, 3)
    good = np.isfinite(points).all(axis=1)
    if colours is None:
        return Cloud(points[good], None, turning)
    colours = np.asarray(colours, dtype=np.uint8)
    if colours.shape != points.shape:
        raise ValueError(f"{len(points)} points need colours of shape {points.shape}, not {colours.shape}")
    return Cloud(points[good], colours[good], turning)


def paint_cloud(painter: QPainter, pose: Pose, cloud: Cloud, near: bool) -> None:
    """The points before the board's centre (``near``), or those behind it."""
    if len(cloud.points) == 0:
        return
    lens = pose.lens
    earth = pose.earth(cloud.points) if cloud.turning else cloud.points
    pixels, depth = lens.camera.project(earth, lens.width, lens.height)
    _, (middle,) = lens.camera.project(np.zeros((1, 3)), lens.width, lens.height)
    chosen = (depth < middle) == near
    accent = theme.palette().accent
    plain = np.array([(accent.red(), accent.green(), accent.blue())], np.uint8)
    colours = np.broadcast_to(plain, earth.shape) if cloud.colours is None else cloud.colours
    strength = _strength(depth)
    ratio = painter.device().devicePixelRatioF()
    order = np.flatnonzero(chosen)[np.argsort(-depth[chosen])]
    size = round(lens.width * ratio), round(lens.height * ratio)
    picture = dots(pixels[order] * ratio, colours[order], strength[order], size, _DOT_RADIUS * ratio)
    height, width = picture.shape
    image = QImage(picture.data, width, height, 4 * width, QImage.Format.Format_ARGB32_Premultiplied)
    image.setDevicePixelRatio(ratio)
    painter.drawImage(0, 0, image)


def dots(
    pixels: Points, colours: Colours, strength: Points, size: tuple[int, int], radius: float
) -> NDArray[np.uint32]:
    """A clear picture (height, width), premultiplied 0xAARRGGBB, with round dots; later ones cover earlier ones.

    ``pixels`` (n, 2), ``size`` (width, height) and ``radius`` are device pixels; ``colours`` (n, 3), 0 to 255;
    ``strength`` (n,) is opacity, 0 to 1. Dots that touch the border are left out.
    """
    width, height = size
    picture = np.zeros(width * height, np.uint32)
    steps, cover = _dot(radius)
    reach = int(np.abs(steps).max())
    spots = np.rint(pixels - 0.5)
    inside = ((spots >= reach) & (spots < np.array((width, height)) - reach)).all(axis=1)
    base = (spots[inside] @ np.array((1, width))).astype(np.intp)
    inks = colours[inside]
    # soft rims first, so that no rim eats into a neighbour's full dot
    for level in np.unique(cover):
        shades = _argb(inks, strength[inside] * level)
        offsets = (steps[cover == level] @ np.array((1, width))).astype(np.intp)
        picture[base[:, None] + offsets] = shades[:, None]  # point by point, so the later one wins
    return picture.reshape(height, width)


@functools.cache
def _dot(radius: float) -> tuple[NDArray[np.intp], Points]:
    """Pixel steps (k, 2) of a round dot and how much of each is covered (k,), in quarters."""
    reach = int(np.ceil(radius))
    steps = np.stack(np.meshgrid(*2 * [np.arange(-reach, reach + 1)]), -1).reshape(-1, 2)
    cover = np.rint(4.0 * np.clip(radius + 0.5 - np.hypot(*steps.T), 0.0, 1.0)) / 4.0
    return steps[cover > 0], cover[cover > 0]


def _strength(depth: Points) -> Points:
    """1 for the nearest point down to 0.4 for the farthest."""
    near, far = float(depth.min()), float(depth.max())
    return 1.0 - 0.6 * (depth - near) / max(far - near, 1e-9)


def _argb(colours: Colours, alpha: Points) -> NDArray[Any]:
    """Premultiplied 0xAARRGGBB (n,) of colours (n, 3) at alpha (n,) from 0 to 1."""
    parts = np.rint(np.column_stack((alpha * 255.0, colours * alpha[:, None]))).astype(np.uint32)
    return parts @ np.array((1 << 24, 1 << 16, 1 << 8, 1), np.uint32)
