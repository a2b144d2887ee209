"""How far the polar target reaches: in steps, nearer as the error falls, with hysteresis and a short glide between."""

from __future__ import annotations

import math

STEPS = ((6.0, 1.0), (12.0, 2.0), (30.0, 5.0), (60.0, 10.0), (180.0, 30.0))
"""(error at the rim, from ring to ring), deg."""
NEARER = 0.7
"""Of the next smaller range: the error must be inside this before the scale zooms in."""
FARTHER = 0.95
"""Of the present range: beyond this the scale zooms out."""
ROOM = 1.5
"""The smallest range is at least this many times the tolerance."""
_GLIDE = 0.3  # of the way, in the logarithm, in each frame
_NEAR_ENOUGH = 0.01


class PolarScale:
    """The step in use, and the range on screen, which glides to it in a fifth of a second."""

    def __init__(self) -> None:
        self._step = len(STEPS) - 1
        self.range_deg = STEPS[-1][0]
        """At the rim, on screen now, deg."""

    @property
    def goal_deg(self) -> float:
        """At the rim, once the glide is over, deg."""
        return STEPS[self._step][0]

    @property
    def ring_deg(self) -> float:
        """From ring to ring, deg."""
        return STEPS[self._step][1]

    def follow(self, error_deg: float, tolerance_deg: float, glide: bool = True) -> None:
        """Choose the step for an error in deg (NaN: keep it) and move one frame towards it, or all the way."""
        nearest = next((i for i, (reach, _) in enumerate(STEPS) if reach >= ROOM * tolerance_deg), len(STEPS) - 1)
        if math.isfinite(error_deg):
            while self._step < len(STEPS) - 1 and error_deg > FARTHER * STEPS[self._step][0]:
                self._step += 1
            while self._step > nearest and error_deg < NEARER * STEPS[self._step - 1][0]:
                self._step -= 1
        self._step = max(self._step, nearest)
        ratio = self.goal_deg / self.range_deg
        settled = not glide or abs(math.log(ratio)) < _NEAR_ENOUGH
        self.range_deg = self.goal_deg if settled else self.range_deg * ratio**_GLIDE

    @property
    def gliding(self) -> bool:
        """Whether the range on screen is still on its way."""
        return self.range_deg != self.goal_deg
