"""imugui's own filter: it calibrates its gyroscope while it runs, and says how far to trust it."""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot, nan, radians
from typing import Any, ClassVar

import numpy as np

from imugui.fusion.attitude import from_acc_mag
from imugui.fusion.detectors import RestDetector
from imugui.fusion.quaternion import Floats, normalise
from imugui.fusion.scalar import (
    FREE_FALL,
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
from imugui.fusion.self_calibrating_block import Block
from imugui.fusion.self_calibrating_guard import Guard
from imugui.fusion.self_calibrating_params import ImuguiParams
from imugui.fusion.self_calibrating_start import SETTLED, Start, as_quat
from imugui.fusion.self_calibrating_steps import BIAS, MATRIX
from imugui.samples import GRAVITY

BLOCK_S = 0.048  # s; a block ends with the sample nearest to it: after 40 to 50 ms at all usual rates
FIRST_TILT, FIRST_HEADING = radians(2.0), radians(6.0)  # sigmas of the first attitude
GIVEN = radians(5.0), radians(8.0)  # sigmas of tilt and heading of an attitude that came from elsewhere

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
        self._start = Start()
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
            self._attitude = as_quat(from_acc_mag(up))
            self._started, dt = True, 0.0
        rate = self._turn(gyr, acc, dt)
        if self._start.levelling:
            self._attitude = self._start.level(self._attitude, acc, dt)
        if mag is not None and not NO_FIELD < hypot(*mag) < LARGEST:
            mag = None
        self._start.field_age += dt
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

    def _take_field(self, mag: Sequence[float], dt: float) -> None:
        """The first fields set the heading, later ones are kept for the block's end."""
        start = self._start
        if start.fields < SETTLED:
            if start.fields == 0:
                self._estimator.doubt_heading(FIRST_HEADING)
            self._attitude = start.turn_north(self._attitude, mag, dt)
            self._block.clear()
        else:
            self._block.add_field(mag)
        start.field_age = 0.0

    def _end_block(self) -> None:
        """Learn from the block, correct the attitude, and see whether all is well."""
        sums = self._block.sums(self._full_scale)
        estimator, risen = self._estimator, self._start.turn_up(self._attitude, sums)
        if risen is not None:
            self._block.clear()
            if risen is not self._attitude:
                self._attitude = risen
                estimator.restart(*GIVEN)
            return
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
        return float(np.sqrt(self._estimator.p.diagonal()[MATRIX].max()))

    @property
    def first_sigma(self) -> float:
        """What that was at first: as set, or widened since."""
        return self._estimator.matrix_sigma

    @property
    def bias_sigma(self) -> Vector:
        """1 sigma of the learnt bias, rad/s."""
        x, y, z = np.sqrt(np.maximum(self._estimator.p.diagonal()[BIAS], 0.0)).tolist()
        return x, y, z

    @property
    def delay(self) -> float:
        """Of the magnetometer, s: as set, and what was learnt beyond it."""
        return self._estimator.delay

    def start(self, quat: Sequence[float], heading_known: bool = True) -> None:
        """Begin again at an attitude: see ``Filter.start``."""
        self._attitude = self.quat = as_quat(normalise(quat))
        self.rest = False
        self._started = True
        self._start.given(heading_known)
        self._rest_detector = RestDetector()
        self._estimator.restart(*GIVEN)
        self._block.clear()
        if self._guard.fallback is not None:
            self._guard.fallback.start(quat, heading_known)

    def refer_heading(self, off: bool = False) -> None:
        """Call the present heading right by definition: ``sigma_heading`` counts from here.

        ``off``: the magnetometer was switched off; otherwise it counts as gone ten seconds after its last field.
        Only without a magnetometer; with one, and while another filter has taken over, it does nothing. It takes the
        heading's error and its correlations out of P. That is no pretence: without a field nothing measures the
        heading, and north is a convention. Calling the present heading exact moves the convention by the error it
        had. Seen from there the heading has none, and all else (tilt, bias, matrix) is as well known as before.
        """
        if self._guard.fallback is None and (off or self._start.blind):
            self._estimator.doubt_heading(0.0)

    def state(self) -> dict[str, Any]:
        """Everything that the next update depends on."""
        kept = ("rest", "disturbed", "_started")
        lists = ("quat", "bias", "_attitude", "_offset", "_gain")
        parts = ("_start", "_estimator", "_block", "_rest_detector", "_guard")
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
