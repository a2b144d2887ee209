"""Three imperfect sensors: from what is true to what they say."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from imugui.samples import GRAVITY
from imugui.simulation.errors import Errors
from imugui.simulation.path import Floats

DEGREE = np.pi / 180
WARM_UP_S = 120.0
MAGNET_DIRECTION = np.array([0.6, -0.48, 0.64])
"""Unit vector, earth frame: where the field of the passing magnet points."""


@dataclass(frozen=True)
class Distortion:
    """The constant errors of one sensor: raw = matrix @ true + bias."""

    bias: Floats  # (3,), in the sensor's unit
    matrix: Floats  # (3, 3)

    def apply(self, true: Floats) -> Floats:
        """Raw values (n, 3) for true ones (n, 3)."""
        raw: Floats = true @ self.matrix.T + self.bias
        return raw


def draw(rng: np.random.Generator, bias: float | Floats, scale_percent: float, cross_percent: float) -> Distortion:
    """A sensor whose axes' errors lie evenly between minus and plus the limits; ``bias`` in the sensor's unit."""
    offset = rng.uniform(-1, 1, 3) * bias
    own, other = rng.uniform(-0.01, 0.01, 3) * scale_percent, rng.uniform(-0.01, 0.01, (3, 3)) * cross_percent
    return Distortion(offset, np.eye(3) + np.diag(own) + other - np.diag(np.diag(other)))


def noise_std(density: float, rate_hz: float) -> float:
    """Standard deviation of white noise of a one-sided density (unit/sqrt(Hz)) sampled at ``rate_hz``."""
    return density * float(np.sqrt(rate_hz / 2))


class Sensors:
    """Gyroscope, accelerometer, magnetometer and thermometer of one board.

    Each draws from its own generator, so that one error switched off leaves the others as they were.
    Blocks must come in order, the same cuts giving the same values; ``gyr``, ``acc``, ``mag`` are the Distortions.
    """

    def __init__(self, errors: Errors, rate_hz: float, seed: int) -> None:
        self.errors, self.rate_hz = errors, rate_hz
        streams = [np.random.default_rng(child) for child in np.random.SeedSequence(seed).spawn(8)]
        self._gyr_rng, self._walk_rng, self._acc_rng, self._mag_rng = streams[:4]
        e = errors
        self.gyr = draw(streams[4], e.gyr_bias_dps * DEGREE, e.gyr_scale_percent, e.gyr_cross_percent)
        acc_bias = np.array([e.acc_bias_mg, e.acc_bias_mg, e.acc_bias_z_mg]) * 1e-3 * GRAVITY
        self.acc = draw(streams[5], acc_bias, e.acc_scale_percent, e.acc_cross_percent)
        self.mag = draw(streams[6], e.mag_hard_ut, e.mag_soft_percent, e.mag_soft_percent)
        self._warm = streams[7].uniform(-1, 1, 3) * e.gyr_warm_dps * DEGREE
        self._walk = np.zeros(3)
        self._held = np.zeros(3)

    def temp_c(self, t: Floats) -> Floats:
        """Temperature (n,) at times t (n,) in s: warming up with a time constant of WARM_UP_S."""
        warm: Floats = self.errors.temp_c + self.errors.warm_up_c * -np.expm1(-t / WARM_UP_S)
        return warm

    def measure_gyr(self, true: Floats, t: Floats) -> Floats:
        """What the gyroscope says, (n, 3) rad/s, for true rates (n, 3) at times t (n,) in s."""
        e = self.errors
        step = e.gyr_walk_dps * DEGREE / np.sqrt(self.rate_hz)
        walk = self._walk + np.cumsum(self._walk_rng.normal(size=true.shape), axis=0) * step
        self._walk = walk[-1]
        warm = self._warm * (self.temp_c(t) - e.temp_c)[:, None]
        noise = noise_std(e.gyr_noise_dps * DEGREE, self.rate_hz) * self._gyr_rng.normal(size=true.shape)
        return _quantised(self.gyr.apply(true) + walk + warm + noise, e.gyr_lsb_dps * DEGREE)

    def measure_acc(self, true: Floats) -> Floats:
        """What the accelerometer says, (n, 3) m/s2, for true specific forces (n, 3)."""
        noise = noise_std(self.errors.acc_noise_ug * 1e-6 * GRAVITY, self.rate_hz)
        raw = self.acc.apply(true) + noise * self._acc_rng.normal(size=true.shape)
        return _quantised(raw, self.errors.acc_lsb_mg * 1e-3 * GRAVITY)

    def measure_mag(self, true: Floats, count: Floats) -> Floats:
        """What the magnetometer says, (n, 3) uT, for true fields (n, 3) at samples number ``count`` (n,).

        Between its own measurements the last one is repeated, bit by bit.
        """
        raw = self.mag.apply(true) + self.errors.mag_noise_ut * self._mag_rng.normal(size=true.shape)
        raw = _quantised(raw, self.errors.mag_lsb_ut)
        newest = np.maximum.accumulate(np.where(self.is_new(count), np.arange(len(raw)), -1))
        held = np.where(newest[:, None] >= 0, raw[newest], self._held)
        self._held = held[-1]
        return held

    def is_new(self, count: Floats) -> np.ndarray[tuple[int, ...], np.dtype[np.bool_]]:
        """Which samples, by number (n,), carry a magnetometer measurement of their own; number 0 always does."""
        share = self.errors.mag_rate_hz / self.rate_hz
        if share == 0.0:
            return np.ones(len(count), bool)
        fresh: np.ndarray[tuple[int, ...], np.dtype[np.bool_]] = _passed(count, share) > _passed(count - 1, share)
        return fresh

    def magnet(self, t: Floats) -> Floats:
        """Field (n, 3) of the passing magnet, uT in the earth frame, at times t (n,) in s."""
        e = self.errors
        near = np.clip((t - e.magnet_at_s) / e.magnet_lasts_s, 0.0, 1.0)
        field: Floats = e.magnet_ut * np.sin(np.pi * near)[:, None] ** 2 * MAGNET_DIRECTION
        return field


def _passed(count: Floats, share: float) -> Floats:
    """How many measurements were due by then; the small addition keeps whole numbers whole."""
    passed: Floats = np.floor(count * share + 1e-9)
    return passed


def _quantised(values: Floats, step: float) -> Floats:
    return np.round(values / step) * step if step > 0.0 else values
