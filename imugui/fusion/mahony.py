"""Mahony's explicit complementary filter with gyroscope bias."""

from __future__ import annotations

from dataclasses import dataclass
from math import expm1, hypot
from typing import ClassVar

from imugui.fields import field as editable
from imugui.fusion.light import TEACHES_BIAS, LightFilter, field_error, tilt_error
from imugui.fusion.scalar import NOTHING, Rows3, Vector


@dataclass(frozen=True)
class MahonyParams:
    """Two gains."""

    kp: float = editable(
        0.74, "Kp, proportional gain", unit="1/s", low=0.0, high=100.0, step=0.1,
        tip="How fast gravity and field are followed: errors fall with the time constant 1/Kp.",
    )  # fmt: skip
    ki: float = editable(
        0.003, "Ki, integral gain", unit="1/s2", low=0.0, high=10.0, step=0.001,
        tip="How fast the gyroscope bias is learnt; 0 leaves it alone.",
    )  # fmt: skip


class Mahony(LightFilter):
    """R. Mahony, T. Hamel, J.-M. Pflimlin, IEEE Trans. Automatic Control 53(5), 2008, section V, equation 32.

    The rate is corrected by Kp * w and the bias moves by -Ki * w, where w is the sum of the cross products of measured
    and estimated directions (weights k_i = 1). For the step from sample to sample Kp * dt becomes
    (1 - exp(-2 Kp dt))/2: the same for small steps, and two measurements together never overshoot at large ones,
    like Kp 15 with a field every 0.125 s. While the tilt is more than 20 degrees off no bias is learnt: the attitude
    is wrong then, not the gyroscope.
    """

    title = "Mahony"
    Params = MahonyParams
    PRESETS: ClassVar[dict[str, MahonyParams]] = {
        "Default": MahonyParams(),
        "BROAD best": MahonyParams(kp=0.74, ki=0.001),  # the best single pair on those recordings
        "Screw assistant 2018": MahonyParams(kp=15.0, ki=0.0),
        "Motion card 2018": MahonyParams(kp=1.4, ki=0.002),
        "Winer sketch": MahonyParams(kp=10.0, ki=0.0),
    }

    params: MahonyParams

    def _turn(self, gravity: Vector | None, field: Vector | None, rows: Rows3, dt: float, field_age: float) -> Vector:
        gx, gy, gz = NOTHING if gravity is None else tilt_error(gravity)
        fx, fy, fz = NOTHING if field is None else field_error(field)
        if self.params.ki > 0.0 and hypot(gx, gy) < TEACHES_BIAS:
            i, j = self.params.ki * dt, self.params.ki * field_age
            self._lower_bias((i * gx + j * fx, i * gy + j * fy, i * gz + j * fz), rows)
        k = self._gain(dt)
        kf = k if field_age == dt else self._gain(field_age)
        return k * gx + kf * fx, k * gy + kf * fy, k * gz + kf * fz

    def _gain(self, dt: float) -> float:
        return -0.5 * expm1(-2.0 * self.params.kp * dt)
