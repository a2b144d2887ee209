"""The limits of the workspace, of speed and of acceleration."""

from __future__ import annotations

from math import hypot
from typing import NamedTuple

from imugui.targeting.settings import Control
from imugui.targeting.view_pose import ZERO, ZOOM, Pair


class Box(NamedTuple):
    """The places the command may take, px."""

    low: Pair
    high: Pair

    def clamp(self, place: Pair) -> Pair:
        """The nearest place inside."""
        (a, b), low, high = place, self.low, self.high
        return min(max(a, low[0]), high[0]), min(max(b, low[1]), high[1])


def box_around(control: Control, mode: str, place: Pair) -> Box:
    """The workspace of a mode, widened to hold ``place``: a view that starts outside must not jump into it."""
    reach = control.half_width
    sizes = sorted((control.size_min, control.size_max))
    low, high = ((sizes[0], 0.0), (sizes[1], 0.0)) if mode == ZOOM else ((-reach, -reach), (reach, reach))
    return Box(
        (min(low[0], place[0]), min(low[1], place[1])),
        (max(high[0], place[0]), max(high[1], place[1])),
    )


class RateLimit:
    """Keeps the length of a velocity and of its change within bounds; the direction of each is kept."""

    def __init__(self, v_max: float, a_max: float) -> None:
        self.v_max = v_max  # px/s
        self.a_max = a_max  # px/s2
        self.value = ZERO

    def reset(self) -> None:
        """At rest."""
        self.value = ZERO

    def limit(self, wanted: Pair, dt: float) -> Pair:
        """The velocity (px/s) nearest to ``wanted`` that may follow the last one ``dt`` s later.

        The last velocity is itself within v_max, so cutting the length afterwards cannot make the change larger.
        """
        velocity = wanted
        a, b = self.value
        da, db = velocity[0] - a, velocity[1] - b
        change, most = hypot(da, db), self.a_max * dt
        if change > most:
            velocity = a + da * most / change, b + db * most / change
        speed = hypot(*velocity)
        if speed > self.v_max:
            part = self.v_max / speed
            velocity = part * velocity[0], part * velocity[1]
        self.value = velocity
        return velocity


def stopped(velocity: Pair, place: Pair, allowed: Pair) -> Pair:
    """The velocity without the parts that a wall has stopped: those in which ``allowed`` differs from ``place``."""
    return (
        velocity[0] if place[0] == allowed[0] else 0.0,
        velocity[1] if place[1] == allowed[1] else 0.0,
    )
