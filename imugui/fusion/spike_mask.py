"""SpikeMask: which samples a press of the board's own button shakes, and what to hold in their place."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from imugui.fusion.scalar import MAX_DT
from imugui.samples import NO_STATUS

MASK_S = 0.020
"""s; how long a press is felt (E. Erat's motion card: button spike filter)."""
ROUNDING_S = 1e-6  # times are sums

Flags = NDArray[np.bool_]
Floats = NDArray[np.float64]


class SpikeMask:
    """The sample whose status differs from the one before, and those of the 20 ms after it, are masked.

    A finger on a button shakes the card: its accelerometer says nothing of the vertical then. The gyroscope is right.
    After a gap the status may have changed long ago, so that nothing is masked. The result does not depend on how
    the samples are cut into blocks.
    """

    def __init__(self) -> None:
        self._t = np.nan  # of the last sample
        self._status = NO_STATUS  # the last one known
        self._changed = np.nan  # when it changed, s
        self._acc: Floats = np.full(3, np.nan)  # the last one that was not masked, m/s2

    def step(self, t: Floats, status: NDArray[np.int16], acc: Floats) -> tuple[Flags, Floats]:
        """Take samples, t (n,) s, status (n,), acc (n, 3) m/s2; returns which are masked, and acc held through them."""
        seen = np.concatenate(([self._status], status))
        seen = seen[_newest(seen != NO_STATUS)]
        steps = np.diff(t, prepend=self._t)
        pressed = (seen[1:] != seen[:-1]) & (seen[:-1] != NO_STATUS) & (np.abs(steps) <= MAX_DT)
        changes = np.concatenate(([self._changed], np.where(pressed, t, np.nan)))
        changes = changes[_newest(np.isfinite(changes))]
        since = t - changes[1:]
        masked = (since >= 0.0) & (since <= MASK_S + ROUNDING_S)
        forces = np.concatenate((self._acc[None], acc))
        held = forces[_newest(np.concatenate(([True], ~masked)))]
        if len(t):
            self._t, self._status, self._changed, self._acc = t[-1], int(seen[-1]), changes[-1], held[-1]
        return masked, held[1:]

    def state(self) -> dict[str, Any]:
        """Everything that the next step depends on, as plain numbers and lists."""
        return {
            "t": float(self._t),
            "status": self._status,
            "changed": float(self._changed),
            "acc": self._acc.tolist(),
        }

    def restore(self, state: dict[str, Any]) -> None:
        """Continue from ``state``; KeyError, TypeError or ValueError when it is none."""
        self._t, self._changed = np.float64(state["t"]), np.float64(state["changed"])
        self._status = int(state["status"])
        self._acc = np.array(state["acc"], float).reshape(3)


def _newest(known: Flags) -> NDArray[np.intp]:
    """For each place the index of the newest known one so far, 0 before the first."""
    return np.maximum.accumulate(np.where(known, np.arange(len(known)), 0))
