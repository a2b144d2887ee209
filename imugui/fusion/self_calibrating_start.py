"""Start of the self-calibrating filter: the first vertical, the first heading, and a board found lying otherwise."""

from __future__ import annotations

from collections.abc import Sequence
from math import atan2, hypot, radians, tan
from typing import Any

from imugui.fusion.light import in_earth, tilt_error
from imugui.fusion.quaternion import Floats, from_rotation_vector, multiply
from imugui.fusion.scalar import FREE_FALL, HELD, Quat, direction, rotation_rows, turned_in_earth
from imugui.fusion.self_calibrating_block import Sums
from imugui.samples import GRAVITY

UPRIGHT_S = 0.1  # s of forces, over which the first vertical is averaged
SETTLED = 10  # fields, over which the first heading is averaged
FIELD_GONE = 10.0  # s without a field, after which the heading is the gyroscope's alone

ASKEW = tan(radians(20.0))  # a quiet board that feels gravity so far from the vertical is not where it seems
ASKEW_AFTER = 0.5  # s
QUIET_RATE = 0.1  # rad/s
QUIET_FORCE = 0.5  # m/s2, so little that no horizontal acceleration could look like ASKEW


class Start:
    """How far the start has come; its steps take an attitude and return the next."""

    def __init__(self) -> None:
        self.field_age = 0.0  # s since the last field
        self._upright = 0.0  # s of forces that have set the vertical
        self._fields = 0  # that have set the heading; SETTLED when it is known
        self._askew = 0.0  # s for which gravity has contradicted the attitude

    def given(self, heading_known: bool) -> None:
        """The attitude came from elsewhere: only the heading may still be open."""
        self.field_age = self._askew = 0.0
        self._upright, self._fields = UPRIGHT_S, SETTLED if heading_known else 0

    @property
    def levelling(self) -> bool:
        """Do forces still set the vertical?"""
        return self._upright < UPRIGHT_S

    @property
    def fields(self) -> int:
        """How many fields have set the heading."""
        return self._fields

    @property
    def blind(self) -> bool:
        """Has no field set the heading, or none come for long?"""
        return self._fields == 0 or self.field_age > FIELD_GONE

    def level(self, quat: Quat, acc: Sequence[float], dt: float) -> Quat:
        """The first tenth of a second sets the vertical: the mean of its forces, each as long as its sample."""
        self._upright += dt
        up = direction(acc, FREE_FALL)
        if up is None or dt <= 0.0:
            return quat
        x, y, z = tilt_error(in_earth(up, rotation_rows(quat)))
        share = dt / (self._upright + dt)
        return turned_in_earth(quat, share * x, share * y, share * z)

    def turn_north(self, quat: Quat, mag: Sequence[float], dt: float) -> Quat:
        """The first fields set the heading: the first alone, then the mean of all, up to ten.

        A board that holds its field may have taken the first a while ago, turned otherwise: when the second comes
        later than the next sample, it sets the heading alone, too.
        """
        held = self.field_age > HELD * dt
        east, north, _ = in_earth((mag[0], mag[1], mag[2]), rotation_rows(quat))
        error = atan2(east, north)
        turn = error if self._fields == 0 or (self._fields == 1 and held) else error / (self._fields + 1)
        self._fields += 1
        # the tangent makes the short form of turned_in_earth exact
        return turned_in_earth(quat, 0.0, 0.0, 2.0 * tan(0.5 * turn))

    def turn_up(self, quat: Quat, sums: Sums) -> Quat | None:
        """None, unless a quiet board's gravity is far from the vertical; half a second later it is turned up.

        Until then (the same attitude is returned) nothing may be learnt: the error is beyond what a linear filter
        can follow: a wrong start, or a shock.
        """
        x, y, z = sums.force.tolist()
        if hypot(x, y) <= ASKEW * z:
            self._askew = 0.0
            return None
        force = hypot(x, y, z) / sums.time
        if sums.turning > QUIET_RATE**2 * sums.time or abs(force - GRAVITY) > QUIET_FORCE:
            return None
        self._askew += sums.time
        if self._askew < ASKEW_AFTER:
            return quat
        self._askew = 0.0
        ex, ey, _ = tilt_error(direction((x, y, z), 0.0) or (0.0, 0.0, 1.0))
        angle = atan2(hypot(x, y), z) / hypot(ex, ey)
        return as_quat(multiply(from_rotation_vector((angle * ex, angle * ey, 0.0)), quat))

    def state(self) -> dict[str, Any]:
        """Everything that the next step depends on, as plain numbers."""
        return dict(vars(self))

    def restore(self, state: dict[str, Any]) -> None:
        """Continue from ``state``."""
        vars(self).update(state)


def as_quat(array: Floats) -> Quat:
    """An attitude (4,) as plain floats."""
    w, x, y, z = array.tolist()
    return w, x, y, z
