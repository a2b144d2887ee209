"""The response curve: dead zone, exponent, saturation."""

from __future__ import annotations

from math import hypot

from imugui.targeting.settings import Control
from imugui.targeting.view_pose import ZERO, Pair


class Curve:
    """Shapes the length of a turn and keeps its direction, so the dead zone is round and diagonals stay diagonal.

    With e the length, d the dead zone, s the saturation and p the exponent the new length is
    (s - d) ((min(e, s) - d) / (s - d))^p beyond d, and 0 within: continuous, and reaching s - d whatever p is.
    """

    def __init__(self, control: Control) -> None:
        self.dead_deg = control.dead_zone_deg
        self.saturation_deg = control.saturation_deg
        self.exponent = control.exponent

    def excess(self, turn: Pair) -> Pair:
        """By how much a turn in deg is beyond saturation, deg."""
        length = hypot(*turn)
        if length <= self.saturation_deg:
            return ZERO
        part = 1.0 - self.saturation_deg / length
        return part * turn[0], part * turn[1]

    def shape(self, turn: Pair) -> Pair:
        """The turn in deg as it counts, deg."""
        length = hypot(*turn)
        span = self.saturation_deg - self.dead_deg
        if not length > self.dead_deg or span <= 0.0:
            return ZERO
        over = min(length, self.saturation_deg) - self.dead_deg
        if self.exponent != 1.0:
            over = span * (over / span) ** self.exponent
        part = over / length
        return part * turn[0], part * turn[1]
