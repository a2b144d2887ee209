"""What keeping is worth that the imugui filter has learnt: when it may be kept, how true it is, and VQF with it.

Virtual boards with calibrated accelerometers, most of them with gyroscopes of 3 % and 1 degree, are moved for two
minutes; what was learnt is kept as soon as that is allowed. Prints one JSON line for each kind of board and motion
and, with ``--write``, makes the second part of docs/calibration.md again.

    python3 run.py bench calibration_learnt [--boards 5] [--write]
"""

from __future__ import annotations

import argparse
import json
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

from imugui.calibration.learnt import kept_part
from imugui.calibration.parts import GyroscopePart
from imugui.calibration.profile import Profile
from imugui.fusion import quaternion
from imugui.fusion.pipeline import Pipeline
from imugui.ring import Ring
from imugui.samples import ATTITUDE, SAMPLE
from imugui.simulation.board import VirtualBoard
from imugui.simulation.curves import Wander, smooth_step
from imugui.simulation.errors import PRESETS
from imugui.simulation.path import Floats
from imugui.simulation.path import Path as Course
from imugui.workers.fusion_worker import FusionWorker
from imugui.workers.learning import Learning

RATE_HZ, PIECE_S, LONGEST_S = 100.0, 5.0, 120.0
GOOD = PRESETS["mpu9250-calibrated"]
BOARDS = {
    "3 %, 1 deg": replace(GOOD, gyr_scale_percent=3.0, gyr_cross_percent=1.75),
    "3 %, 1 deg, iron at the magnetometer": replace(
        GOOD, gyr_scale_percent=3.0, gyr_cross_percent=1.75, mag_hard_ut=30.0, mag_soft_percent=10.0
    ),
    "calibrated, 0.3 %": GOOD,
}
WORDS = """\
The imugui filter learns scale and cross-axis terms of its gyroscope while it runs. The Live page shows them above the
filter's parameters, and a button there takes them into the board's profile, where every filter has them. Nothing is
kept by itself.

Rates reach the filter as K (w - b0), with K and b0 from the profile, and it turns by (1 + M) K (w - b0) - b. So the
profile's K becomes (1 + M) K, and b0 becomes b0 + K^-1 b with the new K; a mounting is turned out before. A bias that
was measured at rest within the hour, and is better known, stays. The filter begins from there as it always does: with
M = 0 give or take 0.4 %, and widens that where it is contradicted.

The button says why it refuses:

- less than 20 s were seen, or the worst known element has a sigma above 0.40 %, or above 75 % of what it had at first,
  or that may still hold what was learnt back by more than 0.3 %;
- VQF has taken over, a sensor has reached the end of its range, or the values are no gyroscope's;
- the accelerometer is not calibrated, or leaves more than 0.5 deg: with 2 % of cross-axis terms of its own, up to 1.4 %
  were missing in what was learnt of the gyroscope;
- the profile's scale is as well known, and neither a year old, nor from 10 K away, nor contradicted;
- no bias is known, and the filter's is not either: the board has to lie still for a moment.

The sigma is on the safe side: of nine elements the worst is within it in most cases."""
HEAD = (
    "| gyroscope | motion | kept | after s | worst element before | after | rms of elements | VQF deg before | after |"
)
MARK = "\n## "
PAGE = Path(__file__).resolve().parent.parent / "docs" / "calibration.md"


class Swung(Course):
    """A hand turns it to and fro about all axes: ``amplitude`` deg rms below ``fastest`` Hz."""

    def __init__(self, seed: int, amplitude: float, fastest: float) -> None:
        self._turned = Wander(np.random.default_rng(seed), 0.1, fastest, np.radians(amplitude))

    def quats(self, t: Floats) -> Floats:
        """Attitude (n, 4) at times t (n,) in s."""
        return quaternion.from_rotation_vector(smooth_step((t - 1.5) / 2.0)[:, None] * self._turned(t))


class OneAxis(Course):
    """Turned to and fro about one axis, as on a turntable."""

    def quats(self, t: Floats) -> Floats:
        """Attitude (n, 4) at times t (n,) in s."""
        angle = smooth_step((t - 1.5) / 2.0) * 4.0 * np.sin(0.4 * t)
        return quaternion.from_rotation_vector(angle[:, None] * np.array([0.0, 0.0, 1.0]))


MOTIONS = {
    "to all sides": lambda _: "free",
    "swung by 60 deg": lambda seed: Swung(seed, 60.0, 1.2),
    "swung by 10 deg": lambda seed: Swung(seed, 10.0, 0.8),
    "about one axis": lambda _: OneAxis(),
    "aiming": lambda _: "aiming",
    "at rest": lambda _: "rest",
}


def learn(board: VirtualBoard) -> tuple[float, GyroscopePart | None]:
    """Seconds until what was learnt could be kept, and the part; None when it never could."""
    samples, attitude = Ring(SAMPLE, 1 << 14), Ring(ATTITUDE, 1 << 14)
    worker = FusionWorker(samples, attitude, Pipeline("imugui"))
    learning = Learning(worker)
    learning.watch(attitude.last(0), 0.0)
    count = round(PIECE_S * RATE_HZ)
    for number in range(1, round(LONGEST_S / PIECE_S) + 1):
        samples.push(board.rows(count))
        worker.drain()
        learning.watch(attitude.last(count), float(number))
        worker.drain()
        found = learning.learnt(Profile(), factory=True)
        if found is not None and not found.refusal:
            return number * PIECE_S, kept_part(found)
    return LONGEST_S, None


def vqf_deg(board: VirtualBoard, profile: Profile) -> float:
    """RMS error of VQF over another 30 s of turning to all sides, degrees."""
    again = VirtualBoard("free", RATE_HZ, board.errors, 1)
    again.sensors = board.sensors
    rows = again.rows(3000)
    quats = Pipeline("vqf", correction=profile.correction()).step(rows)["quat"]
    return float(np.degrees(np.sqrt((quaternion.angle_between(quats, again.truth)[500:] ** 2).mean())))


def figures(errors_name: str, motion: str, boards: int) -> dict[str, object]:
    """What came out for so many boards: medians, and the worst after keeping."""
    rows, kept = [], 0
    for seed in range(1, boards + 1):
        board = VirtualBoard(MOTIONS[motion](seed), RATE_HZ, BOARDS[errors_name], seed)
        seconds, part = learn(board)
        if part is None:
            continue
        kept += 1
        truth = board.sensors.gyr.matrix
        left = 100.0 * (np.array(part.matrix) @ truth - np.eye(3))
        before = 100.0 * float(np.abs(truth - np.eye(3)).max())
        rested = Profile(gyroscope=GyroscopePart("at rest", part.date, bias=part.bias))
        vqf = vqf_deg(board, rested), vqf_deg(board, Profile(gyroscope=part))
        rows.append((seconds, before, float(np.abs(left).max()), float(np.sqrt((left**2).mean())), *vqf))
    named = dict(zip(("seconds", "before", "after", "rms", "vqf_before", "vqf"), np.transpose(rows), strict=False))
    medians = {name: float(np.median(values)) for name, values in named.items()}
    worst = {"worst": float(named["after"].max())} if kept else {}
    return {"board": errors_name, "motion": motion, "boards": boards, "kept": kept, **medians, **worst}


def section(found: list[dict[str, object]]) -> str:
    """The second part of docs/calibration.md."""
    about = (__doc__ or "").split("\n\n")[1].partition("Prints")[0].replace("\n", " ").strip()
    lines = [f"{MARK}Learnt in motion, and kept", "", WORDS, "", about, ""]
    lines += ["Medians over the boards that allowed it; in brackets the worst. Elements in per cent.", ""]
    lines += [HEAD, "|---" * (HEAD.count("|") - 1) + "|"]
    for one in found:
        start = f"| {one['board']} | {one['motion']} | {one['kept']} of {one['boards']} | "
        cells = "refused | | | | | |" if not one["kept"] else (
            f"{one['seconds']:.0f} | {one['before']:.2f} | {one['after']:.2f} ({one['worst']:.2f}) | "
            f"{one['rms']:.2f} | {one['vqf_before']:.2f} | {one['vqf']:.2f} |"
        )  # fmt: skip
        lines.append(start + cells)
    return "\n".join([*lines, "", "Made by `python3 run.py bench calibration_learnt --write`.", ""])


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--boards", type=int, default=5)
    arguments.add_argument("--write", action="store_true")
    chosen = arguments.parse_args()
    found = []
    for errors_name in BOARDS:
        for motion in MOTIONS:
            found.append(figures(errors_name, motion, chosen.boards))
            print(json.dumps({"benchmark": "calibration_learnt", **found[-1]}), flush=True)
    if chosen.write:
        PAGE.write_text(PAGE.read_text(encoding="utf-8").partition(MARK)[0] + section(found), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
