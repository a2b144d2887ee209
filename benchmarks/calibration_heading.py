"""What the guided calibration is worth: VQF's heading error before and after, with the seeds' own methods beside it.

A virtual board with all the errors of the MPU-9250's datasheet is calibrated by the guided flows from its own
samples (at rest, twelve positions, a minute of turning over), then used to aim a tool. Prints one JSON line a board
and, with ``--write``, makes docs/calibration.md again.

    python3 run.py bench calibration_heading [--boards 5] [--write]
"""

from __future__ import annotations

import argparse
import json
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

from imugui.calibration.accelerometer_flows import AccelerometerFlow
from imugui.calibration.ellipsoid import Ellipsoid
from imugui.calibration.magnetometer import MagnetometerFlow
from imugui.calibration.rest import RestFlow
from imugui.calibration.seeds import min_max_offset, min_max_scaled
from imugui.fusion import quaternion
from imugui.fusion.correction import Correction
from imugui.fusion.pipeline import Pipeline
from imugui.simulation.board import VirtualBoard
from imugui.simulation.curves import smooth_step
from imugui.simulation.errors import PRESETS
from imugui.simulation.path import Floats
from imugui.simulation.path import Path as Course

RATE_HZ = 100.0
SETTLE = 1000  # rows
WAYS = ((1, 0, 0), (0, 1, 0), (0, 0, 1), (-1, 0, 0), (0, -1, 0), (0, 0, -1), (1, 1, 0), (0, 1, 1), (1, 0, 1),
        (-1, 1, 0), (0, -1, 1), (1, 0, -1))  # fmt: skip
METHODS = ("uncalibrated", "guided", "min/max (seed 001)", "min/max offset (seed 002)")
PAGE = Path(__file__).resolve().parent.parent / "docs" / "calibration.md"


class Held(Course):
    """Held three seconds in each of twelve attitudes, a hand's ten degrees off, turned in between."""

    def __init__(self, seed: int) -> None:
        rng = np.random.default_rng(seed)
        ups = [np.array(way) / np.linalg.norm(way) + 0.1 * rng.normal(size=3) for way in WAYS]
        self.goals = np.array([_with_up(up, rng.uniform(-3.0, 3.0)) for up in ups])

    def quats(self, t: Floats) -> Floats:
        """Attitude (n, 4) at times t (n,) in s."""
        leg, within = np.divmod(np.maximum(t, 0.0), 5.0)
        here = self.goals[leg.astype(int) % len(self.goals)]
        there = self.goals[(leg.astype(int) + 1) % len(self.goals)]
        turn = quaternion.to_rotation_vector(quaternion.multiply(quaternion.conjugate(here), there))
        share = smooth_step((within - 3.0) / 2.0)[:, None]
        return quaternion.multiply(here, quaternion.from_rotation_vector(share * turn))


def _with_up(up: Floats, yaw: float) -> Floats:
    """An attitude (4,) in which the sensor's direction ``up`` (3,) points up."""
    up = up / np.linalg.norm(up)
    axis = np.cross(up, (0.0, 0.0, 1.0))
    angle = np.arctan2(np.linalg.norm(axis), up[2])
    level = quaternion.from_rotation_vector(axis / max(np.linalg.norm(axis), 1e-9) * angle)
    return quaternion.multiply(quaternion.from_rotation_vector(np.array([0.0, 0.0, yaw])), level)


def calibrate(seed: int) -> dict[str, Correction]:
    """The corrections of each method for one board; RuntimeError when a flow refuses it."""
    errors = PRESETS["mpu9250"]
    rest, held = RestFlow(), AccelerometerFlow("many")
    rest.feed(VirtualBoard("rest", RATE_HZ, errors, seed).rows(1500))
    held.feed(VirtualBoard(Held(seed), RATE_HZ, errors, seed).rows(6000))
    bias, level = rest.result(), held.result()
    before = Correction(gyr_bias=bias.bias, acc_bias=level.bias, acc_matrix=level.matrix)
    turned = VirtualBoard("free", RATE_HZ, errors, seed).rows(7000)
    flow = MagnetometerFlow(before=before)
    for start in range(0, len(turned), 100):
        flow.feed(turned[start : start + 100])
    found = flow.result()
    for result in (bias, level, found):
        if not result.accepted:
            raise RuntimeError(f"board {seed}: {result.reason}")
    points = turned["mag"]
    seeds = {METHODS[2]: min_max_scaled(points), METHODS[3]: min_max_offset(points)}
    others = {name: _with_field(before, fit) for name, fit in seeds.items()}
    return {METHODS[0]: Correction(), METHODS[1]: found.correction(before), **others}


def _with_field(before: Correction, fit: Ellipsoid) -> Correction:
    """A seed's method, scaled to uT so that its field looks like the earth's to the filter."""
    scale = 48.0 / fit.radius * fit.matrix if abs(fit.radius - 1.0) < 1e-6 else fit.matrix
    return replace(before, mag_bias=tuple(fit.bias.tolist()), mag_matrix=tuple(map(tuple, scale.tolist())))


def heading_rms_deg(correction: Correction, seed: int) -> float:
    """RMS heading error of VQF while a tool is aimed, degrees."""
    board = VirtualBoard("aiming", RATE_HZ, PRESETS["mpu9250"], seed)
    rows = board.rows(6000)
    error = quaternion.multiply(
        Pipeline("vqf", correction=correction).step(rows)["quat"], quaternion.conjugate(board.truth)
    )
    heading = 2.0 * np.degrees(np.arctan2(error[:, 3], error[:, 0]))
    wrapped = (heading[SETTLE:] + 180.0) % 360.0 - 180.0
    return float(np.sqrt(np.mean(wrapped**2)))


def page(figures: list[dict[str, float]]) -> str:
    """docs/calibration.md."""
    lines = ["# What calibration is worth", "", (__doc__ or "").split("\n\n")[1].replace("\n", " "), ""]
    lines += ["VQF's heading error while aiming, degrees RMS; the seeds' methods on the same turning, with the",
              "same gyroscope and accelerometer calibration.", ""]  # fmt: skip
    lines += ["| board | " + " | ".join(METHODS) + " |", "|---" * (len(METHODS) + 1) + "|"]
    for number, figure in enumerate(figures, 1):
        lines.append(f"| {number} | " + " | ".join(f"{figure[name]:.2f}" for name in METHODS) + " |")
    lines += ["", "Made by `python3 run.py bench calibration_heading --write`.", ""]
    return "\n".join(lines)


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--boards", type=int, default=5)
    arguments.add_argument("--write", action="store_true")
    chosen = arguments.parse_args()
    figures = []
    for seed in range(1, chosen.boards + 1):
        corrections = calibrate(seed)
        figures.append({name: heading_rms_deg(one, seed) for name, one in corrections.items()})
        ratio = figures[-1]["guided"] / figures[-1]["uncalibrated"]
        print(json.dumps({"benchmark": "calibration_heading", "board": seed, **figures[-1], "ratio": ratio}))
    if chosen.write:
        _, mark, learnt = PAGE.read_text(encoding="utf-8").partition("\n## ")  # calibration_learnt makes that part
        PAGE.write_text(page(figures) + mark + learnt, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
