"""Detectors for the filters that bring none: is the board at rest, is the field the earth's alone?

The rules and numbers are those of VQF (D. Laidig and T. Seel, Information Fusion 91, 2023, sections 3.4 and 3.6),
with first-order low-passes, so that both words mean the same whichever filter is chosen.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot, radians
from typing import Any

REST_TAU = 0.5  # s, low-pass from which a resting sensor hardly departs
REST_GYR = radians(2.0)  # rad/s, largest departure at rest, and largest bias believed
REST_ACC = 0.5  # m/s2, largest departure at rest
REST_AFTER = 1.5  # s without a larger departure

FIELD_TAU = 0.05  # s, low-pass on norm and dip
FIELD_REFERENCE_TAU = 20.0  # s, how slowly the reference follows an undisturbed field
FIELD_NORM = 0.1  # largest relative departure of the norm from the reference
FIELD_DIP = radians(10.0)  # rad, largest departure of the dip
FIELD_UNDISTURBED_AFTER = 0.5  # s near the reference
FIELD_FIRST_AFTER = 1.0  # s of a steady field before the first reference is taken
FIELD_NEW_AFTER = 20.0  # s of another steady field, the board turning, before it becomes the reference
FIELD_TURNING = radians(20.0)  # rad/s


class RestDetector:
    """Calls ``rest`` when gyroscope and accelerometer have stayed near their own low-passes for 1.5 s."""

    def __init__(self) -> None:
        self.rest = False
        self.rate = 0.0  # rad/s, length of the low-passed angular rate
        self._quiet = 0.0
        self._low: list[float] = []

    def update(self, gyr: Sequence[float], acc: Sequence[float], dt: float) -> bool:
        """Take one sample (rad/s, m/s2; ``dt`` in s) and return ``rest``."""
        if not self._low:
            self._low = [*gyr, *acc]
        k = dt / (REST_TAU + dt)
        gx, gy, gz, ax, ay, az = self._low
        ux, uy, uz = gyr[0] - gx, gyr[1] - gy, gyr[2] - gz
        vx, vy, vz = acc[0] - ax, acc[1] - ay, acc[2] - az
        if not (acc[0] or acc[1] or acc[2]):
            vx = vy = vz = 0.0  # no force was measured
        gx, gy, gz = gx + k * ux, gy + k * uy, gz + k * uz
        self._low = [gx, gy, gz, ax + k * vx, ay + k * vy, az + k * vz]
        self.rate = hypot(gx, gy, gz)
        if hypot(ux, uy, uz) < REST_GYR and hypot(vx, vy, vz) < REST_ACC and self.rate < REST_GYR:
            self._quiet += dt
            self.rest = self._quiet >= REST_AFTER
        else:
            self._quiet = 0.0
            self.rest = False
        return self.rest

    def state(self) -> dict[str, Any]:
        """Everything that the next update depends on, as plain numbers and lists."""
        return {**vars(self), "_low": list(self._low)}

    def restore(self, state: dict[str, Any]) -> None:
        """Continue from ``state``."""
        vars(self).update({**state, "_low": list(state["_low"])})


class FieldDetector:
    """Calls the field ``disturbed`` while its norm or dip departs from a slowly followed reference."""

    def __init__(self) -> None:
        self.disturbed = False
        self._known = False  # there is a reference
        # norm (uT) and dip (rad), each low-passed, as reference and as candidate for a new reference
        self._norm = self._dip = 0.0
        self._reference_norm = self._reference_dip = 0.0
        self._candidate_norm = self._candidate_dip = 0.0
        self._near = 0.0  # s near the reference
        self._steady = 0.0  # s near the candidate

    def update(self, norm: float, dip: float, dt: float, rate: float) -> bool:
        """Take one new field (uT, rad), ``dt`` s after the last, turning at ``rate`` rad/s; return ``disturbed``."""
        k = dt / (FIELD_TAU + dt) if self._norm else 1.0
        self._norm = norm = self._norm + k * (norm - self._norm)
        self._dip = dip = self._dip + k * (dip - self._dip)
        k = dt / (FIELD_REFERENCE_TAU + dt)
        self._follow_candidate(norm, dip, dt, k, rate)
        more, deeper = norm - self._reference_norm, dip - self._reference_dip
        if abs(more) < FIELD_NORM * self._reference_norm and abs(deeper) < FIELD_DIP:
            self._near += dt
            if self._near >= FIELD_UNDISTURBED_AFTER:
                self.disturbed = False
                self._reference_norm += k * more
                self._reference_dip += k * deeper
        elif self._steady >= (FIELD_NEW_AFTER if self._known else FIELD_FIRST_AFTER):
            self._reference_norm, self._reference_dip = self._candidate_norm, self._candidate_dip
            self._known, self.disturbed, self._near = True, False, FIELD_UNDISTURBED_AFTER
        else:
            self.disturbed, self._near = self._known, 0.0
        return self.disturbed

    def _follow_candidate(self, norm: float, dip: float, dt: float, k: float, rate: float) -> None:
        """A field that stays the same while the board turns may become the new reference."""
        more, deeper = norm - self._candidate_norm, dip - self._candidate_dip
        if abs(more) < FIELD_NORM * self._candidate_norm and abs(deeper) < FIELD_DIP:
            self._candidate_norm += k * more
            self._candidate_dip += k * deeper
            if rate > FIELD_TURNING or not self._known:
                self._steady += dt
        else:
            self._candidate_norm, self._candidate_dip, self._steady = norm, dip, 0.0

    def state(self) -> dict[str, Any]:
        """Everything that the next update depends on, as plain numbers."""
        return dict(vars(self))

    def restore(self, state: dict[str, Any]) -> None:
        """Continue from ``state``."""
        vars(self).update(state)
