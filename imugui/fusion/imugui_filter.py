"""imugui's own filter: it calibrates its gyroscope while it runs, and says how far to trust it."""

from __future__ import annotations

from collections.abc import Sequence
from math import atan2, hypot, nan, radians, tan
from typing import Any, ClassVar

import numpy as np

from imugui.fusion.attitude import from_acc_mag
from imugui.fusion.detectors import RestDetector
from imugui.fusion.light import in_earth, tilt_error
from imugui.fusion.quaternion import Floats, from_rotation_vector, multiply, normalise
from imugui.fusion.scalar import (
    FREE_FALL,
    HELD,
    LARGEST,
    NO_FIELD,
    NOTHING,
    Quat,
    Vector,
    bounded,
    direction,
    rotation_rows,
    sane,
    turned_in_earth,
    turned_in_sensor,
)
from imugui.fusion.self_calibrating import Estimator
from imugui.fusion.self_calibrating_block import Block, Sums
from imugui.fusion.self_calibrating_guard import Guard
from imugui.fusion.self_calibrating_params import ImuguiParams
from imugui.samples import GRAVITY

BLOCK_S = 0.048  # s; a block ends with the sample nearest to it: after 40 to 50 ms at all usual rates
UPRIGHT_S = 0.1  # s of forces, over which the first vertical is averaged
SETTLED = 10  # fields, over which the first heading is averaged
FIRST_TILT, FIRST_HEADING = radians(2.0), radians(6.0)  # sigmas of the first attitude
GIVEN = radians(5.0), radians(8.0)  # sigmas of tilt and heading of an attitude that came from elsewhere

ASKEW = tan(radians(20.0))  # a quiet board that feels gravity so far from the vertical is not where it seems
ASKEW_AFTER = 0.5  # s
QUIET_RATE = 0.1  # rad/s
QUIET_FORCE = 0.5  # m/s2, so little that no horizontal acceleration could look like ASKEW

NO_TURN: Quat = (1.0, 0.0, 0.0, 0.0)


class Imugui:
    """An error-state Kalman filter on blocks of 40 to 50 ms; between their ends the gyroscope alone turns the attitude.

    The steps are in self_calibrating_steps.py, their order in self_calibrating.py. ``sigma_tilt`` and
    ``sigma_heading`` (rad) are its own 1 sigma. When it is no longer to be believed, VQF takes over until it is,
    ``note`` says why, and the sigmas are NaN.
    """

    title: ClassVar[str] = "imugui"
    Params: ClassVar[type[ImuguiParams]] = ImuguiParams
    PRESETS: ClassVar[dict[str, ImuguiParams]] = {
        "Default": ImuguiParams(),
        "Uncalibrated gyroscope": ImuguiParams(matrix_sigma=0.02, bias_sigma_dps=2.0),
        "Vehicle": ImuguiParams(bounded=False),
    }

    def __init__(self, params: ImuguiParams | None = None) -> None:
        self.params = params if params is not None else ImuguiParams()
        self.quat: Quat = (1.0, 0.0, 0.0, 0.0)
        self.bias: Vector = NOTHING
        self.rest = False
        self.disturbed = False
        self._ahead = 1e-3 * self.params.gyr_latency_ms
        self._full_scale = radians(self.params.gyr_full_scale_dps)
        self._attitude = self.quat  # of the last sample, not predicted
        self._offset: tuple[float, ...] = NOTHING  # b and 1 + M of the rate (1 + M) w - b
        self._gain: tuple[float, ...] = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
        self._started = False
        self._upright = 0.0  # s of forces that have set the vertical
        self._fields = 0  # that have set the heading; SETTLED when it is known
        self._field_age = 0.0  # s since the last field
        self._askew = 0.0  # s for which gravity has contradicted the attitude
        self._estimator = Estimator(self.params)
        self._estimator.forget(FIRST_TILT, 0.0)
        self._block = Block(self._estimator.delay)
        self._rest_detector = RestDetector()
        self._guard = Guard()

    def update(self, gyr: Sequence[float], acc: Sequence[float], mag: Sequence[float] | None, dt: float) -> None:
        """Take one sample: see ``Filter.update``."""
        dt = bounded(dt)
        gyr, acc = sane(gyr), sane(acc)
        if not self._started:
            up = direction(acc, FREE_FALL)
            if up is None:
                return
            self._attitude = _quat(from_acc_mag(up))
            self._started, dt = True, 0.0
        rate = self._turn(gyr, acc, dt)
        if self._upright < UPRIGHT_S:
            self._level(acc, dt)
        if mag is not None and not NO_FIELD < hypot(*mag) < LARGEST:
            mag = None
        self._field_age += dt
        if mag is not None:
            self._take_field(mag, dt)
        if self._block.time > 0.0 and self._block.time + 0.5 * dt >= BLOCK_S:
            self._end_block()
        self._show(rate, gyr, acc, mag, dt)

    def _turn(self, gyr: Sequence[float], acc: Sequence[float], dt: float) -> Vector:
        """Integrate the corrected rate, q <- q exp(((1 + M) w - b) dt / 2), and buffer the sample."""
        x, y, z = gyr
        xx, xy, xz, yx, yy, yz, zx, zy, zz = self._gain
        bx, by, bz = self._offset
        x, y, z = xx * x + xy * y + xz * z - bx, yx * x + yy * y + yz * z - by, zx * x + zy * y + zz * z - bz
        self._attitude = quat = turned_in_sensor(self._attitude, x * dt, y * dt, z * dt)
        self.rest = self._rest_detector.update((x, y, z), acc, dt)
        if acc[0] == 0.0 and acc[1] == 0.0 and acc[2] == 0.0:
            ux, uy, uz = rotation_rows(quat)[2]  # no force was measured: as if it were gravity alone
            acc = (GRAVITY * ux, GRAVITY * uy, GRAVITY * uz)
        self._block.add(gyr, acc, quat, dt)
        return x, y, z

    def _level(self, acc: Sequence[float], dt: float) -> None:
        """The first tenth of a second sets the vertical: the mean of its forces, each as long as its sample."""
        self._upright += dt
        up = direction(acc, FREE_FALL)
        if up is not None and dt > 0.0:
            x, y, z = tilt_error(in_earth(up, rotation_rows(self._attitude)))
            share = dt / (self._upright + dt)
            self._attitude = turned_in_earth(self._attitude, share * x, share * y, share * z)

    def _take_field(self, mag: Sequence[float], dt: float) -> None:
        """The first fields set the heading: the first alone, then the mean of all, up to ten; later ones are kept.

        A board that holds its field may have taken the first a while ago, turned otherwise: when the second comes
        later than the next sample, it sets the heading alone, too.
        """
        held, self._field_age = self._field_age > HELD * dt, 0.0
        if self._fields >= SETTLED:
            self._block.add_field(mag)
            return
        east, north, _ = in_earth((mag[0], mag[1], mag[2]), rotation_rows(self._attitude))
        error = atan2(east, north)
        turn = error if self._fields == 0 or (self._fields == 1 and held) else error / (self._fields + 1)
        if self._fields == 0:
            self._estimator.doubt_heading(FIRST_HEADING)
        self._fields += 1
        # the tangent makes the short form of turned_in_earth exact
        self._attitude = turned_in_earth(self._attitude, 0.0, 0.0, 2.0 * tan(0.5 * turn))
        self._block.clear()

    def _end_block(self) -> None:
        """Learn from the block, correct the attitude, and see whether all is well."""
        sums = self._block.sums(self._full_scale)
        if self._contradicted(sums):
            return
        estimator = self._estimator
        x, y, z = estimator.step(sums, self.rest)
        self._attitude = turned_in_earth(self._attitude, x, y, z)
        self._offset, self._gain = estimator.correction()
        self._block.delay = estimator.delay
        self._block.clear(np.array(rotation_rows(turned_in_earth(NO_TURN, x, y, z))))
        trouble = self._guard.trouble(
            estimator.nominal, estimator.p, sums.time, estimator.position_nis, estimator.heading_nis
        )
        if trouble:
            self._fall_back(trouble)
        else:
            self._guard.passed(sums.time)

    def _contradicted(self, sums: Sums) -> bool:
        """Is a quiet board's gravity far from the vertical? Half a second later it is turned up.

        Until then nothing is learnt: the error is beyond what a linear filter can follow: a wrong start, or a shock.
        """
        x, y, z = sums.force.tolist()
        if hypot(x, y) <= ASKEW * z:
            self._askew = 0.0
            return False
        force = hypot(x, y, z) / sums.time
        if sums.turning > QUIET_RATE**2 * sums.time or abs(force - GRAVITY) > QUIET_FORCE:
            return False
        self._askew += sums.time
        self._block.clear()
        if self._askew >= ASKEW_AFTER:
            ex, ey, _ = tilt_error(direction((x, y, z), 0.0) or (0.0, 0.0, 1.0))
            angle = atan2(hypot(x, y), z) / hypot(ex, ey)
            self._attitude = _quat(multiply(from_rotation_vector((angle * ex, angle * ey, 0.0)), self._attitude))
            self._estimator.restart(*GIVEN)
            self._askew = 0.0
        return True

    def _fall_back(self, reason: str) -> None:
        """Let VQF take over, and begin again from its attitude."""
        safe = self._attitude if np.isfinite(self._attitude).all() else self.quat
        self._guard.fall_back(reason, safe)
        if self._guard.fallback is not None:
            self._attitude = self._guard.fallback.quat
        self._estimator.forget(*GIVEN)
        self._offset, self._gain = self._estimator.correction()
        self._block = Block(self._estimator.delay)

    def _show(
        self, rate: Vector, gyr: Sequence[float], acc: Sequence[float], mag: Sequence[float] | None, dt: float
    ) -> None:
        """Set what is seen from outside: VQF's attitude while it has taken over, else the own, predicted ahead."""
        other, ahead = self._guard.fallback, self._ahead
        if other is not None:
            other.update(gyr, acc, mag, dt)
            self.quat, self.bias, self.disturbed = other.quat, other.bias, other.disturbed
            return
        self.quat = quat = self._attitude
        if ahead > 0.0:
            x, y, z = rate
            self.quat = turned_in_sensor(quat, x * ahead, y * ahead, z * ahead)
        if self._block.time == 0.0:
            bx, by, bz = self._offset
            self.bias = (bx, by, bz)
            self.disturbed = self._estimator.watch.disturbed

    @property
    def sigma_tilt(self) -> float:
        """1 sigma of the inclination, rad; NaN while another filter has taken over."""
        return nan if self._guard.fallback is not None else self._estimator.sigmas[0]

    @property
    def sigma_heading(self) -> float:
        """1 sigma of the heading, rad; without a magnetometer, of the heading since the start."""
        return nan if self._guard.fallback is not None else self._estimator.sigmas[1]

    @property
    def note(self) -> str:
        """Why another filter has taken over, in a sentence; empty when none has."""
        other = self._guard.fallback
        return "" if other is None else f"{other.title} has taken over for now: {self._guard.reason}."

    @property
    def matrix(self) -> Floats:
        """The learnt matrix 1 + M, (3, 3): rate = matrix @ gyr - bias."""
        return np.array(self._gain).reshape(3, 3)

    @property
    def matrix_sigma(self) -> float:
        """1 sigma of the worst known element of the learnt matrix."""
        return float(np.sqrt(self._estimator.p.diagonal()[12:21].max()))

    @property
    def delay(self) -> float:
        """Of the magnetometer, s: as set, and what was learnt beyond it."""
        return self._estimator.delay

    def start(self, quat: Sequence[float], heading_known: bool = True) -> None:
        """Begin again at an attitude: see ``Filter.start``."""
        self._attitude = self.quat = _quat(normalise(quat))
        self.rest = False
        self._started, self._fields = True, SETTLED if heading_known else 0
        self._field_age = self._askew = 0.0
        self._upright = UPRIGHT_S
        self._rest_detector = RestDetector()
        self._estimator.restart(*GIVEN)
        self._block.clear()
        if self._guard.fallback is not None:
            self._guard.fallback.start(quat, heading_known)

    def state(self) -> dict[str, Any]:
        """Everything that the next update depends on."""
        kept = ("rest", "disturbed", "_started", "_upright", "_fields", "_field_age", "_askew")
        lists = ("quat", "bias", "_attitude", "_offset", "_gain")
        parts = ("_estimator", "_block", "_rest_detector", "_guard")
        return {
            **{name: getattr(self, name) for name in kept},
            **{name: list(getattr(self, name)) for name in lists},
            **{name: getattr(self, name).state() for name in parts},
        }

    def restore(self, state: dict[str, Any]) -> None:
        """Continue from a state of the same class."""
        for name, value in state.items():
            if isinstance(value, dict):
                getattr(self, name).restore(value)
            else:
                setattr(self, name, tuple(value) if isinstance(value, list) else value)


def _quat(array: Floats) -> Quat:
    w, x, y, z = array.tolist()
    return w, x, y, z
