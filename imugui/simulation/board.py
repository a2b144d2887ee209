"""The virtual board: a true motion seen through imperfect sensors, as SAMPLE rows."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from imugui.fusion import quaternion
from imugui.samples import GRAVITY, SAMPLE, Rows, empty_rows
from imugui.simulation.errors import PRESETS, Errors
from imugui.simulation.motions import MOTIONS
from imugui.simulation.path import Floats, Path, place
from imugui.simulation.sensors import Sensors

BLOCK = 256
"""Rows made at once. Always the same cuts, so that no value depends on how many rows are asked for."""

LIVE_BLOCK_S = 0.02
"""How far ahead of the person a live motion may be made, s."""

FIX_RATE_HZ = 10.0
"""GNSS fixes per second of a travelling motion; the rows between have none."""


@dataclass(frozen=True)
class EarthField:
    """The earth's magnetic field where the board is; the earth frame's y axis points to magnetic north."""

    norm_ut: float = 48.0
    dip_deg: float = 65.0

    def vector(self) -> Floats:
        """The field (3,), uT east, north, up."""
        dip = math.radians(self.dip_deg)
        return self.norm_ut * np.array([0.0, math.cos(dip), -math.sin(dip)])


EARTH_FIELD = EarthField()


class VirtualBoard:
    """Makes the rows k = 0, 1, 2... of one board at t = k / rate_hz, without end; equal seeds give equal rows.

    ``gyr`` of row k is the mean body rate from row k-1 to row k, log(q[k-1]^-1 q[k]) / dt, so that an exact
    integrator that starts from the truth stays on it (row 0: 0). ``acc`` and ``mag`` belong to the instant of
    their row: acc = R^T (a + g up), with a only if ``errors.linear_acceleration``; mag = R^T (earth + magnet),
    held between measurements.
    """

    def __init__(
        self,
        motion: str | Path,
        rate_hz: float,
        errors: Errors = PRESETS["ideal"],
        seed: int = 0,
        field: EarthField = EARTH_FIELD,
    ) -> None:
        """A board that moves as MOTIONS[motion] or as a given Path. ValueError: unknown motion or rate."""
        if isinstance(motion, str) and motion not in MOTIONS:
            raise ValueError(f"unknown motion {motion!r}; there are {', '.join(MOTIONS)}")
        if not 1.0 <= rate_hz <= 8000.0:
            raise ValueError(f"a board's rate is 1 to 8000 Hz, not {rate_hz}")
        self.path = MOTIONS[motion].start(seed) if isinstance(motion, str) else motion
        self.rate_hz, self.errors, self.field = rate_hz, errors, field
        self.sensors = Sensors(errors, rate_hz, seed)
        self.count = 0  # rows handed out so far
        self.truth: Floats = np.zeros((0, 4))  # true attitudes (n, 4) of the rows handed out last
        self._block = max(1, round(LIVE_BLOCK_S * rate_hz)) if self.path.live else BLOCK
        self._made = 0
        self._last: Floats | None = None
        self._rows: Rows = empty_rows(SAMPLE, 0)
        self._quats: Floats = np.zeros((0, 4))

    def rows(self, n: int) -> Rows:
        """The next n >= 0 SAMPLE rows; ``truth`` then holds their true attitudes."""
        missing = n - len(self._rows)
        if missing > 0:
            made = [self._make() for _ in range(math.ceil(missing / self._block))]
            self._rows = np.concatenate([self._rows, *[rows for rows, _ in made]])
            self._quats = np.concatenate([self._quats, *[quats for _, quats in made]])
        rows, self._rows = self._rows[:n], self._rows[n:]
        self.truth, self._quats = self._quats[:n], self._quats[n:]
        self.count += n
        return rows

    def perfect_correction(self) -> dict[str, Floats]:
        """What a perfect calibration would find, as the arguments of ``fusion.correction.Correction``.

        corrected = matrix @ (raw - bias); the bias of the gyroscope is that at t = 0.
        """
        found: dict[str, Floats] = {}
        for name in ("gyr", "acc", "mag"):
            distortion = getattr(self.sensors, name)
            found[f"{name}_bias"] = distortion.bias.copy()
            found[f"{name}_matrix"] = np.linalg.inv(distortion.matrix)
        return found

    def _make(self) -> tuple[Rows, Floats]:
        """The next whole block: rows and true attitudes."""
        count = np.arange(self._made, self._made + self._block, dtype=float)
        t = count / self.rate_hz
        quats = self.path.quats(t)
        self._made += self._block
        rows = empty_rows(SAMPLE, self._block)
        rows["t"] = t
        rows["temp_c"] = self.sensors.temp_c(t)
        rows["gyr"] = self.sensors.measure_gyr(self._rates(quats), t)
        to_body = quaternion.conjugate(quats)
        force = np.tile([0.0, 0.0, GRAVITY], (len(t), 1))
        if self.errors.linear_acceleration:
            force += self.path.acceleration(t)
        rows["acc"] = self.sensors.measure_acc(quaternion.rotate(to_body, force))
        field = self.field.vector() + self.sensors.magnet(t)
        rows["mag"] = self.sensors.measure_mag(quaternion.rotate(to_body, field), count)
        if self.path.travels:
            self._locate(rows, count, quats)
        return rows, quats

    def _rates(self, quats: Floats) -> Floats:
        """Mean body rates (n, 3), rad/s, each from the row before."""
        first = quats[:1] if self._last is None else self._last
        before = np.concatenate([first, quats[:-1]])
        self._last = quats[-1:]
        turned = quaternion.to_rotation_vector(quaternion.multiply(quaternion.conjugate(before), quats))
        rates: Floats = turned * self.rate_hz
        return rates

    def _locate(self, rows: Rows, count: Floats, quats: Floats) -> None:
        """Write GNSS fixes into the rows at which one is due; the course is where body x points."""
        share = min(1.0, FIX_RATE_HZ / self.rate_hz)
        due = np.floor(count * share + 1e-9) > np.floor((count - 1) * share + 1e-9)
        fixed = place(self.path, rows["t"][due])
        rows["lat"][due], rows["lon"][due], rows["alt"][due], rows["speed"][due] = fixed
        ahead = quaternion.rotate(quats[due], np.broadcast_to([1.0, 0.0, 0.0], (int(due.sum()), 3)))
        rows["course_deg"][due] = np.degrees(np.arctan2(ahead[:, 0], ahead[:, 1])) % 360.0
