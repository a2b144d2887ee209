"""ToolUser: a simulated person who is guided to planned directions by what the target shows, and by nothing else."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from imugui.fusion import quaternion
from imugui.fusion.pipeline import Pipeline
from imugui.guidance.aiming import axis_error
from imugui.guidance.facts import Facts
from imugui.guidance.guide import Guide
from imugui.guidance.look import Look
from imugui.guidance.plan import Plan, target_basis
from imugui.guidance.reading import Reading
from imugui.guidance.registration import from_axes, from_mark, mean_axis
from imugui.simulation.board import VirtualBoard
from imugui.simulation.errors import PRESETS, Errors
from imugui.simulation.path import Floats
from imugui.simulation.tool_hand import ToolHand

DEGREE = np.pi / 180
TICK_S = 0.1
"""How often the person looks and corrects."""
GAIN, FASTEST = 0.35, 60.0 * DEGREE
"""Share of what is seen that is corrected in a tick; rad/s."""
CONTENT, CLUMSY = 0.8 * DEGREE, 0.05 * DEGREE
"""rad: nearer than the first the person lets it be; each correction is off by the second, rms, in every direction."""
LAID_S = 1.2
"""s for which the tool is laid along an axis of the patient."""
LONGEST_S = 30.0
"""Time after which the person gives a plan up, since the last registration."""
PATIENCE_S = 120.0
"""The same since the plan was begun."""


@dataclass(frozen=True)
class Taken:
    """A reading, and what it should have been: the angle in degrees from the tool's true mean direction."""

    reading: Reading
    true_error_deg: float


class ToolUser:
    """A tool with a virtual board in a trembling hand, the filter, the guide, and the person who closes the loop.

    The patient lies prone, the head in a direction that the seed draws. ``now`` is the simulated time: samples arrive
    in the moment they are taken. ``board_facts`` says what the page would say of the board.
    """

    def __init__(
        self,
        guide: Guide,
        board_facts: Callable[[float], Facts],
        seed: int = 0,
        method: str = "axes",
        errors: Errors = PRESETS["mpu9250-calibrated"],
        rate_hz: float = 100.0,
        filter_name: str = "vqf",
        params: Any = None,
    ) -> None:
        self.guide, self.method, self._board_facts = guide, method, board_facts
        self.hand = ToolHand(seed, guide.tool_axis)
        self.board = VirtualBoard(self.hand, rate_hz, errors, seed)
        self.pipeline = Pipeline(filter_name, params, use_mag=False)
        self._rng = np.random.default_rng(seed)
        heading = self._rng.uniform(0.0, 2 * np.pi)
        cranial = np.array((math.cos(heading), math.sin(heading), 0.0))
        anterior = np.array((0.0, 0.0, -1.0))
        self.patient: Floats = np.stack((np.cross(anterior, cranial), anterior, cranial), axis=1)  # RAS -> earth
        self.now = 0.0
        self.registrations = 0
        self._truth: list[Floats] = []
        self.look = Look()

    def tick(self) -> Look:
        """Let TICK_S pass; what the target shows then."""
        rows = self.board.rows(round(TICK_S * self.board.rate_hz))
        first = self.board.count - len(rows)
        self._truth.append(self.board.truth)
        rows["t_arrival"] = rows["t"]
        self.now = float(rows["t"][-1])
        self.look = self.guide.step(self.pipeline.step(rows), first, self._board_facts(self.now))
        return self.look

    def wait(self, seconds: float) -> None:
        """Let time pass."""
        for _ in range(round(seconds / TICK_S)):
            self.tick()

    def run(self, plans: Sequence[Plan]) -> Iterator[Taken]:
        """Register, and go through the plans; registers again when the guide asks for it."""
        self.guide.set_plans(plans)
        self.wait(self.hand.still_s)
        for index, plan in enumerate(plans):
            self.guide.select(index)
            self.guide.confirm_side(plan.side)
            taken = self._reach(plan)
            if taken is not None:
                yield taken

    def register(self) -> None:
        """Lay the tool along the patient's axes, or towards the head only, and say so to the guide."""
        if self.method == "axes":
            anterior = self._laid(self.patient[:, 1])
            found = from_axes(anterior, self._laid(self.patient[:, 2]), self.now)
        else:
            found = from_mark(self._laid(self.patient[:, 2]), "prone", self.now)
        self.guide.register(found)
        self.pipeline.refer_heading()
        self.registrations += 1

    def _laid(self, way: Floats) -> Floats:
        """Where the guide saw the tool while it lay along ``way`` (3,), both in the earth frame."""
        while float(axis_error(self._wanted_way(), way)) > 1e-6:
            self._turn(self._towards(way), TICK_S * FASTEST)
            self.tick()
        self.wait(0.5 + LAID_S)
        return mean_axis(self.guide.recent(LAID_S)["quat"], self.guide.tool_axis)[0]

    def _reach(self, plan: Plan) -> Taken | None:
        """Follow the target to a plan and take a reading; None when that took too long."""
        end, latest = self.now + LONGEST_S, self.now + PATIENCE_S
        while self.now < min(end, latest):
            if self.guide.registration is None or self.look.reference_due_s < 2.0:
                self.register()
                end = self.now + LONGEST_S
            look = self.tick()
            if look.armed:
                reading = self.guide.capture(self.now)
                if isinstance(reading, Reading):
                    return Taken(reading, self._true_error_deg(reading))
            self._correct(look)
        return None

    def _correct(self, look: Look) -> None:
        """Move the tool as the cross says, a little clumsily."""
        if look.aim is None or look.plan is None or look.aim.error < CONTENT:
            return
        tangents = target_basis(self._wanted_way() @ self.patient, look.plan.side)
        medial, cranial = (self.patient @ tangent for tangent in tangents)
        if look.aim.backwards:
            step = 0.5 * medial
        else:
            step = -GAIN * (look.aim.offset[0] * medial + look.aim.offset[1] * cranial)
        step += CLUMSY * self._rng.normal(size=3)
        self._turn(np.cross(self._wanted_way(), step), TICK_S * FASTEST)

    def _wanted_way(self) -> Floats:
        return quaternion.rotate(self.hand.wanted, self.hand.axis)

    def _towards(self, way: Floats) -> Floats:
        """Rotation vector (3,), earth frame, that takes the wanted direction to another; any way round if opposite."""
        here = self._wanted_way()
        axis = np.cross(here, way)
        size = float(np.linalg.norm(axis))
        angle = float(axis_error(here, way))
        if size < 1e-9:
            other = np.cross(here, np.eye(3)[int(np.argmin(np.abs(here)))])
            return np.asarray(angle * other / np.linalg.norm(other))
        return np.asarray(angle / size * axis)

    def _turn(self, turn: Floats, most: float) -> None:
        """Turn the wanted attitude by a rotation vector (3,), earth frame, but by no more than ``most`` rad."""
        size = float(np.linalg.norm(turn))
        part = quaternion.from_rotation_vector(turn * min(1.0, most / max(size, 1e-12)))
        self.hand.turn_to(quaternion.multiply(part, self.hand.wanted))

    def _true_error_deg(self, reading: Reading) -> float:
        first, last = reading.rows
        quats = np.concatenate(self._truth)[first : last + 1]
        mean = quaternion.rotate(quats, self.hand.axis).mean(axis=0) @ self.patient
        return math.degrees(float(axis_error(mean, reading.direction)))


def random_plans(count: int, steepest_deg: float, seed: int = 0) -> list[Plan]:
    """So many plans on both sides, evenly over the cap up to ``steepest_deg`` (below 80) of total tilt, one on its rim.

    tan^2(tilt) = tan^2(axial) + tan^2(sagittal).
    """
    rng = np.random.default_rng(seed)
    tilts = np.arccos(rng.uniform(math.cos(steepest_deg * DEGREE), 1.0, count))
    tilts[0] = steepest_deg * DEGREE
    ways = rng.uniform(0.0, 2 * np.pi, count)
    slopes = np.tan(tilts)[:, None] * np.stack((np.cos(ways), np.sin(ways)), axis=1)
    angles_deg = np.degrees(np.arctan(slopes)).round(1).tolist()
    return [
        Plan(name=f"P{k + 1}", side=("left", "right")[k % 2], axial_deg=axial_deg, sagittal_deg=sagittal_deg)
        for k, (axial_deg, sagittal_deg) in enumerate(angles_deg)
    ]
