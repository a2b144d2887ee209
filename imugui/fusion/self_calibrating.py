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
CONTRADICTED = 1.0  # sigmas by which the squares of the matrix may exceed what its first uncertainty lets expect
WIDER = 6.0
WIDEST = 0.03
NEAR, SLOW = 0.4, 3.0  # m and m/s, beyond which "the position is 0", or a vehicle's velocity, says less
FAR_MEMORY = 2.0  # s, over which the departure is averaged


class Estimator:
    """Nominal values (25,) and covariance (25, 25) of all states, and what one block does to them."""

    def __init__(self, params: ImuguiParams) -> None:
        self._params, self._derived = params, steps.derived(params)
        self.watch = FieldWatch()
        self.position_nis = 0.0  # squared innovation of the position over its variance, mean of the axes
        self.heading_nis: float | None = None  # the same of the heading, None when it was not used
        self._rest_rates = RestRates()
        self.forget(0.0, 0.0)

    def forget(self, tilt: float, heading: float) -> None:
        """Begin with the first uncertainties and these of the attitude, rad."""
        self.nominal: Floats = np.zeros(SIZE)
        self.p = steps.first_covariance(self._params, tilt, heading)
        self._turned: Floats = np.zeros(9)  # rad: how far the heading has turned for each element of the matrix
        self.matrix_sigma = self._params.matrix_sigma  # of the first uncertainty, widened when it was too narrow
        self._since_widened = self._field_age = 0.0
        self._far = 0.0  # squared departure of the position, m2, or of a vehicle's velocity, averaged
        self._weigh()

    def restart(self, tilt: float, heading: float) -> None:
        """Keep what was learnt about the sensors, and begin with new uncertainties of the attitude, rad."""
        p = steps.first_covariance(self._params, tilt, heading)
        p[LEARNT, LEARNT] = self.p[LEARNT, LEARNT]
        self.p = p
        self.nominal[: LEARNT.start] = self._far = 0.0
        self._rest_rates.clear()
        self._weigh()

    def doubt_heading(self, sigma: float) -> None:
        """The heading was set anew, with this uncertainty in rad."""
        self.p[2, :] = self.p[:, 2] = self._turned[:] = 0.0
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
        self._turned = self._turned + sums.by_matrix[2] if self.heading_nis is None else np.zeros(9)
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
        """Position = 0 on each axis; in a vehicle velocity = 0, much more loosely.

        A board that travels about the middle is off it for a second at a time, not anew in each block. A departure
        of r that lasts has a density that grows as r^2, so the noise's is taken (1 + r^2 / NEAR^2) times as large.
        """
        d = self._derived
        first, density, near = (6, d.position, NEAR) if self._params.bounded else (3, d.velocity, SLOW)
        x, y, z = self.nominal[first : first + 3].tolist()
        square = x * x + y * y + z * z
        self._far += sums.time / (FAR_MEMORY + sums.time) * (square - self._far)
        known = float(update.p.diagonal()[first : first + 3].sum()) / 3.0
        self.position_nis = square / 3.0 / (known + density / sums.time)
        update.observe_three(first, (-x, -y, -z), density * (1.0 + self._far / near**2) / sums.time)

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

        Were that right, the squares of the elements would sum up to what has been learnt, sum(sigma^2 - P_ii), or
        to n sigma^2, like n squares of a normal number: give or take sqrt(2 n) sigma^2. The first uncertainty is a
        measurement "each element is 0, give or take sigma", which is taken back, and the wider one put in its
        place, by the variance r with 1/r = 1/sigma^2 - 1/wider^2.
        """
        self._since_widened += time
        sigma = self.matrix_sigma
        if self._since_widened < WIDEN_EVERY or not 0.0 < sigma < WIDEST:
            return
        self._since_widened = 0.0
        found = self.nominal[MATRIX] / sigma
        learnt = float(np.maximum(1.0 - update.p.diagonal()[MATRIX] / sigma**2, 0.0).sum())
        if float((found * found).sum()) <= learnt + CONTRADICTED * sqrt(2.0 * learnt):
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
        """1 sigma of tilt (both horizontal axes together) and of heading, rad, from P and what it may not know."""
        xx, yy, zz = self.p.diagonal()[:3].tolist()
        self.sigmas = (sqrt(max(xx + yy, 0.0)), sqrt(max(zz, 0.0) + self._unlearnt()))

    def _unlearnt(self) -> float:
        """Variance of the heading, rad2, that P lacks without a field where the gyroscope is not calibrated.

        T_i is how far the heading has turned for each element of the matrix since a field, or ``doubt_heading``, set
        it: sum up * (w dt)'. Were the first sigma of the elements not s but u, the variance of each would be
        1 / (1 / P_ii - 1 / s^2 + 1 / u^2): u^2 where nothing has been learnt, hardly more than P_ii where much has.
        """
        first, worst = self.matrix_sigma, self._params.matrix_worst
        if worst <= first or not self._turned.any():
            return 0.0
        if first == 0.0:
            return worst**2 * float((self._turned**2).sum())
        known = np.minimum(self.p.diagonal()[MATRIX], first**2)
        loose = 1.0 / (1.0 / known - first**-2 + worst**-2)
        return float((self._turned**2 * (loose - known)).sum())

    def correction(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """The bias (3) and the matrix 1 + M (9, row by row) as plain floats: rate = (1 + M) w - b."""
        bx, by, bz, xx, xy, xz, yx, yy, yz, zx, zy, zz = self.nominal[9:21].tolist()
        return (bx, by, bz), (1.0 + xx, xy, xz, yx, 1.0 + yy, yz, zx, zy, 1.0 + zz)

    def state(self) -> dict[str, Any]:
        """Everything that the next block depends on, as plain numbers and lists."""
        return {
            "nominal": self.nominal.tolist(),
            "p": self.p.tolist(),
            "turned": self._turned.tolist(),
            "far": self._far,
            "matrix_sigma": self.matrix_sigma,
            "since_widened": self._since_widened,
            "field_age": self._field_age,
            "rest_rates": self._rest_rates.state(),
            "watch": self.watch.state(),
        }

    def restore(self, state: dict[str, Any]) -> None:
        """Continue from ``state``."""
        self.nominal, self.p = np.array(state["nominal"]), np.array(state["p"])
        self._turned = np.array(state.get("turned", [0.0] * 9))  # older recordings have neither of the two
        self._far = state.get("far", 0.0)
        self.matrix_sigma, self._since_widened = state["matrix_sigma"], state["since_widened"]
        self._field_age = state["field_age"]
        self._rest_rates.restore(state["rest_rates"])
        self.watch.restore(state["watch"])
        self._weigh()
