"""LightFilter: all that the complementary filter, Mahony's and Madgwick's have in common.

One update is: integrate the gyroscope, look where gravity and the field now point in the earth frame,
turn the attitude a little so that they point up and north. The filters differ in how far they turn it.

The attitude is corrected after it was integrated, not before. Comparing a measurement with the attitude one
sample earlier, as many ports do, pulls a turning board off by the turn of a whole sample.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from math import atan2, cos, hypot, radians, sin, tan
from typing import Any, ClassVar

from imugui.fusion.attitude import from_acc_mag
from imugui.fusion.detectors import FieldDetector, RestDetector
from imugui.fusion.quaternion import normalise
from imugui.fusion.scalar import (
    FREE_FALL,
    HELD,
    NO_FIELD,
    NOTHING,
    Quat,
    Rows3,
    Vector,
    bounded,
    direction,
    rotation_rows,
    sane,
    turned_in_earth,
    turned_in_sensor,
)

TEACHES_BIAS = sin(radians(20.0))
"""Length of a tilt error above which it says more about the attitude than about the gyroscope's bias."""

SETTLED = 10  # fields, over which the first heading is averaged


class LightFilter(ABC):
    """Base of the three; a child says in ``_turn`` how far to follow gravity and field."""

    title: ClassVar[str]
    Params: ClassVar[type[Any]]
    PRESETS: ClassVar[dict[str, Any]]

    def __init__(self, params: Any = None) -> None:
        self.params = params if params is not None else self.Params()
        self.quat: Quat = (1.0, 0.0, 0.0, 0.0)
        self.bias: Vector = NOTHING
        self.rest = False
        self.disturbed = False
        self._started = False
        self._fields = 0  # that have set the heading; SETTLED when it is known
        self._field_age = 0.0  # s since the last field measurement
        self._rest_detector = RestDetector()
        self._field_detector = FieldDetector()

    def update(self, gyr: Sequence[float], acc: Sequence[float], mag: Sequence[float] | None, dt: float) -> None:
        """Take one sample: see ``Filter.update``."""
        dt = bounded(dt)
        gyr, acc = sane(gyr), sane(acc)
        self.rest = self._rest_detector.update(gyr, acc, dt)
        up = direction(acc, FREE_FALL)
        self._field_age += dt
        if not self._started:
            if up is None:
                return
            self._begin(up)
        else:
            bx, by, bz = self.bias
            self.quat = turned_in_sensor(self.quat, (gyr[0] - bx) * dt, (gyr[1] - by) * dt, (gyr[2] - bz) * dt)
        rows = rotation_rows(self.quat)
        field = None if mag is None else self._earth_field(mag, rows)
        if field is not None and self._fields < SETTLED:
            rows, field = self._settle(field, held=self._field_age > HELD * dt)
        self._correct(up, field, rows, dt)

    def _begin(self, up: Vector) -> None:
        w, x, y, z = from_acc_mag(up).tolist()
        self.quat = (w, x, y, z)
        self._started = True

    def _earth_field(self, mag: Sequence[float], rows: Rows3) -> Vector | None:
        """The unit field in earth axes as the attitude has it, and a look at whether it is disturbed."""
        m = direction(mag, NO_FIELD)
        if m is None:
            return None
        field = in_earth(m, rows)
        east, north, up = field
        dip = atan2(-up, hypot(east, north))
        self.disturbed = self._field_detector.update(hypot(*mag), dip, self._field_age, self._rest_detector.rate)
        return field

    def _settle(self, field: Vector, held: bool) -> tuple[Rows3, Vector]:
        """The first fields set the heading: the first alone, then the mean of all, up to ten.

        A board that holds its field between measurements may have taken the first a while ago, turned otherwise:
        when the second comes later than the next sample, it sets the heading alone, too.
        """
        east, north, up = field
        error = atan2(east, north)
        turn = error if self._fields == 0 or (self._fields == 1 and held) else error / (self._fields + 1)
        self._fields += 1
        # the tangent makes the short form of turned_in_earth exact
        self.quat = turned_in_earth(self.quat, 0.0, 0.0, 2.0 * tan(0.5 * turn))
        level, left = hypot(east, north), error - turn
        return rotation_rows(self.quat), (level * sin(left), level * cos(left), up)

    def _correct(self, up: Vector | None, field: Vector | None, rows: Rows3, dt: float) -> None:
        """Follow gravity (unit, sensor axes) and the field (unit, earth axes), each None when there is none."""
        field_age = 0.0
        if field is not None:
            field_age, self._field_age = bounded(self._field_age), 0.0
        gravity = None if up is None else in_earth(up, rows)
        x, y, z = self._turn(gravity, field, rows, dt, field_age)
        self.quat = turned_in_earth(self.quat, x, y, z)

    @abstractmethod
    def _turn(self, gravity: Vector | None, field: Vector | None, rows: Rows3, dt: float, field_age: float) -> Vector:
        """The rotation vector (rad, earth axes) of this update's correction.

        ``gravity`` and ``field`` are measured directions, unit vectors in earth axes as the attitude now has them.
        A measurement stands for the time since the last of its kind: ``dt`` s, and ``field_age`` s for the field,
        so that a magnetometer with a tenth of the rate pulls ten times as far at each of its values.
        """

    def _lower_bias(self, step: Vector, rows: Rows3) -> None:
        """Take ``step`` (rad/s, earth axes) off the bias (sensor axes)."""
        x, y, z = step
        (ex, ey, ez), (nx, ny, nz), (ux, uy, uz) = rows
        bx, by, bz = self.bias
        self.bias = (
            bx - ex * x - nx * y - ux * z,
            by - ey * x - ny * y - uy * z,
            bz - ez * x - nz * y - uz * z,
        )

    def start(self, quat: Sequence[float], heading_known: bool = True) -> None:
        """Begin again at an attitude: see ``Filter.start``."""
        w, x, y, z = normalise(quat).tolist()
        self.quat = (w, x, y, z)
        self.rest = False
        self._started, self._fields, self._field_age = True, SETTLED if heading_known else 0, 0.0
        self._rest_detector = RestDetector()

    def state(self) -> dict[str, Any]:
        """Everything that the next update depends on."""
        return {
            "quat": list(self.quat),
            "bias": list(self.bias),
            "disturbed": self.disturbed,
            "started": self._started,
            "fields": self._fields,
            "field_age": self._field_age,
            "rest_detector": self._rest_detector.state(),
            "field_detector": self._field_detector.state(),
        }

    def restore(self, state: dict[str, Any]) -> None:
        """Continue from a state of the same class."""
        w, x, y, z = state["quat"]
        bx, by, bz = state["bias"]
        self.quat, self.bias, self.disturbed = (w, x, y, z), (bx, by, bz), state["disturbed"]
        self._started, self._fields = state["started"], state["fields"]
        self._field_age = state["field_age"]
        self._rest_detector.restore(state["rest_detector"])
        self._field_detector.restore(state["field_detector"])
        self.rest = self._rest_detector.rest


def tilt_error(gravity: Vector) -> Vector:
    """The cross product of measured and true vertical, earth axes: the axis to turn about, sin(angle) long.

    Beyond 90 degrees, where the sine falls again and an upside-down attitude would stay so, it keeps length 1.
    """
    east, north, up = gravity
    if up >= 0.0:
        return north, -east, 0.0
    sine = hypot(east, north)
    if sine < 1e-9:
        return 1.0, 0.0, 0.0  # exactly upside down: any way round will do
    return north / sine, -east / sine, 0.0


def field_error(field: Vector) -> Vector:
    """The cross product of the measured field and the same field turned to north about the vertical, earth axes.

    The reference keeps the measured dip, (0, sqrt(hx2 + hy2), hz), so that a wrong dip does not tilt the attitude
    (S. Madgwick, An efficient orientation filter, 2010, equations 45 and 46, with north along y instead of x).
    """
    east, north, up = field
    level = hypot(east, north)
    return up * (north - level), -up * east, level * east


def in_earth(v: Vector, rows: Rows3) -> Vector:
    """A sensor vector in earth axes."""
    x, y, z = v
    (ex, ey, ez), (nx, ny, nz), (ux, uy, uz) = rows
    return ex * x + ey * y + ez * z, nx * x + ny * y + nz * z, ux * x + uy * y + uz * z
