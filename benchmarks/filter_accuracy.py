"""How accurate imugui's own filter is, beside VQF: on BROAD against optics, on the virtual board against the truth.

BROAD's ten development trials (not part of the repository) with the delays of that hardware, and with none known. The
virtual board has the datasheet's noise, what a good calibration leaves of its errors, and a gyroscope that is off by
up to 3 % in scale and 1 degree in alignment; every motion, rate, with and without magnetometer. Prints one JSON line
each and, with ``--write``, puts the figures into docs/filter.md.

    python3 run.py bench filter_accuracy [--data FOLDER] [--seeds 2] [--runs 1000] [--write]
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from _measure import BROAD

from imugui.fusion import quaternion as qt
from imugui.fusion.imugui_filter import Imugui
from imugui.fusion.pipeline import Pipeline
from imugui.fusion.quaternion import Floats
from imugui.fusion.self_calibrating_params import ImuguiParams
from imugui.samples import SAMPLE, Rows, empty_rows
from imugui.simulation.board import VirtualBoard
from imugui.simulation.errors import PRESETS
from imugui.simulation.hand import HandTurned
from imugui.simulation.motions import MOTIONS

HERE = Path(__file__).resolve().parent
PAGE = HERE.parent / "docs" / "filter.md"
ERRORS = replace(PRESETS["mpu9250-calibrated"], gyr_scale_percent=3.0, gyr_cross_percent=1.75)
DELAYS = ImuguiParams(gyr_latency_ms=2.4, mag_latency_ms=14.0)  # of that hardware, measured with its optics
RATES = (25.0, 100.0, 200.0, 1000.0)
SECONDS = 60.0
DRAGS = 60  # a second each, for the board that waits for a hand
DIVERGED = 0.3  # deg, worse than VQF by more in inclination
Figures = dict[str, Any]


def rms(values: Floats) -> float:
    """Root of the mean square."""
    return float(np.sqrt(np.mean(values**2)))


def parts(quats: Floats, truth: Floats) -> tuple[Floats, Floats, Floats]:
    """Total, inclination and heading error, deg, of attitudes (n, 4): the metric of BROAD."""
    w, x, y, z = qt.multiply(quats, qt.conjugate(truth)).T
    total = 2.0 * np.arctan2(np.sqrt(x * x + y * y + z * z), np.abs(w))
    inclination, heading = 2.0 * np.arctan2(np.hypot(x, y), np.hypot(w, z)), 2.0 * np.arctan(z / w)
    return np.degrees(total), np.degrees(inclination), np.degrees(heading)


def inside(errors: Floats, sigma: Floats) -> tuple[float, float]:
    """Shares of errors (n,) in deg within 1 and 2 sigma (n,) in rad."""
    off, limit = np.abs(errors), np.degrees(sigma)
    return float(np.mean(off < limit)), float(np.mean(off < 2.0 * limit))


def trial_rows(path: Path) -> tuple[Rows, Floats, Floats]:
    """The rows of a trial, its optical attitudes, and which of them count."""
    with np.load(path) as file:
        trial = {key: file[key] for key in ("gyr", "acc", "mag", "opt_quat", "movement", "rate")}
    rows = empty_rows(SAMPLE, len(trial["gyr"]))
    rows["t"] = np.arange(len(rows)) / float(trial["rate"])
    for key in ("gyr", "acc", "mag"):
        rows[key] = trial[key]
    truth = trial["opt_quat"].astype(float)
    return rows, truth, trial["movement"] & np.isfinite(truth).all(axis=1)


def broad(folder: Path) -> Iterator[Figures]:
    """One trial after another: RMSE in deg of both filters, coverage of the own sigma, CPU time per sample."""
    for path in sorted(folder.glob("*.npz")):
        rows, truth, counted = trial_rows(path)
        figures: Figures = {"benchmark": "filter_broad", "trial": path.stem}
        for name, params in (("known", DELAYS), ("unknown", None), ("vqf", None)):
            pipeline = Pipeline("vqf" if name == "vqf" else "imugui", params)
            began = time.process_time()
            out = pipeline.step(rows)
            figures[f"{name}_us"] = (time.process_time() - began) / len(rows) * 1e6
            total, inclination, heading = parts(out["quat"][counted], truth[counted])
            figures[f"{name}_total"], figures[f"{name}_inclination"] = rms(total), rms(inclination)
            if name == "known":
                figures["tilt_inside"] = inside(inclination, out["sigma_tilt"][counted])
                figures["heading_inside"] = inside(heading, out["sigma_heading"][counted])
            elif isinstance(pipeline.filter, Imugui):
                figures["delay_learnt_ms"] = 1e3 * pipeline.filter.delay
        yield figures


def recorded(motion: str, rate_hz: float, seed: int) -> tuple[VirtualBoard, Rows, Floats]:
    """A virtual board, its rows and their true attitudes; one that waits for a hand is dragged about."""
    board, rng, pieces = VirtualBoard(motion, rate_hz, ERRORS, seed), np.random.default_rng(seed), []
    for k in range(DRAGS):
        if isinstance(board.path, HandTurned) and k > 2:
            board.path.turn(*rng.uniform(-0.8, 0.8, 3))
        pieces.append((board.rows(round(SECONDS * rate_hz / DRAGS)), board.truth))
    return board, np.concatenate([rows for rows, _ in pieces]), np.concatenate([truth for _, truth in pieces])


def aligned(quats: Floats, truth: Floats) -> Floats:
    """Attitudes (n, 4) turned about the vertical so that the first heading is the true one."""
    w, _, _, z = qt.multiply(truth[0], qt.conjugate(quats[0])).tolist()
    return qt.multiply(qt.normalise((w, 0.0, 0.0, z)), quats)


def field_alone(rows: Rows, truth: Floats) -> float:
    """RMS heading error, deg, of the mean field so far, seen with the true attitudes: what no gyroscope can better."""
    east, north, _ = qt.rotate(truth, rows["mag"]).T
    off = np.degrees(np.arctan2(east, north))
    return rms(np.cumsum(off) / np.arange(1, len(off) + 1))


def virtual(motion: str, rate_hz: float, use_mag: bool, seed: int) -> Figures:
    """One run of the virtual board with both filters: RMS errors in deg and what was learnt."""
    board, rows, truth = recorded(motion, rate_hz, seed)
    figures: Figures = {"benchmark": "filter_virtual", "motion": motion, "rate_hz": rate_hz, "mag": use_mag}
    figures["seed"], figures["field_total"] = seed, field_alone(rows, truth)
    for name in ("imugui", "vqf"):
        pipeline = Pipeline(name, use_mag=use_mag)
        out = pipeline.step(rows)
        quats = out["quat"] if use_mag else aligned(out["quat"], truth)
        total, inclination, heading = parts(quats, truth)
        figures[f"{name}_total"], figures[f"{name}_inclination"] = rms(total), rms(inclination)
        if isinstance(pipeline.filter, Imugui):
            left = pipeline.filter.matrix @ board.sensors.gyr.matrix - np.eye(3)
            figures["matrix_percent"] = float(100.0 * np.abs(left).max())
            figures["note"] = pipeline.filter.note
            figures["tilt_inside"] = inside(inclination, out["sigma_tilt"])
            figures["heading_inside"] = inside(heading, out["sigma_heading"])
    return figures


def stability(runs: int) -> Figures:
    """So many short lives of the board, drawn by seed: how often is the own filter worse than VQF, how often lost?"""
    worse, lost, beaten, names = [], 0, 0, list(MOTIONS)
    for seed in range(runs):
        rng = np.random.default_rng(seed)
        use_mag = bool(rng.integers(2))
        figures = virtual(names[rng.integers(len(names))], RATES[rng.integers(len(RATES))], use_mag, seed)
        key = "total" if use_mag else "inclination"
        own, vqf = figures[f"imugui_{key}"], figures[f"vqf_{key}"]
        lost += figures["note"] != "" or not np.isfinite(own)
        field = figures["field_total"] if use_mag else 0.0
        beaten += field > vqf + DIVERGED
        if not own <= vqf + DIVERGED:
            cells = (figures["motion"], figures["rate_hz"], use_mag, seed, round(own, 2), round(vqf, 2))
            worse.append([*cells, round(field, 2)])
    return {"benchmark": "filter_stability", "runs": runs, "lost": int(lost), "worse": worse, "field": int(beaten)}


def grid(seeds: int) -> Iterator[Figures]:
    """Every motion, with and without magnetometer, at every rate."""
    for motion in MOTIONS:
        for use_mag in (True, False):
            for rate_hz in RATES:
                for seed in range(1, seeds + 1):
                    yield virtual(motion, rate_hz, use_mag, seed)


def trial_table(trials: list[Figures]) -> list[str]:
    """Per-trial figures of BROAD as a table, with the means."""
    columns = ("vqf_total", "known_total", "unknown_total", "vqf_inclination", "known_inclination")
    lines = ["| trial | VQF | own | own, delays unknown | VQF incl. | own incl. | tilt in 1 / 2 sigma | heading |",
             "|---|---|---|---|---|---|---|---|"]  # fmt: skip
    for one in trials:
        cells = [one["trial"], *(f"{one[key]:.2f}" for key in columns)]
        cells += [" / ".join(f"{100 * share:.0f} %" for share in one[key]) for key in ("tilt_inside", "heading_inside")]
        lines.append("| " + " | ".join(cells) + " |")
    means = [f"**{np.mean([one[key] for one in trials]):.2f}**" for key in columns]
    for key in ("tilt_inside", "heading_inside"):
        means.append(" / ".join(f"**{100 * share:.0f} %**" for share in np.mean([one[key] for one in trials], axis=0)))
    return [*lines, "| mean | " + " | ".join(means) + " |"]


def virtual_table(runs: list[Figures]) -> list[str]:
    """The virtual board's figures, mean of rates and seeds, motion by motion."""
    lines = ["| motion | magnetometer | VQF | own | VQF incl. | own incl. | tilt in 1 / 2 sigma | heading "
             "| matrix off by |", "|---|---|---|---|---|---|---|---|---|"]  # fmt: skip
    keys = ("vqf_total", "imugui_total", "vqf_inclination", "imugui_inclination")
    for motion in MOTIONS:
        for use_mag in (True, False):
            chosen = [run for run in runs if run["motion"] == motion and run["mag"] == use_mag]
            cells = [motion, "yes" if use_mag else "no"]
            cells += [f"{np.mean([run[key] for run in chosen]):.2f}" for key in keys]
            for key in ("tilt_inside", "heading_inside"):
                shares = np.mean([run[key] for run in chosen], axis=0)
                cells.append(" / ".join(f"{100 * share:.0f} %" for share in shares))
            lines.append("| " + " | ".join([*cells, f"{np.mean([r['matrix_percent'] for r in chosen]):.2f} %"]) + " |")
    return lines


def stability_text(life: Figures) -> list[str]:
    """What the many short runs showed, in words."""
    lines = [f"{life['runs']} runs of 60 s with drawn motion, rate, magnetometer and errors: lost in {life['lost']};",
             f"worse than VQF by more than {DIVERGED} degrees in {len(life['worse'])}.",
             "With magnetometer the total error is compared, without it the inclination: its heading has no",
             "reference then. The heading of the mean field, seen with the true attitude (the last column), would be",
             f"as much worse than VQF in {life['field']}."]  # fmt: skip
    if life["worse"]:
        lines += ["", "| motion | rate | magnetometer | seed | own | VQF | field |", "|---|---|---|---|---|---|---|"]
        lines += ["| " + " | ".join(str(cell) for cell in one) + " |" for one in life["worse"][:30]]
    return lines


def page(text: str, trials: list[Figures], runs: list[Figures], life: Figures | None) -> str:
    """The text of docs/filter.md with new tables between its marks; without new figures a table stays."""
    tables = {"BROAD": trial_table(trials) if trials else None, "VIRTUAL": virtual_table(runs) if runs else None}
    tables["STABILITY"] = None if life is None else stability_text(life)
    for name, lines in tables.items():
        before, begin, rest = text.partition(f"<!-- {name} -->\n")
        _, end, after = rest.partition(f"<!-- /{name} -->")
        if lines is not None:
            text = "".join((before, begin, "\n".join(lines), "\n", end, after))
    return text


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--data", type=Path, default=BROAD, help="folder with BROAD's trials as .npz")
    arguments.add_argument("--seeds", type=int, default=2)
    arguments.add_argument("--runs", type=int, default=0, help="of the search for divergence; 1000 take half an hour")
    arguments.add_argument("--write", action="store_true")
    chosen = arguments.parse_args()
    kept: dict[str, list[Figures]] = {"trials": [], "runs": []}
    for name, figures in (("trials", broad(chosen.data)), ("runs", grid(chosen.seeds))):
        for one in figures:
            kept[name].append(one)
            print(json.dumps(one), flush=True)
    life = stability(chosen.runs) if chosen.runs else None
    if life is not None:
        print(json.dumps(life))
    if chosen.write:
        PAGE.write_text(page(PAGE.read_text(encoding="utf-8"), kept["trials"], kept["runs"], life), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
