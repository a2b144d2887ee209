"""Madgwick's gradient-descent filter with gyroscope bias."""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot
from typing import ClassVar

from imugui.fields import field as editable
from imugui.fusion.light import TEACHES_BIAS, LightFilter, field_error, tilt_error
from imugui.fusion.scalar import NOTHING, Rows3, Vector

LARGEST_GAIN = 0.5  # a step along the gradient that would pass the minimum is cut


@dataclass(frozen=True)
class MadgwickParams:
    """Two gains."""

    beta: float = editable(
        0.08, "beta, speed of descent", unit="rad/s", low=0.0, high=10.0, step=0.01,
        tip="How fast gravity and field are followed: the attitude is turned by at most 2 beta.",
    )  # fmt: skip
    zeta: float = editable(
        0.001, "zeta, bias drift", unit="rad/s2", low=0.0, high=1.0, step=0.001,
        tip="How fast the gyroscope bias is learnt; 0 leaves it alone.",
    )  # fmt: skip


class Madgwick(LightFilter):
    """S. Madgwick, An efficient orientation filter for inertial and inertial/magnetic sensor arrays, 2010.

    The paper descends along the normalised gradient J'f of f = (estimated - measured directions), equations 25 to 34
    and 43. Seen as a rotation, that gradient is 2 q * (0, w) with w the sum of the cross products of estimated and
    measured directions: each update turns by 2 beta dt along -w/|w|. (J'f also has a part along q, which only changes
    the length of q and is taken out by normalising.) The field enters with its full reference (0, bx, bz); the
    often copied C code halves it ("_2bx = sqrt(...)"), which bends the direction and slows the heading down.

    The bias goes against the direction of the correction, 2 zeta per second (equations 47 and 48).

    Three things are added. A field measured every tenth sample counts for ten. Close to the minimum, where a step of
    fixed length would jump to and fro across it, the step shrinks with the gradient. And while the tilt is more than
    20 degrees off no bias is learnt: the attitude is wrong then, not the gyroscope.
    """

    title = "Madgwick"
    Params = MadgwickParams
    PRESETS: ClassVar[dict[str, MadgwickParams]] = {
        "Default": MadgwickParams(),
        "BROAD best": MadgwickParams(beta=0.08, zeta=0.0),  # the best single beta on those recordings
        # sqrt(3/4) * 40 deg/s of the Winer sketch; it was given zeta 0.005, but its bias block was commented out
        "RC car 2019": MadgwickParams(beta=0.6046, zeta=0.0),
        "Motion card 2018, quiet": MadgwickParams(beta=0.03, zeta=0.0),
        "Motion card 2018, medium": MadgwickParams(beta=0.1, zeta=0.0),
        "Motion card 2018, fast": MadgwickParams(beta=0.4, zeta=0.0),
    }

    params: MadgwickParams

    def _turn(self, gravity: Vector | None, field: Vector | None, rows: Rows3, dt: float, field_age: float) -> Vector:
        gx, gy, gz = NOTHING if gravity is None else tilt_error(gravity)
        fx, fy, fz = NOTHING if field is None else field_error(field)
        length = hypot(gx + fx, gy + fy, gz + fz)
        k, kf = self._gain(dt, length), self._gain(field_age, length)
        turn = (k * gx + kf * fx, k * gy + kf * fy, k * gz + kf * fz)
        beta, zeta = self.params.beta, self.params.zeta
        if zeta > 0.0 and beta > 0.0 and hypot(gx, gy) < TEACHES_BIAS:
            share = zeta / beta
            self._lower_bias((share * turn[0], share * turn[1], share * turn[2]), rows)
        return turn

    def _gain(self, dt: float, length: float) -> float:
        step = 2.0 * self.params.beta * dt
        return step / length if step < LARGEST_GAIN * length else LARGEST_GAIN if length > 0.0 else 0.0
