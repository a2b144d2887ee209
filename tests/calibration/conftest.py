"""Real recordings as SAMPLE rows, and virtual boards held in many positions."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from imugui.fusion import quaternion
from imugui.samples import GRAVITY, SAMPLE, Rows, empty_rows
from imugui.simulation.board import VirtualBoard
from imugui.simulation.curves import smooth_step
from imugui.simulation.errors import PRESETS, Errors
from imugui.simulation.path import Floats
from imugui.simulation.path import Path as Course

DEGREE = np.pi / 180
XSENS_GYR = 2.11e-4  # rad/s per count: the reference's fit, there is no datasheet


class Positions(Course):
    """Held still in one attitude after another, turned in between."""

    hold_s, turn_s = 3.0, 2.0

    def __init__(self, quats: Floats) -> None:
        self._quats = quats
        step = quaternion.multiply(quaternion.conjugate(quats), np.roll(quats, -1, axis=0))
        self._steps = quaternion.to_rotation_vector(step)

    @property
    def seconds(self) -> float:
        """How long once through takes."""
        return len(self._quats) * (self.hold_s + self.turn_s)

    def quats(self, t: Floats) -> Floats:
        """Attitude (n, 4) at times t (n,) in s."""
        leg, within = np.divmod(np.maximum(t, 0.0), self.hold_s + self.turn_s)
        index = leg.astype(int) % len(self._quats)
        share = smooth_step((within - self.hold_s) / self.turn_s)[:, None]
        return quaternion.multiply(self._quats[index], quaternion.from_rotation_vector(share * self._steps[index]))


def attitudes(count: int, seed: int) -> Floats:
    """Attitudes (count, 4) that let ``count`` well spread directions point up, a hand's 10 deg off."""
    rng = np.random.default_rng(seed)
    ways = [*np.eye(3), *-np.eye(3)]
    ways += [np.array(way, float) for way in ((1, 1, 0), (0, 1, 1), (1, 0, 1), (-1, 1, 0), (0, -1, 1), (1, 0, -1))]
    found = []
    for way in ways[:count]:
        up = way / np.linalg.norm(way) + rng.normal(size=3) * 0.1
        level = quaternion.conjugate(_turning(up / np.linalg.norm(up)))
        heading = quaternion.from_rotation_vector(np.array([0, 0, rng.uniform(-3, 3)]))
        found.append(quaternion.multiply(heading, quaternion.conjugate(level)))
    return np.array(found)


def _turning(up: Floats) -> Floats:
    """The shortest turn (4,) that brings ``up`` (3,) to z."""
    across = np.cross(up, (0.0, 0.0, 1.0))
    size = float(np.linalg.norm(across))
    axis = across / size if size > 1e-9 else np.array([1.0, 0, 0])
    return quaternion.from_rotation_vector(axis * np.arctan2(size, up[2]))


def held_board(count: int, seed: int, errors: Errors = PRESETS["mpu9250"]) -> tuple[VirtualBoard, Rows]:
    """A virtual board of 100 Hz and its rows: ``count`` positions, one after the other."""
    course = Positions(attitudes(count, seed))
    board = VirtualBoard(course, 100.0, errors, seed)
    return board, board.rows(int(course.seconds * 100))


def rows_of(t: Floats, gyr: Floats, acc: Floats, temp_c: float = np.nan) -> Rows:
    """SAMPLE rows from times (n,) s, rates (n, 3) rad/s and forces (n, 3) m/s2."""
    rows = empty_rows(SAMPLE, len(t))
    rows["t"], rows["gyr"], rows["acc"], rows["temp_c"] = t, gyr, acc, temp_c
    return rows


@pytest.fixture(scope="session")
def held() -> Callable[..., tuple[VirtualBoard, Rows]]:
    """``held_board(count, seed, errors)``: a virtual board and its rows."""
    return held_board


@pytest.fixture(scope="session")
def make_rows() -> Callable[..., Rows]:
    """``rows_of(t, gyr, acc, temp_c)``."""
    return rows_of


@pytest.fixture(scope="session")
def load_real(data_dir: Path) -> Callable[[str], Rows]:
    """One of the real recordings by name, in SI units."""
    kept: dict[str, Rows] = {}

    def load(name: str) -> Rows:
        if name not in kept:
            kept[name] = _LOADERS[name](data_dir)
        return kept[name]

    return load


def _mpu(folder: Path) -> Rows:
    table = np.loadtxt(folder / "calibration/mpu6050_multiposition.csv", delimiter=",", skiprows=2)
    return rows_of(np.arange(len(table)) / 100, table[:, 3:] * DEGREE / 131, table[:, :3] * GRAVITY / 16384)


def _xsens(folder: Path) -> Rows:
    table = np.loadtxt(folder / "calibration/xsens_multiposition.csv", delimiter=",", skiprows=1)
    acc = table[:, 1:4] - 32768
    scale = GRAVITY / np.linalg.norm(acc[:5000].mean(axis=0))  # no datasheet: the first position reads 1 g
    return rows_of(table[:, 0], (table[:, 4:] - 32768) * XSENS_GYR, acc * scale)


def _nilspod(folder: Path) -> Rows:
    table = np.loadtxt(folder / "calibration/nilspod_ferraris_session.csv", delimiter=",", skiprows=1)
    return rows_of(np.arange(len(table)) / 102.4, table[:, 1:4] * DEGREE, table[:, 4:])


def _static(folder: Path) -> Rows:
    name = "calibration/mpu6050_hmc5883l_static_10min_imu.csv"
    table = np.loadtxt(folder / name, delimiter=",", skiprows=1)
    rows = rows_of(table[:, 0], table[:, 4:7] * DEGREE / 131, table[:, 1:4] * GRAVITY / 4096)
    rows["temp_c"] = table[:, 7]
    return rows


def _startup(name: str) -> Callable[[Path], Rows]:
    def load(folder: Path) -> Rows:
        table = np.loadtxt(folder / f"boards/triplets-{name}.csv", delimiter=",", skiprows=1)
        return rows_of(np.arange(len(table)) / 140, table[:, 3:] * DEGREE, table[:, :3] * GRAVITY)

    return load


_LOADERS: dict[str, Callable[[Path], Rows]] = {
    "mpu6050": _mpu,
    "xsens": _xsens,
    "nilspod": _nilspod,
    "static": _static,
    "startup1": _startup("startup1-moving"),
    "startup3": _startup("startup3-quiet"),
}
