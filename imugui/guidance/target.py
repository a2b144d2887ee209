"""Target: a plan as vectors, and where a tool is seen from it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from imugui.fusion.quaternion import Floats
from imugui.guidance.aiming import Aim, aim, aim_many, twist_angle
from imugui.guidance.plan import Plan, attitude, direction, target_basis
from imugui.guidance.registration import Registration, to_patient


@dataclass(frozen=True, eq=False)
class Target:
    """Where to point, ``way`` (3,) in RAS, with its basis (m', c'); ``quat`` (4,) box -> RAS, if a roll is planned."""

    plan: Plan
    tool_axis: ArrayLike
    way: Floats
    basis: tuple[Floats, Floats]
    quat: Floats | None

    @property
    def tolerance(self) -> float:
        """The plan's tolerance in rad."""
        return math.radians(self.plan.tolerance_deg)

    def seen(self, way: Floats, quat: Floats, registration: Registration) -> Aim:
        """The aim of a tool that points to ``way`` (3,) in the earth frame, in the attitude (4,) box -> earth."""
        twist = math.nan
        if self.quat is not None:
            twist = float(twist_angle(self.quat, to_patient(registration, quat), self.tool_axis))
        return aim(in_patient(way, registration), self.way, self.basis, twist)

    def offsets(self, ways: Floats, registration: Registration) -> Floats:
        """Offsets (n, 2), rad, of directions (n, 3) in the earth frame."""
        return aim_many(in_patient(ways, registration), self.way, self.basis)[1]


def target_of(plan: Plan, tool_axis: ArrayLike) -> Target:
    """The plan as vectors, for a tool along ``tool_axis`` (3,) in the box; ValueError when the plan is wrong."""
    way = direction(plan, tool_axis)
    turned = plan.kind == "plain" and not math.isnan(plan.roll_deg)
    return Target(plan, tool_axis, way, target_basis(way, plan.side), attitude(plan) if turned else None)


def in_patient(ways: Floats, registration: Registration) -> Floats:
    """Directions (..., 3) of the earth frame in RAS."""
    return np.asarray(ways @ np.asarray(registration.matrix))


def from_vertical(way: Floats) -> float:
    """The angle in rad, 0 to pi/2, between a direction (3,) of the earth frame and the vertical."""
    x, y, z = way.tolist()
    return math.atan2(math.hypot(x, y), abs(z))
