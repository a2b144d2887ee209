"""Paint cost of the 3D scene at 600 x 600, against drawing 30 plain polygons in the same run.

Prints one JSON line: medians in ms and their ratios. Limits are those of DESIGN.md section 7: 4 ms for the cube
scene, 8 ms with 5,000 points.  Run: python benchmarks/paint_scene.py
"""

from __future__ import annotations

import json
import os
import statistics
import time
from collections.abc import Callable

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")

import numpy as np
from PySide6.QtCore import QPointF
from PySide6.QtGui import QColor, QImage, QPainter, QPolygonF
from PySide6.QtWidgets import QApplication

from imugui.views import theme
from imugui.views.scene3d import Scene3D

SIZE = 600
ROUNDS = 300


def median_ms(draw: Callable[[int], None]) -> float:
    """Median processor time of one call of ``draw(round)``, after a warm-up."""
    times = []
    for i in range(ROUNDS + 10):
        start = time.thread_time()
        draw(i)
        times.append(1e3 * (time.thread_time() - start))
    return statistics.median(times[10:])


def new_image() -> QImage:
    """A picture like the window's: 600 x 600, opaque."""
    return QImage(SIZE, SIZE, QImage.Format.Format_RGB32)


def plain_polygons() -> float:
    """30 filled quadrilaterals of the size of a board's face, smooth edges: the yardstick."""
    image = new_image()
    shapes = [
        QPolygonF([QPointF(100 + i, 150 + 2 * i), QPointF(340 + i, 120), QPointF(400, 330 + i), QPointF(140, 380)])
        for i in range(30)
    ]

    def draw(_: int) -> None:
        painter = QPainter(image)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        for i, shape in enumerate(shapes):
            painter.setBrush(QColor(8 * i, 100, 150))
            painter.drawPolygon(shape)
        painter.end()

    return median_ms(draw)


def scene_ms(turning: bool = False, orbiting: bool = False, points: int = 0) -> float:
    """Cost of one repaint of the whole scene."""
    scene = Scene3D()
    scene.resize(SIZE, SIZE)
    if points:
        cloud = np.random.default_rng(1).normal(size=(points, 3))
        scene.set_points(cloud / np.linalg.norm(cloud, axis=1, keepdims=True))
    image = new_image()
    axis = np.array((0.48, 0.6, 0.64))

    def draw(i: int) -> None:
        if turning or points:
            half = 0.01 * i
            scene.set_quat((np.cos(half), *(np.sin(half) * axis)))
        if orbiting:
            scene.orbit(0.02, 0.0)
        scene.render(image)

    return median_ms(draw)


def main() -> None:
    """Measure and print."""
    app = QApplication([])
    theme.apply(app, "dark")
    yardstick = plain_polygons()
    cases = {
        "still": scene_ms(),
        "turning": scene_ms(turning=True),
        "points_5000": scene_ms(points=5000),
        "orbiting": scene_ms(orbiting=True),
    }
    result = {"benchmark": "paint_scene", "size": SIZE, "polygons_30_ms": round(yardstick, 3)}
    result |= {f"{name}_ms": round(value, 3) for name, value in cases.items()}
    result |= {f"{name}_ratio": round(value / yardstick, 2) for name, value in cases.items()}
    result["ok"] = max(cases["still"], cases["turning"]) <= 4.0 and cases["points_5000"] <= 8.0
    print(json.dumps(result))


if __name__ == "__main__":
    main()
