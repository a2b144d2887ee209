"""The 1-euro filter: steady when the hand is still, quick when it moves."""

from __future__ import annotations

from math import hypot, tau

from imugui.targeting.view_pose import ZERO, Pair


def share(cutoff_hz: float, dt: float) -> float:
    """The weight of a new value in a first-order low-pass of this cut-off, ``dt`` s after the value before."""
    return 1.0 / (1.0 + 1.0 / (tau * cutoff_hz * dt))


class OneEuro:
    """G. Casiez, N. Roussel, D. Vogel, "1 € filter", CHI 2012, equations 1 to 6, on two numbers at once.

    The cut-off follows the speed of the two together, so that the direction is not bent; a lone number goes in as
    (x, 0). The speed is taken from the last filtered value, as in the authors' code.
    """

    def __init__(self, min_cutoff_hz: float = 1.0, beta: float = 0.0, derivative_cutoff_hz: float = 1.0) -> None:
        self.min_cutoff_hz = min_cutoff_hz
        self.beta = beta  # Hz per unit per second
        self.derivative_cutoff_hz = derivative_cutoff_hz
        self.value: Pair | None = None
        self._speed = ZERO

    def reset(self, value: Pair | None = None) -> None:
        """Begin again at ``value``, at rest there; None takes the next value as it comes."""
        self.value, self._speed = value, ZERO

    def update(self, x: Pair, dt: float) -> Pair:
        """The filtered value, ``dt`` s after the value before; without time in between nothing changes."""
        if self.value is None:
            self.value = x
        elif dt > 0.0:
            a, b = self.value
            da, db = x[0] - a, x[1] - b
            k = share(self.derivative_cutoff_hz, dt)
            va, vb = self._speed
            va, vb = va + k * (da / dt - va), vb + k * (db / dt - vb)
            k = share(self.min_cutoff_hz + self.beta * hypot(va, vb), dt)
            self._speed = va, vb
            self.value = a + k * da, b + k * db
        return self.value
