"""How the sensor sits in its box or on its tool: level it, raise its nose, done."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from imugui.calibration.flow import Result
from imugui.calibration.positions import Stop, angle, stops_of
from imugui.calibration.stillness import DEGREE, Floats, Gathered
from imugui.fusion.correction import Correction
from imugui.fusion.quaternion import from_matrix
from imugui.samples import Rows

LEAST, MOST = 20.0 * DEGREE, 150.0 * DEGREE
"""rad by which the nose must rise: less makes the axis uncertain, more turns the box over."""
HAND = 1.0 * DEGREE
"""rad; how evenly a hand raises the nose without leaning the box sideways."""


@dataclass(frozen=True)
class MountingResult(Result):
    """``quat`` (w, x, y, z) turns the sensor's axes into the box's: x ahead, y left, z up."""

    quat: tuple[float, float, float, float] = (1.0, 0.0, 0.0, 0.0)
    angle_deg: float = 0.0  # how far that turns
    error_deg: float = float("nan")  # of the direction ahead, to expect
    samples: int = 0


class MountingFlow:
    """Mounting: two still attitudes of the box, level and nose up, in this order; x is ahead, y left, z up."""

    title = "Mounting"

    def __init__(self, correction: Correction | None = None) -> None:
        """``correction`` holds the accelerometer's calibration, which goes before the mounting."""
        self._correction = correction or Correction()
        self._gathered = Gathered()
        self._stops: list[Stop] = []

    def feed(self, rows: Rows) -> None:
        """Take raw SAMPLE rows, shape (n,)."""
        self._gathered.feed(rows)
        self._stops = stops_of(self._gathered.rows)

    @property
    def progress(self) -> float:
        """Half for each attitude."""
        return 1.0 if self.done else 0.5 * bool(self._stops)

    @property
    def missing(self) -> tuple[str, ...]:
        """Attitudes still to hold."""
        return () if self.done else ("the box with its nose up",) if self._stops else ("the box level", "its nose up")

    @property
    def sentence(self) -> str:
        """What to do now."""
        if self.done:
            return "Done: the axes of the box are known."
        if not self._stops:
            return "Put the box level, as it is used, and let go."
        return "Raise its nose by 30 to 90 degrees, without leaning it sideways, and hold it against something."

    @property
    def done(self) -> bool:
        """Whether both attitudes were held."""
        return self._raised() is not None

    def result(self) -> MountingResult:
        """The mounting, or what is missing."""
        raised = self._raised()
        if raised is None:
            return MountingResult(False, f"Missing: {', '.join(self.missing)}.")
        level = self._stops[0]
        up, tipped = (self._corrected(stop) for stop in (level, raised))
        rise = angle(up, tipped)
        matrix = mounting_matrix(up, tipped)
        w, x, y, z = from_matrix(matrix).tolist()
        turned = 2 * float(np.arccos(min(1.0, abs(w)))) / DEGREE
        error = HAND / float(np.sin(rise)) / DEGREE
        samples = sum(stop.span.stop - stop.span.start for stop in (level, raised))
        text = f"The sensor is turned by {turned:.1f} deg in its box; ahead is known to about {error:.1f} deg."
        return MountingResult(True, text, (w, x, y, z), turned, error, samples)

    def _corrected(self, stop: Stop) -> Floats:
        acc = np.array(self._correction.acc_matrix) @ (stop.acc - self._correction.acc_bias)
        return np.asarray(acc / np.linalg.norm(acc))

    def _raised(self) -> Stop | None:
        """The first stop that lies far enough from the first one."""
        for stop in self._stops[1:]:
            if LEAST <= angle(self._corrected(self._stops[0]), self._corrected(stop)) <= MOST:
                return stop
        return None


def mounting_matrix(level: Floats, raised: Floats) -> Floats:
    """Rotation (3, 3) sensor -> box from the directions (3,) of up in sensor axes, box level and box nose up.

    Raising the nose turns the box about its y axis, and up moves from z toward x: so y = level x raised.
    """
    z = level / np.linalg.norm(level)
    y = np.cross(level, raised)
    y = y / np.linalg.norm(y)
    return np.array([np.cross(y, z), y, z])
