"""How a filter that is built for one sampling time keeps up with samples that have another."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

DEPARTURE = 0.06  # relative; a smaller one changes the gains by less than matters
WINDOW = 1.0  # s


class Spacing:
    """The mean time between samples, taken over windows that grow from one sample to a second."""

    def __init__(self) -> None:
        self._window = 0.0  # s, length of the present window
        self._time = 0.0
        self._count = 0

    def departed(self, dt: float, assumed: float) -> float | None:
        """Take one spacing in s; the mean of a full window when it is more than 6 % off the ``assumed`` one."""
        self._time += dt
        self._count += 1
        if self._time < self._window or self._time <= 0.0:
            return None
        mean = self._time / self._count
        self._window = min(WINDOW, 4.0 * self._time)
        self._time, self._count = 0.0, 0
        return mean if abs(mean - assumed) > DEPARTURE * assumed else None

    def walked(self, dts: NDArray[np.float64], assumed: float) -> dict[str, Any] | None:
        """The state after spacings (n,) in s, each taken as by ``departed``; None when one of them would depart."""
        window, time, count, at = self._window, self._time, self._count, 0
        while at < len(dts):
            # added one after the other: np.sum would round differently
            times = np.add.accumulate(np.concatenate(([time], dts[at:])))[1:]
            full = (times >= window) & (times > 0.0)
            if not full.any():
                time, count = float(times[-1]), count + len(times)
                break
            k = int(np.argmax(full))
            time, count, at = float(times[k]), count + k + 1, at + k + 1
            if abs(time / count - assumed) > DEPARTURE * assumed:
                return None
            window, time, count = min(WINDOW, 4.0 * time), 0.0, 0
        return {"_window": window, "_time": time, "_count": count}

    def state(self) -> dict[str, Any]:
        """Everything that the next call depends on, as plain numbers."""
        return dict(vars(self))

    def restore(self, state: dict[str, Any]) -> None:
        """Continue from ``state``."""
        vars(self).update(state)


# each second-order low-pass of the library: its state, its coefficients, and its last output where that is kept
_LOW_PASSES = (
    ("accLpState", "accLp", "lastAccLp"),
    ("motionBiasEstRLpState", "accLp", None),
    ("motionBiasEstBiasLpState", "accLp", None),
    ("restGyrLpState", "restGyrLp", "restLastGyrLp"),
    ("restAccLpState", "restAccLp", "restLastAccLp"),
    ("magNormDipLpState", "magNormDipLp", "magNormDip"),
)


def carried_over(state: dict[str, Any], old: dict[str, Any], new: dict[str, Any]) -> dict[str, Any]:
    """The library's ``state`` for coefficients ``new`` instead of ``old``, so that no low-pass output jumps.

    All else in the state (quaternions, bias and its covariance, times, references) does not depend on them.
    """
    carried = dict(state)
    for name, prefix, last in _LOW_PASSES:
        before, after = ([*c[prefix + "B"], *c[prefix + "A"]] for c in (old, new))
        if before != after:
            carried[name] = _adapted(state[name], state[last] if last else None, before, after)
    return carried


def _adapted(memory: list[float], outputs: list[float] | None, old: list[float], new: list[float]) -> list[float]:
    """The two memories of each channel moved from where the old filter rests at its last output to where the new does.

    A filter y = b0 x + s0 (transposed direct form II) that rests at y has s0 = (1 - b0) y and s1 = (b2 - a2) y.
    Where the library does not keep the last output, s0 is close to it, as b0 is small.
    """
    if memory[0] != memory[0]:
        return memory  # NaN: still averaging its first samples, which needs no coefficients
    first, second = old[0] - new[0], (new[2] - new[4]) - (old[2] - old[4])
    moved = list(memory)
    for i, y in enumerate(outputs if outputs is not None else memory[::2]):
        moved[2 * i] += first * y
        moved[2 * i + 1] += second * y
    return moved
