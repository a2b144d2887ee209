"""The three ways to register, as steps that each hold the tool in one pose."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from imugui.guidance.reading import Vector
from imugui.guidance.registration import Registration, from_axes, from_mark, from_origin, mean_axis
from imugui.views.guide_pose import Pose

Maker = Callable[[Sequence[Pose], Vector, str], Registration]


@dataclass(frozen=True)
class Way:
    """``steps``: (name, what to do); ``make`` gives the registration of the held poses, or raises ValueError."""

    title: str
    words: str
    steps: tuple[tuple[str, str], ...]
    make: Maker
    asks_position: bool = False


def _axes(poses: Sequence[Pose], axis: Vector, _position: str) -> Registration:
    anterior, cranial = (mean_axis(pose.quats, axis)[0] for pose in poses)
    return from_axes(anterior, cranial, poses[-1].t, _rows(poses))


def _mark(poses: Sequence[Pose], axis: Vector, position: str) -> Registration:
    return from_mark(mean_axis(poses[0].quats, axis)[0], position, poses[-1].t, _rows(poses))


def _origin(poses: Sequence[Pose], axis: Vector, _position: str) -> Registration:
    return from_origin(poses[0].quats, axis, poses[-1].t, _rows(poses))


def _rows(poses: Sequence[Pose]) -> tuple[tuple[int, int], ...]:
    return tuple(pose.rows for pose in poses)


ANTERIOR = ("Along the insertion", "Lay the tool from back to front of the patient: the tip points anterior.")
CRANIAL = ("Along the spine", "Lay the tool along the spine: the tip points to the head.")
MARK = ("To the head", "Hold the tool level: the tip points to the patient's head.")
ORIGIN = ("The zero", "Hold the box as zero: its x ahead (anterior), its y to the patient's left, its z to the head.")

WAYS = {
    "axes": Way(
        "Two anatomical axes",
        "The tool is laid along two axes, one after the other. What they miss of a right angle is the residual.",
        (ANTERIOR, CRANIAL),
        _axes,
    ),
    "mark": Way(
        "Gravity and one mark",
        "Gravity says where up is, the tool where the head is. The table must be level.",
        (MARK,),
        _mark,
        asks_position=True,
    ),
    "origin": Way(
        "Set origin",
        "The box as it is held now becomes zero. Nothing is measured twice, so nothing can be checked.",
        (ORIGIN,),
        _origin,
    ),
}
"""By the method of a Registration."""
