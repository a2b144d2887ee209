"""The complementary filter in quaternion form: gyroscope for fast motion, gravity and field for slow."""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2, hypot
from typing import ClassVar

from imugui.fields import field as editable
from imugui.fusion.light import LightFilter, tilt_error
from imugui.fusion.scalar import Rows3, Vector


@dataclass(frozen=True)
class ComplementaryParams:
    """Two time constants."""

    tau: float = editable(
        4.0, "Time constant, tilt", unit="s", low=0.0, high=1000.0, step=0.1,
        tip="How slowly the vertical of the accelerometer is followed; short trusts it more.",
    )  # fmt: skip
    tau_mag: float = editable(
        8.0, "Time constant, heading", unit="s", low=0.0, high=1000.0, step=0.1,
        tip="How slowly the magnetic north is followed; 0 takes the heading straight from the magnetometer.",
    )  # fmt: skip


class Complementary(LightFilter):
    """Each update takes away dt/(tau + dt) of the tilt and of the heading error, as a rotation.

    It works at any attitude, upside down too. The recursion a = tau/(tau + dt) of the seeds' Euler-angle filters is
    the same along one axis; here it acts on the angle between measured and estimated vertical, not on yaw, pitch, roll.
    The field moves the heading only.
    """

    title = "Complementary"
    Params = ComplementaryParams
    PRESETS: ClassVar[dict[str, ComplementaryParams]] = {
        "Default": ComplementaryParams(),
        "Motion card 2018": ComplementaryParams(tau=0.1, tau_mag=0.1),
        "Motion card 2018, slower": ComplementaryParams(tau=0.2, tau_mag=0.2),
        # alpha 0.9 at 15 ms is tau = 0.9/0.1 * 15 ms; its yaw came straight from the magnetometer
        "TIPS probe 2016": ComplementaryParams(tau=0.135, tau_mag=0.0),
        # alpha 0.9 at the 5 ms its scripts assumed
        "RC car 2019": ComplementaryParams(tau=0.045, tau_mag=0.045),
    }

    params: ComplementaryParams

    def _turn(self, gravity: Vector | None, field: Vector | None, rows: Rows3, dt: float, field_age: float) -> Vector:
        x = y = z = 0.0
        if gravity is not None:
            x, y, _ = tilt_error(gravity)
            angle = atan2(hypot(gravity[0], gravity[1]), gravity[2])
            scale = _share(dt, self.params.tau) * angle / (hypot(x, y) or 1.0)
            x, y = scale * x, scale * y
        if field is not None:
            z = _share(field_age, self.params.tau_mag) * atan2(field[0], field[1])
        return x, y, z


def _share(dt: float, tau: float) -> float:
    """1 - a of the recursion with a = tau/(tau + dt)."""
    return dt / (tau + dt) if dt > 0.0 else 0.0
