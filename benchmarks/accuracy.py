"""Error of every filter on the BROAD development trials, against the bare libraries on the same samples.

Total, heading and inclination as the data set defines them: root mean square over the moving samples, then the plain
mean over the trials, one parameter set for all. Peers that are not installed are left out, and said so.
D. Laidig et al., BROAD, Data 6(7):72, 2021, doi:10.3390/data6070072.

    python3 run.py bench accuracy [--data FOLDER]
"""

from __future__ import annotations

import argparse
import importlib.util
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from _measure import BROAD, line, note
from numpy.typing import NDArray

from imugui.fusion import FILTERS
from imugui.fusion.pipeline import Pipeline
from imugui.fusion.quaternion import conjugate, multiply
from imugui.samples import SAMPLE, Rows, empty_rows

Floats = NDArray[np.float64]
NORTH_TO_EAST = (np.sqrt(0.5), 0.0, 0.0, np.sqrt(0.5))
"""From axes north, west, up to east, north, up."""
EQUAL_DEG = 0.05
NAMES = ("total", "heading", "inclination")


@dataclass(frozen=True)
class Trial:
    """One recording with optical reference, sensor to earth."""

    rows: Rows
    reference: Floats
    moving: NDArray[np.bool_]
    rate_hz: float


def load(path: Path) -> Trial:
    """One file of the data folder."""
    with np.load(path) as file:
        rate_hz = float(file["rate"])
        rows = empty_rows(SAMPLE, len(file["gyr"]))
        rows["t"] = np.arange(len(rows)) / rate_hz
        for name in ("gyr", "acc", "mag"):
            rows[name] = file[name]
        return Trial(rows, file["opt_quat"].astype(float), file["movement"], rate_hz)


def errors_deg(quat: Floats, trial: Trial) -> Floats:
    """Total, heading and inclination RMSE, degrees, of attitudes (n, 4)."""
    w, _, _, z = multiply(quat, conjugate(trial.reference)).T
    parts = (
        2.0 * np.arccos(np.clip(np.abs(w), 0.0, 1.0)),
        2.0 * np.arctan2(np.abs(z), np.abs(w)),
        2.0 * np.arccos(np.clip(np.sqrt(w * w + z * z), 0.0, 1.0)),
    )
    return np.array([np.degrees(np.sqrt(np.nanmean(part[trial.moving] ** 2))) for part in parts])


def ours(name: str) -> Callable[[Trial], Floats]:
    """A filter of the table with its defaults, as the program runs it."""

    def run(trial: Trial) -> Floats:
        return np.concatenate([rows["quat"] for rows in Pipeline(name).steps(trial.rows)])

    return run


def bare_vqf(trial: Trial) -> Floats:
    """The library's batch call, defaults."""
    from vqf import VQF

    gyr, acc, mag = (np.ascontiguousarray(trial.rows[name]) for name in ("gyr", "acc", "mag"))
    return np.asarray(VQF(1.0 / trial.rate_hz).updateBatch(gyr, acc, mag)["quat9D"])


def bare_imufusion(trial: Trial) -> Floats:
    """The Ahrs loop, defaults."""
    import imufusion

    ahrs = imufusion.Ahrs()
    ahrs.set_sample_period(1.0 / trial.rate_hz)
    quats = np.empty((len(trial.rows), 4))
    gyr, acc = np.degrees(trial.rows["gyr"]), trial.rows["acc"] / 9.80665
    for k, (rate, force, field) in enumerate(zip(gyr, acc, trial.rows["mag"], strict=True)):
        ahrs.update(rate, force, field)
        quats[k] = ahrs.get_quaternion()
    return multiply(NORTH_TO_EAST, quats)


def bare_ahrs(trial: Trial) -> Floats:
    """Madgwick's filter of the ahrs library, defaults."""
    from ahrs.filters import Madgwick

    gyr, acc, mag = (trial.rows[name] for name in ("gyr", "acc", "mag"))
    return multiply(NORTH_TO_EAST, Madgwick(gyr=gyr, acc=acc, mag=mag, frequency=trial.rate_hz).Q)


PEERS = {"vqf": bare_vqf, "imufusion": bare_imufusion, "ahrs": bare_ahrs}


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--data", type=Path, default=BROAD, help="folder with BROAD's trials as .npz")
    paths = sorted(arguments.parse_args().data.glob("*.npz"))
    if not paths:
        note("accuracy", "no BROAD trials here: give their folder with --data")
        return 0
    trials = [load(path) for path in paths]
    missing = [name for name in PEERS if importlib.util.find_spec(name) is None]
    if missing:
        note("accuracy", f"not installed, so not compared: {', '.join(missing)}")
    filters = {f"{name} (library)": run for name, run in PEERS.items() if name not in missing}
    filters |= {f"imugui {name}": ours(name) for name in FILTERS}
    found = {}
    for name, run in filters.items():
        begin = time.process_time()
        found[name] = np.mean([errors_deg(run(trial), trial) for trial in trials], axis=0)
        taken = time.process_time() - begin
        us = 1e6 * taken / sum(len(trial.rows) for trial in trials)
        base = found.get("vqf (library)", found[name])
        more = {f"{part}_deg": round(float(deg), 3) for part, deg in zip(NAMES, found[name], strict=True)}
        same = name == "imugui vqf" and "vqf" not in missing
        ok = bool(np.abs(found[name] - base).max() <= EQUAL_DEG) if same else True
        ratio = float(found[name][0] / base[0])
        line("accuracy", name, ratio, None, False, ok=ok, trials=len(trials), us_per_sample=round(us, 2), **more)
    return 0


if __name__ == "__main__":
    sys.exit(main())
