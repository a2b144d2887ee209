"""The tool's axis in the box: found by turning the tool about itself, or one of the box's own axes.

While the tool spins, its axis is the one direction of the box that stays where it is in the earth frame.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from imugui.fusion.quaternion import Floats, angle_between, conjugate, multiply, rotate, to_matrix, to_rotation_vector
from imugui.samples import Rows

Axis = tuple[float, float, float]

BOX_AXES: dict[str, Axis] = {
    "+x": (1.0, 0.0, 0.0),
    "-x": (-1.0, 0.0, 0.0),
    "+y": (0.0, 1.0, 0.0),
    "-y": (0.0, -1.0, 0.0),
    "+z": (0.0, 0.0, 1.0),
    "-z": (0.0, 0.0, -1.0),
}

STEP = math.radians(5.0)
"""The tool has turned by this much before another pose is kept, so that standing still weighs nothing."""
ENOUGH_DEG = 180.0
"""Spin that is demanded, between the two ends of it; rocking to and fro does not add up."""
LARGEST_WOBBLE_DEG = 3.0
"""A tool turned by hand stays within 1 degree; above this it was not turned about its own axis."""
LEVEL = math.sin(math.radians(15.0))
"""Nearer than this to the horizon gravity does not say which end of the tool is the tip."""
MOST = 720
"""Poses kept: ten turns."""


@dataclass(frozen=True)
class ToolAxis:
    """A verdict. ``axis``: unit, in the box's axes, towards the tip; ``reason`` says in words what was reached.

    ``quality_deg``: rms angle between the axis in one pose and in another, in the earth frame; ``spin_deg``: how far
    the tool was turned.
    """

    accepted: bool
    reason: str
    axis: Axis = BOX_AXES["+x"]
    quality_deg: float = math.nan
    spin_deg: float = 0.0


class SpinFlow:
    """Turn the tool about its own axis by half a turn or more, the tip down at the start."""

    title = "Tool axis"

    def __init__(self) -> None:
        self._poses: Floats = np.zeros((0, 4))
        self._up: Floats = np.full(3, np.nan)  # up in the box's axes at the start
        self._found = ToolAxis(False, "The tool has not been turned yet.")

    def feed(self, rows: Rows) -> None:
        """Take ATTITUDE rows, shape (n,), as they come; those after ``done`` are left out."""
        quats = rows["quat"][np.isfinite(rows["quat"]).all(axis=1)]
        if self.done or len(quats) == 0:
            return
        if len(self._poses) == 0:
            self._poses = quats[:1]
            self._up = rotate(conjugate(quats[0]), (0.0, 0.0, 1.0))
        for pose in _kept(self._poses[-1], quats):
            self._poses = np.concatenate((self._poses, pose[None]))[-MOST:]
            self._found = self._judge()
            if self.done:
                return

    def _judge(self) -> ToolAxis:
        axis, wobble_deg = spin_axis(self._poses)
        spin_deg = _spin_deg(self._poses, axis)
        height = float(axis @ self._up)
        x, y, z = (axis if height < 0.0 else -axis).tolist()
        reason = _refusal(spin_deg, wobble_deg, height)
        said = reason or f"Turned by {spin_deg:.0f}° about one axis, which kept its direction to {wobble_deg:.1f}°."
        return ToolAxis(reason == "", said, (x, y, z), wobble_deg, spin_deg)

    def result(self) -> ToolAxis:
        """The axis with its quality, or why there is none."""
        return self._found

    @property
    def progress(self) -> float:
        """Share of the half turn that is done, 0 to 1."""
        return min(1.0, self._found.spin_deg / ENOUGH_DEG)

    @property
    def missing(self) -> tuple[str, ...]:
        """What is still missing, in words."""
        return () if self.done else (self._found.reason,)

    @property
    def sentence(self) -> str:
        """What to do now."""
        if self.done:
            return f"Done. {self._found.reason}"
        if self.progress >= 1.0:
            return f"{self._found.reason} Begin again."
        return "Hold the tip down and turn the tool about its own axis, by half a turn or more."

    @property
    def done(self) -> bool:
        """Whether the axis was found; what comes later changes nothing."""
        return self._found.accepted


def spin_axis(quats: Floats) -> tuple[Floats, float]:
    """The box's direction (3,), sign open, that moves least from pose to pose, and its rms change in degrees.

    The eigenvector of the smallest eigenvalue of A = sum (dR - I)^T (dR - I) over the relative rotations dR of the
    poses ``quats`` (n, 4); with e = sqrt(lambda_min / N) the change is acos(1 - e^2 / 2), as in IGSIO. All N = n^2
    pairs are taken instead of neighbours, whose small turns drown in tremor: then A / N = 2 (I - M^T M), where M is
    the mean of the rotation matrices.
    """
    mean = to_matrix(quats).mean(axis=0)
    values, vectors = np.linalg.eigh(2.0 * (np.eye(3) - mean.T @ mean))
    change = math.sqrt(max(float(values[0]), 0.0))
    return np.asarray(vectors[:, 0]), math.degrees(2.0 * math.asin(min(1.0, change / 2.0)))


def _kept(last: Floats, quats: Floats) -> list[Floats]:
    """Those of the attitudes (n, 4) that are a step further than the one kept before."""
    found: list[Floats] = []
    while len(quats):
        far = np.flatnonzero(angle_between(last, quats) >= STEP)
        if len(far) == 0:
            break
        last, quats = quats[far[0]], quats[far[0] + 1 :]
        found.append(last)
    return found


def _spin_deg(quats: Floats, axis: Floats) -> float:
    """How far the poses (n, 4) are spread about the box's axis (3,), from one end to the other, degrees."""
    steps = to_rotation_vector(multiply(conjugate(quats[:-1]), quats[1:])) @ axis
    return float(np.degrees(np.ptp(np.concatenate(([0.0], np.cumsum(steps))))))


def _refusal(spin_deg: float, wobble_deg: float, height: float) -> str:
    """Why there is no axis, one sentence, or empty; ``height``: sine of its elevation at the start."""
    if spin_deg < ENOUGH_DEG:
        return f"Turned by {spin_deg:.0f}° of {ENOUGH_DEG:.0f}°."
    if wobble_deg > LARGEST_WOBBLE_DEG:
        return (
            f"The tool was not turned about one axis: the steadiest one still moved by {wobble_deg:.1f}°, "
            f"{LARGEST_WOBBLE_DEG:g}° is the most."
        )
    if abs(height) < LEVEL:
        return "The tool lay level at the start, so gravity does not say which end is the tip: hold the tip down."
    return ""
