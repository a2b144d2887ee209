"""Smooth functions of time from which the motions are made: all have continuous first and second derivatives."""

from __future__ import annotations

import numpy as np

from imugui.simulation.path import Floats


def smooth_step(u: Floats) -> Floats:
    """0 for u <= 0, 1 for u >= 1, in between the quintic 6u^5 - 15u^4 + 10u^3."""
    u = np.clip(u, 0.0, 1.0)
    step: Floats = u**3 * (10 - 15 * u + 6 * u**2)
    return step


def soft_start(t: Floats, still_s: float, ramp_s: float) -> Floats:
    """A clock (n,) in s that stands for ``still_s``, gathers speed for ``ramp_s`` and then runs at full rate."""
    u = np.clip((t - still_s) / ramp_s, 0.0, 1.0)
    running = np.maximum(t - still_s - ramp_s, 0.0)
    clock: Floats = ramp_s * (2.5 * u**4 - 3 * u**5 + u**6) + running
    return clock


class Wander:
    """A sum of sines in three axes with drawn frequencies and phases: tremor, sway, rough ground."""

    def __init__(self, rng: np.random.Generator, low_hz: float, high_hz: float, rms: float, count: int = 8) -> None:
        self._omega = 2 * np.pi * rng.uniform(low_hz, high_hz, (count, 3))
        self._phase = rng.uniform(0, 2 * np.pi, (count, 3))
        self._amplitude = rms * np.sqrt(2 / count)

    def __call__(self, t: Floats) -> Floats:
        """Values (n, 3) of the given rms per axis at times t (n,) in s."""
        angle = t[:, None, None] * self._omega + self._phase
        values: Floats = self._amplitude * np.sin(angle).sum(axis=1)
        return values
