"""The steps of the self-calibrating filter: an error-state Kalman filter with 25 states, one step a block.

States, in this order: THETA attitude error (earth axes, true R = exp([theta]x) R), VELOCITY and POSITION (earth
axes), BIAS and MATRIX of the gyroscope (corrected rate = w + M w - b, M row by row), FORCE bias of the accelerometer
(sensor axes), DELAY of the magnetometer beyond the delay that was set.

The first three of the nominal vector stay 0: the attitude itself is a quaternion, kept by the filter.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2, hypot, isfinite, radians, sqrt

import numpy as np
from numpy.typing import NDArray

from imugui.fusion.quaternion import Floats
from imugui.fusion.self_calibrating_block import Field, Sums
from imugui.fusion.self_calibrating_params import ImuguiParams
from imugui.samples import GRAVITY

SIZE = 25
THETA, VELOCITY, POSITION = slice(0, 3), slice(3, 6), slice(6, 9)
BIAS, MATRIX, FORCE, DELAY = slice(9, 12), slice(12, 21), slice(21, 24), 24
LEARNT = slice(9, 25)

FIRST_VELOCITY, FIRST_POSITION = 0.1, 1.0  # m/s and m, sigmas at the start, which need not be in the middle
CLIPPED_TURN = 0.2**2  # rad2/s, noise of the attitude while a sensor is at the end of its range
CLIPPED_FORCE = 5.0**2  # m2/s3, the same for the velocity


@dataclass(frozen=True)
class Derived:
    """Constants that follow from the parameters: densities and variances in SI."""

    gyr: float  # rad2/s
    gyr_rate: float  # s
    acc: float  # m2/s3
    bias_walk: float  # rad2/s3
    position: float  # m2 s
    velocity: float  # m2/s
    heading: float  # rad2 s
    full_scale: float  # rad/s
    delay: float  # s, of the magnetometer as it was set
    limits: tuple[float, float, float]  # of the field's norm, dip (rad), and tau (s)


def derived(params: ImuguiParams) -> Derived:
    """The constants of these parameters."""
    return Derived(
        gyr=radians(params.gyr_noise_dps) ** 2,
        gyr_rate=params.gyr_rate_noise**2,
        acc=params.acc_noise**2,
        bias_walk=radians(params.bias_walk_dps) ** 2,
        position=params.position_noise**2,
        velocity=params.velocity_noise**2,
        heading=radians(params.heading_noise_deg) ** 2,
        full_scale=radians(params.gyr_full_scale_dps),
        delay=1e-3 * params.mag_latency_ms,
        limits=(params.field_norm, radians(params.field_dip_deg), params.field_tau),
    )


def first_covariance(params: ImuguiParams, tilt: float, heading: float) -> Floats:
    """P at the start, (25, 25), with the given sigmas of tilt and heading in rad."""
    sigma = np.zeros(SIZE)
    sigma[0:2], sigma[2] = tilt, heading
    sigma[VELOCITY], sigma[POSITION] = FIRST_VELOCITY, FIRST_POSITION
    sigma[BIAS], sigma[MATRIX] = radians(params.bias_sigma_dps), params.matrix_sigma
    sigma[FORCE], sigma[DELAY] = params.acc_bias_sigma, 1e-3 * params.mag_latency_sigma_ms
    return np.diag(sigma**2)


def move(nominal: Floats, sums: Sums) -> Floats:
    """dv = F - g T z; p += v T + dv T / 2; v += dv, in place; returns F (3,) = sum R (a - ba) dt, m/s."""
    time = sums.time
    force = sums.force - sums.rotation @ nominal[FORCE]
    change = force.copy()
    change[2] -= GRAVITY * time
    nominal[POSITION] += (nominal[VELOCITY] + 0.5 * change) * time
    nominal[VELOCITY] += change
    return force


IDENTITY = np.eye(SIZE)


def transition(sums: Sums, force: Floats) -> Floats:
    """Phi (25, 25): the identity, and theta <- G (bias, matrix); v <- theta x F; v <- -sum(R dt) on ba; p <- T v.

    Without the share of theta_z in theta x F: an error of the heading turns force, velocity and position together,
    and a place near 0 stays near 0. So the position says nothing of the heading.
    """
    phi = IDENTITY.copy()
    phi[THETA, BIAS] = -sums.rotation
    phi[THETA, MATRIX] = sums.by_matrix
    x, y, z = force.tolist()
    phi[VELOCITY, THETA] = ((0.0, z, 0.0), (-z, 0.0, 0.0), (y, -x, 0.0))
    phi[VELOCITY, FORCE] = -sums.rotation
    phi[6, 3] = phi[7, 4] = phi[8, 5] = sums.time
    return phi


def noise(sums: Sums, d: Derived) -> Floats:
    """The diagonal (25,) of Q: gyr^2 T + gyr_rate^2 sum|w|^2 dt; acc^2 T; bias_walk^2 T; more while clipped."""
    q = np.zeros(SIZE)
    q[THETA] = d.gyr * sums.time + d.gyr_rate * sums.turning
    q[VELOCITY] = d.acc * sums.time
    q[BIAS] = d.bias_walk * sums.time
    if sums.clipped:
        q[THETA] += CLIPPED_TURN * sums.time
        q[VELOCITY] += CLIPPED_FORCE * sums.time
    return q


def propagate(p: Floats, phi: Floats, q: Floats) -> Floats:
    """P = Phi P Phi' + Q, kept symmetric."""
    p = phi @ p @ phi.T
    p = 0.5 * (p + p.T)
    p.reshape(-1)[:: SIZE + 1] += q
    return p


def _heading_states() -> NDArray[np.bool_]:
    """The states that a heading may move: attitude about the vertical, bias, matrix, delay."""
    moved = np.zeros(SIZE, bool)
    moved[2] = moved[BIAS] = moved[MATRIX] = moved[DELAY] = True
    return moved


HEADING_STATES = _heading_states()
HEADING_WEIGHTS = (HEADING_STATES[:, None] | HEADING_STATES).astype(float)
"""(I - k h') P (I - k h')' + k r k' is P - k' S k with the best gain; where that gain is set to 0 for some states,
it leaves exactly their block of P as it was."""


class Update:
    """The error state x and its covariance P while the measurements of one block come in, one number at a time.

    In Joseph's form; with the best gain k = P h / s that is P - s k k', which keeps P symmetric to the last digit.
    """

    def __init__(self, p: Floats) -> None:
        self.p = p
        self.x = np.zeros(SIZE)
        self._product = np.empty_like(p)

    def observe(self, index: int, z: float, variance: float) -> float:
        """One state was measured: z = x[index] + noise. Returns the squared innovation over its variance."""
        row = self.p[index]
        s = max(float(row[index]), 0.0) + variance
        left = z - float(self.x[index])
        u = row / sqrt(s)
        self.x += u * (left / sqrt(s))
        self.p -= np.multiply(u[:, None], u, out=self._product)
        return left * left / s

    def observe_three(self, first: int, z: tuple[float, float, float], variance: float) -> list[float]:
        """Three states in a row were measured: the same as ``observe`` one after another, in fewer array steps."""
        rows: list[Floats] = []
        nis = []
        for index, measured in enumerate(z, first):
            row = self.p[index]
            for u in rows:
                row = row - u * float(u[index])
            s = max(float(row[index]), 0.0) + variance
            left = measured - float(self.x[index])
            u = row / sqrt(s)
            self.x += u * (left / sqrt(s))
            rows.append(u)
            nis.append(left * left / s)
        stacked = np.array(rows)
        self.p -= stacked.T @ stacked
        return nis

    def withdraw(self, index: int, z: float, variance: float) -> None:
        """Take back that one state was measured: the same as ``observe`` with a negative variance."""
        row = self.p[index]
        s = variance - float(row[index])
        left = z - float(self.x[index])
        u = row / sqrt(s)
        self.x -= u * (left / sqrt(s))
        self.p += np.multiply(u[:, None], u, out=self._product)

    def observe_heading(self, field: Field, variance: float) -> float:
        """z = atan2(hx, hy) = theta_z - (hz / |h_xy|) theta_y + (delay's share); moves no tilt, velocity, position.

        The share of the delay: where it is longer by d, the field was turned by an attitude d too late, which turns
        the mean field by d times its ``speed``. Returns the squared innovation over its variance.
        """
        (x, y, z), (vx, vy, _) = field.mean.tolist(), field.speed.tolist()
        level = max(hypot(x, y), 1e-9)
        slope, turning = -z / level, (vx * y - vy * x) / level**2
        ph = self.p[2] + slope * self.p[1] + turning * self.p[DELAY]
        s = max(float(ph[2] + slope * ph[1] + turning * ph[DELAY]), 0.0) + variance
        left = atan2(x, y) - float(self.x[2] + slope * self.x[1] + turning * self.x[DELAY])
        u = ph / sqrt(s)
        self.x += np.where(HEADING_STATES, u * (left / sqrt(s)), 0.0)
        self.p -= HEADING_WEIGHTS * np.multiply(u[:, None], u, out=self._product)
        return left * left / s


def healthy(nominal: Floats, p: Floats) -> bool:
    """Are the nominal values finite, and the variances numbers and not negative?"""
    # a sum is finite only where all its terms are; what fails elsewhere in P is on its diagonal one block later
    return bool(isfinite(nominal.sum()) and p.diagonal().min() >= 0.0)
