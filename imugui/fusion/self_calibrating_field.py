"""FieldWatch: how far is the field from the earth's, and may the heading follow it?"""

from __future__ import annotations

from math import hypot
from typing import Any

FIRST_AFTER = 1.0  # s of a steady field before the first reference is taken
UNDISTURBED_AFTER = 0.5  # s near the reference before the field is used again
WEAKLY_AFTER = 60.0  # s of unbroken disturbance before the field is followed again, weakly
NEW_AFTER = 20.0  # s of another steady field, the board turning, before it becomes the reference
NEW_TAU = 20.0  # s, how slowly the candidate is followed
TURNING = 0.35  # rad/s
WEAKER = 4.0  # factor on the noise of a field followed weakly


class FieldWatch:
    """Compares norm and dip with a slowly followed reference, once a block.

    ``departure`` is d = sqrt((norm / norm limit)^2 + (dip / dip limit)^2); the field is disturbed where d >= 1.
    """

    def __init__(self) -> None:
        self.departure = 0.0
        self.disturbed = False
        self._norm = self._dip = 0.0  # the reference, uT and rad
        self._known = False
        self._near = 0.0  # s undisturbed
        self._far = 0.0  # s of unbroken disturbance
        self._new_norm = self._new_dip = 0.0  # the candidate for a new reference
        self._steady = 0.0  # s near the candidate

    def update(self, norm: float, dip: float, dt: float, rate: float, limits: tuple[float, float, float]) -> None:
        """Take a block's field (uT, rad) for ``dt`` s, turning at ``rate`` rad/s; limits: norm, dip (rad), tau (s)."""
        norm_limit, dip_limit, tau = limits
        self._follow_candidate(norm, dip, dt, rate, norm_limit, dip_limit)
        if not self._known:
            self._known = self._steady >= FIRST_AFTER
            self._norm, self._dip = self._new_norm, self._new_dip
        more, deeper = norm - self._norm, dip - self._dip
        self.departure = hypot(more / (norm_limit * max(self._norm, 1e-9)), deeper / dip_limit)
        if self.departure < 1.0:
            self._near, self._far = self._near + dt, 0.0
            self.disturbed = self.disturbed and self._near < UNDISTURBED_AFTER
            if not self.disturbed:
                k = dt / (tau + dt)
                self._norm, self._dip = self._norm + k * more, self._dip + k * deeper
        elif self._steady >= NEW_AFTER:
            self._norm, self._dip, self._near = self._new_norm, self._new_dip, 0.0
        else:
            self._near, self._far, self.disturbed = 0.0, self._far + dt, self._known

    def noise_factor(self) -> float:
        """Factor on the noise of the heading, or 0 when the field must not be used."""
        if not self.disturbed:
            return (1.0 + self.departure) ** 2
        return WEAKER if self._far >= WEAKLY_AFTER else 0.0

    def _follow_candidate(
        self, norm: float, dip: float, dt: float, rate: float, norm_limit: float, dip_limit: float
    ) -> None:
        more, deeper = norm - self._new_norm, dip - self._new_dip
        if hypot(more / (norm_limit * max(self._new_norm, 1e-9)), deeper / dip_limit) < 1.0:
            k = dt / (NEW_TAU + dt)
            self._new_norm, self._new_dip = self._new_norm + k * more, self._new_dip + k * deeper
            if rate > TURNING or not self._known:
                self._steady += dt
        else:
            self._new_norm, self._new_dip, self._steady = norm, dip, 0.0

    def state(self) -> dict[str, Any]:
        """Everything that the next update depends on, as plain numbers."""
        return dict(vars(self))

    def restore(self, state: dict[str, Any]) -> None:
        """Continue from ``state``."""
        vars(self).update(state)
