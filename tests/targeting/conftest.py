"""A hand with a board in it that drives a controller row by row."""

from __future__ import annotations

from collections.abc import Callable
from math import radians
from typing import Any

import pytest

from imugui.fusion.scalar import Quat, turned_in_sensor
from imugui.samples import NO_STATUS
from imugui.targeting.activation import Input
from imugui.targeting.controller import Controller
from imugui.targeting.settings import Control
from imugui.targeting.view_pose import View

LEVEL: Quat = (1.0, 0.0, 0.0, 0.0)
START = View(10.0, -20.0, 200.0)


class Hand:
    """Steps a controller with rows ``dt`` s apart and remembers them, so that they can be played again."""

    def __init__(self, control: Control, view: View = START, quat: Quat = LEVEL, dt: float = 0.01) -> None:
        self.controller = Controller(control, view)
        self.t, self.quat, self.dt, self.status = 100.0, quat, dt, NO_STATUS
        self.rows: list[tuple[Any, ...]] = []

    def row(self, *inputs: Input, quat: Quat | None = None, gyr: Any = (0.0, 0.0, 0.0)) -> View:
        """One row; ``quat`` only for a broken one."""
        self.t += self.dt
        self.rows.append((self.t, quat or self.quat, gyr, self.status, inputs))
        return self.controller.step(*self.rows[-1])

    def turn(self, x: float = 0.0, y: float = 0.0, z: float = 0.0, rows: int = 10) -> View:
        """Turn by this rotation vector, deg, in the board's axes, evenly over so many rows."""
        part = tuple(radians(angle) / rows for angle in (x, y, z))
        for _ in range(rows):
            self.quat = turned_in_sensor(self.quat, *part)
            self.row(gyr=tuple(angle / self.dt for angle in part))
        return self.controller.view

    def wait(self, seconds: float) -> View:
        """Hold still."""
        for _ in range(round(seconds / self.dt)):
            self.row()
        return self.controller.view

    def engage(self, button: str = "pan", settle_s: float = 0.3) -> View:
        """Arm, press, and wait until jolt and ramp have passed."""
        self.row(Input("confirm"))
        self.row(Input("press", button))
        return self.wait(settle_s)

    def causes(self) -> list[tuple[str, str]]:
        """Names of the states that were entered, with the causes."""
        return [(line.target.name, line.cause) for line in self.controller.log]


@pytest.fixture
def new_hand() -> Callable[..., Hand]:
    """``new_hand(control, view, quat, dt)`` -> Hand."""
    return Hand
