"""The seeds' own ways to calibrate a magnetometer beside ours, on the same data: labelled, compared, never used."""

from __future__ import annotations

import numpy as np

from imugui.calibration.ellipsoid import Ellipsoid, Floats
from imugui.calibration.seeds import final_bar, half_turns, min_max_offset, min_max_scaled
from imugui.fusion.correction import Correction
from imugui.fusion.pipeline import Pipeline
from imugui.samples import Rows

HEAD = ("On the same data", "even to", "off by")


def seed_table(rows: Rows, ours: Ellipsoid, before: Correction) -> tuple[tuple[str, ...], ...]:
    """How even the field is and by how much directions differ from ours (RMS); ``rows`` are raw SAMPLE rows (n,)."""
    attitude = Pipeline(correction=before, use_mag=False).step(rows)
    fresh = np.isfinite(rows["mag"]).all(axis=1)
    fresh[1:] &= (rows["mag"][1:] != rows["mag"][:-1]).any(axis=1)
    points = rows["mag"][fresh]
    if len(points) < 20:
        return ()
    found = [half_turns(points, attitude["quat"][fresh]), min_max_scaled(points), min_max_offset(points)]
    lines = [_line("This calibration", ours, ours, points)]
    lines += [_line(fit.method, fit, ours, points) for fit in found if fit is not None]
    return (HEAD, *lines, ("Progress bar of seed 001", f"{final_bar(points)} %", ""))


def _line(name: str, fit: Ellipsoid, ours: Ellipsoid, points: Floats) -> tuple[str, ...]:
    a, b = fit.apply(points), ours.apply(points)
    cosine = (a * b).sum(axis=1) / (np.linalg.norm(a, axis=1) * np.linalg.norm(b, axis=1))
    off = np.degrees(np.sqrt((np.arccos(np.clip(cosine, -1.0, 1.0)) ** 2).mean()))
    even = 100.0 * fit.residual(points)
    return (name, f"{even:.1f} %", "" if fit is ours else f"{off:.1f}°")
