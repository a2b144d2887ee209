"""Replay file to file of one hour at 200 Hz, against a bare script with numpy and the filter library's batch call.

Both are fresh processes: `imugui replay FILE --filter vqf --out OUT`, which finds format and units, checks every row,
follows the times and writes ten columns; and a script that knows the file's columns and writes time and quaternion.

The virtual board measures the field 100 times a second and holds it between, as real ones do. The script feeds every
row's field, so each twice; imugui feeds each once and tells the library how often they come. That is why the two
differ. How far imugui is from the library when that is fed in the same way is computed beside, and printed too.

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
from numpy.typing import NDArray
from vqf import VQF

from imugui.recording import write_samples
from imugui.simulation.board import VirtualBoard
from imugui.simulation.errors import PRESETS

WANTED = 0.8
RATE_HZ = 200.0
MAG_HZ = PRESETS["mpu9250-calibrated"].mag_rate_hz
PIECE_S = 60.0
SETTLED = 12_000  # rows

Floats = NDArray[np.float64]

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

        jobs = {name: lambda name=name: job(name) for name in commands}
        seconds = interleaved(jobs, chosen.rounds, children_s)
        more = {f"{name}_s": round(taken, 2) for name, taken in seconds.items()}
        more |= {"rows": round(chosen.seconds * RATE_HZ)} | differences(source, bare_out, out)
    ratio = seconds["bare"] / seconds["imugui"]
    line("fuse", "one hour at 200 Hz, file to file", ratio, WANTED, True, **more)
    return 0


def differences(source: Path, bare: Path, ours: Path) -> dict[str, float]:
    """Largest angles of imugui's attitudes to the script's, and to the library's fed as imugui feeds it, deg."""
    quat = np.loadtxt(ours, delimiter=",", usecols=range(1, 5), comments=("#", "t"))
    script = np.loadtxt(bare, delimiter=",", usecols=range(1, 5))
    script_deg, alike_deg = largest_angle_deg(script, quat), largest_angle_deg(fed_alike(source), quat)
    return {"largest_difference_deg": round(script_deg, 4), "fed_alike_difference_deg": round(alike_deg, 4)}


def fed_alike(source: Path) -> Floats:
    """The library's attitudes (n, 4) when every field is fed once: it passes over zeros."""
    table = np.loadtxt(source, delimiter=",", skiprows=2, usecols=range(10))
    acc, gyr, mag = (np.ascontiguousarray(table[:, k : k + 3]) for k in (1, 4, 7))
    mag[1:][(mag[1:] == mag[:-1]).all(axis=1)] = 0.0
    attitudes: Floats = VQF(1.0 / RATE_HZ, magTs=1.0 / MAG_HZ).updateBatch(gyr, acc, mag)["quat9D"]
    return attitudes


def largest_angle_deg(a: Floats, b: Floats) -> float:
    """The largest angle between attitudes (n, 4) after the first minute, deg; from the chord, exact for small ones."""
    a, b = a[SETTLED:], b[SETTLED:]
    chord = np.minimum(np.linalg.norm(a - b, axis=1), np.linalg.norm(a + b, axis=1))
    return float(np.degrees(4.0 * np.arcsin(chord.max(initial=0.0) / 2.0)))


if __name__ == "__main__":
    sys.exit(main())
