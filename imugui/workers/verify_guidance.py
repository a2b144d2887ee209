"""What the Guide page claimed in a recording, computed again from the attitudes that were computed again."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from imugui.fusion.quaternion import Floats, angle_between, from_matrix
from imugui.guidance.reading import Reading, reading_from, recompute
from imugui.guidance.registration import POSITIONS, Registration, from_axes, from_mark, from_origin, mean_axis
from imugui.recording import Event
from imugui.samples import Rows

READING = "reading"
"""Text of a "guidance" event whose data hold a reading."""


@dataclass(frozen=True)
class GuidanceCheck:
    """Readings that were found, and what came out of them; the differences are the largest, in degrees."""

    readings: int = 0
    recomputed: int = 0  # the attitudes of the others lie outside the recording, or are not of one board alone
    relative: int = 0  # measured against a reference board, whose attitudes a recording of one board does not hold
    outside: int = 0  # taken before the recording began
    reading_difference_deg: float = 0.0
    registrations: int = 0  # of recomputed readings, measured within the recording
    registration_difference_deg: float = 0.0
    sigmas: int = 0  # of recomputed readings, whose heading's sigma the filter stated
    sigma_difference_deg: float = 0.0
    problems: tuple[str, ...] = ()

    @property
    def sentence(self) -> str:
        """What to tell the user; empty without a reading."""
        if not self.readings:
            return ""
        text = f"{self.recomputed} of {self.readings} readings computed again"
        if self.recomputed:
            text += f": largest difference {self.reading_difference_deg:.3g} deg; {self.registrations} of their "
            text += f"registrations: {self.registration_difference_deg:.3g} deg"
        if self.sigmas:
            text += f"; {self.sigmas} of their heading's sigmas: {self.sigma_difference_deg:.3g} deg"
        return " ".join((f"{text}.", *self._left_out(), *self.problems))

    def _left_out(self) -> list[str]:
        """Why readings were not computed again, a sentence for each reason."""
        said = []
        if self.relative:
            said.append(
                f"Not checked: {self.relative} measured against a reference board, whose attitudes the recording of "
                "the tool alone does not hold."
            )
        if self.outside:
            said.append("The others were taken before the recording began.")
        return said


def verify_guidance(events: list[Event], fused: Rows) -> GuidanceCheck:
    """Compute every reading, its registration and its heading's sigma from the ATTITUDE rows (n,) of the recording."""
    quats = fused["quat"]
    found = [event for event in events if event.kind == "guidance" and event.text == READING]
    differences: list[float] = []
    registered: list[float] = []
    sigmas: list[float] = []
    problems: list[str] = []
    sound = _sound(found, problems)
    own = [(reading, first) for reading, first in sound if not reading.relative]
    for reading, first in own:
        span = _span(quats, reading.rows, first)
        if span is not None:
            differences.append(recompute(reading, span))
            sigmas += _sigma_differences(reading, fused[reading.rows[1] - first])
            try:
                registered.append(_registration_difference(reading, quats, first))
            except (ValueError, StopIteration) as error:
                problems.append(f"The registration of reading {reading.number} cannot be measured again: {error}")
    measured = [value for value in registered if not math.isnan(value)]
    return GuidanceCheck(
        len(found),
        len(differences),
        len(sound) - len(own),
        len(own) - len(differences),
        max(differences, default=0.0),
        len(measured),
        max(measured, default=0.0),
        len(sigmas),
        max(sigmas, default=0.0),
        tuple(problems),
    )


def _sound(events: list[Event], problems: list[str]) -> list[tuple[Reading, int]]:
    """The readings that can be read, each with the number of the recording's first attitude."""
    sound = []
    for event in events:
        try:
            sound.append((reading_from(event.data["reading"]), int(event.data["first_attitude"])))
        except (KeyError, TypeError, ValueError, OverflowError) as error:
            problems.append(f"A reading is damaged: {error}")
    return sound


def _span(quats: Floats, rows: tuple[int, int], first: int) -> Floats | None:
    """The attitudes of these numbers in the ring, or None when the recording does not hold them all."""
    begin, end = rows[0] - first, rows[1] - first + 1
    return quats[begin:end] if 0 <= begin < end <= len(quats) else None


def _sigma_differences(reading: Reading, newest: Any) -> list[float]:
    """Degrees between the stored sigma of the heading and that in the newest ATTITUDE row; none if it is another's.

    Infinite where the filter, computed again, states nothing.
    """
    if reading.heading_from != "filter":
        return []
    apart = abs(reading.heading_sigma_deg - math.degrees(float(newest["sigma_heading"])))
    return [math.inf if math.isnan(apart) else apart]


def _registration_difference(reading: Reading, quats: Floats, first: int) -> float:
    """Degrees between the registration and the one from the attitudes it was measured with; NaN without them."""
    registration = reading.registration
    spans = [_span(quats, rows, first) for rows in registration.rows]
    if not spans or any(span is None for span in spans):
        return math.nan
    again = _MEASURED[registration.method](registration, spans, reading.tool_axis)
    apart = angle_between(from_matrix(np.array(registration.matrix)), from_matrix(np.array(again.matrix)))
    return math.degrees(float(apart))


def _axes(_: Registration, spans: list[Any], axis: Any) -> Registration:
    anterior, cranial = (mean_axis(span, axis)[0] for span in spans)
    return from_axes(anterior, cranial)


def _mark(registration: Registration, spans: list[Any], axis: Any) -> Registration:
    position = next(word for word in POSITIONS if f"patient {word};" in registration.words)
    return from_mark(mean_axis(spans[0], axis)[0], position)


def _origin(_: Registration, spans: list[Any], axis: Any) -> Registration:
    return from_origin(spans[0], axis)


_MEASURED = {"axes": _axes, "mark": _mark, "origin": _origin}
