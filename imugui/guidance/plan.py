"""A plan: in which direction a tool shall point, and what that is as a vector.

The patient frame is RAS: x to the patient's right, y anterior, z cranial. A (the direction of insertion) is +y,
C (cranial) is +z, and M (medial) is +x for an entry on the left, -x for one on the right. The plain mode's local
frame is the box's own at the moment of Set origin: x ahead (A), y to the patient's left, z up (C).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from imugui.fields import field
from imugui.fusion.attitude import from_euler
from imugui.fusion.quaternion import Floats, from_matrix, multiply, rotate

FRAME = "RAS"
"""Name of the patient frame, kept with every stored vector."""
ANTERIOR, CRANIAL = (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
MEDIAL = {"left": (1.0, 0.0, 0.0), "right": (-1.0, 0.0, 0.0)}
LOCAL_TO_RAS = ((0.0, -1.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0))
"""v_RAS = LOCAL_TO_RAS @ v_local: ahead is anterior, left is the patient's left, up is cranial."""

KINDS = ("projected", "plain")
SIDES = ("left", "right", "")
LEVELS = (*(f"T{n}" for n in range(1, 13)), *(f"L{n}" for n in range(1, 6)), "S1")
REFERENCES = ("superior end-plate", "table normal")
CONVENTION = (
    "Axial: the angle from the vertebral midline seen in the axial slice, positive when the tip goes medial. "
    "Sagittal: the angle seen in the sagittal plane from the superior end-plate or from the normal of the table, as "
    "the plan says, positive when the tip goes cranial. Both are projected angles: each is what one would measure on "
    "its own slice, and neither is turned after the other. Plain: yaw, then pitch, then roll from the origin; "
    "positive yaw turns to the left, positive pitch down, positive roll to the right."
)

_STEEP = 89.9  # degrees; at 90 a projected angle has no direction
_POLE = 1e-6  # rad from C within which rounding would decide which way cranial is


@dataclass(frozen=True)
class Plan:
    """One trajectory. Degrees and millimetres, as a person enters them; NaN: no depth, any roll."""

    name: str = field("", "Level", tip="T1 to S1, or any words")
    kind: str = field("projected", "Kind", choices=KINDS, tip="two plane angles, or yaw and pitch from the origin")
    side: str = field("", "Side", choices=SIDES, tip="the patient's side on which the tool enters")
    axial_deg: float = field(0.0, "Axial", unit="°", low=-_STEEP, high=_STEEP, step=0.5, tip="positive is medial")
    sagittal_deg: float = field(0.0, "Sagittal", unit="°", low=-_STEEP, high=_STEEP, step=0.5, tip="positive: cranial")
    yaw_deg: float = field(0.0, "Yaw", unit="°", low=-180.0, high=180.0, step=1.0, tip="positive turns left")
    pitch_deg: float = field(0.0, "Pitch", unit="°", low=-90.0, high=90.0, step=1.0, tip="positive turns down")
    roll_deg: float = field(math.nan, "Roll", unit="°", low=-180.0, high=180.0, step=1.0, tip="empty: any")
    depth_mm: float = field(math.nan, "Depth", unit=" mm", low=1.0, high=300.0, step=1.0, tip="empty: none")
    tolerance_deg: float = field(2.0, "Green up to", unit="°", low=0.1, high=45.0, step=0.5)
    amber_deg: float = field(5.0, "Amber up to", unit="°", low=0.1, high=90.0, step=0.5)
    reference: str = field(REFERENCES[0], "Sagittal reference", choices=REFERENCES)


FIELDS = {item.name: item for item in fields(Plan)}
ANGLES = {"projected": ("axial_deg", "sagittal_deg"), "plain": ("yaw_deg", "pitch_deg", "roll_deg")}
COMMON = ("name", "kind", "side", "depth_mm", "tolerance_deg", "amber_deg", "reference")
MAY_BE_OPEN = ("depth_mm", "roll_deg")
"""Numbers that may be NaN."""


def problems(plan: Plan) -> dict[str, str]:
    """What is wrong with a plan: field name -> one sentence; empty when it can be used.

    Fields that the plan's kind does not use are not looked at.
    """
    found = {}
    for name in (*COMMON, *ANGLES.get(plan.kind, ())):
        wrong = field_problem(name, getattr(plan, name))
        if wrong:
            found[name] = wrong
    if plan.kind == "projected" and plan.side == "":
        found["side"] = "Side is open: say left or right, because medial depends on it."
    if not {"tolerance_deg", "amber_deg"} & set(found) and plan.amber_deg < plan.tolerance_deg:
        found["amber_deg"] = (
            f"Amber ends at {plan.amber_deg:g}°, inside green, which goes up to {plan.tolerance_deg:g}°."
        )
    return found


def field_problem(name: str, value: Any) -> str:
    """What is wrong with one value of a plan on its own, one sentence; empty when nothing is."""
    item = FIELDS[name]
    label, choices = item.metadata["label"], item.metadata["choices"]
    if type(item.default) is float:
        return _number_problem(name, value)
    if not isinstance(value, str):
        return f"{label} must be text, not {value!r:.40}."
    if choices and value not in choices:
        return f"{label} is {value!r:.40}: it must be {_either(choices)}."
    return _name_problem(value) if name == "name" else ""


def _number_problem(name: str, value: Any) -> str:
    meta = FIELDS[name].metadata
    label, unit, low, high = (meta[key] for key in ("label", "unit", "low", "high"))
    if isinstance(value, bool) or not isinstance(value, int | float):
        return f"{label} must be a number, not {value!r:.40}."
    if math.isnan(value):
        return "" if name in MAY_BE_OPEN else f"{label} is not a number."
    if not low <= value <= high:
        return f"{label} is {value:g}{unit}: it must lie between {low:g} and {high:g}{unit}."
    return ""


def _name_problem(name: str) -> str:
    if not name.strip():
        return "Level is empty: name the trajectory, for example L4."
    if len(name) > 40:
        return f"Level has {len(name)} characters: 40 is the most."
    if name != name.strip() or not name.isprintable():
        return "Level must be plain text without spaces at its ends."
    if name[0] in "=+-@":
        return f"Level begins with {name[0]}, which a spreadsheet takes for a formula."
    return ""


def _either(choices: tuple[str, ...]) -> str:
    *most, last = (choice or "empty" for choice in choices)
    return f"{', '.join(most)} or {last}"


def list_problems(plans: list[Plan] | tuple[Plan, ...]) -> list[dict[str, str]]:
    """``problems`` of each plan of a list, and which of them name the same trajectory twice."""
    found = [problems(plan) for plan in plans]
    first: dict[tuple[str, str], int] = {}
    for number, plan in enumerate(plans):
        before = first.setdefault(identity(plan), number)
        if before != number and "name" not in found[number]:
            found[number]["name"] = f"{title(plan)} is already there, in row {before + 1}."
    return found


def identity(plan: Plan) -> tuple[str, str]:
    """What must differ between two plans of a list: level, whatever its case, and side."""
    return str(plan.name).strip().casefold(), str(plan.side)


def title(plan: Plan) -> str:
    """Level and side, as in "L4 left"."""
    return f"{plan.name} {plan.side}".strip()


def plan_words(plan: Plan) -> str:
    """The angles in words, never as bare signs: "12° medial, 5° caudal"."""
    if plan.kind == "projected":
        axial = _signed(plan.axial_deg, "medial", "lateral")
        return f"{axial}, {_signed(plan.sagittal_deg, 'cranial', 'caudal')}"
    said = f"yaw {_signed(plan.yaw_deg, 'left', 'right')}, pitch {_signed(plan.pitch_deg, 'down', 'up')}"
    return said if math.isnan(plan.roll_deg) else f"{said}, roll {_signed(plan.roll_deg, 'right', 'left')}"


def _signed(angle_deg: float, positive: str, negative: str) -> str:
    return f"{abs(angle_deg):g}° {negative if angle_deg < 0.0 else positive}"


def direction(plan: Plan, tool_axis: ArrayLike = (1.0, 0.0, 0.0)) -> Floats:
    """Where the tool shall point, unit vector (3,) in RAS.

    Projected: d ~ A + tan(axial) M + tan(sagittal) C. Plain: the tool's axis, (3,) in the box's axes, at the planned
    attitude, with roll 0 when any will do. ValueError: an angle or the side is wrong.
    """
    _refuse_bad(plan)
    if plan.kind == "plain":
        axis = np.asarray(tool_axis, float)
        return _unit(rotate(attitude(plan), axis))
    medial, cranial = math.tan(math.radians(plan.axial_deg)), math.tan(math.radians(plan.sagittal_deg))
    return _unit(np.array(ANTERIOR) + medial * np.array(MEDIAL[plan.side]) + cranial * np.array(CRANIAL))


def attitude(plan: Plan) -> Floats:
    """The planned attitude of a plain plan, quaternion (4,) box -> RAS, with roll 0 when any will do.

    ValueError: an angle is wrong, or the plan is projected and so has a direction only.
    """
    _refuse_bad(plan)
    if plan.kind != "plain":
        raise ValueError("A projected plan has a direction but no attitude.")
    roll_deg = 0.0 if math.isnan(plan.roll_deg) else plan.roll_deg
    local = from_euler(*np.radians((plan.yaw_deg, plan.pitch_deg, roll_deg)))
    return multiply(from_matrix(LOCAL_TO_RAS), local)


def _refuse_bad(plan: Plan) -> None:
    found = problems(plan)
    for name in ("kind", "side", *ANGLES.get(plan.kind, ())):
        if name in found:
            raise ValueError(found[name])


def plane_angles(d: ArrayLike, side: str) -> Floats:
    """Axial and sagittal angle in rad, shape (..., 2), of directions (..., 3) in RAS; the inverse of ``direction``.

    Medial and cranial are positive; without a side the patient's right counts as medial.
    """
    d = np.asarray(d, float)
    medial = screen_sign(side) * d[..., 0]
    return np.stack((np.arctan2(medial, d[..., 1]), np.arctan2(d[..., 2], d[..., 1])), axis=-1)


def target_basis(p: ArrayLike, side: str) -> tuple[Floats, Floats]:
    """Unit tangents (m', c') at the plan's direction p, each (3,) in RAS, square to p and to each other.

    c' is C made orthogonal to p, m' is square to both and points to M's side: for an entry on the left, and without
    a side, to the right of one who looks along p with c' up; for an entry on the right to the left. Where p is C
    itself (or -C), c' is what it becomes when A is tilted there: posterior (anterior).
    """
    p = _unit(p)
    level = math.hypot(p[0], p[1])
    if level > _POLE:
        cranial = _unit((-p[0] * p[2] / level, -p[1] * p[2] / level, level))
    else:
        cranial = np.array((0.0, -math.copysign(1.0, p[2]), 0.0))
        cranial = _unit(cranial - (cranial @ p) * p)
    return screen_sign(side) * np.cross(p, cranial), cranial


def screen_sign(side: str) -> float:
    """+1 where m' lies to the right of one who looks along the tool with cranial up, -1 where it lies to the left."""
    return -1.0 if side == "right" else 1.0


def _unit(v: ArrayLike) -> Floats:
    v = np.asarray(v, float)
    return np.asarray(v / np.linalg.norm(v))
