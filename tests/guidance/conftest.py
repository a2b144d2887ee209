"""A tool on a desk: attitudes of our choice, by a clock of our own."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from imugui.fusion import quaternion
from imugui.guidance.facts import Facts
from imugui.guidance.guide import Guide
from imugui.guidance.look import Look
from imugui.guidance.plan import Plan, direction
from imugui.guidance.reading import Reading
from imugui.guidance.registration import from_axes
from imugui.samples import ATTITUDE, GRAVITY, Rows, empty_rows

RATE_HZ = 100.0
DOWN, NORTH = (0.0, 0.0, -1.0), (0.0, 1.0, 0.0)
PLANS = (
    Plan(name="L4", side="left", axial_deg=20.0, sagittal_deg=10.0, depth_mm=40.0),
    Plan(name="L4", side="right", axial_deg=15.0, sagittal_deg=-5.0),
    Plan(name="L5", side="left", axial_deg=30.0, sagittal_deg=-15.0),
)


def turned_to(way: Any, spin: Any = 0.0) -> np.ndarray:
    """Attitudes (..., 4) of a box whose x axis points to ``way`` (3,) in the earth frame, spun about it."""
    way = np.asarray(way, float) / np.linalg.norm(way)
    axis = np.cross((1.0, 0.0, 0.0), way)
    angle = math.atan2(float(np.linalg.norm(axis)), float(way[0]))
    swing = quaternion.from_rotation_vector(angle * axis / max(float(np.linalg.norm(axis)), 1e-12))
    return quaternion.multiply(swing, quaternion.from_rotation_vector(np.asarray(spin)[..., None] * (1.0, 0.0, 0.0)))


class Desk:
    """The guide, registered for a patient who lies prone with the head to the north, and the board's stream."""

    def __init__(self) -> None:
        self.guide = Guide()
        self.now = 1000.0
        self.number = 0
        self.said: dict[str, Any] = {
            "streaming": True,
            "calibrated": True,
            "profile_words": "test board",
            "filter": "vqf",
            "base_tilt": math.radians(0.2),
            "drift": math.radians(0.01),
            "turn_share": 0.002,
        }

    def facts(self) -> Facts:
        return Facts(now=self.now, **self.said)

    def rows(self, quats: np.ndarray) -> Rows:
        """ATTITUDE rows of these attitudes (n, 4), which follow at RATE_HZ; the clock goes along."""
        rows = empty_rows(ATTITUDE, len(quats))
        rows["t"] = rows["t_arrival"] = self.now + np.arange(1, len(quats) + 1) / RATE_HZ
        rows["quat"] = rows["local"] = quats
        rows["gyr"] = 0.0
        rows["acc"] = quaternion.rotate(quaternion.conjugate(quats), (0.0, 0.0, GRAVITY))
        rows["rest"] = True
        self.now += len(quats) / RATE_HZ
        return rows

    def step(self, rows: Rows) -> Look:
        """Hand rows to the guide, as the stream's next."""
        self.number += len(rows)
        return self.guide.step(rows, self.number - len(rows), self.facts())

    def hold(self, way: Any, seconds: float = 1.2, spin_rate: float = 0.0) -> Look:
        """Hold the tool to ``way`` (3,), earth frame, spun at ``spin_rate`` rad/s; look 50 times a second."""
        look = self.guide.look
        for k in range(round(seconds * RATE_HZ / 2)):
            look = self.step(self.rows(turned_to(way, spin_rate * (2 * k + np.arange(2)) / RATE_HZ)))
        return look

    def wait(self, seconds: float) -> Look:
        """No row comes for so long."""
        self.now += seconds
        return self.guide.step(empty_rows(ATTITUDE, 0), self.number, self.facts())

    def register(self) -> None:
        self.guide.register(from_axes(DOWN, NORTH, self.now))

    def begin(self) -> Look:
        """Plans, a tool at rest, a registration and the side: the tool points straight down."""
        self.guide.set_plans(PLANS)
        self.hold(DOWN, 0.6)
        self.register()
        self.guide.confirm_side("left")
        return self.hold(DOWN, 0.2)

    def to_plan(self, off_deg: float = 0.0) -> np.ndarray:
        """The way (3,), earth frame, that the plan wants, moved medially by ``off_deg``."""
        plan = self.guide.plan
        assert plan is not None
        assert self.guide.registration is not None
        return np.array(self.guide.registration.matrix) @ direction(
            replace(plan, axial_deg=plan.axial_deg + off_deg), self.guide.tool_axis
        )


@pytest.fixture
def desk() -> Desk:
    """A desk that nothing was done on yet."""
    return Desk()


@pytest.fixture
def new_desk() -> Callable[[], Desk]:
    """Makes desks, for tests that need more than one."""
    return Desk


@pytest.fixture
def armed() -> Desk:
    """The tool is held on the first plan, green and armed."""
    desk = Desk()
    desk.begin()
    look = desk.hold(desk.to_plan())
    assert look.colour == "green"
    assert look.armed
    return desk


@pytest.fixture
def pose() -> Callable[..., np.ndarray]:
    """``turned_to``."""
    return turned_to


@pytest.fixture
def reading(armed: Desk) -> Reading:
    """A reading of the first plan, 1.2 degrees too far medial."""
    armed.hold(armed.to_plan(1.2))
    taken = armed.guide.capture(armed.now)
    assert isinstance(taken, Reading)
    return taken
