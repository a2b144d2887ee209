"""Two profiles side by side: what changed, in words and in numbers that mean something."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np

from imugui.calibration.parts import PARTS, Part
from imugui.calibration.profile import Profile
from imugui.fusion.quaternion import angle_between
from imugui.samples import GRAVITY


@dataclass(frozen=True)
class Difference:
    """One line: what, before, after, and how far apart in words."""

    label: str
    before: str
    after: str
    change: str


def compare(before: Profile, after: Profile) -> list[Difference]:
    """The differences of two profiles, part by part; empty when they calibrate alike."""
    lines = []
    for name in PARTS:
        old, new = getattr(before, name), getattr(after, name)
        if (old is None) != (new is None):
            words = ("only in the second", "") if old is None else ("only in the first", "")
            lines.append(Difference(name.capitalize(), _date(old), _date(new), words[0]))
        elif old is not None and old != new:
            lines += [Difference(name.capitalize(), _date(old), _date(new), _age(old, new))]
            lines += _LINES[name](old, new) if name in _LINES else []
    tilts = before.tilt_error_deg, after.tilt_error_deg
    headings = before.heading_error_deg, after.heading_error_deg
    for label, (first, second) in (("Expected tilt error", tilts), ("Expected heading error", headings)):
        if not math.isnan(first) and not math.isnan(second) and abs(first - second) >= 0.005:
            better = "better" if second < first else "worse"
            lines.append(Difference(label, f"{first:.2f} deg", f"{second:.2f} deg", better))
    return lines


def _gyroscope(old: Any, new: Any) -> Iterable[Difference]:
    yield _vector("Gyroscope bias", old.bias, new.bias, 180 / math.pi, "deg/s", 3)
    yield from _matrix("Gyroscope scale and cross-axis", old.matrix, new.matrix)


def _accelerometer(old: Any, new: Any) -> Iterable[Difference]:
    yield _vector("Accelerometer bias", old.bias, new.bias, 1000 / GRAVITY, "mg", 1)
    yield from _matrix("Accelerometer scale and cross-axis", old.matrix, new.matrix)


def _magnetometer(old: Any, new: Any) -> Iterable[Difference]:
    line = _vector("Hard iron", old.hard_iron, new.hard_iron, 1.0, "µT", 1)
    field = new.field_ut if not math.isnan(new.field_ut) else 45.0
    moved = float(np.linalg.norm(np.subtract(new.hard_iron, old.hard_iron)))
    wrong = math.degrees(math.asin(min(1.0, moved / field)))
    yield Difference(line.label, line.before, line.after, f"{line.change}: directions change by up to {wrong:.1f} deg")
    yield from _matrix("Soft iron", old.soft_iron, new.soft_iron)


def _mounting(old: Any, new: Any) -> Iterable[Difference]:
    turned = math.degrees(float(angle_between(old.quat, new.quat)))
    yield Difference("Mounting", "", "", f"turned by {turned:.1f} deg")


_LINES: dict[str, Callable[[Any, Any], Iterable[Difference]]] = {
    "gyroscope": _gyroscope,
    "accelerometer": _accelerometer,
    "magnetometer": _magnetometer,
    "mounting": _mounting,
}


def _vector(label: str, old: Any, new: Any, factor: float, unit: str, decimals: int) -> Difference:
    first, second = np.multiply(old, factor), np.multiply(new, factor)
    moved = float(np.linalg.norm(second - first))
    texts = [f"{', '.join(f'{v:+.{decimals}f}' for v in values)} {unit}" for values in (first, second)]
    return Difference(label, texts[0], texts[1], f"moved by {moved:.{decimals}f} {unit}")


def _matrix(label: str, old: Any, new: Any) -> Iterable[Difference]:
    worst = 100 * float(np.abs(np.subtract(new, old)).max())
    if worst > 0.0:
        yield Difference(label, "", "", f"changed by up to {worst:.2f} %")


def _date(part: Part | None) -> str:
    return part.date[:10] if part else "not calibrated"


def _age(old: Part, new: Part) -> str:
    days = (new.when() - old.when()).total_seconds() / 86400
    return "the same day" if abs(days) < 0.5 else f"{abs(days):.0f} days {'later' if days > 0 else 'earlier'}"
