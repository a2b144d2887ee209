"""Registration: what the patient's axes are in the earth frame, in three explicit ways, each with its residual.

The result is a rotation alone, ``v_earth = matrix @ v_RAS``. Without one there is no guidance.
"""

from __future__ import annotations

import hashlib
import json
import math
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from imugui.fusion.quaternion import Floats, conjugate, from_matrix, multiply, rotate, to_matrix, to_rotation_vector
from imugui.guidance.aiming import axis_error
from imugui.guidance.plan import ANTERIOR, CRANIAL, LOCAL_TO_RAS

WARN_DEG, REFUSE_DEG = 3.0, 10.0
"""A residual above the first is warned about, one above the second is refused."""
UP = (0.0, 0.0, 1.0)
POSITIONS: dict[str, tuple[float, float, float]] = {
    "prone": (0.0, -1.0, 0.0),
    "supine": (0.0, 1.0, 0.0),
    "on the left side": (1.0, 0.0, 0.0),
    "on the right side": (-1.0, 0.0, 0.0),
}
"""How the patient lies -> which way of the patient, in RAS, points up."""
METHODS = {"axes": "Two anatomical axes", "mark": "Gravity and one mark", "origin": "Set origin"}

Matrix = tuple[tuple[float, ...], ...]
Spans = tuple[tuple[int, int], ...]


@dataclass(frozen=True)
class Registration:
    """The patient's axes. ``matrix``: three rows; its columns are the patient's right, anterior and cranial in ENU.

    ``t``: time of the last sample used, s; ``rows``: first and last attitude number of each step; ``id``: hash of all
    these values.
    """

    method: str
    matrix: Matrix
    residual_deg: float
    t: float
    rows: Spans
    words: str
    id: str = ""

    @property
    def warning(self) -> str:
        """One sentence when the residual is large, else empty."""
        if self.residual_deg <= WARN_DEG:
            return ""
        return (
            f"The residual is {self.residual_deg:.1f}°, more than {WARN_DEG:g}°: every reading may be off by as much. "
            "Register again."
        )

    def to_dict(self) -> dict[str, Any]:
        """Plain values for JSON."""
        return asdict(self)


def from_axes(anterior: ArrayLike, cranial: ArrayLike, t: float = math.nan, rows: Spans = ()) -> Registration:
    """The tool laid along A and then along C: two directions (3,) in the earth frame.

    Both get the same weight: what they miss of a right angle is shared (the residual is all of it). ValueError:
    not a direction, or more than 10 degrees off a right angle.
    """
    anterior, cranial = _direction(anterior, "anterior"), _direction(cranial, "cranial")
    apart_deg = math.degrees(float(axis_error(anterior, cranial)))
    residual_deg = abs(apart_deg - 90.0)
    if residual_deg > REFUSE_DEG:
        raise ValueError(
            f"The two axes were measured {apart_deg:.0f}° apart instead of 90°; {REFUSE_DEG:g}° off is the most. "
            "Lay the tool along each axis again."
        )
    middle, across = anterior + cranial, anterior - cranial  # square to each other, whatever the angle
    matrix = _triad(middle, across, np.add(ANTERIOR, CRANIAL), np.subtract(ANTERIOR, CRANIAL))
    words = f"{METHODS['axes']}: measured {apart_deg:.1f}° apart instead of 90°, each moved by {residual_deg / 2:.1f}°."
    return _named("axes", matrix, residual_deg, t, rows, words)


def from_mark(cranial: ArrayLike, position: str = "prone", t: float = math.nan, rows: Spans = ()) -> Registration:
    """Gravity gives the patient's vertical; the tool laid towards the head, (3,) in the earth frame, the heading.

    The table is taken as level: the residual is how far the mark points above or below the horizon. ValueError:
    unknown position, not a direction, or more than 10 degrees off the horizon.
    """
    if position not in POSITIONS:
        raise ValueError(f"The position {position!r} is unknown; there are {', '.join(POSITIONS)}.")
    mark = _direction(cranial, "mark")
    above_deg = math.degrees(math.atan2(mark[2], math.hypot(mark[0], mark[1])))
    if abs(above_deg) > REFUSE_DEG:
        raise ValueError(
            f"The mark points {abs(above_deg):.0f}° {_above(above_deg)} the horizon; {REFUSE_DEG:g}° is the most. "
            "Lay the tool level, towards the head; on a tilted table use the two anatomical axes."
        )
    matrix = _triad(UP, (mark[0], mark[1], 0.0), POSITIONS[position], CRANIAL)
    words = f"{METHODS['mark']}: patient {position}; the mark is {abs(above_deg):.1f}° {_above(above_deg)} the horizon."
    return _named("mark", matrix, abs(above_deg), t, rows, words)


def from_origin(
    quats: ArrayLike, tool_axis: ArrayLike = (1.0, 0.0, 0.0), t: float = math.nan, rows: Spans = ()
) -> Registration:
    """The box as it is now is the zero: its x, y, z axes are anterior, the patient's left and cranial.

    ``quats``: one attitude (4,) or those of a held pose (n, 4), sensor -> earth. The residual is how far the box moved
    meanwhile (rms); nothing else can be checked. ``tool_axis`` (3,), in the box's axes, is named in the words.
    ValueError: no attitude, or the box moved by more than 10 degrees.
    """
    quats = _finite(np.atleast_2d(np.asarray(quats, float)))
    mean = from_matrix(_nearest_rotation(to_matrix(quats).mean(axis=0)))
    turns = to_rotation_vector(multiply(conjugate(mean), quats))
    moved_deg = math.degrees(float(np.sqrt(np.mean((turns**2).sum(axis=1)))))
    if moved_deg > REFUSE_DEG:
        raise ValueError(f"The box moved by {moved_deg:.0f}° meanwhile; {REFUSE_DEG:g}° is the most. Hold it still.")
    aside_deg = math.degrees(float(axis_error(tool_axis, (1.0, 0.0, 0.0))))
    words = (
        f"{METHODS['origin']}: the box moved by {moved_deg:.1f}° meanwhile, which is all that can be checked; the "
        f"tool's axis is {aside_deg:.1f}° from the box's x axis."
    )
    return _named("origin", to_matrix(mean) @ np.transpose(LOCAL_TO_RAS), moved_deg, t, rows, words)


def mean_axis(quats: ArrayLike, tool_axis: ArrayLike) -> tuple[Floats, float]:
    """Where the tool pointed in a held pose: unit mean (3,) in the earth frame, and the rms angle from it, rad.

    ``quats`` (n, 4) sensor -> earth; ``tool_axis`` (3,) in the box's axes. ValueError: no attitude at all.
    """
    directions = rotate(_finite(np.atleast_2d(np.asarray(quats, float))), tool_axis)
    mean = _direction(directions.mean(axis=0), "held")
    return mean, float(np.sqrt(np.mean(axis_error(directions, mean) ** 2)))


def to_patient(registration: Registration, quats: ArrayLike) -> Floats:
    """Attitudes box -> RAS, (..., 4), of attitudes box -> earth, (..., 4)."""
    return multiply(from_matrix(np.transpose(registration.matrix)), quats)


def tool_direction(registration: Registration, quats: ArrayLike, tool_axis: ArrayLike) -> Floats:
    """Where the tool points in RAS, (..., 3), from attitudes box -> earth (..., 4) and its axis in the box (3,)."""
    return np.asarray(rotate(quats, tool_axis) @ np.asarray(registration.matrix))


def from_dict(values: dict[str, Any]) -> Registration:
    """A registration as ``to_dict`` gave it; ValueError in words when it is none or was changed since."""
    try:
        matrix = tuple(tuple(float(value) for value in row) for row in values["matrix"])
        rows = tuple((int(first), int(last)) for first, last in values["rows"])
        method, words = str(values["method"]), str(values["words"])
        numbers = [math.nan if values[key] is None else float(values[key]) for key in ("residual_deg", "t")]
        found = _named(method, np.array(matrix).reshape(3, 3), numbers[0], numbers[1], rows, words)
    except (KeyError, TypeError, ValueError) as error:
        raise ValueError(f"This is no registration: {error}.") from error
    axes = np.array(matrix)
    square = np.abs(axes).max() < 2.0 and np.allclose(axes @ axes.T, np.eye(3), atol=1e-6)  # larger ones overflow
    if method not in METHODS or not square or np.linalg.det(axes) < 0.0:
        raise ValueError("This is no registration: its axes are not a right-handed set at right angles.")
    if found.id != values.get("id"):
        raise ValueError("The registration was changed after it was made: its values do not fit its identity.")
    return found


def _named(method: str, matrix: Floats, residual_deg: float, t: float, rows: Spans, words: str) -> Registration:
    """With the hash of its values as identity."""
    plain: Matrix = tuple(tuple(row) for row in matrix.tolist())
    whole = Registration(method, plain, residual_deg, t, rows, words)
    text = json.dumps(whole.to_dict(), sort_keys=True)
    return replace(whole, id=hashlib.sha256(text.encode()).hexdigest()[:12])


def _triad(first: ArrayLike, second: ArrayLike, first_ras: ArrayLike, second_ras: ArrayLike) -> Floats:
    """The rotation RAS -> earth that takes two vectors square to each other there to two here (H. D. Black, 1964)."""
    return np.asarray(_frame(first, second) @ _frame(first_ras, second_ras).T)


def _frame(first: ArrayLike, second: ArrayLike) -> Floats:
    one, two = (np.asarray(v, float) / np.linalg.norm(v) for v in (first, second))
    return np.stack((one, two, np.cross(one, two)), axis=1)


def _nearest_rotation(matrix: Floats) -> Floats:
    """The mean rotation of a mean matrix (M. Moakher, SIAM J. Matrix Anal. 24, 2002, projected mean)."""
    u, _, vt = np.linalg.svd(matrix)
    return np.asarray(u @ np.diag((1.0, 1.0, np.linalg.det(u @ vt))) @ vt)


def _direction(v: ArrayLike, name: str) -> Floats:
    v = np.asarray(v, float).reshape(3)
    size = float(np.linalg.norm(v))
    if not 1e-9 < size < math.inf:
        raise ValueError(f"The {name} direction is not known: hold the tool still along it.")
    return v / size


def _finite(quats: Floats) -> Floats:
    good = quats[np.isfinite(quats).all(axis=1)]
    if len(good) == 0:
        raise ValueError("There is no attitude to take: wait until the board sends.")
    return good


def _above(angle_deg: float) -> str:
    return "below" if angle_deg < 0.0 else "above"
