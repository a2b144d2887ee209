"""The robot that follows late: a first-order lag and a pure delay, two separate things.

People adapt to slowness, not to dead time (Rakita et al. 2020).
"""

from __future__ import annotations

from collections import deque

from imugui.targeting.view_pose import ZERO, Pair


class FirstOrderLag:
    """y_k = a y_{k-1} + (1 - a) u_k with a = tau / (tau + dt) and the measured dt (Erat 2018, equation 6.4).

    Written as a step towards u: a value that has arrived then stays exactly where it is.
    """

    def __init__(self, tau_s: float) -> None:
        self.tau_s = tau_s
        self.value = ZERO

    def reset(self, value: Pair = ZERO) -> None:
        """At rest at ``value``."""
        self.value = value

    def update(self, u: Pair, dt: float) -> Pair:
        """The output ``dt`` s later, the input being u."""
        if self.tau_s > 0.0:
            k = dt / (self.tau_s + dt)
            a, b = self.value
            self.value = a + k * (u[0] - a), b + k * (u[1] - b)
        elif dt > 0.0:
            self.value = u
        return self.value


class DeadTime:
    """What the input was ``delay_s`` ago, straight between its samples, in sample time."""

    def __init__(self, delay_s: float) -> None:
        self.delay_s = delay_s
        self._seen: deque[tuple[float, Pair]] = deque()

    def reset(self, t: float, value: Pair = ZERO) -> None:
        """The input was ``value`` until t in s."""
        self._seen.clear()
        self._seen.append((t, value))

    def update(self, t: float, u: Pair) -> Pair:
        """Take the input at t in s, not before the last one; the first call without ``reset`` starts at u."""
        if self.delay_s <= 0.0:
            return u
        seen = self._seen
        seen.append((t, u))
        wanted = t - self.delay_s
        while len(seen) > 1 and seen[1][0] <= wanted:
            seen.popleft()
        t0, before = seen[0]
        if wanted <= t0:
            return before
        t1, after = seen[1]
        part = (wanted - t0) / (t1 - t0)
        return before[0] + part * (after[0] - before[0]), before[1] + part * (after[1] - before[1])
