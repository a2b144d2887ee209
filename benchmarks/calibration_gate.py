"""The gate on simulated clouds with known truth: what it accepts, and what it refuses that was good.

The 18 scenarios of the project's study: directions inside a cap of the sphere, free turning by hand, a car turning
on the spot; with noise and outliers. Soft iron of 5 and of 12 %, with and without a figure for the field.
Prints one JSON line for each, and the ratio of good fits that were refused.

    python3 run.py bench calibration_gate [--runs 45]
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from imugui.calibration.coverage import fibonacci
from imugui.calibration.ellipsoid import Ellipsoid
from imugui.calibration.gate import Verdict, judge
from imugui.calibration.geometric import tukey
from imugui.fusion.quaternion import conjugate, from_rotation_vector, multiply, rotate

Floats = NDArray[np.float64]
Random = np.random.Generator

FIELD_UT, DIP_DEG, SAMPLES = 48.0, 66.0, 600
SOFT_IRON = (0.05, 0.12)
BAD_DEG, GOOD_DEG = 5.0, 2.0
HAND_DPS, HAND_TAU_S = 75.0, 1.0
"""Rate about each axis and how long it lasts; 10, 20, 40 s then see 0.45, 0.68, 0.87 of the cells, as the study's."""


@dataclass(frozen=True)
class Cloud:
    """Raw points (n, 3) in uT and their truth: raw = matrix @ field + bias."""

    points: Floats
    matrix: Floats
    bias: Floats


def on_sphere(rng: Random, count: int) -> Floats:
    """Unit vectors (count, 3), evenly spread."""
    v = rng.normal(size=(count, 3))
    return v / np.linalg.norm(v, axis=1, keepdims=True)


def cap(rng: Random, share: float) -> Floats:
    """Directions in a cap of this share of the sphere, turned anywhere."""
    up, turn = 1.0 - 2.0 * share * rng.uniform(size=SAMPLES), rng.uniform(0.0, 2.0 * np.pi, SAMPLES)
    level = np.sqrt(1.0 - up * up)
    around = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    return np.column_stack((level * np.cos(turn), level * np.sin(turn), up)) @ around.T


def hand(rng: Random, seconds: float) -> Floats:
    """The field seen by a board that is turned about for so long."""
    dt = 0.02
    steps = int(seconds / dt)
    rate, quat = rng.normal(size=3), np.array([1.0, 0.0, 0.0, 0.0])
    quats = np.empty((steps, 4))
    for i in range(steps):
        rate += -rate * dt / HAND_TAU_S + np.sqrt(2.0 * dt / HAND_TAU_S) * rng.normal(size=3)
        quat = multiply(quat, from_rotation_vector(np.radians(HAND_DPS) * rate * dt))
        quats[i] = quat
    seen = rotate(conjugate(quats), on_sphere(rng, 1))
    return seen[np.linspace(0, steps - 1, SAMPLES).astype(int)]


def car(rng: Random, tilt_deg: float) -> Floats:
    """Two turns on the spot, swaying in roll and pitch by up to the tilt."""
    turn = np.linspace(0.0, 4.0 * np.pi, SAMPLES)
    start, first, second = rng.uniform(0.0, 2.0 * np.pi, 3)
    tilt, zero = np.radians(tilt_deg), np.zeros(SAMPLES)
    yaw = from_rotation_vector(np.column_stack((zero, zero, turn + start)))
    roll = from_rotation_vector(np.column_stack((tilt * np.sin(1.7 * turn + first), zero, zero)))
    pitch = from_rotation_vector(np.column_stack((zero, tilt * np.sin(1.3 * turn + second), zero)))
    dip = np.radians(DIP_DEG)
    return rotate(conjugate(multiply(yaw, multiply(roll, pitch))), (0.0, np.cos(dip), -np.sin(dip)))


Scenario = tuple[Callable[[Random], Floats], float, float]  # directions, noise, outliers (shares)


def scenario(kind: Callable[[Random, float], Floats], value: float, noise: float, outliers: float) -> Scenario:
    """One row of the study's table 1.3."""
    return partial(_directions, kind, value), noise, outliers


def _directions(kind: Callable[[Random, float], Floats], value: float, rng: Random) -> Floats:
    return kind(rng, value)


SCENARIOS: dict[str, Scenario] = {
    "full": scenario(cap, 1.0, 0.006, 0.0),
    "full, 2 % outliers": scenario(cap, 1.0, 0.006, 0.02),
    "cap 80 %": scenario(cap, 0.8, 0.006, 0.0),
    "cap 60 %": scenario(cap, 0.6, 0.006, 0.0),
    "cap 60 %, 2 % outliers": scenario(cap, 0.6, 0.006, 0.02),
    "cap 60 %, noise 2 %": scenario(cap, 0.6, 0.02, 0.0),
    "cap 50 %": scenario(cap, 0.5, 0.006, 0.0),
    "cap 40 %, noise 2 %": scenario(cap, 0.4, 0.02, 0.0),
    "cap 30 %, noise 2 %": scenario(cap, 0.3, 0.02, 0.0),
    "cap 20 %": scenario(cap, 0.2, 0.006, 0.0),
    "cap 10 %": scenario(cap, 0.1, 0.006, 0.0),
    "hand 5 s": scenario(hand, 5.0, 0.006, 0.0),
    "hand 10 s": scenario(hand, 10.0, 0.006, 0.0),
    "hand 20 s": scenario(hand, 20.0, 0.006, 0.0),
    "car, tilt 0": scenario(car, 0.0, 0.006, 0.0),
    "car, tilt 10 deg": scenario(car, 10.0, 0.006, 0.0),
    "car, tilt 30 deg": scenario(car, 30.0, 0.006, 0.0),
    "car, tilt 45 deg": scenario(car, 45.0, 0.006, 0.0),
}


def cloud(name: str, soft_iron: float, seed: int) -> Cloud:
    """A cloud of a scenario; soft iron on the axes, 0.4 of it across them; hard iron about the field."""
    rng = np.random.default_rng([list(SCENARIOS).index(name), round(1000 * soft_iron), seed])
    directions, noise, outliers = SCENARIOS[name]
    field = FIELD_UT * directions(rng)
    across = 0.4 * soft_iron * np.triu(rng.normal(size=(3, 3)), 1)
    matrix = np.eye(3) + np.diag(soft_iron * rng.normal(size=3)) + across + across.T
    bias = on_sphere(rng, 1)[0] * FIELD_UT * rng.uniform(0.5, 1.5)
    points = field @ matrix.T + bias + noise * FIELD_UT * rng.normal(size=field.shape)
    wrong = rng.uniform(size=len(points)) < outliers
    points[wrong] += on_sphere(rng, int(wrong.sum())) * FIELD_UT * rng.uniform(0.3, 2.0, (int(wrong.sum()), 1))
    return Cloud(points, matrix, bias)


def direction_error_deg(fit: Ellipsoid, truth: Cloud) -> float:
    """True rms error over the sphere, degrees, after the one rotation that no cloud can tell."""
    true = fibonacci(500)
    found = fit.apply(FIELD_UT * true @ truth.matrix.T + truth.bias)
    found /= np.linalg.norm(found, axis=1, keepdims=True)
    left, _, right = np.linalg.svd(true.T @ found)
    turned = found @ (left @ np.diag([1.0, 1.0, np.linalg.det(left @ right)]) @ right).T
    angles = np.arctan2(np.linalg.norm(np.cross(turned, true), axis=1), (turned * true).sum(axis=1))
    return float(np.degrees(np.sqrt((angles**2).mean())))


def trials(runs: int, with_field: bool, seed: int = 0) -> Iterator[tuple[str, Verdict, float]]:
    """Every scenario so many times with each soft iron: its name, the verdict, and the true error in degrees."""
    for name in SCENARIOS:
        for soft_iron in SOFT_IRON:
            for run in range(seed, seed + runs):
                made = cloud(name, soft_iron, run)
                expected = FIELD_UT * np.random.default_rng(run).normal(1.0, 0.03) if with_field else None
                verdict = judge(made.points, expected, DIP_DEG)
                yield name, verdict, direction_error_deg(verdict.fit, made) if verdict.fit else 180.0


def summary(runs: int, with_field: bool, seed: int = 0) -> dict[str, float]:
    """The figures of a whole run."""
    found = [(verdict.accepted, error) for _, verdict, error in trials(runs, with_field, seed)]
    accepted, error = np.array([a for a, _ in found]), np.array([e for _, e in found])
    good, bad = error < GOOD_DEG, error > BAD_DEG
    return {
        "fits": len(found),
        "accepted": int(accepted.sum()),
        "bad": int(bad.sum()),
        "bad_accepted": int((bad & accepted).sum()),
        "worst_accepted_deg": round(float(error[accepted].max()), 2),
        "p95_accepted_deg": round(float(np.quantile(error[accepted], 0.95)), 2),
        "good": int(good.sum()),
        "good_refused_share": round(float((good & ~accepted).sum() / good.sum()), 3),
    }


def fit_ms(samples: int = 500, times: int = 50) -> float:
    """Time of one Tukey fit of a full buffer, milliseconds, the median; the limit is 20."""
    made = cloud("full, 2 % outliers", 0.05, 0).points[:samples]
    taken = []
    for _ in range(times):
        begin = time.perf_counter()
        tukey(made)
        taken.append(1000.0 * (time.perf_counter() - begin))
    return round(float(np.median(taken)), 2)


def main() -> None:
    """Run and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--runs", type=int, default=45, help="clouds per scenario and soft iron (default 45)")
    runs = parser.parse_args().runs
    print(json.dumps({"benchmark": "calibration_gate", "tukey_fit_ms": fit_ms()}))
    for with_field in (False, True):
        print(json.dumps({"benchmark": "calibration_gate", "field_known": with_field, **summary(runs, with_field)}))


if __name__ == "__main__":
    main()
