"""Where to turn the board next, as a direction in the sensor frame and as a sentence."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

TAKES_PART = 0.4
"""A component of a unit vector from which on its axis is named."""

LEVEL_DIP_DEG = 25.0


def side(direction: ArrayLike) -> str:
    """The side, edge or corner of the board that a vector (3,) in the sensor frame comes out of."""
    vector = np.asarray(direction, float)
    vector = vector / max(float(np.linalg.norm(vector)), 1e-12)
    order = np.argsort(-np.abs(vector))
    names = [("+" if vector[i] > 0 else "−") + "xyz"[i] for i in order if abs(vector[i]) >= TAKES_PART]
    if len(names) == 1:
        return f"{names[0]} side"
    return f"edge between {names[0]} and {names[1]}" if len(names) == 2 else f"corner of {', '.join(names)}"


def turn_next(gap: ArrayLike, dip_deg: float) -> str:
    """One sentence that brings the field into the direction ``gap`` (3,), sensor frame, where it has not been yet."""
    if abs(dip_deg) < LEVEL_DIP_DEG:
        place = "to the magnetic north"
    else:
        place = f"to the {'floor' if dip_deg > 0 else 'ceiling'}, leaning to the north"
    return f"Turn the board until its {side(gap)} points {place}."
