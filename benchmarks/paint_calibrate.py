"""Cost of one frame of the magnetometer's picture with 5,000 points, against drawing 30 plain polygons in the same run.

Prints one JSON line: medians in ms and their ratios. The limit is 60 frames a second with all that a frame of the page
does: turn the board, move the needle, paint.  Run: python benchmarks/paint_calibrate.py
"""

from __future__ import annotations

import json
import os

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")

import numpy as np
from paint_scene import SIZE, median_ms, new_image, plain_polygons
from PySide6.QtWidgets import QApplication

from imugui.calibration.coverage import CELLS, fibonacci
from imugui.views import theme
from imugui.views.position_scene import PositionScene
from imugui.views.scene3d import Scene3D
from imugui.views.sphere_scene import SphereScene

POINTS = 5000
LIMIT_MS = 1000.0 / 60.0
AXIS = np.array((0.48, 0.6, 0.64))


def turned_ms(scene: Scene3D) -> float:
    """One repaint of a scene whose board turns."""
    scene.resize(SIZE, SIZE)
    image = new_image()

    def draw(i: int) -> None:
        half = 0.01 * i
        scene.set_quat((np.cos(half), *(np.sin(half) * AXIS)))
        if isinstance(scene, SphereScene):
            scene.set_needle(AXIS, fibonacci(CELLS)[i % CELLS])
        scene.render(image)

    return median_ms(draw)


def full_sphere() -> SphereScene:
    """Every other cell filled, 5,000 points, twenty of them outliers."""
    scene = SphereScene()
    cloud = np.random.default_rng(1).normal(size=(POINTS, 3))
    cloud /= np.linalg.norm(cloud, axis=1, keepdims=True)
    scene.set_cells(fibonacci(CELLS), np.arange(CELLS) % 3 / 2.0)
    scene.set_cloud(cloud, 1.2 * cloud[:20])
    return scene


def full_cube() -> PositionScene:
    """A cube with 26 marks."""
    scene = PositionScene()
    scene.set_positions(fibonacci(26), np.arange(26) % 2 == 0, fibonacci(26)[3])
    return scene


def main() -> None:
    """Measure and print."""
    app = QApplication([])
    theme.apply(app, "dark")
    yardstick = plain_polygons()
    cases = {"sphere_5000": turned_ms(full_sphere()), "cube": turned_ms(full_cube())}
    result: dict[str, object] = {"benchmark": "paint_calibrate", "size": SIZE, "polygons_30_ms": round(yardstick, 3)}
    result |= {f"{name}_ms": round(value, 3) for name, value in cases.items()}
    result |= {f"{name}_ratio": round(value / yardstick, 2) for name, value in cases.items()}
    result["ok"] = max(cases.values()) <= LIMIT_MS
    print(json.dumps(result))


if __name__ == "__main__":
    main()
