"""The guided accelerometer calibrations: still positions that find themselves."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from imugui.calibration.accelerometer import (
    CROSS_TILT_DEG,
    FEWEST,
    FEWEST_FULL,
    FLAT_TILT_DEG,
    NAN,
    AccelerometerResult,
    fit_positions,
    flat,
    many,
    six,
)
from imugui.calibration.free_fall import FreeFallFlow
from imugui.calibration.positions import (
    FACES,
    Position,
    between_faces,
    farthest_between,
    missing_faces,
    positions_of,
    stops_of,
)
from imugui.calibration.stillness import DEGREE, Floats, Gathered
from imugui.samples import Rows

GOOD_TILT = 0.1 * DEGREE
"""rad; where the positions leave less than this open, more of them would not show."""


@dataclass(frozen=True)
class Method:
    """One way to calibrate: its names, what it is worth, its solver and what it still lacks in words."""

    title: str
    accuracy: str
    solve: Callable[[Sequence[Position]], AccelerometerResult]
    missing: Callable[[Sequence[Position]], list[str]]


def _flat_missing(positions: Sequence[Position]) -> list[str]:
    return [] if flat(positions).accepted else ["z up, on a level table"]


def _many_missing(positions: Sequence[Position]) -> list[str]:
    """Faces first; then the edge or corner that would settle most of what is still open."""
    faces = missing_faces(positions)
    left = FEWEST_FULL - len(positions)
    if len(positions) < FEWEST:
        return faces + farthest_between(positions, max(0, left - len(faces)))
    fit = fit_positions(positions)
    if left <= 0 and fit.predicted_tilt <= GOOD_TILT:
        return []
    ways, names = between_faces()
    # a 6-parameter fit does not know of cross-axis terms: it cannot say which edge would settle them
    if left > 0:
        return faces + farthest_between(positions, max(1, left - len(faces)))
    return [*faces, names[int(fit.gains(ways).argmax())]]


METHODS: dict[str, Method] = {
    "many": Method(
        "Many positions",
        "Bias, scale and cross-axis from 9 or more positions, aim at 12: 0.1 to 0.3 mg, about 0.02 deg.",
        many,
        _many_missing,
    ),
    "six": Method(
        "Six positions",
        f"Bias and scale from the six faces: 2 to 14 mg, up to {CROSS_TILT_DEG:g} deg.",
        six,
        missing_faces,
    ),
    "flat": Method(
        "Flat",
        f"Bias from one level position: wrong by up to {FLAT_TILT_DEG:g} deg elsewhere.",
        flat,
        _flat_missing,
    ),
}


class AccelerometerFlow:
    """Still positions in any order; ``method`` is a key of METHODS."""

    def __init__(self, method: str = "many") -> None:
        self._method = METHODS[method]
        self.title, self.accuracy = self._method.title, self._method.accuracy
        self._gathered = Gathered()
        self.positions: list[Position] = []
        self._result = self._method.solve([])
        self.missing: tuple[str, ...] = tuple(self._method.missing([]))
        self.stops = 0

    def feed(self, rows: Rows) -> None:
        """Take raw SAMPLE rows, shape (n,)."""
        self._gathered.feed(rows)
        stops = stops_of(self._gathered.rows)
        self.stops = len(stops)
        self.positions = positions_of(stops)
        self._result = self._method.solve(self.positions)
        self.missing = tuple(self._method.missing(self.positions))

    def result(self) -> AccelerometerResult:
        """Bias and matrix, or why there are none."""
        temperatures = self._gathered.rows["temp_c"]
        known = temperatures[np.isfinite(temperatures)]
        return replace(self._result, temp_c=float(known.mean()) if len(known) else NAN)

    @property
    def faces(self) -> dict[str, bool]:
        """Which faces were up already, for a picture of a cube."""
        missing = missing_faces(self.positions)
        return {face: face not in missing for face in FACES}

    @property
    def up(self) -> Floats:
        """The newest raw acceleration (3,), m/s2; NaN before the first."""
        rows = self._gathered.rows
        return np.asarray(rows["acc"][-1]) if len(rows) else np.full(3, np.nan)

    @property
    def progress(self) -> float:
        """Share of the positions wanted that were really held."""
        if self.done:
            return 1.0
        held = len(self.positions) if self._method.missing is not missing_faces else sum(self.faces.values())
        return min(0.95, held / max(1, held + len(self.missing)))

    @property
    def done(self) -> bool:
        """Whether nothing is missing."""
        return self._result.accepted and not self.missing

    @property
    def sentence(self) -> str:
        """What to do now."""
        if self.done:
            return "Done: enough positions."
        wanted = self.missing[0] if self.missing else "another position"
        return f"Next: {wanted}. Put the board down so, let go and wait a second."


FLOWS: dict[str, Callable[[], AccelerometerFlow | FreeFallFlow]] = {
    **{name: partial(AccelerometerFlow, name) for name in METHODS},
    "free fall": FreeFallFlow,
}
"""Every way by name, best first."""
