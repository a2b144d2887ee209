"""Estimator: takes the blocks of the self-calibrating filter one by one and learns from them.

The model: what limits a good filter in fast motion is not the gyroscope's noise but its own scale and misalignment.
They are states here, and gravity is not a low-passed accelerometer but follows from the board staying within arm's
reach: the twice integrated force must lead nowhere. docs/filter.md tells it in short.
"""

from __future__ import annotations

from math import atan2, hypot, sqrt
from typing import Any

import numpy as np

from imugui.fusion import self_calibrating_steps as steps
from imugui.fusion.quaternion import Floats
from imugui.fusion.scalar import Vector
from imugui.fusion.self_calibrating_block import REMEMBERED, Sums
from imugui.fusion.self_calibrating_field import FieldWatch
from imugui.fusion.self_calibrating_params import ImuguiParams
from imugui.fusion.self_calibrating_rest import STANDING, RestRates, still_variance
from imugui.fusion.self_calibrating_steps import BIAS, DELAY, LEARNT, MATRIX, SIZE, VELOCITY, Update

OLDEST_FIELD = 1.0  # s, for which a field may stand at most
BELIEVABLE = 16.0  # squared innovation over its variance, beyond which a quiet board rather moves evenly
RESTING = 6.0  # factor on the noise of the heading at rest: there the local error of the field does not average out
WIDEN_EVERY = 0.25  # s
WIDEN_BEYOND = 1.8  # sigmas of the first uncertainty: an element of the matrix beyond them contradicts it
WIDER = 4.0
WIDEST = 0.03


class Estimator:
    """Nominal values (25,) and covariance (25, 25) of all states, and what one block does to them."""

    def __init__(self, params: ImuguiParams) -> None:
        self._params, self._derived = params, steps.derived(params)
        self.watch = FieldWatch()
        self.position_nis = 0.0  # squared innovation of the position over its variance, largest of the axes
        self.heading_nis: float | None = None  # the same of the heading, None when it was not used
        self._rest_rates = RestRates()
        self.forget(0.0, 0.0)

    def forget(self, tilt: float, heading: float) -> None:
        """Begin with the first uncertainties and these of the attitude, rad."""
        self.nominal: Floats = np.zeros(SIZE)
        self.p = steps.first_covariance(self._params, tilt, heading)
        self.matrix_sigma = self._params.matrix_sigma  # of the first uncertainty, widened when it was too narrow
        self._since_widened = self._field_age = 0.0
        self._weigh()

    def restart(self, tilt: float, heading: float) -> None:
        """Keep what was learnt about the sensors, and begin with new uncertainties of the attitude, rad."""
        p = steps.first_covariance(self._params, tilt, heading)
        p[LEARNT, LEARNT] = self.p[LEARNT, LEARNT]
        self.p = p
        self.nominal[: LEARNT.start] = 0.0
        self._rest_rates.clear()
        self._weigh()

    def doubt_heading(self, sigma: float) -> None:
        """The heading was set anew, with this uncertainty in rad."""
        self.p[2, :] = self.p[:, 2] = 0.0
        self.p[2, 2] = sigma**2
        self._weigh()

    @property
    def delay(self) -> float:
        """Of the magnetometer, in s: set and learnt."""
        return self._derived.delay + float(self.nominal[DELAY])

    def step(self, sums: Sums, rest: bool) -> Vector:
        """Take a block; returns the rotation vector, rad in earth axes, that corrects the attitude."""
        force = steps.move(self.nominal, sums)
        phi, q = steps.transition(sums, force), steps.noise(sums, self._derived)
        update = Update(steps.propagate(self.p, phi, q))
        self._hold_still(update, sums, rest)
        self._stay_near(update, sums)
        self._follow_north(update, sums, rest)
        self._widen(update, sums.time)
        return self._feed_back(update)

    def _hold_still(self, update: Update, sums: Sums, rest: bool) -> None:
        """At rest v = 0 and the mean corrected rate is 0; a board that is held almost still has almost v = 0."""
        velocity = still_variance(sums)
        matrix = self.nominal[MATRIX].reshape(3, 3)
        seen = self._rest_rates.push(sums.mean_rate + matrix @ sums.mean_rate, self.nominal[BIAS], rest)
        if seen is not None:
            velocity = STANDING**2
            for index, rate, variance in zip(range(9, 12), *seen, strict=True):
                update.observe(index, rate - float(self.nominal[index]), variance)
        if velocity is None or not self._params.bounded:
            return  # in a vehicle nothing tells standing from a smooth ride
        moving = self.nominal[VELOCITY]
        if float((moving * moving / (update.p.diagonal()[VELOCITY] + velocity)).max()) < BELIEVABLE:
            x, y, z = moving.tolist()
            update.observe_three(3, (-x, -y, -z), velocity)

    def _stay_near(self, update: Update, sums: Sums) -> None:
        """Position = 0 on each axis; in a vehicle velocity = 0, much more loosely."""
        d = self._derived
        first, density = (6, d.position) if self._params.bounded else (3, d.velocity)
        x, y, z = self.nominal[first : first + 3].tolist()
        nis = update.observe_three(first, (-x, -y, -z), density / sums.time)
        self.position_nis = max(nis)

    def _follow_north(self, update: Update, sums: Sums, rest: bool) -> None:
        """The heading of the mean field, as far as the field may be believed."""
        self._field_age += sums.time
        self.heading_nis = None
        if sums.field is None:
            return
        x, y, z = sums.field.mean.tolist()
        age, self._field_age = min(self._field_age, OLDEST_FIELD), 0.0
        rate = sqrt(sums.turning / sums.time)
        self.watch.update(sums.field.norm, atan2(-z, hypot(x, y)), age, rate, self._derived.limits)
        factor = self.watch.noise_factor() * (RESTING if rest else 1.0)
        if factor > 0.0:
            self.heading_nis = update.observe_heading(sums.field, factor**2 * self._derived.heading / age)

    def _widen(self, update: Update, time: float) -> None:
        """Where the matrix contradicts its first uncertainty, replace that by a wider one.

        The first uncertainty is a measurement "each element is 0, give or take sigma". It is taken back, and the
        wider one put in its place, by the variance r with 1/r = 1/sigma^2 - 1/wider^2.
        """
        self._since_widened += time
        sigma = self.matrix_sigma
        if self._since_widened < WIDEN_EVERY or not 0.0 < sigma < WIDEST:
            return
        self._since_widened = 0.0
        if np.abs(self.nominal[MATRIX]).max() < WIDEN_BEYOND * sigma:
            return
        self.matrix_sigma = wider = min(WIDER * sigma, WIDEST)
        variance = 1.0 / (sigma**-2 - wider**-2)
        for index in range(MATRIX.start, MATRIX.stop):
            if update.p[index, index] < 0.98 * variance:
                update.withdraw(index, -float(self.nominal[index]), variance)

    def _feed_back(self, update: Update) -> Vector:
        """Move the error state into the nominal values."""
        self.p = update.p
        x, y, z = update.x[:3].tolist()
        self.nominal += update.x
        self.nominal[:3] = 0.0
        least = -self._derived.delay
        self.nominal[DELAY] = min(max(float(self.nominal[DELAY]), least), least + REMEMBERED)
        self._weigh()
        return x, y, z

    def _weigh(self) -> None:
        """1 sigma of tilt (both horizontal axes together) and of heading, rad, from P."""
        xx, yy, zz = self.p.diagonal()[:3].tolist()
        self.sigmas = (sqrt(max(xx + yy, 0.0)), sqrt(max(zz, 0.0)))

    def correction(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """The bias (3) and the matrix 1 + M (9, row by row) as plain floats: rate = (1 + M) w - b."""
        bx, by, bz, xx, xy, xz, yx, yy, yz, zx, zy, zz = self.nominal[9:21].tolist()
        return (bx, by, bz), (1.0 + xx, xy, xz, yx, 1.0 + yy, yz, zx, zy, 1.0 + zz)

    def state(self) -> dict[str, Any]:
        """Everything that the next block depends on, as plain numbers and lists."""
        return {
            "nominal": self.nominal.tolist(),
            "p": self.p.tolist(),
            "matrix_sigma": self.matrix_sigma,
            "since_widened": self._since_widened,
            "field_age": self._field_age,
            "rest_rates": self._rest_rates.state(),
            "watch": self.watch.state(),
        }

    def restore(self, state: dict[str, Any]) -> None:
        """Continue from ``state``."""
        self.nominal, self.p = np.array(state["nominal"]), np.array(state["p"])
        self.matrix_sigma, self._since_widened = state["matrix_sigma"], state["since_widened"]
        self._field_age = state["field_age"]
        self._rest_rates.restore(state["rest_rates"])
        self.watch.restore(state["watch"])
        self._weigh()
