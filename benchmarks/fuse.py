"""Replay file to file of one hour at 200 Hz, against a bare script with numpy and the filter library's batch call.

Both are fresh processes: `imugui replay FILE --filter vqf --out OUT`, which finds format and units, checks every row,
follows the times and writes ten columns; and a script that knows the file's columns and writes time and quaternion.

    python3 run.py bench fuse [--seconds 3600] [--rounds 3]
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from _measure import children_s, interleaved, line

from imugui.recording import write_samples
from imugui.simulation.board import VirtualBoard
from imugui.simulation.errors import PRESETS

WANTED = 0.8
RATE_HZ = 200.0
PIECE_S = 60.0

BARE = """
import sys
import numpy as np
from vqf import VQF
table = np.loadtxt(sys.argv[1], delimiter=",", skiprows=2, usecols=range(10))
acc, gyr, mag = (np.ascontiguousarray(table[:, k : k + 3]) for k in (1, 4, 7))
quat = VQF(1.0 / 200.0).updateBatch(gyr, acc, mag)["quat9D"]
np.savetxt(sys.argv[2], np.column_stack((table[:, 0], quat)), fmt="%.6f,%.9f,%.9f,%.9f,%.9f", header="t,qw,qx,qy,qz")
"""


def make(path: Path, seconds: float) -> None:
    """A sample CSV of the virtual board in the hand."""
    board = VirtualBoard("free", RATE_HZ, PRESETS["mpu9250-calibrated"], 1)
    pieces = [board.rows(int(RATE_HZ * PIECE_S)) for _ in range(max(1, round(seconds / PIECE_S)))]
    write_samples(path, np.concatenate(pieces), {"made by": "benchmarks/fuse.py"})


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--seconds", type=float, default=3600.0)
    arguments.add_argument("--rounds", type=int, default=3)
    chosen = arguments.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        source, bare_out, out = (Path(folder) / name for name in ("samples.csv", "bare.csv", "out.csv"))
        make(source, chosen.seconds)
        replay = ["-m", "imugui", "replay", str(source), "--filter", "vqf", "--out", str(out)]
        commands = {"bare": ["-c", BARE, str(source), str(bare_out)], "imugui": replay}

        def job(name: str) -> None:
            subprocess.run([sys.executable, *commands[name]], check=True, capture_output=True)

        jobs = {name: lambda name=name: job(name) for name in commands}  # type: ignore[misc]
        seconds = interleaved(jobs, chosen.rounds, children_s)
        rows = round(chosen.seconds * RATE_HZ)
        apart_deg = largest_difference_deg(bare_out, out)
    more = {f"{name}_s": round(taken, 2) for name, taken in seconds.items()} | {"rows": rows}
    ratio = seconds["bare"] / seconds["imugui"]
    line("fuse", "one hour at 200 Hz, file to file", ratio, WANTED, True, **more, largest_difference_deg=apart_deg)
    return 0


def largest_difference_deg(bare: Path, ours: Path) -> float:
    """The largest angle between the two attitudes after the first minute, deg."""
    a = np.loadtxt(bare, delimiter=",", usecols=range(1, 5))[12_000:]
    b = np.loadtxt(ours, delimiter=",", usecols=range(1, 5), comments=("#", "t"))[12_000:]
    cosine = np.clip(np.abs((a * b).sum(axis=1)), 0.0, 1.0)
    return round(float(np.degrees(2.0 * np.arccos(cosine.min(initial=1.0)))), 4)


if __name__ == "__main__":
    sys.exit(main())
