"""What the self-calibrating filter makes of a board that is held still, and of one that lies still."""

from __future__ import annotations

from math import hypot, radians
from typing import Any

import numpy as np

from imugui.fusion.quaternion import Floats
from imugui.fusion.self_calibrating_block import Sums
from imugui.samples import GRAVITY

WAIT = 12  # blocks, half a second, for which a rate at rest waits before it is believed
SPREAD = 3.0  # the rates at rest scatter slowly: their standard deviation counts threefold
SLOW = radians(2.0)  # rad/s, largest bias that may be mistaken for a turn
STEADY = radians(0.2)  # rad/s, scatter of the mean rates below which a board lies on something firm
RATE = radians(0.05)  # rad/s, noise of a block's mean rate at rest
STANDING = 0.02  # m/s, noise of a block's velocity at rest

STILL = 0.03  # m/s, velocity of a hand that holds still
PER_RATE = 1.0  # m, more for each rad/s that it turns
PER_FORCE = 0.15  # s, more for each m/s2 by which the force's norm differs from gravity's
STILL_MEMORY = 0.3  # s, for which such a velocity lasts
FAST = 1.0  # m/s, beyond which nothing is learnt from it


def still_variance(sums: Sums) -> float | None:
    """Variance (m2/s2) of the velocity 0 that a block suggests which hardly turns and feels just gravity.

    sigma = STILL + PER_RATE |w| + PER_FORCE ||a| - g|, as a density over STILL_MEMORY; None when it says nothing.
    """
    rate = (sums.turning / sums.time) ** 0.5
    x, y, z = sums.force.tolist()
    force = (x * x + y * y + z * z) ** 0.5 / sums.time
    sigma = STILL + PER_RATE * rate + PER_FORCE * abs(force - GRAVITY)
    return None if sigma > FAST else sigma * sigma * STILL_MEMORY / sums.time


class RestRates:
    """The mean rates of the blocks that may be rest, held back for half a second.

    A motion that begins slowly is still called rest for a moment; by the time its rates come up the rest has ended,
    or at least their scatter says how little they are worth.
    """

    def __init__(self) -> None:
        self._rates: list[list[float]] = []

    def push(self, rate: Floats, bias: Floats, rest: bool) -> tuple[list[float], list[float]] | None:
        """Take a block's mean rate (3,), rad/s; returns one half a second old with its variances when it was rest.

        It was when the rest detector says so, or when the rates scatter as little as only those of a lying board.
        """
        x, y, z = (rate - bias).tolist()
        if not rest and hypot(x, y, z) > SLOW:
            self._rates.clear()
            return None
        self._rates.append(rate.tolist())
        if len(self._rates) <= WAIT:
            return None
        spread = np.array(self._rates).std(axis=0)
        oldest = self._rates.pop(0)
        if not rest and float(spread.max()) > STEADY:
            return None
        return oldest, (RATE**2 + (SPREAD * spread) ** 2).tolist()

    def clear(self) -> None:
        """The rest has ended."""
        self._rates.clear()

    def state(self) -> list[Any]:
        """The rates held back, as plain lists."""
        return [list(rate) for rate in self._rates]

    def restore(self, state: list[Any]) -> None:
        """Continue from ``state``."""
        self._rates = [list(rate) for rate in state]
